#include "cli/app.h"

int main(int argc, char** argv) {
  return triglyph::run_app(argc, argv);
}
