// The values that a picture shows.
#pragma once

#include "sage/draw/picture.hpp"
#include "sage/record/nodal_values.hpp"

namespace sage {

// "sig-z [psi], compression positive"
std::string describe_field(const Model& model, Field field);

// What a field is computed from, at the entries of a layout: displacements, or stresses (tension positive) and
// their level; 0 at interfaces.  These are what shape functions carry to places between the nodes, not the
// field itself: the length of a vector and the second invariant of a stress are no polynomials.
struct FieldParts {
  int components = 0;
  Eigen::MatrixXd at;    // components x entries
  double largest = 0.0;  // displacement or stress
};
FieldParts field_parts(const Model& model, const Solution& solution, const NodalLayout& layout, Field field);

// The field from its parts at one place, with the signs that people read; what is rounding beside the largest
// is zero.
double field_value(Field field, const FieldParts& parts, const double* at);

}  // namespace sage
