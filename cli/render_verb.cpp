#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/app.h"
#include "cli/renderer.h"
#include "cli/run_arguments.h"
#include "cli/sibling.h"
#include "cli/verbs.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "manifests/file_runs.h"
#include "manifests/json_line.h"
#include "manifests/ledger.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

// What is drawn and how, where it is a collection.
struct CollectionArguments {
  std::vector<std::string> names;
  std::vector<std::string> drawing;  // the options of the renderer
  fs::path out;                      // a folder
  bool json = false;
  RunArguments run;

  void add_to(CLI::App& app) {
    app.add_flag("--json", json, "Print one JSON object per pair of a collection");
    run.add_to(app);
  }
};

// Returns the words before the first option: what is to be drawn.
std::vector<std::string> leading_names(const std::vector<std::string>& words) {
  const auto end = std::find_if(words.begin(), words.end(), [](const std::string& word) {
    return word.size() > 1 && word.front() == '-';
  });
  return {words.begin(), end};
}

bool asks_for_help(const std::vector<std::string>& words) {
  return std::any_of(words.begin(), words.end(),
                     [](const std::string& word) { return word == "--help" || word == "-h"; });
}

// Takes the options of the run from the words after the names; those that it does not know are the
// renderer's. Throws Error Usage.
void parse(std::vector<std::string> options, CollectionArguments& arguments) {
  CLI::App parser;
  parser.set_help_flag();
  parser.allow_extras();
  parser.add_option("--out", arguments.out);
  arguments.add_to(parser);
  std::reverse(options.begin(), options.end());  // as the parser takes them
  try {
    parser.parse(options);
  } catch (const CLI::ParseError& error) {
    throw Error(ErrorCode::Usage, {}, "", error.what());
  }
  arguments.drawing = parser.remaining();
  if (arguments.out.empty()) {
    throw Error(ErrorCode::Usage, {}, "", "--out names the folder for the pictures");
  }
}

fs::path picture_of(const MeshPair& pair, const fs::path& folder) {
  return folder / (pair.name.string() + ".png");
}

std::string_view status_of(const PairResult& result) {
  return result.failure ? name_of(result.failure->status) : "drawn";
}

nlohmann::ordered_json json_of(const PairResult& result, const fs::path& folder) {
  nlohmann::ordered_json json;
  put_path(json, "original", result.pair.original);
  put_path(json, "marked", result.pair.marked);
  put_path(json, "picture", picture_of(result.pair, folder));
  json["status"] = status_of(result);
  if (result.failure) json["error"] = result.failure->error;
  return json;
}

void print_drawn(const PairResult& result, const CollectionArguments& arguments) {
  if (result.failure) std::cerr << "triglyph: " << printable(result.failure->error) << "\n";
  if (!arguments.json) return;
  std::cout << to_line(json_of(result, arguments.out));
  std::cout.flush();
  check_standard_output();  // nobody is there to read the rest
}

int draw_share(const CollectionArguments& arguments, const WorkOrder& order) {
  RendererPool renderers(arguments.drawing, arguments.run.threads());
  std::optional<Ledger> ledger;
  if (!arguments.run.ledger().empty()) ledger.emplace(arguments.run.ledger());
  const LoggedRun run(ledger ? &*ledger : nullptr, order, "render");
  RunTally tally(arguments.run, order, 0, {"drawn", "failed"});
  run_pairs(
      pairs_of(arguments.names),
      [&](PairResult& result) {
        result.failure = renderers.draw(result.pair, picture_of(result.pair, arguments.out));
      },
      arguments.run.context(order),
      [&](const PairResult& result) {
        tally.clear_bar();
        print_drawn(result, arguments);
        run.note(result.pair.original, status_of(result), json_of(result, arguments.out));
        const bool failed = result.failure.has_value();
        tally.count(failed ? 1 : 0, failed, false, result.pair.original);
      },
      order.board->stop());
  if (order.only) return kDone;
  const int code = tally.finish("pair", "pairs");
  run.end(code);
  return code;
}

int run_render(const std::vector<std::string>& words) {
  CollectionArguments arguments;
  arguments.names = leading_names(words);
  const std::vector<std::string>& names = arguments.names;
  const bool names_many = names.size() == 2
                              ? name_many_pairs(names)
                              : names.size() == 1 && (fs::path(names[0]).extension() == ".jsonl" ||
                                                      fs::path(names[0]).extension() == ".ledger");
  if (!names_many || asks_for_help(words)) exec_renderer(words);
  parse({words.begin() + static_cast<std::ptrdiff_t>(names.size()), words.end()}, arguments);
  (void)pairs_of(names);  // a mistake is to be known before the run
  return arguments.run.supervised({"render", {"drawn", "failed"}}, [&](const WorkOrder& order) {
    return draw_share(arguments, order);
  });
}

}  // namespace

void add_render_verb(CLI::App& app, Action& action) {
  CLI::App* verb = app.add_subcommand(
      "render", "Draw meshes side by side, without a display (runs triglyph-render)");
  // all arguments, including --help, are passed to the renderer
  verb->prefix_command();
  verb->set_help_flag();
  verb->callback(
      [&action, verb] { action = [rest = verb->remaining()] { return run_render(rest); }; });
}

void declare_collection_options(CLI::App& renderer) {
  auto arguments = std::make_shared<CollectionArguments>();
  renderer.remove_option(renderer.get_option("--threads"));  // the run has it as well
  arguments->add_to(renderer);
  renderer.callback([arguments] {});  // keeps what the options refer to
}

}  // namespace triglyph
