// What a sweep found, as JUnit XML: continuous integration shows it as a list of tests, one for
// each file.
#pragma once

#include <filesystem>
#include <string>

#include "manifests/ledger.h"

namespace triglyph {

// Writes the file for a sweep of this ledger: a test for each output that it looked at, by name, of
// which those that somebody has to look at failed. A file that could not be read is an error.
// Throws Error Unwritable. O(files), without keeping them in memory.
void write_junit_report(const Ledger& ledger, std::int64_t run, const std::filesystem::path& path);

// Returns the text as the content of XML or of an attribute: printable(), with the five characters
// that have a meaning there replaced.
[[nodiscard]] std::string xml_text(const std::string& text);

}  // namespace triglyph
