// Contact of an edge of a solid with a rigid straight line, under large strain (docs/theory/large_strain.md).
// Nodes: 1 2 [3] of the edge (ends, then the middle), then the two ends of the line, whose displacements are its motion.
// The body lies to the left of the way along the line.  w = [slip, gap]: along the line, and away from it; gap > 0 is open.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "elements/moving_line.hpp"
#include "sage/math/quadrature.hpp"

namespace sage {

// Points: Gauss points of the edge.  A point beyond the line or beyond its ends carries nothing.  In contact its law sees
// the gap (below 0) and the slip since the first step that ended in contact.  Weights are those of the moved edge.
template <class Line, class Kinematics>
class Contact final : public Element {
 public:
  static constexpr int kEdge = Line::nodes, kNodes = kEdge + 2, kDofs = 2 * kNodes, kPoints = Line::nodes;
  explicit Contact(std::string_view name);

  const ElementTraits& traits() const override { return traits_; }
  // In the mesh.
  void geometry(const NodeCoordinates& x, std::span<double> out) const override;
  Vector2 position(const NodeCoordinates& x, int point) const override;
  // The ends of the line have the mean of the edge.
  std::span<const double> point_to_node(const NodeCoordinates& /*x*/) const override { return to_nodes_; }
  Outcome evaluate(const ElementIn& in, ElementOut& out) const override;

 private:
  using Place = SlipPoint<kNodes, Kinematics>;
  static MovingLine<kNodes> parts_at(const LinePoint& at);
  static bool is_beside(const Place& place) { return place.share >= 0.0 && place.share <= 1.0; }
  static bool touches(const Place& place) { return place.gap <= 0.0 && is_beside(place); }
  Outcome add_point(std::size_t p, const ElementIn& in, ElementOut& out, const Place& before, const Place& now,
                    SlipForces<kNodes>& sums) const;
  static void leave_open(std::size_t p, const ElementIn& in, ElementOut& out, double gap);

  std::array<MovingLine<kNodes>, kPoints> parts_;
  ElementTraits traits_;
  std::vector<double> to_nodes_;
};

}  // namespace sage
