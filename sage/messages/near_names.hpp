// "did you mean": the nearest of the names that are known.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sage {

// Letters to insert, delete, replace or exchange with their neighbour.
std::size_t distance(std::string_view a, std::string_view b);
// "; did you mean NAME?"; empty where none is near.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& known);

}  // namespace sage
