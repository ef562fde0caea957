#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sage/section/arrangement.hpp"

namespace sage {

namespace section {

namespace {

class DataCheck {
 public:
  DataCheck(const Section& section, Faults& faults) : section_(section), faults_(faults) {}

  void check() {
    if (section_.areas.empty()) add(SectionItem::section, 0, "the section has no area");
    size(SectionItem::section, 0, section_.size);
    if (section_.nodes_per_edge != 2 && section_.nodes_per_edge != 3)
      add(SectionItem::section, 0, fmt::format("edges have 2 or 3 nodes, not {}", section_.nodes_per_edge));
    for (int i = 0; i < count(section_.points); ++i) {
      const SectionPoint& point = section_.points[i];
      if (!point.x.allFinite()) add(SectionItem::point, i, "the coordinates must be finite numbers");
      size(SectionItem::point, i, point.size);
    }
    for (int i = 0; i < count(section_.lines); ++i) check_line(i, section_.lines[i]);
    for (int i = 0; i < count(section_.areas); ++i) check_area(i, section_.areas[i]);
  }

 private:
  template <class T>
  static int count(const std::vector<T>& list) {
    return static_cast<int>(list.size());
  }

  void add(SectionItem item, int index, const std::string& what) {
    const std::string who = item == SectionItem::section ? "" : name_of(section_, item, index) + ": ";
    faults_.push_back({"S254", item, index, who + what});
  }

  void size(SectionItem item, int index, double size) {
    if (!std::isfinite(size) || size < 0.0)
      add(item, index,
          fmt::format("the size of elements must be a positive number (0 = no wish), not {}", size));
  }

  bool is_point(SectionItem item, int index, int point) {
    if (point >= 0 && point < count(section_.points)) return true;
    add(item, index, fmt::format("there is no point {}", point));
    return false;
  }

  void check_line(int i, const SectionLine& line) {
    size(SectionItem::line, i, line.size);
    bool known = true;
    for (const int point : line.points) known = is_point(SectionItem::line, i, point) && known;
    if (line.shape != LineShape::polyline) known = is_point(SectionItem::line, i, line.centre) && known;
    if (!known) return;
    if (line.shape == LineShape::circle) {
      if (!std::isfinite(line.radius) || line.radius <= 0.0 || !std::isfinite(line.start_angle))
        add(SectionItem::line, i, fmt::format("a circle needs a positive radius, not {}", line.radius));
    } else if (line.points.size() < 2 || (line.shape == LineShape::arc && line.points.size() > 2)) {
      add(SectionItem::line, i,
          fmt::format("{} points, this line has {}",
                      line.shape == LineShape::arc ? "an arc needs two" : "a polyline needs two or more",
                      line.points.size()));
    } else if (line.shape == LineShape::arc) {
      check_arc(i, line);
    } else {
      check_polyline(i, line);
    }
  }

  const Vector2& place(int point) const { return section_.points[point].x; }

  void check_arc(int i, const SectionLine& line) {
    const double first = (place(line.points[0]) - place(line.centre)).norm();
    const double last = (place(line.points[1]) - place(line.centre)).norm();
    if (!(std::abs(first - last) <= 1e-4 * std::max(first, last)) || first == 0.0)
      add(SectionItem::line, i,
          fmt::format("the ends of an arc must be equally far from its centre; they are {:.6g} and {:.6g} away",
                      first, last));
    else if ((place(line.points[0]) - place(line.points[1])).norm() <= 1e-4 * first)
      add(SectionItem::line, i,
          "an arc needs two ends at different places; a whole circle has a shape of its own");
  }

  void check_polyline(int i, const SectionLine& line) {
    for (std::size_t k = 0; k + 1 < line.points.size(); ++k)
      if ((place(line.points[k]) - place(line.points[k + 1])).norm() == 0.0)
        add(SectionItem::line, i,
            fmt::format("two points one after the other lie at the same place {}",
                        text_of(place(line.points[k]))));
  }

  void check_area(int i, const SectionArea& area) {
    size(SectionItem::area, i, area.size);
    check_outline(i, area.outline, "the outline");
    for (std::size_t h = 0; h < area.holes.size(); ++h)
      check_outline(i, area.holes[h], fmt::format("hole {}", h + 1));
  }

  void check_outline(int i, const Outline& outline, const std::string& what) {
    int points = 0, lines = 0;
    for (const OutlinePart& part : outline) {
      if ((part.point >= 0) == (part.line >= 0)) {
        add(SectionItem::area, i, what + " has a part that is neither a point nor a line");
        return;
      }
      if (part.point >= 0) {
        if (!is_point(SectionItem::area, i, part.point)) return;
        ++points;
      } else if (part.line >= count(section_.lines)) {
        add(SectionItem::area, i, fmt::format("{}: there is no line {}", what, part.line));
        return;
      } else {
        ++lines;
      }
    }
    if (lines == 0 && points < 3)
      add(SectionItem::area, i,
          fmt::format("{} needs three points or more, or lines; it has {} points", what, points));
  }

  const Section& section_;
  Faults& faults_;
};

}  // namespace

std::string name_of(const Section& section, SectionItem item, int index) {
  const auto named = [index](const char* kind, const auto& list) {
    const std::string& name = list[index].name;
    return name.empty() ? fmt::format("{} {}", kind, index + 1) : fmt::format("{} {}", kind, name);
  };
  switch (item) {
    case SectionItem::point:
      return named("point", section.points);
    case SectionItem::line:
      return named("line", section.lines);
    case SectionItem::area:
      return named("area", section.areas);
    case SectionItem::section:
      break;
  }
  return "the section";
}

std::string text_of(const Vector2& x) {
  const auto plain = [](double value) { return std::abs(value) < 1e-12 ? 0.0 : value; };
  return fmt::format("({:.6g}, {:.6g})", plain(x.x()), plain(x.y()));
}

void check_data(const Section& section, Faults& faults) {
  DataCheck(section, faults).check();
}

}  // namespace section

SectionError::SectionError(std::vector<SectionFault> faults)
    : CodedError(faults.front().code, faults.front().message), faults_(std::move(faults)) {}

std::vector<SectionFault> check_section(const Section& section) {
  section::Faults faults;
  section::check_data(section, faults);
  if (faults.empty()) section::arrange(section, {}, faults);
  return faults;
}

}  // namespace sage
