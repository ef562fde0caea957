// Values as people read them: compression positive, with words for what a point does.  Signs turn here on the
// way out and nowhere else.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sage/analysis/observer.hpp"

namespace sage {

// Stress, strain, traction and relative displacement: the program's tension + becomes compression +.  Never -0.
inline double outward(double internal) {
  return 0.0 - internal;
}

std::string_view status_name(PointStatus status);  // "yielded"
std::string_view method_name(Method method);       // "Newton"

struct AxisNames {
  std::string_view x, y;  // x y, or r z
};
inline AxisNames axis_names(Geometry geometry) {
  return geometry == Geometry::axisymmetric ? AxisNames{"r", "z"} : AxisNames{"x", "y"};
}

// What the supports do to the mesh at a held dof, along +x or +y: internal force minus applied load.
inline double reaction(const Solution& solution, int dof) {
  return (*solution.internal)[dof] - (*solution.external)[dof];
}

// How a run ended that reached its end, with what the model lacks of its deck: "completed: every increment in
// equilibrium", or "completed, but PARTIAL: left out ...".
std::string completed_words(const Model& model, double motion);
// Of displacements that are no small ones (RunResult::motion); empty where they are, and under large strain.
std::string motion_words(const Model& model, double motion);
// "left out 36 beam elements; ...": empty where the model has all that its deck asks for.
std::string left_out_words(const Model& model);

// The first line of a text, for comments in files.
std::string one_line(const std::string& text);

// With & < > " replaced, for XML and SVG; what XML does not allow, such as control characters, becomes a blank.
std::string xml_text(std::string_view text);

// A file's name as text that every reader takes: bytes that are no UTF-8, control characters and those of
// `also` become %XX.  And the way back from it (with `also` = "%"); nothing where a %XX is spoilt.
std::string plain_name(std::string_view name, std::string_view also = "%");
std::optional<std::string> name_from_plain(std::string_view text);

// "per metre", by the deck's unit of length, or "for the full circle (2 pi r)".
std::string forces_per(const Model& model);
// The same of forces in structures: a ring's are for each unit of its circumference.
std::string structure_forces_per(const Model& model);
// "metre", "foot", ... ; another unit as the deck has it.
std::string length_word(const std::string& unit);

// The sign convention in a few lines; `mark` stands before each.
std::string sign_convention(const Model& model, std::string_view mark);
// Which stress and strain results have then.
inline constexpr std::string_view kLargeStrainWords =
    "stress is Cauchy stress (force over present area), strain logarithmic, of the left stretch";

}  // namespace sage
