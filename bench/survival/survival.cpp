// triglyph_survival MESH...: marks each mesh with an 8-byte message under every scheme, does what
// happens to meshes to it, eight times each, and prints how often the message came back.
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "engine/base/error.h"
#include "engine/io/mesh_file.h"
#include "engine/marking/extract.h"
#include "engine/marking/mark.h"
#include "engine/scheme/registry.h"
#include "tests/support/attacks.h"
#include "tests/support/remeshing.h"

namespace triglyph {
namespace {

constexpr int kTrials = 8;

using Attack = std::function<Mesh(const Mesh& mesh, std::uint64_t seed)>;

struct NamedAttack {
  const char* name;
  Attack apply;
};

std::vector<NamedAttack> attacks() {
  using namespace test;
  const auto noise = [](double intensity) {
    return
        [=](const Mesh& m, std::uint64_t seed) { return with_uniform_noise(m, intensity, seed); };
  };
  const auto turned_and_quantised = [](int bits) {
    return [=](const Mesh& m, std::uint64_t seed) {
      return quantised(moved_rigidly_and_scaled(m, seed), bits);
    };
  };
  const auto affine = [](double condition, bool reflect) {
    return [=](const Mesh& m, std::uint64_t seed) {
      return affinely_mapped(m, condition, reflect, seed);
    };
  };
  return {
      {"nothing", [](const Mesh& m, std::uint64_t) { return m; }},
      {"order of vertices, faces, corners", shuffled},
      {"rotation, scale, shift", moved_rigidly_and_scaled},
      {"6 significant digits",
       [](const Mesh& m, std::uint64_t) { return with_significant_digits(m, 6); }},
      {"moved as above, then 6 significant digits",
       [](const Mesh& m, std::uint64_t seed) {
         return with_significant_digits(moved_rigidly_and_scaled(m, seed), 6);
       }},
      {"affine, condition 2", affine(2, false)},
      {"affine, condition 4", affine(4, false)},
      {"affine, condition 4, reflected", affine(4, true)},
      {"quantised to 12 bits", turned_and_quantised(12)},
      {"quantised to 11 bits", turned_and_quantised(11)},
      {"quantised to 10 bits", turned_and_quantised(10)},
      {"quantised to 9 bits", turned_and_quantised(9)},
      {"noise 0.01 %", noise(0.0001)},
      {"noise 0.05 %", noise(0.0005)},
      {"noise 0.1 %", noise(0.001)},
      {"noise 0.3 %", noise(0.003)},
      {"half cut away", cropped_half},
      {"one smoothing step", [](const Mesh& m, std::uint64_t) { return test::smoothed(m); }},
      {"10 % of points decimated",
       [](const Mesh& m, std::uint64_t) { return test::decimated(m, 0.1); }},
      {"inside out", [](const Mesh& m, std::uint64_t) { return test::turned_inside_out(m); }},
      {"mirrored",
       [](const Mesh& m, std::uint64_t) { return test::turned_inside_out(test::mirrored(m)); }},
  };
}

Mesh as_float(Mesh mesh) {
  for (Vec3& p : mesh.positions) p = test::as_float(p);
  return mesh;
}

// A mesh under one scheme.
class Subject {
 public:
  Subject(const Mesh& mesh, const std::string& scheme)
      : options_(default_mark_options(scheme, false)),
        code_(Key::trial(), options_.format),
        scheme_(make_scheme(scheme, code_, options_.scheme_options)),
        marked_(mesh) {
    const Halfedges halfedges = build_halfedges(mesh);
    const Marking marking = mark(
        {mesh, halfedges}, message_, Key::trial(), options_,
        [](const Vec3& p) { return test::as_float(p); }, 0);
    is_marked_ = marking.status == MarkStatus::Marked;
    marked_.positions = marking.positions;
  }
  // How often the message comes back from the attacked mesh, stored as float32.
  [[nodiscard]] int survivals(const Attack& attack) const {
    if (!is_marked_) return -1;
    int count = 0;
    for (std::uint64_t seed = 0; seed < kTrials; ++seed) {
      const Mesh attacked = as_float(attack(marked_, seed));
      const Halfedges halfedges = build_halfedges(attacked);
      const Extraction found = extract(*scheme_->bind({attacked, halfedges}), code_,
                                       doubtful_parts(options_.scheme_options));
      count += found.message == message_ ? 1 : 0;
    }
    return count;
  }

 private:
  Message message_{'s', 'u', 'r', 'v', 'i', 'v', 'e', 's'};
  MarkOptions options_;
  WordCode code_;
  std::unique_ptr<Scheme> scheme_;
  Mesh marked_;
  bool is_marked_ = false;
};

void print_table(const char* path) {
  const Mesh mesh = MeshFile::open(path).mesh();
  std::vector<Subject> subjects;
  std::printf("%s, %zu points; times of %d\n%-36s", path, mesh.positions.size(), kTrials, "");
  for (const std::string_view name : scheme_names()) {
    subjects.emplace_back(mesh, std::string(name));
    std::printf("%7s", std::string(name).c_str());
  }
  std::printf("\n");
  for (const NamedAttack& attack : attacks()) {
    std::printf("%-36s", attack.name);
    for (const Subject& subject : subjects) {
      const int count = subject.survivals(attack.apply);
      std::printf("%7s", count < 0 ? "-" : std::to_string(count).c_str());
    }
    std::printf("\n");
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace triglyph

int main(int argc, char** argv) try {
  for (int i = 1; i < argc; ++i) triglyph::print_table(argv[i]);
  return argc > 1 ? 0 : 2;
} catch (const triglyph::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
