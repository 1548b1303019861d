// The figures of the paper: a model as it is, marked without and with optimisation.
// Wang & Hu, CAGD 27 (2010), figures 6 to 8.
#pragma once

#include <string>

#include "render/comparison.h"

namespace triglyph {

// Marks the mesh both ways, every unit carrying a part of its own (the paper's experiment, trial
// key), and draws three panels: the original, the un-optimised and the optimised mark, with units
// shown as the paper does: facets (tsq), moved points (aie), balls (iie). Throws Error Usage for an
// unknown scheme or a mesh without faces. O of two markings.
[[nodiscard]] Image draw_paper_figure(const Mesh& mesh, const std::string& scheme,
                                      const PictureOptions& options);

}  // namespace triglyph
