#include "cli/config.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/error.h"
#include "engine/marking/options.h"

namespace triglyph {
namespace {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == text.npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::string with(std::string text, char from, char to) {
  std::replace(text.begin(), text.end(), from, to);
  return text;
}

class StrictConfig final : public CLI::ConfigTOML {
 public:
  explicit StrictConfig(const CLI::App& app) : app_(app) {}

  std::vector<CLI::ConfigItem> from_config(std::istream& stream) const override {
    const std::string text{std::istreambuf_iterator<char>(stream),
                           std::istreambuf_iterator<char>()};
    const Lines lines = lines_of(text);
    std::istringstream copy(text);
    std::vector<CLI::ConfigItem> found = ConfigBase::from_config(copy);
    for (CLI::ConfigItem& item : found) {
      if (item.name == "++" || item.name == "--") continue;  // a section begins or ends
      item.name = with(item.name, '_', '-');
      check(item, lines);
    }
    return found;
  }

 private:
  using Lines = std::map<std::pair<std::string, std::string>, std::size_t>;  // section, key

  [[noreturn]] void fail(std::size_t line, const std::string& reason) const {
    throw Error(ErrorCode::Malformed, app_.get_config_ptr()->as<std::string>(), at_line(line),
                reason);
  }

  // Finds the line of every key; a section must not repeat a key.
  [[nodiscard]] Lines lines_of(const std::string& text) const {
    Lines lines;
    std::istringstream stream(text);
    std::string section;
    std::size_t number = 0;
    for (std::string line; std::getline(stream, line);) {
      ++number;
      const std::string content = trimmed(line);
      if (content.empty() || content[0] == '#') continue;
      if (content[0] == '[') {
        section = trimmed(content.substr(1, content.find(']') - 1));
        continue;
      }
      const auto equals = content.find('=');
      if (equals == content.npos) continue;
      const std::string key = trimmed(content.substr(0, equals));
      if (!lines.emplace(std::pair(section, with(key, '_', '-')), number).second) {
        fail(number, "key \"" + key + "\" comes twice");
      }
    }
    return lines;
  }

  void check(const CLI::ConfigItem& item, const Lines& lines) const {
    const std::string section = item.parents.empty() ? "" : item.parents.back();
    const auto at = lines.find({section, item.name});
    const std::size_t line = at == lines.end() ? 1 : at->second;
    const CLI::App* app = &app_;
    for (const std::string& parent : item.parents) {
      const auto subcommands = app->get_subcommands([](const CLI::App*) { return true; });
      const auto named = std::find_if(
          subcommands.begin(), subcommands.end(),
          [&](const CLI::App* subcommand) { return subcommand->get_name() == parent; });
      if (named == subcommands.end()) fail(line, "unknown section [" + parent + "]");
      app = *named;
    }
    if (app->get_option_no_throw("--" + item.name) == nullptr) {
      fail(line, "unknown key \"" + item.name + "\"");
    }
    const OptionSpec* spec = find_mark_option(with(item.name, '-', '_'));
    if (spec == nullptr || item.inputs.size() != 1) return;
    try {
      (void)spec->parsed(item.inputs[0]);
    } catch (const Error& error) {
      fail(line, error.message());
    }
  }

  const CLI::App& app_;
};

}  // namespace

void add_config_file(CLI::App& app) {
  app.set_config("--config", "", "Read options from a TOML file with one section per subcommand")
      ->type_name("FILE");
  app.config_formatter(std::make_shared<StrictConfig>(app));
}

}  // namespace triglyph
