#include "manifests/recipients.h"

#include <cstdio>
#include <fstream>
#include <string_view>
#include <unordered_map>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "manifests/json_line.h"

namespace triglyph {
namespace {

// Returns the first field of a line of comma separated values (RFC 4180).
std::string first_field(const std::string& line) {
  if (line.empty() || line.front() != '"') return line.substr(0, line.find(','));
  std::string field;
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (line[i] != '"') {
      field += line[i];
    } else if (i + 1 < line.size() && line[i + 1] == '"') {
      field += line[++i];
    } else {
      return field;
    }
  }
  throw Error(ErrorCode::Malformed, {}, "", "a quoted name does not end on its line");
}

std::string without_blanks(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

void check_recipient(const std::string& name) {
  if (name.size() > kMaxMessageBytes) {
    throw Error(ErrorCode::Malformed, {}, "",
                "a recipient's name has 1 to 256 bytes, not " + std::to_string(name.size()));
  }
  for (const char c : name) {
    if (static_cast<unsigned char>(c) >= 32 && c != 127) continue;
    throw Error(ErrorCode::Malformed, {}, "", "a recipient's name holds a control character");
  }
}

}  // namespace

std::string folder_of(const std::string& name) {
  constexpr std::string_view kSigns = "-_.@+ ";
  std::string folder;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_plain = byte >= 128 || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') ||
                          (c >= 'A' && c <= 'Z') || kSigns.find(c) != kSigns.npos;
    const bool is_hidden = folder.empty() && c == '.';
    if (is_plain && !is_hidden) {
      folder += c;
    } else {
      char code[4];
      std::snprintf(code, sizeof(code), "%%%02x", byte);
      folder += code;
    }
  }
  // some systems drop a blank or a dot at the end
  if (!folder.empty() && (folder.back() == ' ' || folder.back() == '.')) {
    folder = folder.substr(0, folder.size() - 1) + (folder.back() == ' ' ? "%20" : "%2e");
  }
  return folder;
}

std::shared_ptr<const Recipients> read_recipients(const std::filesystem::path& list) {
  std::ifstream stream(list);
  if (std::filesystem::is_directory(list) || !stream) {
    throw Error(ErrorCode::Unreadable, list, "", "the list of recipients cannot be read");
  }
  const bool is_csv = lower_case_ending(list) == ".csv";
  auto recipients = std::make_shared<Recipients>();
  std::unordered_map<std::string, std::size_t> lines;
  std::size_t number = 0;
  try {
    for (std::string line; ++number, read_line(stream, line);) {
      if (number == 1 && line.starts_with("\xef\xbb\xbf")) line.erase(0, 3);
      std::string name = without_blanks(is_csv ? first_field(without_blanks(line)) : line);
      const bool is_heading = is_csv && number == 1 && (name == "recipient" || name == "name");
      if (name.empty() || is_heading) continue;
      check_recipient(name);
      const auto [known, is_new] = lines.emplace(name, number);
      if (!is_new) {
        throw Error(ErrorCode::Malformed, {}, "",
                    "\"" + printable(name) + "\" is there twice, first in line " +
                        std::to_string(known->second));
      }
      std::string folder = folder_of(name);
      recipients->push_back({std::move(name), std::move(folder)});
    }
  } catch (const Error& error) {
    throw Error(error.code(), list, at_line(number), error.message());
  }
  if (recipients->empty()) throw Error(ErrorCode::Malformed, list, "", "names no recipient");
  return recipients;
}

std::vector<Message> names_of(const Recipients& recipients) {
  std::vector<Message> names;
  names.reserve(recipients.size());
  for (const Recipient& recipient : recipients) {
    names.emplace_back(recipient.name.begin(), recipient.name.end());
  }
  return names;
}

}  // namespace triglyph
