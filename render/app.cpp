#include "render/app.h"

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/base/text.h"
#include "engine/io/mesh_file.h"
#include "engine/marking/mark_file.h"
#include "engine/marking/refusal.h"
#include "engine/message/key.h"
#include "render/arguments.h"
#include "render/colours.h"
#include "render/comparison.h"
#include "render/mesh_as_cut.h"
#include "render/paper_figure.h"
#include "render/picture_file.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

constexpr int kFatal = 1;
constexpr int kUsageError = 2;
constexpr int kSomeFailed = 3;

Colour background_named(const std::string& name) {
  if (name == "white") return {1, 1, 1, 1};
  if (name == "transparent") return {0, 0, 0, 0};
  std::size_t used = 0;
  unsigned long code = 0;
  try {
    code = std::stoul(name, &used, 16);
  } catch (const std::exception&) {
    used = 0;
  }
  if (name.size() != 6 || used != 6) {
    throw Error(ErrorCode::Usage, {}, "",
                "a background is white, transparent or RRGGBB, not '" + name + "'");
  }
  return from_srgb(static_cast<unsigned>(code));
}

// "pic.png" becomes "pic-007.png".
fs::path numbered(const fs::path& path, int number) {
  char suffix[16];
  std::snprintf(suffix, sizeof suffix, "-%03d", number);
  fs::path result = path;
  result.replace_filename(path.stem().string() + suffix + path.extension().string());
  return result;
}

void draw_pair(const RenderArguments& arguments, const fs::path& original, const fs::path& marked,
               const fs::path& out) {
  const MeshFile first = MeshFile::open(original);
  const auto panels = arguments.chosen_panels();
  const auto draw = [&](const Mesh& second, const PictureOptions& options, const fs::path& path) {
    PictureOptions named = options;
    named.original_name = printable(original.filename().string());
    named.marked_name = printable((marked.empty() ? original : marked).filename().string());
    write_picture(draw_comparison(first.mesh(), second, panels, named), path);
  };
  const auto draw_all = [&](const Mesh& second) {
    if (arguments.turntable == 0) return draw(second, arguments.picture, out);
    for (int i = 0; i < arguments.turntable; ++i) {
      PictureOptions options = arguments.picture;
      options.view = std::to_string(360.0 * i / arguments.turntable) + ",15";
      draw(second, options, numbered(out, i));
    }
  };
  if (marked.empty()) return draw_all(first.mesh());
  draw_all(mesh_as_cut_in(first, MeshFile::open(marked)));
}

volatile std::sig_atomic_t stop_requested = 0;

// Returns a path of a job: byte for byte if it is there in hexadecimal, since JSON holds UTF-8
// alone.
fs::path path_in(const nlohmann::json& job, const std::string& key) {
  if (!job.contains(key + "_bytes")) return job.at(key).get<std::string>();
  const auto bytes = from_hex(job.at(key + "_bytes").get<std::string>());
  return std::string(bytes.begin(), bytes.end());
}

// Draws the picture of a job {"original", "marked", "out"}, each also as "<key>_bytes".
void draw_job(const RenderArguments& arguments, const nlohmann::json& job) {
  const auto draw = [&] {
    draw_pair(arguments, path_in(job, "original"), path_in(job, "marked"), path_in(job, "out"));
  };
  job.contains("threads") ? with_threads(job.at("threads").get<int>(), draw) : draw();
}

// Reads one job per line from standard input. Prints the number of jobs that failed in the end,
// unless it is stopped.
int draw_batch(const RenderArguments& arguments) {
  std::signal(SIGTERM, [](int) {
    stop_requested = 1;
  });  // takes effect between pictures, so that none is incomplete
  std::size_t failed = 0;
  std::size_t number = 0;
  for (std::string line; stop_requested == 0 && std::getline(std::cin, line);) {
    ++number;
    try {
      draw_job(arguments, nlohmann::json::parse(line));
    } catch (const std::exception& error) {
      std::cerr << "triglyph-render: line " << number << ": " << error.what() << "\n";
      ++failed;
    }
  }
  if (stop_requested != 0) return kSomeFailed;
  std::cout << failed << std::endl;
  return failed == 0 ? 0 : kSomeFailed;
}

// Returns why the line's picture is not there, or an empty object.
nlohmann::ordered_json answer_to(const RenderArguments& arguments, const std::string& line) {
  fs::path original;
  const auto failure = [&](FileStatus status, const std::string& error, bool names_file) {
    const std::string place = names_file ? "" : original.string() + ": ";
    return nlohmann::ordered_json{{"status", name_of(status)}, {"error", place + error}};
  };
  try {
    const auto job = nlohmann::json::parse(line);
    original = path_in(job, "original");
    draw_job(arguments, job);
    return nlohmann::ordered_json::object();
  } catch (const Error& error) {
    return failure(file_status(error.code()), error.what(), !error.path().empty());
  } catch (const std::bad_alloc&) {
    std::error_code ignored;
    const auto bytes = fs::file_size(original, ignored);
    const std::uint64_t estimate = estimate_memory(ignored ? 0 : bytes, original, MeshWork::Usual);
    return failure(FileStatus::Failed, too_little_memory(estimate), false);
  } catch (const std::exception& error) {
    return failure(FileStatus::Failed, error.what(), false);
  }
}

// Reads one job per line from standard input, and answers each with a line before it reads the
// next, until its input ends.
int answer_batch(const RenderArguments& arguments) {
  std::cout << "{}" << std::endl;
  for (std::string line; std::getline(std::cin, line);) {
    constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
    std::cout << answer_to(arguments, line).dump(-1, ' ', false, kReplace) << std::endl;
  }
  return 0;
}

// Throws Error Usage for sizes and views that no mesh can be drawn with, before the first is.
void check_options(const PictureOptions& options) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  (void)camera_for(mesh, drawable(mesh, options));
}

int run(RenderArguments arguments) {
  arguments.picture.background = background_named(arguments.background);
  check_options(arguments.picture);
  if (arguments.batch) return arguments.answer ? answer_batch(arguments) : draw_batch(arguments);
  if (arguments.original.empty() || arguments.out.empty()) {
    throw Error(ErrorCode::Usage, {}, "", "a mesh to draw and --out are needed");
  }
  check_picture_name(arguments.out);  // before any work is done
  if (arguments.paper_figure.empty()) {
    draw_pair(arguments, arguments.original, arguments.marked, arguments.out);
  } else {
    const MeshFile file = MeshFile::open(arguments.original);
    write_picture(draw_paper_figure(file.mesh(), arguments.paper_figure, arguments.picture),
                  arguments.out);
  }
  return 0;
}

}  // namespace

int run_render_app(int argc, char** argv) try {
  RenderArguments arguments;
  const auto app = make_render_app(arguments);
  try {
    app->parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app->exit(error) == 0 ? 0 : kUsageError;
  }
  int code = 0;
  with_threads(arguments.threads, [&] { code = run(arguments); });
  return code;
} catch (const Error& error) {
  std::cerr << "triglyph-render: " << error.what() << "\n";
  return error.code() == ErrorCode::Unwritable ? kFatal : kUsageError;
} catch (const std::exception& error) {
  std::cerr << "triglyph-render: " << error.what() << "\n";
  return kFatal;
}

}  // namespace triglyph
