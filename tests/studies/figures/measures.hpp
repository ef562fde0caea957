// What the source chapter's sentences about its figures 7.1 to 7.40 mean in numbers.  The table was written before
// anything was computed with it: a limit that is changed later needs a commit of its own that says why.
//
// Where the numbers come from: the mean stress of every element, which is what full integration of nearly
// incompressible elements gets right (docs/manual/figures.md); stress levels are those of such means; interface stresses
// at its points. `away from the corner` leaves out the 2 x 2 elements at the rim of the end. Each check is made with
// 4-node elements of full integration, as published, and with B-bar; those of the lubricated platen with three K_j: 120 (Table 7.2), 5, and the one for which the largest
// |conf - 50 psi| of full elements away from the corner is 3 percent of 50 psi at 10 percent of strain (Figure 7.18).
// Verdicts: holds (full and B-bar alike); holds away from the corner (both, there); artefact (only full elements,
// everywhere or away from the corner); depends on K_j (the verdict is not the same for all three); does not hold.
// The chapter does not give the second modulus of Figures 7.2 and 7.7: 1500 psi here.
#pragma once

#include <limits>
#include <span>

namespace sage::figures {

inline constexpr double kAny = std::numeric_limits<double>::infinity();

// The chapter's vague words; a check names the one that its limit comes from.
struct Word {
  const char* words;   // as the chapter has them
  const char* number;  // what they mean here
  const char* reason;
};
std::span<const Word> words();

// What a figure shows.  Compression positive.  conf = sigma_3, dev = sigma_1 - sigma_3; level is sqrt(J_2) over the
// strength; the last three are of the interface, along r.
enum class Quantity {
  none,
  sigma_r,
  sigma_theta,
  sigma_z,
  tau,
  dev,
  conf,
  level,
  joint_normal,
  joint_shear,
  joint_level,
};

// Parts of the quarter specimen.  R = radius, H = half height, z from the mid-height.
enum class Place {
  everywhere,
  near_ends,      // outer quarter of the half height: z >= .75 H
  near_axis,      // inner quarter of the radius: r <= .25 R
  near_rim,       // outer quarter of the radius: r >= .75 R
  end,            // the last row of elements
  away_from_end,  // the inner half of the half height: z <= .5 H
  not_near_ends,  // z < .75 H
  below_ends,     // z < .70 H: all but 15 percent of the length at each end
  halfway,        // between mid-height and end: .25 H <= z <= .75 H
  mid_axis,       // z <= .25 H and r <= .25 R
  end_axis,       // z >= .75 H and r <= .25 R
  at_end_axis,    // points of the section: no further than .15 R from them along r and along z
  at_end_rim,
  at_mid_axis,
  at_mid_rim,
};

// One field, one curve (no quantity) or one state.
struct Source {
  const char* scene = nullptr;  // a name of scene_list() (scenes.hpp)
  Quantity quantity = Quantity::none;
  double strain = 10.0;  // percent
};

// How a number is made of one or two sources.  c is the correct value (frictionless ends), q the correct deviator
// stress, x a value of the first source, y of the second; shares and means are those of the drawn section's area.
enum class Measure {
  // of the model
  elements,     // solid elements
  diameter,     // of the whole specimen, in
  height,       // of the whole specimen, in
  platen_flat,  // largest |u_z / prescribed - 1| along the loaded face
  // of fields
  change_most,   // largest |x - c| / q
  percent_most,  // largest |x - c| / c
  change_mean,   // mean (x - c) / q
  percent_mean,  // mean (x - c) / c
  excess_least,  // smallest (x - c) / q
  nearness,      // (largest x - correct conf) / (correct dev - correct conf): above 1/2 is nearer to the latter
  least,         // smallest x / q
  distance_most,  // from `target` to the place of the largest x (tau: |x|), in radii
  distance_least,
  rows_at_axis,       // share of the rows of elements whose largest x is no further than .15 R from the axis
  row_range,          // largest difference of x within a row of elements / q
  share_close,        // share with |x - c| <= p q
  share_below,        // share with x <= p
  share_above,        // share with x >= p
  above_r,            // mean r / R of where x >= p
  above_in,           // share of where x >= p that lies at `target`
  difference,         // largest |x - y| / q, both at one place
  correlation,        // of x - c with y - c
  change_ratio,       // largest |x - c| over largest |y - c|
  change_ratio_mean,  // mean |x - c| over mean |y - c|
  mean_gap,           // mean x at `place` less mean x in the rest of the section
  mean_step,          // |mean x - mean y|
  range,              // largest x less smallest x
  // of the yielded elements (level of the mean stress >= .999)
  yielded,         // share
  yielded_ratio,   // share in the first over share in the second
  yielded_r,       // mean r / R
  yielded_z,       // mean z / H
  yielded_r_step,  // mean r / R in the first less that in the second
  yielded_z_step,  // z / H below which 95 percent of them lie, first less second
  yielded_edge,    // z / H of the highest row of elements of which at least half has yielded
  unyielded,       // share
  // of the interface
  joint_most,       // largest level at the strain
  joint_most_ever,  // largest level at any strain
  // of curves: ratio = measured / correct deviator stress, excess = ratio - 1
  ratio,
  excess,
  excess_most,        // largest |excess| at any strain
  excess_ratio,       // first over second
  excess_difference,  // |first - second|
  excess_spread,      // (largest - smallest) / largest excess from 1 percent of strain on
  ratio_spread,       // largest - smallest ratio at any strain
  ratio_spread_both,  // the same over both scenes
  normalised,         // largest difference of measured deviator stress / E, over its largest value
  first_above,        // percent of strain from which the ratio stays above p
  yield_strain,       // percent of strain at which half of the specimen's points have yielded
  measured,           // measured deviator stress, psi
  nu_rises,  // smallest rise of the excess from one Poisson's ratio to the next, over its largest value
  nu_bow,    // largest distance from a straight line between nu = 0 and the largest, over its excess
};

// One sentence of the chapter, or part of one, as a number with limits.
struct Check {
  int figure = 0;  // 7.x
  const char* quote = nullptr;
  Measure measure = Measure::ratio;
  Source a, b{};
  double low = -kAny, high = kAny;  // of the number
  const char* word = nullptr;       // Word::words, or empty where the limit is the sentence's own
  Place place = Place::everywhere;  // of the field that is looked at
  Place target = Place::everywhere;
  double p = 0.0;
};
std::span<const Check> checks();

// The chapter's words for a figure and what its panels show.
struct Caption {
  int figure = 0;
  const char* title = nullptr;
};
std::span<const Caption> captions();

}  // namespace sage::figures
