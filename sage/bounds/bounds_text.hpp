// Bounds for people: the page, tables and the picture.
#pragma once

#include <string>
#include <vector>

#include "sage/bounds/bounds.hpp"
#include "sage/bounds/model_domain.hpp"

namespace sage::bounds {

// "load multiplier", "force at the supports that move" or "factor of safety".
std::string quantity_words(const Domain& domain, Quantity quantity);

// "between 5.10664 and 5.20080", "above 5.1": what is proved.
std::string bracket_words(const Bounds& found);

// A row of the table beside the bounds: what finite elements say.
struct OtherAnswer {
  std::string name;  // "finite elements, psi = phi"
  std::string words;
};

std::string to_text(const Model& model, const Ground& ground, Quantity quantity, const Bounds& found,
                    const std::vector<OtherAnswer>& others = {});
// A row a mesh.
std::string to_csv(const Bounds& found, int digits);
// A row a corner of a triangle: place, effective stress of the lower field (compression positive), velocity of the
// upper field.
std::string fields_csv(const Bounds& found, int digits);
// How much of the strength the lower field mobilises, and the mechanism of the upper field.
std::string fields_svg(const Model& model, Quantity quantity, const Bounds& found,
                       const std::vector<OtherAnswer>& others = {});

}  // namespace sage::bounds
