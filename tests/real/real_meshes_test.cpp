// Meshes from elsewhere: Debian's packages where they are installed, and the folder named by the
// environment variable TRIGLYPH_MODELS.
#include <cstdlib>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "engine/base/error.h"
#include "engine/base/output_file.h"
#include "engine/io/export_mesh.h"
#include "engine/io/mesh_file.h"
#include "engine/marking/extract.h"
#include "engine/marking/mark_file.h"
#include "engine/marking/read_file.h"
#include "engine/metric/hausdorff.h"
#include "engine/scheme/registry.h"
#include "manifests/run.h"
#include "tests/support/attacks.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_folder.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

const fs::path kBunny = "/usr/share/glmark2/models/bunny.obj";

// Marks one mesh into a folder with the trial key.
MarkedFile mark_into(const fs::path& mesh, const fs::path& folder, const OptionValues& values) {
  return mark_file(mesh, folder / mesh.filename(), resolve(values), Key::trial());
}

std::optional<Message> message_in_file(const fs::path& path) {
  const std::vector<Key> keys = {Key::trial()};
  const FileReading reading = read_file(path, encodings_of({}), keys);
  return reading.mark ? std::optional(reading.mark->message) : std::nullopt;
}

// The paper's experiment on one model: both steps must pay.
struct PaperFigures {
  std::uint32_t least_units;
  double greatest_ratio;  // of the Hausdorff distances after and before
  double most_hausdorff_rel_diag = 1;
};

void expect_optimisation_pays(const std::string& scheme, const fs::path& mesh,
                              const PaperFigures& figures) {
  const test::TempFolder folder;
  const OptionValues optimised = {{"fill", true}, {"scheme", scheme}};
  const OptionValues plain = layered(
      optimised, {{"layout", std::string("first-fit")}, {"assign", std::string("sequential")}});
  const MarkedFile before = mark_into(mesh, folder / "plain", plain);
  const MarkedFile after = mark_into(mesh, folder / "optimised", optimised);
  EXPECT_EQ(before.status, FileStatus::Marked) << before.error;
  EXPECT_EQ(after.status, FileStatus::Marked) << after.error;
  EXPECT_GE(after.units_valid, figures.least_units);
  EXPECT_GT(after.units_valid, before.units_valid);
  EXPECT_GE(after.units_embedded, after.units_valid * 95 / 100);
  EXPECT_LT(after.hausdorff, figures.greatest_ratio * before.hausdorff);
  EXPECT_LT(after.hausdorff_rel_diag, figures.most_hausdorff_rel_diag);
}

TEST(RealMeshes, BunnyFillsAsInThePaper) {
  if (!fs::exists(kBunny)) GTEST_SKIP() << "glmark2-data is not installed";
  expect_optimisation_pays("tsq", kBunny, {5300, 0.52, 0.00068});
  expect_optimisation_pays("aie", kBunny, {3444, 0.71});
  expect_optimisation_pays("iie", kBunny, {424, 0.876});
}

// Optimised units, and how much nearer the marked surface is, as in the paper's tables 1 to 3.
TEST(RealMeshes, PaperModelsFillAsInThePaper) {
  const char* models = std::getenv("TRIGLYPH_MODELS");
  if (models == nullptr) GTEST_SKIP() << "TRIGLYPH_MODELS names no folder of models";
  const fs::path folder(models);
  expect_optimisation_pays("tsq", folder / "bunny.obj", {5300, 0.52, 0.00068});
  expect_optimisation_pays("tsq", folder / "armadillo.obj", {3300, 0.48, 0.00068});
  expect_optimisation_pays("tsq", folder / "max-planck.obj", {1600, 0.77, 0.00068});
  expect_optimisation_pays("aie", folder / "bunny.obj", {3444, 0.71});
  expect_optimisation_pays("aie", folder / "armadillo.obj", {2232, 0.77});
  expect_optimisation_pays("aie", folder / "max-planck.obj", {1049, 0.85});
  expect_optimisation_pays("iie", folder / "bunny.obj", {424, 0.876});
  expect_optimisation_pays("iie", folder / "armadillo.obj", {287, 0.801});
  expect_optimisation_pays("iie", folder / "max-planck.obj", {140, 0.926});
}

TEST(RealMeshes, MarkedBunnySurvivesWhatItShould) {
  if (!fs::exists(kBunny)) GTEST_SKIP() << "glmark2-data is not installed";
  const test::TempFolder folder;
  const MarkRequest request = resolve({{"message", std::string("bunny001")}});
  const MarkedFile record = mark_file(kBunny, folder / "bunny.obj", request, Key::trial());
  ASSERT_EQ(record.status, FileStatus::Marked) << record.error;
  const Mesh marked = MeshFile::open(record.out).mesh();
  const WordCode code(Key::trial(), {});
  const auto scheme = make_scheme("tsq", code, {});
  const auto message_in = [&](const Mesh& mesh) {
    const test::Solid solid(mesh);
    return extract(*scheme->bind(solid.surface()), code).message;
  };
  EXPECT_EQ(message_in(marked), request.message());
  EXPECT_EQ(message_in(test::with_significant_digits(marked, 6)), request.message());
  EXPECT_FALSE(message_in(MeshFile::open(kBunny).mesh()));
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    EXPECT_EQ(message_in(test::shuffled(marked, seed)), request.message());
    EXPECT_EQ(message_in(test::moved_rigidly_and_scaled(marked, seed)), request.message());
    EXPECT_EQ(message_in(test::cropped_half(marked, seed)), request.message());
  }
  fs::path path = record.out;
  const FileFormat chain[] = {FileFormat::PlyLittle, FileFormat::StlBinary, FileFormat::Off};
  const char* endings[] = {"ply", "stl", "off"};
  for (std::size_t i = 0; i < 3; ++i) {
    ExportFormat format;
    format.format = chain[i];
    const Mesh mesh = MeshFile::open(path).mesh();
    path = folder / (std::string("chain.") + endings[i]);
    OutputFile file(path);
    file.write(export_mesh(mesh, format));
    file.commit();
    EXPECT_EQ(message_in_file(path), request.message()) << path;
  }
}

// The message comes back after affine maps stored as float32, shuffling and cropping.
void expect_affine_survival(const fs::path& mesh, const std::string& groups) {
  const test::TempFolder folder;
  const OptionValues values = {
      {"message", std::string("affine 8")}, {"scheme", std::string("aie")}, {"aie_groups", groups}};
  const MarkRequest request = resolve(values);
  const MarkedFile record = mark_file(mesh, folder / mesh.filename(), request, Key::trial());
  ASSERT_EQ(record.status, FileStatus::Marked) << record.error;
  const Mesh marked = MeshFile::open(record.out).mesh();
  const auto message_in = [&](Mesh attacked, const Key& key = Key::trial()) {
    for (Vec3& p : attacked.positions) p = test::as_float(p);
    const test::Solid solid(attacked);
    return extract(solid.surface(), request.options.encoding(), key).message;
  };
  EXPECT_FALSE(message_in(MeshFile::open(mesh).mesh()));
  EXPECT_FALSE(message_in(marked, Key::generate()));
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Mesh mapped = test::affinely_mapped(marked, 4, seed % 2 == 0, seed);
    EXPECT_EQ(message_in(mapped), request.message()) << mesh << seed;
    EXPECT_EQ(message_in(test::cropped_half(test::shuffled(mapped, seed), seed)), request.message())
        << mesh << seed;
  }
}

TEST(RealMeshes, AffineMarksSurviveOnTheBunny) {
  if (!fs::exists(kBunny)) GTEST_SKIP() << "glmark2-data is not installed";
  for (const char* groups : {"one", "all"}) {
    expect_affine_survival(kBunny, groups);
  }
}

TEST(RealMeshes, AffineMarksSurviveOnThePapersModels) {
  const char* models = std::getenv("TRIGLYPH_MODELS");
  if (models == nullptr) GTEST_SKIP() << "TRIGLYPH_MODELS names no folder of models";
  for (const char* name : {"bunny.obj", "armadillo.obj", "max-planck.obj"}) {
    expect_affine_survival(fs::path(models) / name, "one");
  }
}

// The message comes back after noise of so much of the mean radius, and quantisation to so many
// bits, of a mesh that was also reordered, moved and scaled.
void expect_noise_survival(const fs::path& mesh, double intensity, int bits) {
  const test::TempFolder folder;
  const MarkRequest request =
      resolve({{"message", std::string("integral")}, {"scheme", std::string("iie")}});
  const MarkedFile record = mark_file(mesh, folder / mesh.filename(), request, Key::trial());
  ASSERT_EQ(record.status, FileStatus::Marked) << record.error;
  const Mesh marked = MeshFile::open(record.out).mesh();
  const auto message_in = [&](Mesh attacked, const Key& key = Key::trial()) {
    for (Vec3& p : attacked.positions) p = test::as_float(p);
    const test::Solid solid(attacked);
    return extract(solid.surface(), request.options.encoding(), key).message;
  };
  EXPECT_EQ(message_in(marked), request.message());
  EXPECT_FALSE(message_in(MeshFile::open(mesh).mesh()));
  EXPECT_FALSE(message_in(marked, Key::generate()));
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Mesh moved = test::moved_rigidly_and_scaled(test::shuffled(marked, seed), seed);
    EXPECT_EQ(message_in(moved), request.message()) << mesh << seed;
    EXPECT_EQ(message_in(test::with_uniform_noise(moved, intensity, seed)), request.message())
        << mesh << seed;
    EXPECT_EQ(message_in(test::quantised(moved, bits)), request.message()) << mesh << seed;
  }
}

TEST(RealMeshes, IntegralMarksSurviveNoiseOnTheBunny) {
  if (!fs::exists(kBunny)) GTEST_SKIP() << "glmark2-data is not installed";
  expect_noise_survival(kBunny, 0.0005, 11);
  expect_noise_survival(kBunny, 0.001, 10);
}

TEST(RealMeshes, IntegralMarksSurviveNoiseOnThePapersModels) {
  const char* models = std::getenv("TRIGLYPH_MODELS");
  if (models == nullptr) GTEST_SKIP() << "TRIGLYPH_MODELS names no folder of models";
  const fs::path folder(models);
  expect_noise_survival(folder / "bunny.obj", 0.001, 10);
  expect_noise_survival(folder / "armadillo.obj", 0.001, 12);
  expect_noise_survival(folder / "max-planck.obj", 0.001, 11);
}

TEST(RealMeshes, OutputDiffersFromInputInMovedCoordinatesOnly) {
  if (!fs::exists(kBunny)) GTEST_SKIP() << "glmark2-data is not installed";
  const test::TempFolder folder;
  const MarkRequest request =
      resolve({{"message", std::string("x")}, {"scheme", std::string("tsq")}});
  const MarkedFile record = mark_file(kBunny, folder / "bunny.obj", request, Key::trial());
  std::istringstream before(test::read_all(kBunny)), after(test::read_all(record.out));
  std::string a, b;
  std::size_t changed = 0;
  while (std::getline(before, a)) {
    ASSERT_TRUE(std::getline(after, b));
    if (a == b) continue;
    ++changed;
    EXPECT_EQ(a.substr(0, 2), "v ");
    EXPECT_EQ(b.substr(0, 2), "v ");
  }
  EXPECT_FALSE(std::getline(after, b));
  EXPECT_GT(changed, 0U);
  EXPECT_LE(changed, 6U * record.units_embedded);
}

// A manifest over everything that may lie in a folder: each gets a record, none ends the run.
TEST(RealMeshes, EveryFileOfACollectionGetsARecord) {
  const test::TempFolder folder;
  std::string manifest;
  std::size_t expected = 0;
  for (const char* pattern : {"OBJ/*.obj", "OFF/*.off", "PLY/*.ply", "STL/*.[sS][tT][lL]",
                              "invalid/*.o[bf][jf]", "invalid/*.ply"}) {
    const fs::path glob = fs::path("/usr/share/assimp/models") / pattern;
    const std::size_t files = fs::exists(glob_root(glob)) ? expand_glob(glob).size() : 0;
    if (files == 0) continue;
    expected += files;
    manifest += "{\"mesh\": \"" + glob.string() + "\"}\n";
  }
  const std::pair<const char*, std::string> hostile[] = {
      {"huge.off", "OFF\n4000000000 4000000000 0\n0 0 0\n"},
      {"huge.ply",
       "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\n"
       "property float z\nend_header\n0 0 0\n"},
      {"noend.ply", "ply\nformat ascii 1.0\nelement vertex 3\n"},
      {"noelement.ply", "ply\nformat ascii 1.0\nproperty float x\nend_header\n"},
      {"truncated.stl", std::string(80, '\0') + std::string("\0(kn", 4) + std::string(50, '\0')},
      {"nan.obj", "v nan inf 0\nv 1e999 0 0\nf 1 2 1\n"},
      {"range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 90000000/1/1 2/1/1 3/1/1\n"},
      {"library.obj", "mtllib ../../../../../../dev/zero\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"empty.obj", ""},
      {"strange.xyz", "1 2 3\n"}};
  for (const auto& [name, bytes] : hostile) {
    folder.write(name, bytes);
    manifest += std::string("{\"mesh\": \"") + name + "\"}\n";
    ++expected;
  }
  mkfifo((folder / "pipe.obj").c_str(), 0600);
  fs::create_directory(folder / "folder.obj");
  manifest += "{\"mesh\": \"pipe.obj\"}\n{\"mesh\": \"folder.obj\"}\n{\"mesh\": \"absent.obj\"}\n";
  expected += 3;

  ManifestReader jobs(folder.write("m.jsonl", manifest), {{"message", std::string("collect!")}},
                      folder / "out");
  std::vector<Record> records;
  const std::atomic<bool> stop{false};
  run_jobs(jobs, Key::trial(), {},
           {.delivered = [&](const Record& record) { records.push_back(record); }}, stop);
  EXPECT_EQ(records.size(), expected);
  for (const Record& done : records) {
    const MarkedFile& record = done.file;
    EXPECT_NE(record.status, FileStatus::Failed) << record.error;
    EXPECT_EQ(record.is_marked(), fs::exists(record.out)) << record.mesh;
    EXPECT_EQ(record.is_marked(), record.error.empty());
    if (!record.is_marked()) {
      EXPECT_EQ(record.error.find('\n'), std::string::npos);
      EXPECT_EQ(record.error.rfind(record.mesh.string() + ": ", 0), 0U) << record.error;
    }
  }
}

}  // namespace
}  // namespace triglyph
