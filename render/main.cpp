#include "render/app.h"

int main(int argc, char** argv) {
  return triglyph::run_render_app(argc, argv);
}
