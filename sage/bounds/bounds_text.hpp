// Bounds for people: the page, tables and the picture.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sage/bounds/bounds.hpp"
#include "sage/bounds/model_domain.hpp"

namespace sage::bounds {

// "load multiplier", "force at the supports that move" or "factor of safety".
std::string quantity_words(const Domain& domain, Quantity quantity);

// "between 5.10664 and 5.20080", "above 5.1": what is proved.
std::string bracket_words(const Bounds& found);

// An element of a mechanism: its corners, counter-clockwise, and how they move.
struct MovingPart {
  std::vector<Vector2> corner, motion;
};

// A row of the table beside the bounds: what finite elements found.
struct OtherAnswer {
  std::string name;                    // "finite elements, psi = phi"
  std::optional<double> lower, upper;  // ends of the bracket
  std::string remark;                  // why it is not proved; empty = it is
  bool associated = true;              // the bounds hold for it
  std::vector<MovingPart> mechanism;   // in the units of the model; empty = none
};

// Radius of Mohr's circle over that at yield with the strengths divided by F, in the mean of a triangle's corners.
double mobilised(const Bounds& found, std::size_t triangle, double factor);
// The F with which pictures show it: that of the lower bound, 1 of a load.
double shown_factor(const Bounds& found, Quantity quantity);

// Whether finite elements with associated flow found no equilibrium below the lower bound, which is impossible.
bool contradicts(const Bounds& found, const OtherAnswer& other);

std::string to_text(const Model& model, const Ground& ground, Quantity quantity, const Bounds& found,
                    const std::vector<OtherAnswer>& others = {});
// A row a mesh.
std::string to_csv(const Bounds& found, int digits);
// A row an answer: the bounds, then finite elements, with both ends and whether they are proved.
std::string answers_csv(const Bounds& found, const std::vector<OtherAnswer>& others, int digits);
// A row a corner of a triangle: place, effective stress of the lower field (compression positive), velocity of the
// upper field.
std::string fields_csv(const Bounds& found, int digits);
// The same for ParaView, as the text of a VTU file: six points a triangle (velocities are quadratic, stresses linear and
// free to jump), pore pressure, and by triangle the strength mobilised and its part of the gap.
std::string fields_vtu(const Bounds& found, Quantity quantity);
// How much of the strength the lower field mobilises, and the mechanism of the upper field; below them the mechanisms of
// the other answers.
std::string fields_svg(const Model& model, Quantity quantity, const Bounds& found,
                       const std::vector<OtherAnswer>& others = {});

}  // namespace sage::bounds
