// Zero-thickness interface under large strain: slip and gap along the present middle line of its sides
// (docs/theory/large_strain.md).  Nodes, signs and the points of its rule are those of Interface.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "elements/interface.hpp"
#include "elements/moving_line.hpp"

namespace sage {

// Weights are those of the present middle line.  Not for InterfaceRule::row_sum.
template <class Line, class Kinematics>
class LargeInterface final : public Element {
 public:
  static constexpr int kPairs = Line::nodes, kNodes = 2 * kPairs, kDofs = 2 * kNodes;
  LargeInterface(std::string_view name, InterfaceRule rule);

  const ElementTraits& traits() const override { return traits_; }
  // In the mesh.
  void geometry(const NodeCoordinates& x, std::span<double> out) const override { small_.geometry(x, out); }
  Vector2 position(const NodeCoordinates& x, int point) const override { return small_.position(x, point); }
  void body_load(const NodeCoordinates&, const Vector2&, std::span<double>) const override {}
  const std::vector<std::vector<int>>& edges() const override { return small_.edges(); }
  std::span<const double> point_to_node(const NodeCoordinates& x) const override {
    return small_.point_to_node(x);
  }
  double shape_quality(const NodeCoordinates& x) const override { return small_.shape_quality(x); }
  std::string caution(const NodeCoordinates& x) const override { return small_.caution(x); }
  Outcome evaluate(const ElementIn& in, ElementOut& out) const override;

 private:
  Interface<Line, Kinematics> small_;
  ElementTraits traits_;
  std::array<MovingLine<kNodes>, kPairs> parts_;
};

}  // namespace sage
