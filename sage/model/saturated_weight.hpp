// What soil below a phreatic line weighs more than above it (Material::saturated_unit_weight).
#pragma once

#include <functional>
#include <span>

#include "sage/model/water.hpp"

namespace sage {

// The line below which the solids of a group have their saturated unit weight in a stage (0-based); nullptr: none have.
const WaterCard* saturating_line(const Model& model, int stage, std::size_t group);

// Saturated less plain unit weight; 0 where the material states none.
double saturation_weight(const Material& material);

// add(element, f): the weight that saturation adds to an element of the group, two forces a node; gravity: factors along x and
// y.  Exact for elements with straight sides that are parallelograms or triangles, wherever the line crosses them.
using AddElementForce = std::function<void(int element, std::span<const double> f)>;
void add_saturation_weight(const Model& model, std::size_t group, const WaterCard& line, const Vector2& gravity,
                           const AddElementForce& add);

}  // namespace sage
