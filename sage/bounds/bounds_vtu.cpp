// The fields of both bounds for ParaView.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>

#include "sage/bounds/bounds_text.hpp"

namespace sage::bounds {

namespace {

constexpr int kPoints = 6;  // of VTK's quadratic triangle: corners, then the middles of its sides

class VtuFields {
 public:
  VtuFields(const Bounds& found, Quantity quantity) : found_(found), quantity_(quantity) {}

  std::string text() && {
    const std::size_t cells = found_.domain.triangles.size();
    out_ = fmt::format(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
        "byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" "
        "NumberOfCells=\"{}\">\n",
        kPoints * cells, cells);
    add_grid();
    out_ += "<PointData>\n";
    add_points();
    out_ += "</PointData>\n<CellData>\n";
    add_cells();
    out_ += "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
    return std::move(out_);
  }

 private:
  // value(i, c): component c of entry i.
  template <class Value>
  void array(const char* name, const char* type, std::size_t entries, int width, const Value& value) {
    fmt::format_to(std::back_inserter(out_),
                   "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"ascii\">\n", type,
                   name, width);
    for (std::size_t i = 0; i < entries; ++i)
      for (int c = 0; c < width; ++c)
        fmt::format_to(std::back_inserter(out_), "{}{}", value(i, c), c + 1 < width ? " " : "\n");
    out_ += "</DataArray>\n";
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
    out_ += "<Points>\n";
    array("Points", "Float64", kPoints * cells(), 3, [&](std::size_t i, int c) {
      return c == 2 ? 0.0 : at_point(i, [&](std::size_t t, std::size_t k) {
        return d.x[at(d.triangles[t].node[k])][c];
      });
    });
    out_ += "</Points>\n<Cells>\n";
    array("connectivity", "Int64", kPoints * cells(), 1, [](std::size_t i, int) { return i; });
    array("offsets", "Int64", cells(), 1, [](std::size_t i, int) { return kPoints * (i + 1); });
    array("types", "UInt8", cells(), 1, [](std::size_t, int) { return 22; });
    out_ += "</Cells>\n";
  }
  void add_points() {
    const Domain& d = found_.domain;
    constexpr std::array kNames{"stress_xx", "stress_yy", "stress_xy"};
    for (int c = 0; c < 3 && found_.stress.cols() > 0; ++c)
      array(kNames[at(c)], "Float64", kPoints * cells(), 1, [&](std::size_t i, int) {
        return -at_point(i, [&](std::size_t t, std::size_t k) {
          return found_.stress(c, static_cast<Eigen::Index>(3 * t + k));
        });
      });
    if (d.pore_pressure)
      array("pore_pressure", "Float64", kPoints * cells(), 1, [&](std::size_t i, int) {
        return at_point(
            i, [&](std::size_t t, std::size_t k) { return d.pressure(d.triangles[t], static_cast<int>(k)); });
      });
    if (found_.velocity.cols() > 0)
      array("velocity", "Float64", kPoints * cells(), 3, [&](std::size_t i, int c) {
        const std::size_t t = i / kPoints, k = i % kPoints;
        const int column =
            k < 3 ? d.triangles[t].node[k] : static_cast<int>(d.x.size()) + found_.edges.of[t][k - 3];
        return c == 2 ? 0.0 : found_.velocity(c, column);
      });
  }
  void add_cells() {
    if (found_.stress.cols() > 0) {
      const double factor = shown_factor(found_, quantity_);
      array("strength_mobilised", "Float64", cells(), 1,
            [&](std::size_t t, int) { return mobilised(found_, t, factor); });
    }
    const double sum = std::accumulate(found_.gap.begin(), found_.gap.end(), 0.0);
    if (!found_.gap.empty())
      array("part_of_gap", "Float64", cells(), 1,
            [&](std::size_t t, int) { return sum > 0.0 ? found_.gap[t] / sum : 0.0; });
    array("soil", "Int32", cells(), 1, [&](std::size_t t, int) { return found_.domain.triangles[t].soil + 1; });
  }

  const Bounds& found_;
  Quantity quantity_;
  std::string out_;
};

}  // namespace

std::string fields_vtu(const Bounds& found, Quantity quantity) {
  return VtuFields(found, quantity).text();
}

}  // namespace sage::bounds
