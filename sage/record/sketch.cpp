#include "sage/record/sketch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sage/record/values.hpp"

namespace sage {

namespace {

constexpr int kRows = 10;       // of characters
constexpr int kMargin = 14;     // columns left of the axis
constexpr int kMostWidth = 72;  // of the plot itself

struct Range {
  double low = 0.0, high = 0.0;
  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double share(double value) const { return (value - low) / (high - low); }
};

bool finite(const Sketch::Curve& curve, std::size_t i) {
  return std::isfinite(curve.x[i]) && std::isfinite(curve.y[i]);
}

// Characters of the plot's area; each holds dots, or a mark of its own.
class Area {
 public:
  Area(int width, bool unicode)
      : width_(width), across_(unicode ? 2 : 1), down_(unicode ? 4 : 1), unicode_(unicode) {
    dots_.assign(width * kRows, 0);
  }

  // Shares of the area, from its lower left corner.
  void line(double x0, double y0, double x1, double y1) {
    const int steps =
        1 + static_cast<int>(std::max(std::abs(x1 - x0) * across_ * width_, std::abs(y1 - y0) * down_ * kRows));
    for (int i = 0; i <= steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      dot(x0 + t * (x1 - x0), y0 + t * (y1 - y0));
    }
  }
  void cross(double x, double y) {
    unsigned& cell = cell_at(place(x, width_), kRows - 1 - place(y, kRows));
    if (cell == 0) cell = kCross;
  }
  std::string row(int r) const {
    std::string text;
    for (int c = 0; c < width_; ++c) text += character(dots_[r * width_ + c]);
    text.erase(text.find_last_not_of(' ') + 1);
    return text;
  }

 private:
  static constexpr unsigned kCross = 1u << 8;

  static int place(double share, int count) {
    return std::clamp(static_cast<int>(std::lround(share * (count - 1))), 0, count - 1);
  }
  unsigned& cell_at(int column, int row) { return dots_[row * width_ + column]; }

  void dot(double x, double y) {
    const int column = place(x, across_ * width_), row = down_ * kRows - 1 - place(y, down_ * kRows);
    // Dots of a Braille character by column and row, as Unicode numbers them.
    constexpr unsigned kBraille[2][4] = {{0x01, 0x02, 0x04, 0x40}, {0x08, 0x10, 0x20, 0x80}};
    cell_at(column / across_, row / down_) |= kBraille[column % across_][row % down_];
  }
  std::string character(unsigned cell) const {
    if (cell == 0) return " ";
    if (cell == kCross) return "+";
    if (!unicode_) return "*";
    const unsigned code = 0x2800 + (cell & 0xffu);  // three bytes of UTF-8
    return {static_cast<char>(0xe0 | (code >> 12)), static_cast<char>(0x80 | ((code >> 6) & 0x3f)),
            static_cast<char>(0x80 | (code & 0x3f))};
  }

  int width_, across_, down_;
  bool unicode_;
  std::vector<unsigned> dots_;
};

std::optional<Sketch> triaxial_sketch(const Model& model, const std::vector<TriaxialRow>& rows) {
  Sketch sketch;
  sketch.title =
      fmt::format("measured (line) and correct (+) deviator [{}] against axial strain [-]", model.units.stress);
  sketch.curves.resize(2);
  for (const TriaxialRow& row : rows) {
    for (Sketch::Curve& curve : sketch.curves) curve.x.push_back(row.axial_strain);
    sketch.curves[0].y.push_back(row.measured_deviator);
    sketch.curves[1].y.push_back(row.correct_deviator);
  }
  return sketch;
}

double span_of(const std::vector<NodesRow>& rows, int axis) {
  Range range;
  for (const NodesRow& row : rows) range.take(row.displacement[axis]);
  return range.high - range.low;
}

std::optional<Sketch> nodes_sketch(const Model& model, const std::vector<NodesRow>& rows) {
  const int axis = span_of(rows, 0) > span_of(rows, 1) ? 0 : 1;
  const double turn_u = rows.back().displacement[axis] < 0.0 ? -1.0 : 1.0;
  const double turn_f = rows.back().force[axis] < 0.0 ? -1.0 : 1.0;
  const AxisNames names = axis_names(model.geometry);
  const std::string_view name = axis == 0 ? names.x : names.y;
  Sketch sketch;
  sketch.title = fmt::format("{}force-{} [{}] against {}u-{} [{}]", turn_f < 0.0 ? "-" : "", name,
                             model.units.force, turn_u < 0.0 ? "-" : "", name, model.units.length);
  Sketch::Curve& curve = sketch.curves.emplace_back();
  for (const NodesRow& row : rows) {
    curve.x.push_back(turn_u * row.displacement[axis]);
    curve.y.push_back(turn_f * row.force[axis]);
  }
  return sketch;
}

}  // namespace

std::optional<Sketch> sketch_of(const Model& model, const Reports& reports) {
  constexpr std::size_t kPath = 3;
  for (std::size_t i = 0; i < reports.count(); ++i) {
    if (reports.triaxial(i).size() >= kPath) return triaxial_sketch(model, reports.triaxial(i));
    if (reports.nodes(i).size() >= kPath) return nodes_sketch(model, reports.nodes(i));
  }
  return {};
}

std::string sketch_text(const Sketch& sketch, int columns, bool unicode) {
  Range x, y;
  for (const Sketch::Curve& curve : sketch.curves)
    for (std::size_t i = 0; i < curve.x.size(); ++i)
      if (finite(curve, i)) x.take(curve.x[i]), y.take(curve.y[i]);
  if (!(x.high > x.low && y.high > y.low)) return {};
  const int width = std::clamp(columns - kMargin - 2, 24, kMostWidth);
  Area area(width, unicode);
  for (std::size_t c = 0; c < sketch.curves.size(); ++c) {
    const Sketch::Curve& curve = sketch.curves[c];
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      if (!finite(curve, i)) continue;
      const double at_x = x.share(curve.x[i]), at_y = y.share(curve.y[i]);
      const std::size_t from = i > 0 && finite(curve, i - 1) ? i - 1 : i;
      if (c == 0)
        area.line(x.share(curve.x[from]), y.share(curve.y[from]), at_x, at_y);
      else
        area.cross(at_x, at_y);
    }
  }
  std::string text = "  " + sketch.title + '\n';
  const std::string bar = unicode ? "\u2502" : "|", corner = unicode ? "\u2514" : "+";
  for (int r = 0; r < kRows; ++r) {
    const std::string label = r == 0           ? fmt::format("{:.4g}", y.high)
                              : r == kRows - 1 ? fmt::format("{:.4g}", y.low)
                                               : "";
    text += fmt::format("{:>{}} {}{}\n", label, kMargin - 1, bar, area.row(r));
  }
  std::string axis;
  for (int c = 0; c < width; ++c) axis += unicode ? "\u2500" : "-";
  const std::string low = fmt::format("{:.4g}", x.low), high = fmt::format("{:.4g}", x.high);
  text += fmt::format("{:>{}} {}{}\n", "", kMargin - 1, corner, axis);
  return text + fmt::format("{:>{}} {}{:>{}}\n", "", kMargin, low, high, width - static_cast<int>(low.size()));
}

}  // namespace sage
