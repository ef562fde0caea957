#include <algorithm>
#include <cmath>
#include <map>

#include "sage/section/arrangement.hpp"

namespace sage::section {

namespace {

// A point closer to a curve than this share of the section's size lies on it.
constexpr double kTolerance = 1e-6;

struct Primitive {
  Curve curve;
  int line = -1;
  std::vector<std::pair<double, int>> breaks{};  // place and vertex
  std::vector<int> pieces{};                     // between the breaks, in order
  std::vector<char> turned{};                    // the piece runs against this curve
};

struct Use {
  int primitive = -1;
  bool back = false;
};

struct Span {
  Vector2 low, high;
};

Span span_of(const Curve& curve, double margin) {
  const Vector2 m = Vector2::Constant(margin);
  if (curve.arc) {
    const Vector2 r = Vector2::Constant(curve.radius);
    return {curve.centre - r - m, curve.centre + r + m};
  }
  return {curve.a.cwiseMin(curve.b) - m, curve.a.cwiseMax(curve.b) + m};
}

bool apart(const Span& a, const Span& b) {
  return (a.low.array() > b.high.array()).any() || (b.low.array() > a.high.array()).any();
}

class Arranger {
 public:
  Arranger(const Section& section, Faults& faults) : section_(section), faults_(faults) {}

  Arrangement arrange(const std::vector<Curve>& cuts) {
    collect(cuts);
    set_tolerance();
    add_points();
    break_curves();
    make_pieces();
    follow_lines();
    follow_loops();
    mark_isolated();
    return std::move(out_);
  }

 private:
  const Vector2& place(int point) const { return section_.points[point].x; }

  void collect(const std::vector<Curve>& cuts) {
    for (std::size_t i = 0; i < section_.lines.size(); ++i) {
      lines_.emplace_back();
      for (const Curve& curve : curves_of(section_, section_.lines[i])) {
        lines_.back().push_back({static_cast<int>(primitives_.size()), false});
        primitives_.push_back({curve, static_cast<int>(i)});
      }
    }
    set_tolerance();
    for (std::size_t a = 0; a < section_.areas.size(); ++a) {
      const SectionArea& area = section_.areas[a];
      add_loop(area.outline, static_cast<int>(a), -1);
      for (std::size_t h = 0; h < area.holes.size(); ++h)
        add_loop(area.holes[h], static_cast<int>(a), static_cast<int>(h));
    }
    for (const Curve& cut : cuts) primitives_.push_back({cut});
  }

  struct Ends {
    Vector2 first, last;
  };

  Ends ends_of(const OutlinePart& part, bool back) const {
    if (part.point >= 0) return {place(part.point), place(part.point)};
    const std::vector<Use>& uses = lines_[part.line];
    const Vector2 a = primitives_[uses.front().primitive].curve.a;
    const Vector2 b = primitives_[uses.back().primitive].curve.b;
    return back ? Ends{b, a} : Ends{a, b};
  }

  // The first line of an outline runs towards the next part, each later one away from the part before.
  bool runs_back(const Outline& outline, std::size_t i, const Vector2* from) const {
    if (outline[i].line < 0) return false;
    const Ends ends = ends_of(outline[i], false);
    if (from != nullptr) return (ends.last - *from).norm() < (ends.first - *from).norm();
    if (outline.size() == 1) return false;
    const Ends next = ends_of(outline[i + 1], false);
    const auto away = [&](const Vector2& p) {
      return std::min((p - next.first).norm(), (p - next.last).norm());
    };
    return away(ends.first) < away(ends.last);
  }

  void add_loop(const Outline& outline, int area, int hole) {
    std::vector<Use> uses;
    Vector2 begin = Vector2::Zero(), at = Vector2::Zero();
    const auto go_to = [&](const Vector2& p) {
      if ((p - at).norm() <= out_.tolerance) return;
      uses.push_back({static_cast<int>(primitives_.size()), false});
      primitives_.push_back({straight(at, p)});
      at = p;
    };
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const bool back = runs_back(outline, i, i == 0 ? nullptr : &at);
      const Ends ends = ends_of(outline[i], back);
      if (i == 0)
        begin = at = ends.first;
      else
        go_to(ends.first);
      if (outline[i].line < 0) continue;
      std::vector<Use> of_line = lines_[outline[i].line];
      if (back) std::reverse(of_line.begin(), of_line.end());
      for (const Use& use : of_line) uses.push_back({use.primitive, back});
      at = ends.last;
    }
    go_to(begin);
    loops_.push_back(std::move(uses));
    out_.loops.push_back({area, hole >= 0, hole, {}});
  }

  void set_tolerance() {
    Vector2 low = Vector2::Constant(1e300), high = Vector2::Constant(-1e300);
    const auto take = [&](const Vector2& p) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    };
    for (const SectionPoint& point : section_.points) take(point.x);
    for (const Primitive& primitive : primitives_) {
      const Span span = span_of(primitive.curve, 0.0);
      take(span.low);
      take(span.high);
    }
    out_.tolerance = kTolerance * std::max((high - low).norm(), 1e-300);
  }

  // Places within the tolerance of each other are one vertex, the first of them.
  int vertex_at(const Vector2& x) {
    const double cell = 2.0 * out_.tolerance;
    const auto i = std::llround(x.x() / cell), j = std::llround(x.y() / cell);
    for (long long di = -1; di <= 1; ++di)
      for (long long dj = -1; dj <= 1; ++dj) {
        const auto found = cells_.find({i + di, j + dj});
        if (found == cells_.end()) continue;
        for (const int v : found->second)
          if ((out_.vertices[v] - x).norm() <= out_.tolerance) return v;
      }
    out_.vertices.push_back(x);
    cells_[{i, j}].push_back(static_cast<int>(out_.vertices.size()) - 1);
    return static_cast<int>(out_.vertices.size()) - 1;
  }

  void add_points() {
    for (const SectionPoint& point : section_.points) out_.vertex_of_point.push_back(vertex_at(point.x));
    user_vertices_ = out_.vertices.size();
  }

  void break_at(Primitive& primitive, const Vector2& x) {
    primitive.breaks.emplace_back(primitive.curve.nearest(x), vertex_at(x));
  }

  void break_curves() {
    std::vector<Span> spans;
    for (Primitive& primitive : primitives_) {
      spans.push_back(span_of(primitive.curve, 2.0 * out_.tolerance));
      primitive.breaks.emplace_back(0.0, vertex_at(primitive.curve.a));
      primitive.breaks.emplace_back(1.0, vertex_at(primitive.curve.b));
      for (std::size_t v = 0; v < user_vertices_; ++v)
        if (primitive.curve.distance(out_.vertices[v]) <= out_.tolerance)
          primitive.breaks.emplace_back(primitive.curve.nearest(out_.vertices[v]), static_cast<int>(v));
      const int quarters =
          primitive.curve.arc ? static_cast<int>(std::ceil(std::abs(primitive.curve.sweep) / 1.6)) : 1;
      for (int k = 1; k < quarters; ++k) break_at(primitive, primitive.curve.at(k * 1.0 / quarters));
    }
    for (std::size_t i = 0; i < primitives_.size(); ++i)
      for (std::size_t j = i + 1; j < primitives_.size(); ++j) {
        if (apart(spans[i], spans[j])) continue;
        for (const Vector2& x : meetings(primitives_[i].curve, primitives_[j].curve, out_.tolerance)) {
          break_at(primitives_[i], x);
          break_at(primitives_[j], x);
        }
      }
  }

  int piece_between(int first, int last, const Curve& curve, bool& turned) {
    auto& there = between_[{std::min(first, last), std::max(first, last)}];
    for (const int p : there) {
      const Piece& piece = out_.pieces[p];
      if ((piece.curve.at(0.5) - curve.at(0.5)).norm() > 4.0 * out_.tolerance) continue;
      turned = piece.first != first;
      return p;
    }
    turned = false;
    there.push_back(static_cast<int>(out_.pieces.size()));
    out_.pieces.push_back({first, last, curve});
    return there.back();
  }

  void make_pieces() {
    for (Primitive& primitive : primitives_) {
      std::stable_sort(primitive.breaks.begin(), primitive.breaks.end(),
                       [](const auto& a, const auto& b) { return a.first < b.first; });
      for (std::size_t i = 0; i + 1 < primitive.breaks.size(); ++i) {
        const auto [from, first] = primitive.breaks[i];
        const auto [to, last] = primitive.breaks[i + 1];
        if (first == last) continue;
        Curve part = primitive.curve.part(from, to);
        part.a = out_.vertices[first];
        part.b = out_.vertices[last];
        bool turned = false;
        primitive.pieces.push_back(piece_between(first, last, part, turned));
        primitive.turned.push_back(turned);
      }
    }
  }

  std::vector<Way> ways_along(const std::vector<Use>& uses) const {
    std::vector<Way> ways;
    for (const Use& use : uses) {
      const Primitive& primitive = primitives_[use.primitive];
      const std::size_t n = primitive.pieces.size();
      for (std::size_t k = 0; k < n; ++k) {
        const std::size_t i = use.back ? n - 1 - k : k;
        ways.push_back({primitive.pieces[i], (primitive.turned[i] != 0) != use.back});
      }
    }
    return ways;
  }

  void follow_lines() {
    std::vector<int> owner(out_.pieces.size(), -1);
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      const SectionLine& line = section_.lines[i];
      out_.lines.push_back(ways_along(lines_[i]));
      const bool structure = line.beam || line.interface != InterfaceSide::none;
      int reported = -1;
      for (const Way& way : out_.lines.back()) {
        Piece& piece = out_.pieces[way.piece];
        if (line.size > 0.0) piece.size = piece.size > 0.0 ? std::min(piece.size, line.size) : line.size;
        int& other = owner[way.piece];
        if (structure && other >= 0 && other != reported)
          report_common(static_cast<int>(i), reported = other, piece);
        if (structure) other = static_cast<int>(i);
      }
    }
  }

  void report_common(int line, int other, const Piece& piece) {
    const std::string who = name_of(section_, SectionItem::line, line);
    const std::string with = other == line ? "itself" : name_of(section_, SectionItem::line, other);
    faults_.push_back({"S258", SectionItem::line, line,
                       who + " lies on " + with + " near " + text_of(piece.curve.at(0.5)) +
                           "; only one line with a beam or interfaces may lie there"});
  }

  void follow_loops() {
    for (std::size_t i = 0; i < loops_.size(); ++i) {
      Arrangement::Loop& loop = out_.loops[i];
      loop.ways = ways_along(loops_[i]);
      std::vector<int> seen;
      for (const Way& way : loop.ways) seen.push_back(out_.first_of(way));
      std::sort(seen.begin(), seen.end());
      const auto twice = std::adjacent_find(seen.begin(), seen.end());
      const std::string who = name_of(section_, SectionItem::area, loop.area);
      const std::string what =
          loop.hole ? who + ": hole " + std::to_string(loop.index + 1) : who + ": the outline";
      if (loop.ways.size() < 2)
        faults_.push_back({"S255", SectionItem::area, loop.area, what + " encloses nothing"});
      else if (twice != seen.end())
        faults_.push_back({"S255", SectionItem::area, loop.area,
                           what + " crosses or touches itself at " + text_of(out_.vertices[*twice])});
    }
  }

  void mark_isolated() {
    out_.isolated.assign(out_.vertices.size(), 0);
    for (const int v : out_.vertex_of_point) out_.isolated[v] = 1;
    for (const SectionLine& line : section_.lines)
      if (line.centre >= 0) out_.isolated[out_.vertex_of_point[line.centre]] = 0;
    for (const Piece& piece : out_.pieces)
      for (const int v : {piece.first, piece.last}) out_.isolated[v] = 0;
  }

  const Section& section_;
  Faults& faults_;
  Arrangement out_;
  std::vector<Primitive> primitives_;
  std::vector<std::vector<Use>> lines_, loops_;
  std::size_t user_vertices_ = 0;
  std::map<std::pair<long long, long long>, std::vector<int>> cells_;
  std::map<std::pair<int, int>, std::vector<int>> between_;
};

}  // namespace

std::vector<Curve> curves_of(const Section& section, const SectionLine& line) {
  std::vector<Curve> curves;
  const auto place = [&](int i) { return section.points[i].x; };
  const double sense = line.clockwise ? -1.0 : 1.0;
  if (line.shape == LineShape::polyline) {
    for (std::size_t i = 0; i + 1 < line.points.size(); ++i)
      curves.push_back(straight(place(line.points[i]), place(line.points[i + 1])));
    return curves;
  }
  const Vector2 centre = place(line.centre);
  if (line.shape == LineShape::circle)
    return {arc_around(centre, line.radius, line.start_angle, sense * 2.0 * kPi)};
  const Vector2 a = place(line.points.front()) - centre, b = place(line.points.back()) - centre;
  const double start = std::atan2(a.y(), a.x());
  double sweep = std::fmod(sense * (std::atan2(b.y(), b.x()) - start), 2.0 * kPi);
  if (sweep <= 0.0) sweep += 2.0 * kPi;
  Curve curve = arc_around(centre, 0.5 * (a.norm() + b.norm()), start, sense * sweep);
  curve.a = centre + a;
  curve.b = centre + b;
  return {curve};
}

Arrangement arrange(const Section& section, const std::vector<Curve>& cuts, Faults& faults) {
  const std::size_t before = faults.size();
  Arrangement arrangement = Arranger(section, faults).arrange(cuts);
  if (faults.size() == before) find_faces(section, arrangement, faults);
  return arrangement;
}

}  // namespace sage::section
