#include <array>
#include <cerrno>
#include <chrono>
#include <iostream>
#include <memory>

#include <stdlib.h>
#include <sys/resource.h>

#include "cli/app.h"
#include "cli/options.h"
#include "cli/profile_report.h"
#include "cli/progress.h"
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

namespace fs = std::filesystem;

struct ProfileArguments {
  std::size_t count = 200;
  std::size_t triangles = 2000;
  int repetitions = 3;
  bool json = false;
  MachineArguments machine;
};

// The workload is the same in every build, so that builds can be compared.
constexpr std::uint64_t kProfileSeed = 1;

// A folder for the meshes and what is made of them, removed at the end.
class ProfileFolder {
 public:
  ProfileFolder() {
    std::string pattern = (fs::temp_directory_path() / "triglyph-profile-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) {
      throw Error(ErrorCode::Unwritable, pattern, "", system_reason(errno));
    }
    path_ = pattern;
  }
  ~ProfileFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ProfileFolder(const ProfileFolder&) = delete;
  ProfileFolder& operator=(const ProfileFolder&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) / 1e6;
}

double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
}

// Marks the same meshes again and again.
class ProfiledRuns {
 public:
  ProfiledRuns(const ProfileArguments& arguments, const fs::path& folder)
      : arguments_(arguments), folder_(folder) {
    constexpr std::array kShapes = {SampleShape::Closed, SampleShape::Open, SampleShape::HighGenus};
    workload_.meshes = arguments.count;
    for (std::size_t i = 0; i < arguments.count; ++i) {
      const Mesh mesh = make_sample_shape(kShapes.at(i % kShapes.size()), arguments.triangles,
                                          random_bits(kProfileSeed, 0, i));
      const fs::path path = folder / "in" / (std::to_string(i) + ".obj");
      OutputFile file(path);
      file.write(export_mesh(mesh, {}));
      file.commit();
      workload_.triangles += mesh.triangles.size();
      workload_.bytes += bytes_of_file(path);
      meshes_.push_back({path, folder / "in"});
    }
  }

  [[nodiscard]] const ProfileWorkload& workload() const { return workload_; }

  // Returns the runs with one thread and with all that were asked for, in turns, so that what
  // disturbs the machine for a while disturbs both.
  [[nodiscard]] std::vector<ProfileRun> all(const std::atomic<bool>& stop) const {
    const int most = thread_count(arguments_.machine.threads());
    std::vector<ProfileRun> runs;
    for (int repetition = 0; repetition < arguments_.repetitions; ++repetition) {
      for (const int threads : most > 1 ? std::vector{1, most} : std::vector{1}) {
        if (!stop) runs.push_back(run(threads, stop));
      }
    }
    return runs;
  }

 private:
  [[nodiscard]] ProfileRun run(int threads, const std::atomic<bool>& stop) const {
    ProfileRun result;
    result.threads = threads;
    const fs::path place = folder_ / "out";
    fs::create_directory(place);
    RunTrace trace(place / "trace.json");
    {
      Ledger ledger(place / "ledger");
      const Key key = Key::trial();
      const Resume resume(ledger, ledger.begin_run({}), key, {});
      MeshList jobs(meshes_, {{"message", "profile"}}, place / "marked");
      RunContext context;
      context.resume = &resume;
      context.flow.trace = &trace;
      context.flow.memory_bytes = arguments_.machine.memory_bytes();
      const double processor = processor_seconds();
      const auto start = std::chrono::steady_clock::now();
      with_threads(threads, [&] { run_jobs(jobs, key, context, {}, stop); });
      const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
      result.wall_seconds = wall.count();
      result.processor_seconds = processor_seconds() - processor;
    }
    trace.finish();
    result.stages = summarise_trace(place / "trace.json");
    fs::remove_all(place);
    return result;
  }

  const ProfileArguments& arguments_;
  fs::path folder_;
  ProfileWorkload workload_;
  std::vector<NamedFile> meshes_;
};

int run_profile(const ProfileArguments& arguments) {
  const ProfileFolder folder;
  const std::optional<int> code = supervise(
      [&](const WorkOrder& order) {
        const ProfiledRuns profiled(arguments, folder.path());
        const std::vector<ProfileRun> runs = profiled.all(order.board->stop());
        if (order.board->stop()) return kInterrupted;
        if (arguments.json) {
          std::cout << profile_json(profiled.workload(), runs).dump(2) << "\n";
        } else {
          print_profile(std::cout, profiled.workload(), runs);
        }
        return kDone;
      },
      0);
  return code.value_or(kInterrupted);
}

}  // namespace

void add_profile_verb(CLI::App& app, Action& action) {
  CLI::App* verb =
      app.add_subcommand("profile", "Mark procedural meshes, and tell where the time goes");
  auto arguments = std::make_shared<ProfileArguments>();
  verb->add_option("--count", arguments->count, "Number of meshes (1 to 100000; default: 200)")
      ->check(CLI::Range(1, 100000).description(""))
      ->type_name("N");
  verb->add_option("--triangles", arguments->triangles,
                   "Number of triangles of each mesh, within 10 % (80 to 20000000; default: 2000)")
      ->check(CLI::Range(80, 20000000).description(""))
      ->type_name("N");
  verb->add_option("--repetitions", arguments->repetitions,
                   "Number of runs with one thread, and with all (1 to 100; default: 3)")
      ->check(CLI::Range(1, 100).description(""))
      ->type_name("N");
  verb->add_flag("--json", arguments->json, "Print what Google Benchmark's compare.py reads");
  arguments->machine.add_threads_to(*verb);
  arguments->machine.add_memory_to(*verb);
  verb->footer(
      "Compare one thread with two on a thousand small meshes:\n"
      "  triglyph profile --count 1000 --triangles 200 --threads 2");
  verb->callback(
      [&action, arguments] { action = [arguments] { return run_profile(*arguments); }; });
}

}  // namespace triglyph
