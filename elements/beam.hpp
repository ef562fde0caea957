// Timoshenko beams; in axisymmetry shells of revolution (Reissner).  docs/theory/structures.md
//
// Dofs: u1 v1 u2 v2 [u3 v3] theta1 theta2 [theta3] [slip]; theta turns counter-clockwise.  At a point, with t along the
// line, n to its left, w = u . n:  axial t . u', hoop u_r / r, shear w' - theta, bending theta', hoop bending
// theta t_r / r.  A positive bending moment pulls the right-hand side of the way from node 1 to node 2.  In plane
// strain the two hoop strains are zero, as for solids.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "elements/line_frame.hpp"
#include "elements/point_kernel.hpp"
#include "sage/math/quadrature.hpp"

namespace sage {

// What the first end of a beam does not hand on to its node.  The end then has a motion of its own against the node,
// along the line (axial) or to its left (shear), as a last dof; a beam that hands on all has none.  A hinge needs no
// release: its rotation is another unknown.
enum class Release { none, axial, shear };

constexpr int slip_dofs(Release release) {
  return release == Release::none ? 0 : 1;
}

// Three nodes, two Gauss points: no locking of thin or curved beams, and no motion without energy.
template <class Kinematics, Release released = Release::none>
class Beam3 final : public PointElement<5, 9 + slip_dofs(released), 2> {
  static constexpr int kDofs = 9 + slip_dofs(released);

 public:
  explicit Beam3(std::string_view name);
  void geometry(const NodeCoordinates& x, std::span<double> out) const override;
  Vector2 position(const NodeCoordinates& x, int point) const override {
    return x * Line3::N(GaussLine<2>::table[point].xi);
  }
  void body_load(const NodeCoordinates& x, const Vector2& b, std::span<double> f) const override;
  const std::vector<std::vector<int>>& edges() const override;
  void edge_load(const NodeCoordinates& x, int edge, const Vector2& normal, const Vector2& shear,
                 std::span<double> f) const override;
  // ElementEntry::force_at.
  static void force_at(const NodeCoordinates& x, double xi, const Vector2& force, std::span<double> f);
  std::span<const double> point_to_node(const NodeCoordinates& /*x*/) const override { return to_nodes_; }

 private:
  std::vector<double> to_nodes_;
};

// Two nodes, straight.  One shear strain for the element, found from its own equilibrium, and the deflection and
// rotation that follow from it: of a beam of one section the stiffness matrix is the exact one, however slender it
// is.  Points: the two ends and the middle (Simpson), so that results stand where designers want them.  Laws that are not
// linear see at the ends the axial force and the moment that the ends put on their nodes.
template <class Kinematics, Release released = Release::none>
class Beam2 final : public Element {
  static constexpr int kDofs = 6 + slip_dofs(released);

 public:
  explicit Beam2(std::string_view name);
  const ElementTraits& traits() const override { return traits_; }
  void geometry(const NodeCoordinates& x, std::span<double> out) const override;
  Outcome evaluate(const ElementIn& in, ElementOut& out) const override;
  Vector2 position(const NodeCoordinates& x, int point) const override;
  void body_load(const NodeCoordinates& x, const Vector2& b, std::span<double> f) const override;
  const std::vector<std::vector<int>>& edges() const override;
  void edge_load(const NodeCoordinates& x, int edge, const Vector2& normal, const Vector2& shear,
                 std::span<double> f) const override;
  // ElementEntry::force_at.
  static void force_at(const NodeCoordinates& x, double xi, const Vector2& force, std::span<double> f);
  std::span<const double> point_to_node(const NodeCoordinates& /*x*/) const override {
    static constexpr std::array<double, 6> ends{1.0, 0.0, 0.0, 0.0, 0.0, 1.0};
    return ends;
  }

 private:
  ElementTraits traits_;
};

// A spring between the two rotations of a hinge, at one node: its moment per radian is the law's bending stiffness.
// Dofs: u v, rotation, hinge_rotation.  Bending is by how much the beams of the hinge turn more than the others, an angle;
// the other four strains are zero.  In axisymmetry for each unit of circumference.
template <class Kinematics>
class RotationalSpring final : public PointElement<5, 4, 1> {
 public:
  explicit RotationalSpring(std::string_view name)
      : PointElement({.name = name,
                      .geometry = Kinematics::geometry,
                      .nodes = 1,
                      .dofs = 4,
                      .points = 1,
                      .law_size = 5}) {}
  void geometry(const NodeCoordinates& x, std::span<double> out) const override;
  Vector2 position(const NodeCoordinates& x, int /*point*/) const override { return x.col(0); }
  std::span<const double> point_to_node(const NodeCoordinates& /*x*/) const override {
    static constexpr std::array<double, 1> same{1.0};
    return same;
  }
};

}  // namespace sage
