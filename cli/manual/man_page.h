// Manual pages made from the declared arguments, so that no option can be missing.
#pragma once

#include <span>
#include <string>

#include <CLI/CLI.hpp>

#include "cli/app.h"

namespace triglyph {

// Returns the manual page in the man macros of roff: of the program itself, which lists its verbs,
// or of one verb, called `name` ("triglyph mark"). `version` stands in the page's foot.
[[nodiscard]] std::string man_page(const CLI::App& app, const std::string& name,
                                   const std::string& version);

}  // namespace triglyph
