#include <cstdio>
#include <iostream>
#include <memory>

#include "cli/app.h"
#include "cli/options.h"
#include "cli/verbs.h"
#include "engine/base/error.h"
#include "engine/base/output_file.h"
#include "engine/base/parallel.h"
#include "engine/base/random.h"
#include "engine/io/export_mesh.h"
#include "engine/samples/sample_shapes.h"
#include "manifests/run.h"

namespace triglyph {
namespace {

struct SampleArguments {
  std::filesystem::path out;
  std::size_t count = 1;
  std::size_t triangles = 10000;
  std::uint64_t seed = 1;
  std::string shape = "all";
  std::string format = "obj";
  bool ascii = false;
  MachineArguments machine;
};

// Names of the shapes on the command line and in file names; "all" takes turns.
struct NamedShape {
  const char* name;
  SampleShape shape;
};
constexpr std::array<NamedShape, 3> kShapes{{{"closed", SampleShape::Closed},
                                             {"open", SampleShape::Open},
                                             {"high-genus", SampleShape::HighGenus}}};

const NamedShape& shape_of(const SampleArguments& arguments, std::size_t index) {
  for (const NamedShape& shape : kShapes) {
    if (arguments.shape == shape.name) return shape;
  }
  return kShapes[index % kShapes.size()];
}

ExportFormat export_format(const SampleArguments& arguments) {
  ExportFormat format;
  format.significant_digits = 9;  // enough to represent any float exactly
  if (arguments.format == "off") format.format = FileFormat::Off;
  if (arguments.format == "ply") {
    format.format = arguments.ascii ? FileFormat::PlyAscii : FileFormat::PlyLittle;
  }
  if (arguments.format == "stl") {
    format.format = arguments.ascii ? FileFormat::StlAscii : FileFormat::StlBinary;
  }
  if (arguments.format == "glb") format.format = FileFormat::Glb;
  if (arguments.format == "gltf") format.format = FileFormat::Gltf;
  return format;
}

int run_sample(const SampleArguments& arguments) {
  with_threads(arguments.machine.threads(), [&] {
    for (std::size_t i = 0; i < arguments.count; ++i) {
      const NamedShape& shape = shape_of(arguments, i);
      const Mesh mesh =
          make_sample_shape(shape.shape, arguments.triangles, random_bits(arguments.seed, 0, i));
      std::array<char, 64> name{};
      std::snprintf(name.data(), name.size(), "%04zu-%s.%s", i, shape.name,
                    arguments.format.c_str());
      OutputFile file(arguments.out / name.data());
      file.write(export_mesh(mesh, export_format(arguments)));
      file.commit();
      std::cout << (arguments.out / name.data()).string() << ": " << mesh.positions.size()
                << " vertices, " << mesh.triangles.size() << " triangles\n";
    }
  });
  return kDone;
}

}  // namespace

void add_sample_verb(CLI::App& app, Action& action) {
  CLI::App* verb =
      app.add_subcommand("sample", "Generate procedural meshes for trials and benchmarks");
  auto arguments = std::make_shared<SampleArguments>();
  verb->add_option("--out", arguments->out, "Directory for the meshes")
      ->required()
      ->type_name("DIR");
  verb->add_option("--count", arguments->count, "Number of meshes (1 to 1000000; default: 1)")
      ->check(CLI::Range(1, 1000000).description(""))
      ->type_name("N");
  verb->add_option("--triangles", arguments->triangles,
                   "Number of triangles of each mesh, within 10 % (80 to 20000000; default: 10000)")
      ->check(CLI::Range(80, 20000000).description(""))
      ->type_name("N");
  verb->add_option("--seed", arguments->seed,
                   "Seed of the random numbers; the same seed gives the same meshes (default: 1)")
      ->type_name("N");
  verb->add_option("--shape", arguments->shape, "Kind of shapes; all takes turns (default: all)")
      ->check(CLI::IsMember({"all", "closed", "open", "high-genus"}).description(""))
      ->type_name("all|closed|open|high-genus");
  verb->add_option("--format", arguments->format, "File format (default: obj)")
      ->check(CLI::IsMember({"obj", "off", "ply", "stl", "glb", "gltf"}).description(""))
      ->type_name("obj|off|ply|stl|glb|gltf");
  verb->add_flag("--ascii", arguments->ascii, "Write PLY and STL as text instead of binary");
  arguments->machine.add_threads_to(*verb);
  verb->footer(
      "Make ten closed meshes of about 50,000 triangles:\n"
      "  triglyph sample --out meshes --count 10 --triangles 50000 --shape closed");
  verb->callback([&action, arguments] { action = [arguments] { return run_sample(*arguments); }; });
}

}  // namespace triglyph
