#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/app.h"
#include "cli/run_arguments.h"
#include "cli/sibling.h"
#include "cli/verbs.h"
#include "engine/base/error.h"
#include "manifests/ledger.h"
#include "manifests/pairs.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

// Returns the words before the first option: what is to be drawn.
std::vector<std::string> leading_names(const std::vector<std::string>& words) {
  const auto end = std::find_if(words.begin(), words.end(), [](const std::string& word) {
    return word.size() > 1 && word.front() == '-';
  });
  return {words.begin(), end};
}

// Removes the option and its value from the words, and returns the value.
std::optional<std::string> take_option(std::vector<std::string>& words, const std::string& name) {
  for (auto word = words.begin(); word != words.end(); ++word) {
    if (word->rfind(name + "=", 0) == 0) {
      std::string value = word->substr(name.size() + 1);
      words.erase(word);
      return value;
    }
    if (*word != name || word + 1 == words.end()) continue;
    std::string value = *(word + 1);
    words.erase(word, word + 2);
    return value;
  }
  return std::nullopt;
}

// Notes the run in the ledger, if one is named. Returns its number.
std::int64_t begin_logged(std::optional<Ledger>& ledger, const std::optional<std::string>& path) {
  if (!path) return 0;
  LedgerRun run;
  run.verb = "render";
  run.command = command_line();
  std::error_code ignored;
  run.directory = fs::current_path(ignored).string();
  run.version = TRIGLYPH_VERSION;
  return ledger.emplace(*path).begin_run(run);
}

// Draws every pair into the folder that --out names; --ledger notes the run, and all other options
// are the renderer's.
int draw_all(const std::vector<std::string>& names, std::vector<std::string> options) {
  const std::optional<std::string> out = take_option(options, "--out");
  if (!out) throw Error(ErrorCode::Usage, {}, "", "--out names the folder for the pictures");
  std::optional<Ledger> ledger;
  const std::int64_t run = begin_logged(ledger, take_option(options, "--ledger"));
  const PairSource next = pairs_of(names);
  options.insert(options.begin(), "--batch");
  RenderBatch batch(options);
  std::size_t pairs = 0;
  while (const std::optional<MeshPair> pair = next()) {
    batch.draw(pair->original, pair->marked, fs::path(*out) / (pair->name.string() + ".png"));
    ++pairs;
  }
  const std::optional<std::size_t> failed = batch.finish();
  if (!failed) throw std::runtime_error("triglyph-render ended before it had drawn all pictures");
  const bool is_done = *failed == 0;
  std::cerr << "triglyph: " << pairs << (pairs == 1 ? " pair: " : " pairs: ") << pairs - *failed
            << " drawn, " << *failed << " failed\n";
  if (ledger) ledger->end_run(run, is_done ? "done" : "some failed");
  return is_done ? kDone : kSomeFailed;
}

int run_render(const std::vector<std::string>& words) {
  const std::vector<std::string> names = leading_names(words);
  const bool names_many = names.size() == 2
                              ? name_many_pairs(names)
                              : names.size() == 1 && (fs::path(names[0]).extension() == ".jsonl" ||
                                                      fs::path(names[0]).extension() == ".ledger");
  if (!names_many) exec_renderer(words);
  return draw_all(names, {words.begin() + static_cast<std::ptrdiff_t>(names.size()), words.end()});
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

}  // namespace triglyph
