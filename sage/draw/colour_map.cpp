#include "sage/draw/colour_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sage {

Colour viridis(double t) {
  static constexpr std::array<Colour, 17> kTable{{{68, 1, 84},
                                                  {72, 24, 106},
                                                  {71, 45, 123},
                                                  {66, 64, 134},
                                                  {59, 82, 139},
                                                  {51, 99, 141},
                                                  {44, 114, 142},
                                                  {38, 130, 142},
                                                  {33, 145, 140},
                                                  {31, 160, 136},
                                                  {40, 174, 128},
                                                  {63, 188, 115},
                                                  {94, 201, 98},
                                                  {132, 212, 75},
                                                  {173, 220, 48},
                                                  {216, 226, 25},
                                                  {253, 231, 37}}};
  const double at = std::clamp(t, 0.0, 1.0) * (kTable.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(at), kTable.size() - 2);
  const double part = at - static_cast<double>(low);
  const auto mix = [part](int a, int b) { return static_cast<int>(std::lround(a + part * (b - a))); };
  const Colour &a = kTable[low], &b = kTable[low + 1];
  return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue)};
}

std::string hex(const Colour& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue);
}

const char* line_colour(std::size_t index) {
  static constexpr std::array<const char*, 7> kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                       "#000000", "#e69f00", "#56b4e9"};
  return kColours[index % kColours.size()];
}

}  // namespace sage
