// The fields of both bounds for ParaView.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "sage/bounds/bounds_text.hpp"
#include "sage/record/vtu_text.hpp"

namespace sage::bounds {

namespace {

constexpr int kPoints = 6;  // of VTK's quadratic triangle: corners, then the middles of its sides

class VtuFields {
 public:
  VtuFields(const Bounds& found, Quantity quantity) : found_(found), quantity_(quantity) {}

  std::string text() && {
    vtu_.tag(fmt::format("    <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">", kPoints * cells(), cells()));
    add_grid();
    vtu_.tag("      <PointData>");
    add_points();
    vtu_.tag("      </PointData>\n      <CellData>");
    add_cells();
    vtu_.tag("      </CellData>");
    return std::move(vtu_).text();
  }

 private:
  // value(i, c): component c of entry i.
  template <class Number = double, class Value>
  void array(const char* name, std::size_t entries, int width, const Value& value) {
    std::vector<Number> values;
    values.reserve(entries * at(width));
    for (std::size_t i = 0; i < entries; ++i)
      for (int c = 0; c < width; ++c) values.push_back(static_cast<Number>(value(i, c)));
    vtu_.array(name, width, values);
  }
  std::size_t cells() const { return found_.domain.triangles.size(); }
  // Of a linear field by corner: at point i of all.
  template <class Corner>
  static double at_point(std::size_t i, const Corner& corner) {
    const std::size_t t = i / kPoints, k = i % kPoints;
    return k < 3 ? corner(t, k) : 0.5 * (corner(t, k - 3) + corner(t, (k - 2) % 3));
  }

  void add_grid() {
    const Domain& d = found_.domain;
    vtu_.tag("      <Points>");
    array("Points", kPoints * cells(), 3, [&](std::size_t i, int c) {
      return c == 2 ? 0.0 : at_point(i, [&](std::size_t t, std::size_t k) {
        return d.x[at(d.triangles[t].node[k])][c];
      });
    });
    vtu_.tag("      </Points>\n      <Cells>");
    array<std::int64_t>("connectivity", kPoints * cells(), 1, [](std::size_t i, int) { return i; });
    array<std::int64_t>("offsets", cells(), 1, [](std::size_t i, int) { return kPoints * (i + 1); });
    array<std::uint8_t>("types", cells(), 1, [](std::size_t, int) { return 22; });
    vtu_.tag("      </Cells>");
  }
  void add_points() {
    const Domain& d = found_.domain;
    constexpr std::array kNames{"stress_xx", "stress_yy", "stress_xy"};
    for (int c = 0; c < 3 && found_.stress.cols() > 0; ++c)
      array(kNames[at(c)], kPoints * cells(), 1, [&](std::size_t i, int) {
        return -at_point(i, [&](std::size_t t, std::size_t k) {
          return found_.stress(c, static_cast<Eigen::Index>(3 * t + k));
        });
      });
    if (d.pore_pressure)
      array("pore_pressure", kPoints * cells(), 1, [&](std::size_t i, int) {
        return at_point(
            i, [&](std::size_t t, std::size_t k) { return d.pressure(d.triangles[t], static_cast<int>(k)); });
      });
    if (found_.velocity.cols() > 0)
      array("velocity", kPoints * cells(), 3, [&](std::size_t i, int c) {
        const std::size_t t = i / kPoints, k = i % kPoints;
        const int column =
            k < 3 ? d.triangles[t].node[k] : static_cast<int>(d.x.size()) + found_.edges.of[t][k - 3];
        return c == 2 ? 0.0 : found_.velocity(c, column);
      });
  }
  void add_cells() {
    if (found_.stress.cols() > 0) {
      const double factor = shown_factor(found_, quantity_);
      array("strength_mobilised", cells(), 1, [&](std::size_t t, int) { return mobilised(found_, t, factor); });
    }
    const double sum = std::accumulate(found_.gap.begin(), found_.gap.end(), 0.0);
    if (!found_.gap.empty())
      array("part_of_gap", cells(), 1,
            [&](std::size_t t, int) { return sum > 0.0 ? found_.gap[t] / sum : 0.0; });
    array<std::int32_t>("soil", cells(), 1,
                        [&](std::size_t t, int) { return found_.domain.triangles[t].soil + 1; });
  }

  const Bounds& found_;
  Quantity quantity_;
  VtuText vtu_;
};

}  // namespace

std::string fields_vtu(const Bounds& found, Quantity quantity) {
  return VtuFields(found, quantity).text();
}

}  // namespace sage::bounds
