#include "sage/exchange/cande_soils.hpp"

#include <algorithm>
#include <span>

namespace sage::translate {

namespace {

// Duncan, Byrne, Wong & Mabry (1980), UCB/GT/80-01: conservative values for compacted soils, cohesion in ksf there.
constexpr double kKsf = 1000.0 / 144.0;
constexpr NamedSoil kDuncan[] = {
    {"CA105", 600, 0.40, 0.7, 0.0, 42, 9, 175, 0.2},
    {"CA95", 300, 0.40, 0.7, 0.0, 36, 5, 75, 0.2},
    {"CA90", 200, 0.40, 0.7, 0.0, 33, 3, 50, 0.2},
    {"SM100", 600, 0.25, 0.7, 0.0, 36, 8, 450, 0.0},
    {"SM90", 300, 0.25, 0.7, 0.0, 32, 4, 250, 0.0},
    {"SM85", 150, 0.25, 0.7, 0.0, 30, 2, 150, 0.0},
    {"SC100", 400, 0.60, 0.7, 0.5 * kKsf, 33, 0, 200, 0.5},
    {"SC90", 150, 0.60, 0.7, 0.3 * kKsf, 33, 0, 75, 0.5},
    {"SC85", 100, 0.60, 0.7, 0.2 * kKsf, 33, 0, 50, 0.5},
    {"CL100", 150, 0.45, 0.7, 0.4 * kKsf, 30, 0, 140, 0.2},
    {"CL90", 90, 0.45, 0.7, 0.2 * kKsf, 30, 0, 80, 0.2},
    {"CL85", 60, 0.45, 0.7, 0.1 * kKsf, 30, 0, 50, 0.2},
};

// Selig (1988); Boscardin, Selig, Lin & Yang (1990), J. Geotech. Eng. 116(1), 88-104: compacted soils.
constexpr NamedSoil kSelig[] = {
    {"SW100", 1300, 0.90, 0.65, 0.0, 54, 15, 108.8, 0.01}, {"SW95", 950, 0.60, 0.70, 0.0, 48, 8, 74.8, 0.02},
    {"SW90", 640, 0.43, 0.75, 0.0, 42, 4, 40.8, 0.05},     {"SW85", 450, 0.35, 0.80, 0.0, 38, 2, 12.7, 0.08},
    {"SW80", 320, 0.35, 0.83, 0.0, 36, 1, 6.1, 0.11},      {"ML95", 440, 0.40, 0.95, 4.0, 34, 0, 48.3, 0.06},
    {"ML90", 200, 0.26, 0.89, 3.5, 32, 0, 18.4, 0.10},     {"ML85", 110, 0.25, 0.85, 3.0, 30, 0, 9.5, 0.14},
    {"ML80", 75, 0.25, 0.80, 2.5, 28, 0, 5.1, 0.19},       {"ML50", 16, 0.95, 0.55, 0.0, 23, 0, 1.3, 0.43},
    {"CL95", 120, 0.45, 1.00, 9.0, 15, 4, 21.2, 0.13},     {"CL90", 75, 0.54, 0.94, 7.0, 17, 7, 10.2, 0.17},
    {"CL85", 50, 0.60, 0.90, 6.0, 18, 8, 5.2, 0.21},       {"CL80", 35, 0.66, 0.87, 5.0, 19, 8.5, 3.5, 0.25},
};

}  // namespace

const NamedSoil* named_soil(bool selig, std::string_view text) {
  const std::size_t begin = text.find_first_not_of(' ');
  if (begin == std::string_view::npos) return nullptr;
  const std::string_view word = text.substr(begin, text.find(' ', begin) - begin);
  const std::span<const NamedSoil> soils =
      selig ? std::span<const NamedSoil>(kSelig) : std::span<const NamedSoil>(kDuncan);
  const auto found = std::ranges::find(soils, word, &NamedSoil::name);
  return found == soils.end() ? nullptr : &*found;
}

}  // namespace sage::translate
