// Lists of whom copies are for.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/message/words.h"

namespace triglyph {

struct Recipient {
  std::string name;    // 1 to 256 bytes, no control characters
  std::string folder;  // the name as a file system takes it: of the copies
};
using Recipients = std::vector<Recipient>;

// Reads a list of names, one a line; of a file that ends in .csv the first field of each line,
// quoted or not, without the first line if that is "recipient" or "name". Empty lines are left out.
// Throws Error Unreadable, and Malformed, naming the line, for a name that is too long, holds a
// control character or is there twice, and for a list without names. O(bytes).
[[nodiscard]] std::shared_ptr<const Recipients> read_recipients(const std::filesystem::path& list);

// Returns the folder for a name: bytes other than letters, digits, those beyond ASCII and a few
// signs become %xx, and so do a dot that leads and a dot or blank that ends the name.
[[nodiscard]] std::string folder_of(const std::string& name);

// Returns the bytes of names.
[[nodiscard]] std::vector<Message> names_of(const Recipients& recipients);

}  // namespace triglyph
