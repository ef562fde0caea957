// The pictures of the 40 figures.
#pragma once

#include <string>
#include <vector>

#include "tests/studies/figures/verdict.hpp"

namespace sage::figures {

// A whole SVG document.  `choices`: the first and the last are drawn side by side where the platen is lubricated.
std::string figure_svg(int figure, Runs& runs, const std::vector<StiffnessChoice>& choices);

}  // namespace sage::figures
