// How long edges of elements are to be, by place.  Not part of the public interface.
#pragma once

#include <vector>

#include "sage/section/arrangement.hpp"

namespace sage::section {

// The least of the wishes around, each growing with the distance from its place.
class SizeField {
 public:
  // An arc, by piece, gets no fewer edges than a circle of `edges_of_circle` has.
  SizeField(const Section& section, const Arrangement& arrangement, const MeshSettings& settings,
            const std::vector<double>& edges_of_circle);

  // Without the limits of areas.
  double at(const Vector2& x) const;
  double limit_of(int area) const;  // the longest edge there; -1: beside all areas
  double at(const Vector2& x, int area) const { return std::min(at(x), limit_of(area)); }
  // Number of elements that all areas will have, roughly.
  double elements(const Arrangement& arrangement) const;

 private:
  struct Source {
    Curve curve;
    double size;
  };
  void add(const Curve& curve, double size);
  void add_short_pieces(const Arrangement& arrangement, const std::vector<double>& edges_of_circle);

  std::vector<Source> sources_;
  std::vector<double> limits_;  // by area
  double default_ = 0.0, growth_ = 0.35, factor_ = 1.0;
};

}  // namespace sage::section
