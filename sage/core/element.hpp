// The interface between analysis and elements.  An element is a stateless formulation shared by a whole group.
#pragma once

#include <array>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "sage/core/law.hpp"

namespace sage {

enum class Geometry { plane_strain, axisymmetric };

// Coordinates of an element's nodes, one column a node: (x, y), or (r, z) when axisymmetric.
using NodeCoordinates = Eigen::Ref<const Eigen::Matrix2Xd>;

struct ElementTraits {
  std::string_view name;
  Geometry geometry = Geometry::plane_strain;
  int nodes = 0;
  int dofs = 0;                // 2 a node, ordered u1 v1 u2 v2 ..., or as ElementEntry::unknowns says
  int points = 0;              // integration points
  int degree = 1;              // polynomial degree of the displacements
  int law_size = 4;            // 4 solid, 2 interface, 1, 3 or 5 structure
  bool reduced = false;        // reduced integration: fewer points than full rank needs (hourglass possible)
  bool locks = false;          // stiffens without bound as nu -> 1/2 (full integration of low order)
  bool symmetric = true;       // K is wherever the law's D is
  bool linear = true;          // f is linear in du, with one K for every dt, wherever the law is
  bool sees_unknowns = false;  // ElementIn::u0 and dt are wanted
  // f is linear in du, with one K for each ElementIn::dt, wherever the laws are: K is made once for a step size, and its
  // factors serve all steps of that size.
  bool linear_in_step = false;
  bool sees_coordinates =
      false;  // ElementIn::x is wanted: for elements that recompute their geometry as they move
  // Stress is that of the moved place (Cauchy's), strain logarithmic, and loads on edges follow the motion
  // (ElementIn::edges); sees unknowns and coordinates.
  bool large_strain = false;
  int second_law_size = 0;   // components of ElementIn::second_law; 0 = the element has one law
  bool loses_order = false;  // as nu -> 1/2 it still converges, but slower than its shape functions allow
  int own_doubles = 0;       // that geometry() writes behind the points, for evaluate() alone
  // What the element itself remembers at each point, behind the quantities of the law in ElementIn::h0 and
  // ElementOut::h1.  Committed, restarted and written like the law's; such an element is never taken for linear.
  std::span<const Quantity> history = {};
  int pressure_history = -1;  // of them the excess pressure of pore water, which the law's stress is without
  // Doubles filled by geometry(): for each point its weight w, then B^T (dofs x law_size, column-major).
  int geometry_size() const { return points * (1 + law_size * dofs) + own_doubles; }
};

// A load on an edge, as Element::edge_load has it.
template <int N>
class FourPointLaw;

struct EdgeTraction {
  int edge = 0;
  Vector2 normal = Vector2::Zero(), shear = Vector2::Zero();
};

// One element's inputs.  Pointers are to contiguous blocks of the sizes that the traits give.
struct ElementIn {
  const double* geometry = nullptr;  // from Element::geometry
  const double* du = nullptr;        // dofs: unknowns since the committed state
  LawRef law;
  const double* sigma0 = nullptr;  // points x law_size, committed stress
  const double* eps0 = nullptr;    // points x law_size, committed strain
  const double* h0 = nullptr;      // points x (history of the law, then of the element)
  // One a point where the law wants them, else nullptr: to be handed on as PointIn::context.
  const PointContext* contexts = nullptr;
  // For elements that see them: committed unknowns (dofs), and the time of the step; 0 at a state that stands.
  const double* u0 = nullptr;
  double dt = 0.0;
  // Of that time what water has to flow in, and where in the step its flow is taken (0.5 .. 1).
  double flow_dt = 0.0, theta = 1.0;
  const double* x = nullptr;  // sees_coordinates: of the nodes as the mesh has them, x1 y1 x2 y2 ...
  // Elements with two laws (a skeleton and the flow through it): the other one.  What it needs to remember is part of the
  // element's own history.
  LawRef second_law = {};
  // Of lines whose law is not linear: loads spread along the element, a force a dof, at the end of the step and at the
  // committed state; nullptr = there are none.
  const double* spread = nullptr;
  const double* spread0 = nullptr;
  // Of large strain: the law again, where it updates four points at once; nullptr = one by one.
  const FourPointLaw<4>* four_law = nullptr;
  // Of large strain: loads on its edges at the end of the step.  The loads of the run are those of the mesh; what the motion
  // adds to them is taken from f (and its derivative from K).
  std::span<const EdgeTraction> edges = {};
};

struct ElementOut {
  double* K = nullptr;            // dofs x dofs column-major, overwritten; nullptr = not wanted
  double* f = nullptr;            // dofs: internal force  sum w B^T sigma, overwritten
  double* sigma1 = nullptr;       // points x law_size, trial stress
  double* eps1 = nullptr;         // points x law_size, trial strain
  double* h1 = nullptr;           // points x (history of the law, then of the element), overwritten
  PointStatus* status = nullptr;  // points
  double* load = nullptr;         // dofs, of ElementIn::edges: what the motion adds to these loads, overwritten
};

// Elements hold no state: several threads may call them at once.  Optional interface: FourElements (four_at_a_time.hpp).
class Element {
 public:
  virtual ~Element() = default;
  virtual const ElementTraits& traits() const = 0;

  // w and B of every integration point.  Strains are small, so one call serves a whole analysis.
  // w contains detJ, the quadrature weight and the measure: unit thickness, or 2 pi r (full circle).
  // Throws ElementShapeError (non-positive detJ, crossed, clockwise, negative radius, pairs that do not match).
  virtual void geometry(const NodeCoordinates& x, std::span<double> geometry) const = 0;

  // f, K and the trial state.  Allocates nothing.
  virtual Outcome evaluate(const ElementIn& in, ElementOut& out) const = 0;

  // Position of an integration point.
  virtual Vector2 position(const NodeCoordinates& x, int point) const = 0;

  // f += integral of N^T b dV; b = force per volume in x and y (of a line: per length).  Nothing where an
  // element has no weight.
  virtual void body_load(const NodeCoordinates& /*x*/, const Vector2& /*b*/, std::span<double> /*f*/) const {}

  // Local node numbers of each edge, counter-clockwise: corner, corner[, mid-side nodes in order].  None: no
  // edge load can be put on the element.
  virtual const std::vector<std::vector<int>>& edges() const {
    static const std::vector<std::vector<int>> none;
    return none;
  }

  // f += integral of N^T t dA over an edge.  normal > 0 pushes into the element (a pressure); shear > 0 acts
  // along the edge in its counter-clockwise direction.  Both vary linearly from first to second corner.
  virtual void edge_load(const NodeCoordinates& /*x*/, int /*edge*/, const Vector2& /*normal*/,
                         const Vector2& /*shear*/, std::span<double> /*f*/) const {
    throw std::logic_error("an element with edges takes loads on them");
  }

  // Stress at the places where it is most accurate (p x p Gauss points of a quadrilateral of degree p), from
  // the stress at the points: samples x points, row-major.  Empty: the points are those places.
  virtual std::span<const double> point_to_sample() const { return {}; }

  // Least-squares or exact extrapolation from points to nodes: nodes x points, row-major.  The map depends on the place
  // of a quadratic interface alone (at r = 0).
  virtual std::span<const double> point_to_node(const NodeCoordinates& x) const = 0;

  // N (nodes) and dN/d(xi, eta) (nodes x 2, column-major) at a place of the parent shape: the square (-1, 1)^2,
  // or the triangle (0, 0) (1, 0) (0, 1).  False: the element has no inside
  // (interfaces).
  virtual bool shape_functions(const Vector2& /*parent*/, std::span<double> /*N*/,
                               std::span<double> /*dN*/) const {
    return false;
  }

  // Smallest detJ over the mean detJ at the integration points and corners; 1 = parallelogram, <= 0 = unusable.
  virtual double shape_quality(const NodeCoordinates& /*x*/) const { return 1.0; }

  // A warning for the user about a usable element, empty if there is none: e.g. a pair
  // of nodes without stiffness.
  virtual std::string caution(const NodeCoordinates& /*x*/) const { return {}; }
};

inline PointHistory history_of(const LawRef& law, const ElementTraits& element) {
  return {history_of(law), element.history};
}

}  // namespace sage
