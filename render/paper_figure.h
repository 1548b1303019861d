// The figures of the paper: a model, and its mark without and with optimisation.
// Wang & Hu, CAGD 27 (2010), figures 6 to 8.
#pragma once

#include <string>

#include "render/comparison.h"

namespace triglyph {

// Fills the mesh (the paper's experiment, with the trial key) with and without optimisation, and
// draws three panels: the original, the un-optimised and the optimised mark. Units are shown as in
// the paper: as facets (tsq), moved points (aie) or balls (iie). Throws Error Usage for an unknown
// scheme or a mesh without faces. Costs two markings.
[[nodiscard]] Image draw_paper_figure(const Mesh& mesh, const std::string& scheme,
                                      const PictureOptions& options);

}  // namespace triglyph
