// Exact fields against computed ones, and models whose loads and supports come from them at full precision.
#pragma once

#include <functional>
#include <vector>

#include "tests/studies/verify/record.hpp"

namespace sage::verify {

using VectorField = std::function<Vector2(const Vector2&)>;
using TensorField = std::function<Vector4(const Vector2&)>;

// Nodes on edges of solids that belong to one element only, one flag a node.
std::vector<char> boundary_nodes(const Model& model);

// Holds both components of flagged nodes at u(x) from the first stage on.  In rings u_r on the axis stays 0.
void hold(Model& model, const std::vector<char>& nodes, const VectorField& u);
// One node, in the given components.
void hold(Model& model, int node, bool x, bool y, const Vector2& u);

// Nodal loads of a body force b(x) per volume in the first stage, by the elements' load rule.
void add_body_force(Model& model, const VectorField& b);

// Stress of a law without stress before, tension positive.
Vector4 stress_of(const Material& material, const Vector4& strain);

// Errors over the volume (measure included), relative to the exact field's own size.
struct FieldErrors {
  double displacement = 0.0;  // L2, in the integration points of the load rule
  double stress = 0.0;        // L2, in the points of the element
};
FieldErrors field_errors(const WholeRun& run, const VectorField& u, const TensorField& sigma);

// Largest difference of any point's stress of a group from sigma, over the largest norm of sigma.
double largest_stress_error(const WholeRun& run, std::size_t group, const TensorField& sigma);

// Position of a point of a group, points counted through all its elements.
Vector2 point_position(const Model& model, std::size_t group, Eigen::Index point);

// What the part towards node 2 puts on the part towards node 1 at an end of a structure's element, from the forces of its
// nodes; M is positive where it pulls the right-hand side of the way from node 1 to node 2.  N and Q are its parts along
// the line and to the left of it: of the true line, which a polygon has not.
struct EndForces {
  Vector2 force = Vector2::Zero(), place = Vector2::Zero();
  double M = 0.0;

  double N(const Vector2& along) const { return force.dot(along); }
  double Q(const Vector2& along) const { return force.y() * along.x() - force.x() * along.y(); }
};

// Reads them of one group at the end of every increment; the last stay.
class EndReader final : public Observer {
 public:
  explicit EndReader(std::size_t group) : group_(group) {}
  void on_increment(const Model& model, const StepReport&, const Solution& now) override;
  const std::vector<EndForces>& ends() const { return ends_; }  // two an element, in order

 private:
  std::size_t group_;
  std::vector<EndForces> ends_;
};

// Stress at a node: mean of what the elements of the group around it extrapolate.
Vector4 stress_at_node(const WholeRun& run, std::size_t group, int number);

}  // namespace sage::verify
