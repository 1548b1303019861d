#include "manifests/run.h"

#include <thread>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/base/output_file.h"
#include "engine/base/parallel.h"
#include "engine/io/export_mesh.h"
#include "engine/marking/read_file.h"
#include "tests/support/attacks.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_folder.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

void save(const Mesh& mesh, const fs::path& path, FileFormat format) {
  ExportFormat options;
  options.format = format;
  OutputFile file(path);
  file.write(export_mesh(mesh, options));
  file.commit();
}

std::optional<Message> message_in(const fs::path& path) {
  const std::vector<Key> keys = {Key::trial()};
  const FileReading reading = read_file(path, encodings_of({}), keys);
  return reading.mark ? std::optional(reading.mark->message) : std::nullopt;
}

// Good and bad meshes of all formats, and a manifest over them.
class Collection {
 public:
  Collection() {
    const SampleShape shapes[] = {SampleShape::Closed, SampleShape::Open, SampleShape::HighGenus};
    const FileFormat formats[] = {FileFormat::Obj,      FileFormat::Off,      FileFormat::PlyAscii,
                                  FileFormat::PlyBig,   FileFormat::StlAscii, FileFormat::PlyLittle,
                                  FileFormat::StlBinary};
    const char* endings[] = {"obj", "off", "ply", "ply", "stl", "ply", "stl"};
    std::string manifest = "{\"triglyph\": 1, \"defaults\": {\"message\": \"run test\"}}\n";
    for (std::size_t i = 0; i < 7; ++i) {
      const std::string name = "in/" + std::to_string(i) + "." + endings[i];
      save(make_sample_shape(shapes[i % 3], 6000 - 500 * i, i), folder_ / name, formats[i]);
      manifest += "{\"mesh\": \"" + name + "\"}\n";
    }
    folder_.write("in/bad.obj", "v 0 0 0\nv 1 x 0\n");
    folder_.write("in/small.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    manifest += "{\"mesh\": \"in/bad.obj\"}\n{\"mesh\": \"in/small.off\"}\n";
    manifest +=
        "{\"mesh\": \"in/absent.obj\"}\n{\"mesh\": \"in/0.obj\", \"out\": \"o/again.obj\"}\n";
    manifest_ = folder_.write("m.jsonl", manifest);
  }

  [[nodiscard]] std::vector<Record> run(const FlowOptions& options, const fs::path& out,
                                        int threads = 0) const {
    ManifestReader jobs(manifest_, {}, out);
    std::vector<Record> records;
    const std::atomic<bool> stop{false};
    with_threads(threads, [&] {
      run_jobs(jobs, Key::trial(), {.flow = options},
               {.delivered = [&](const Record& record) { records.push_back(record); }}, stop);
    });
    return records;
  }

  [[nodiscard]] const test::TempFolder& folder() const { return folder_; }
  [[nodiscard]] const fs::path& manifest() const { return manifest_; }

 private:
  test::TempFolder folder_;
  fs::path manifest_;
};

TEST(RunJobs, GivesEveryMeshARecordInOrder) {
  const Collection collection;
  const auto records = collection.run({}, collection.folder() / "out");
  ASSERT_EQ(records.size(), 11U);
  for (std::size_t i = 0; i < records.size(); ++i) EXPECT_EQ(records[i].index, i);
  for (const std::size_t i : {0, 1, 2, 3, 4, 5, 6, 10}) {
    EXPECT_EQ(records[i].file.status, FileStatus::Marked) << records[i].file.error;
    EXPECT_GT(records[i].file.units_embedded, 0U);
    EXPECT_GT(records[i].file.hausdorff, 0);
    EXPECT_TRUE(fs::exists(records[i].file.out));
    EXPECT_EQ(message_in(records[i].file.out), (Message{'r', 'u', 'n', ' ', 't', 'e', 's', 't'}));
  }
  EXPECT_EQ(records[7].file.status, FileStatus::Malformed);
  EXPECT_NE(records[7].file.error.find("line 2"), std::string::npos);
  EXPECT_EQ(records[8].file.status, FileStatus::TooSmall);
  EXPECT_EQ(records[9].file.status, FileStatus::Unreadable);
  for (const std::size_t i : {7, 8, 9}) EXPECT_FALSE(fs::exists(records[i].file.out));
  for (const auto& entry : fs::recursive_directory_iterator(collection.folder() / "out")) {
    EXPECT_EQ(entry.path().filename().string().find(".part"), std::string::npos);
  }
}

TEST(RunJobs, BytesAndRecordsAreTheSameForAnyThreadsAndMemory) {
  const Collection collection;
  const auto snapshot = [&](const FlowOptions& options, int threads = 0) {
    const fs::path out = collection.folder() / "out";
    fs::remove_all(out);
    std::vector<std::string> all;
    for (const Record& record : collection.run(options, out, threads)) {
      auto json = to_json(record);
      json.erase("run");
      all.push_back(json.dump());
      all.push_back(test::read_all(record.file.out));
    }
    return all;
  };
  const auto expected = snapshot({});
  for (const int threads : {1, 2, 8}) {
    FlowOptions options;
    options.memory_bytes = threads == 8 ? 1 : std::uint64_t{1} << 30;
    EXPECT_EQ(snapshot(options, threads), expected) << threads << " threads";
  }
}

TEST(RunJobs, StopsAtAnInterruptWithWholeFilesOnly) {
  const Collection collection;
  ManifestReader jobs(collection.manifest(), {}, collection.folder() / "out");
  std::atomic<bool> stop{false};
  std::size_t count = 0;
  std::vector<fs::path> marked;
  FlowOptions options;
  options.memory_bytes = 1;  // one mesh at a time
  run_jobs(jobs, Key::trial(), {.flow = options},
           {.delivered =
                [&](const Record& record) {
                  if (record.file.status == FileStatus::Marked) marked.push_back(record.file.out);
                  stop = ++count >= 2;
                }},
           stop);
  for (const fs::path& path : marked) (void)message_in(path);
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(collection.folder() / "out/in")) {
    EXPECT_EQ(entry.path().filename().string().front() == '.', false);
    ++files;
  }
  EXPECT_LT(files, 7U);
}

// A record holds all that wrote it: read and written again it is the same line.
TEST(Records, ComeBackFromTheirLine) {
  const Collection collection;
  for (const Record& record : collection.run({}, collection.folder() / "out")) {
    const std::string line = to_json(record).dump();
    const Record back = parse_record(line);
    EXPECT_EQ(to_json(back).dump(), line);
    EXPECT_EQ(back.file.request, record.file.request);
    EXPECT_EQ(back.file.encoding(), record.file.encoding());
    EXPECT_EQ(back.file.status, record.file.status);
  }
  EXPECT_THROW((void)parse_record("{}"), Error);
  EXPECT_THROW((void)parse_record("not json"), Error);
  EXPECT_THROW((void)parse_record("{\"schema\": 1}"), Error);
  EXPECT_THROW((void)parse_record("{\"schema\": 3}"), Error);
}

// The whole way through every pair of formats that a marked mesh may be converted to.
TEST(Formats, MessageSurvivesConversionFromAnyToAny) {
  const Collection collection;
  const auto records = collection.run({}, collection.folder() / "out");
  const FileFormat chain[] = {FileFormat::PlyLittle, FileFormat::StlBinary, FileFormat::Off,
                              FileFormat::StlAscii,  FileFormat::PlyBig,    FileFormat::Obj};
  const char* endings[] = {"ply", "stl", "off", "stl", "ply", "obj"};
  for (std::size_t i = 0; i < 7; ++i) {
    fs::path path = records[i].file.out;
    for (std::size_t k = 0; k < 6; ++k) {
      const Mesh mesh = MeshFile::open(path).mesh();
      path = collection.folder() / std::to_string(k);
      path.replace_extension(endings[k]);
      save(test::with_significant_digits(mesh, 6), path, chain[k]);
      EXPECT_EQ(message_in(path), records[i].file.request.message()) << i << " -> " << path;
    }
  }
}

}  // namespace
}  // namespace triglyph
