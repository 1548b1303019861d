// Marks a mesh and reads the message back: mark_and_read IN OUT
#include <iostream>

#include <triglyph/triglyph.h>

int main(int argc, char** argv) {
  if (argc != 3) return std::cerr << "usage: mark_and_read IN OUT\n", 2;
  const auto key = triglyph::SecretKey::generate();  // keep it: SecretKey::save()
  const auto marked = triglyph::mark_file(argv[1], argv[2], {{"message", "for Ada"}}, key);
  if (!marked.marked) return std::cerr << marked.error << "\n", 1;
  const auto found = triglyph::read_file(argv[2], {{key}});
  std::cout << found.message.value_or("no mark") << ", moved by " << 100 * marked.hausdorff_rel_diag
            << " % of the diagonal\n";
}
