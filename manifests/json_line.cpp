#include "manifests/json_line.h"

#include <set>
#include <vector>

#include "engine/base/error.h"
#include "engine/message/key.h"
#include "engine/message/words.h"

namespace triglyph {
namespace {

using Json = nlohmann::ordered_json;

// A record has three levels (object, "units", unit); the rest is room for later schemas.
constexpr int kDeepest = 8;

// Refuses repeated keys and deep nesting while the parser is still reading.
class StrictLine {
 public:
  bool operator()(int depth, Json::parse_event_t event, const Json& parsed) {
    switch (event) {
      case Json::parse_event_t::object_start:
        open(depth);
        keys_.emplace_back();
        break;
      case Json::parse_event_t::array_start:
        open(depth);
        break;
      case Json::parse_event_t::object_end:
        keys_.pop_back();
        break;
      case Json::parse_event_t::key:
        if (!keys_.back().insert(parsed.get<std::string>()).second) {
          refuse("key \"" + parsed.get<std::string>() + "\" comes twice");
        }
        break;
      default:
        break;
    }
    return true;
  }

 private:
  static void open(int depth) {
    if (depth >= kDeepest) refuse("nested more than " + std::to_string(kDeepest) + " deep");
  }
  [[noreturn]] static void refuse(const std::string& reason) {
    throw Error(ErrorCode::Malformed, {}, "", reason);
  }

  std::vector<std::set<std::string>> keys_;  // of the objects that are open
};

// Returns the parser's message without the library's prefix.
std::string plain_message(const Json::exception& error) {
  const std::string text = error.what();
  const auto end_of_tag = text.find("] ");
  return end_of_tag == text.npos ? text : text.substr(end_of_tag + 2);
}

}  // namespace

bool read_line(std::istream& stream, std::string& line) try {
  line.clear();
  std::streambuf& buffer = *stream.rdbuf();
  for (int next = buffer.sbumpc(); next != EOF; next = buffer.sbumpc()) {
    if (next == '\n') return true;
    if (line.size() == kLongestLine) {
      throw Error(ErrorCode::Malformed, {}, "",
                  "longer than " + std::to_string(kLongestLine >> 20) + " MiB");
    }
    line += static_cast<char>(next);
  }
  return !line.empty();
} catch (const std::ios_base::failure& error) {
  throw Error(ErrorCode::Unreadable, {}, "", error.code().message());
}

Json parse_json_line(const std::string& line) try {
  StrictLine strict;
  Json json = Json::parse(line, [&](int depth, Json::parse_event_t event, const Json& parsed) {
    return strict(depth, event, parsed);
  });
  if (!json.is_object()) throw Error(ErrorCode::Malformed, {}, "", "a line holds one JSON object");
  return json;
} catch (const Json::exception& error) {
  throw Error(ErrorCode::Malformed, {}, "", plain_message(error));
}

OptionValue option_value(const std::string& key, const Json& json) {
  if (json.is_boolean()) return json.get<bool>();
  if (json.is_string()) return json.get<std::string>();
  if (json.is_number_float()) return json.get<double>();
  const bool fits = !json.is_number_unsigned() || json.get<std::uint64_t>() >> 63 == 0;
  if (json.is_number_integer() && fits) return json.get<std::int64_t>();
  throw Error(ErrorCode::Usage, {}, "",
              "\"" + key + "\" is true or false, a number or text, not " +
                  (json.is_number() ? json.dump() : std::string(json.type_name())));
}

Json to_json(const OptionValue& value) {
  return std::visit([](const auto& plain) { return Json(plain); }, value);
}

void put_path(Json& json, const std::string& key, const std::filesystem::path& path) {
  const std::string& bytes = path.native();
  json[key] = bytes;
  try {
    (void)json[key].dump();
  } catch (const Json::exception&) {
    json[key + "_bytes"] = to_hex(Message(bytes.begin(), bytes.end()));
  }
}

std::filesystem::path path_in(const Json& json, const std::string& key) {
  const auto exact = json.find(key + "_bytes");
  if (exact == json.end()) return json.value(key, std::string());
  if (!exact->is_string())
    throw Error(ErrorCode::Malformed, {}, "", "\"" + exact.key() + "\" is text");
  const Message bytes = from_hex(exact->get<std::string>());
  return std::string(bytes.begin(), bytes.end());
}

std::string to_line(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace triglyph
