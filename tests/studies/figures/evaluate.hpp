// The number of a check, from the runs that it names.
#pragma once

#include <functional>
#include <string>

#include "tests/studies/figures/specimen.hpp"

namespace sage::figures {

using GetRun = std::function<const SpecimenRun&(const std::string&)>;

// Units as Measure has them; NaN where the fields have no such number (the place of nothing). away_from_corner leaves
// the elements there out.  `a` and `b` are the runs of the check's sources (`b` null without one), perhaps altered;
// `get` gives the further runs that nu_rises and nu_bow need.
double number_of(const Check& check, const SpecimenRun& a, const SpecimenRun* b, bool away_from_corner,
                 const GetRun& get);

// NaN never passes.
bool passes(const Check& check, double number);

// Whether the number lies within 5 percent of a limit of the check, on either side of it.  A number that passes may be
// so near to a limit because there is little room for it (a share between .99 and 1): then within a quarter of that.
bool is_near_limit(const Check& check, double number);

// Whether r / R and z / H are of a place; `aspect` = H / R.  How far they are from it, in radii.
bool contains(Place place, double r, double z, double aspect);
double distance(Place place, double r, double z, double aspect);

// What shows that a check can fail.
enum class Alteration {
  none,
  swapped,   // another scene in the place of the first source
  same,      // the second source in the place of the first
  mirrored,  // upside down; curves from their end, the interface from the rim
  shuffled,  // every value at another place (strain)
  sign,      // deviations from the correct value with the other sign; levels: 1 - level
  lifted,    // stresses by a tenth of the correct deviator stress, levels and ratios by 0.1, sizes by a tenth
};
const char* name_of(Alteration alteration);
// Of a run: mirrored, shuffled, sign or lifted.
SpecimenRun altered(const SpecimenRun& run, Alteration alteration);
// Names of scenes that are taken for a scene in turn.
std::span<const char* const> swaps(const std::string& scene);

}  // namespace sage::figures
