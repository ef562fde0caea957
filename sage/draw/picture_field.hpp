// The values that a picture shows.
#pragma once

#include "sage/draw/picture.hpp"
#include "sage/model/locate.hpp"
#include "sage/record/nodal_values.hpp"

namespace sage {

// "unknown field devi; known: conf, dev, SL, ..."; `pictures`: flow_net is one, where there are heads.
std::string unknown_field(const FieldTable& table, std::string_view name, bool pictures);

// A direction has two angles, 180 degrees apart.  Where most of these angles (degrees, -90 to 90) are nearer to 90
// than to 0, they are turned to 0 to 180, so that directions which are nearly alike do not lie at both ends.
// Nothing happens to fields that are no angles.
void unfold_angles(const FieldEntry& field, std::vector<double*> values);

// What is carried of a field (carry()), at the entries of a layout: that is what shape functions take to places
// between the nodes, not the field itself; the length of a vector and the second invariant of a stress are no
// polynomials.
struct FieldParts {
  int components = 0;
  Eigen::MatrixXd at;    // components x entries
  double largest = 0.0;  // displacement or stress: what is rounding beside it is zero
  // Of what areas have of a field that is carried as it is (a stress level, a pore pressure), by component: neither
  // extrapolation nor shape functions lead out of what the integration points have.  Empty of other fields.
  std::vector<double> least = {}, most = {};
};
FieldParts field_parts(const Model& model, const Solution& solution, const NodalLayout& layout,
                       const FieldEntry& field, NodalRule rule);

// The number that a picture shows, from its parts at one place; what is rounding beside the largest is zero.
double field_number(const FieldChoice& field, const FieldParts& parts, const double* at);

// How values came from the integration points to where they are shown; empty for what nodes have themselves.
std::string rule_text(const FieldEntry& entry, NodalRule rule);

// The number that a picture shows, at any place of the undeformed mesh.  Model and solution must outlive it.
class PictureValues {
 public:
  PictureValues(const Model& model, const Solution& solution, const FieldChoice& field, NodalRule rule);

  // NaN where no active element that fills an area has one.
  double at(const Vector2& place) const;

 private:
  double at(const Location& location) const;

  const Model& model_;
  FieldChoice field_;
  NodalLayout layout_;
  FieldParts parts_;
  std::vector<std::vector<double>> of_elements_;  // by group: of directions, which are no means of directions
  Locator solids_, flow_;
};

}  // namespace sage
