// Colours of pictures for grey print and for colour-blind readers.
#include "sage/draw/colour_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace sage {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

// sRGB to linear light.
double linear(int value) {
  const double c = value / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

// Lightness L* (CIE 1976) of what an eye sees.
double lightness(const Colour& colour, const Matrix& eye) {
  const std::array<double, 3> light{linear(colour.red), linear(colour.green), linear(colour.blue)};
  constexpr std::array<double, 3> kWeight{0.2126, 0.7152, 0.0722};
  double y = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    double seen = 0.0;
    for (std::size_t j = 0; j < 3; ++j) seen += eye[i][j] * light[j];
    y += kWeight[i] * std::max(0.0, seen);
  }
  return y > 0.008856 ? 116.0 * std::cbrt(y) - 16.0 : 903.3 * y;
}

// Red-blind and green-blind eyes by Vienot, Brettel and Mollon (1999).  Ten bands of a picture get lighter from one to
// the next by at least 5 L*: 2 is a difference that readers see side by side.
TEST(ColourMap, BandsDifferInGreyAndForColourBlindReaders) {
  const std::array<Matrix, 3> eyes{
      Matrix{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}},
      Matrix{{{0.11238, 0.88762, 0.0}, {0.11238, 0.88762, 0.0}, {0.00401, -0.00401, 1.0}}},
      Matrix{{{0.29275, 0.70725, 0.0}, {0.29275, 0.70725, 0.0}, {-0.02234, 0.02234, 1.0}}}};
  for (const Matrix& eye : eyes)
    for (int band = 1; band < 10; ++band)
      EXPECT_GT(lightness(viridis(band / 9.0), eye), lightness(viridis((band - 1) / 9.0), eye) + 5.0) << band;
}

}  // namespace
}  // namespace sage
