#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "sage/section/arrangement.hpp"

namespace sage::section {

namespace {

std::size_t index(int i) {
  return static_cast<std::size_t>(i);
}

// Half of a piece h: piece h / 2, against its direction where h is odd.
Way way_of(int half) {
  return {half / 2, half % 2 == 1};
}

class FaceFinder {
 public:
  FaceFinder(const Section& section, Arrangement& a, Faults& faults)
      : section_(section), a_(a), faults_(faults) {}

  void find() {
    sort_around_vertices();
    trace();
    make_faces();
    wind();
    assign_areas();
    place_points();
    if (faults_.empty()) check_lines();
  }

 private:
  struct Traced {
    std::vector<int> halves;
    std::vector<Vector2> polygon;
    double area = 0.0;
    bool outer = false;
    int face = -1;
  };

  // Chords of at most a tenth of a right angle stand for arcs.
  void add_chords(Way way, std::vector<Vector2>& polygon) const {
    const Curve& curve = a_.pieces[index(way.piece)].curve;
    const int n =
        curve.arc ? std::max(2, static_cast<int>(std::ceil(std::abs(curve.sweep) / (0.05 * kPi)))) : 1;
    for (int k = 0; k < n; ++k) polygon.push_back(curve.at(way.back ? 1.0 - k * 1.0 / n : k * 1.0 / n));
  }

  // By their angle a short way off, at the same distance for all, so that curves of one tangent are told apart.
  void sort_around_vertices() {
    std::vector<double> shortest(a_.vertices.size(), 1e300);
    for (const Piece& piece : a_.pieces)
      for (const int v : {piece.first, piece.last})
        shortest[index(v)] = std::min(shortest[index(v)], piece.curve.length());
    around_.resize(a_.vertices.size());
    const int halves = 2 * static_cast<int>(a_.pieces.size());
    std::vector<double> angle(index(halves));
    for (int h = 0; h < halves; ++h) {
      const Curve& curve = a_.pieces[index(h / 2)].curve;
      const int v = a_.first_of(way_of(h));
      const double t = 0.2 * shortest[index(v)] / curve.length();
      const Vector2 d = curve.at(h % 2 == 1 ? 1.0 - t : t) - a_.vertices[index(v)];
      angle[index(h)] = std::atan2(d.y(), d.x());
      around_[index(v)].push_back(h);
    }
    for (std::vector<int>& list : around_)
      std::sort(list.begin(), list.end(), [&](int a, int b) { return angle[index(a)] < angle[index(b)]; });
  }

  // The next half along the face to the left: the first clockwise from the way back.
  int next(int half) const {
    const std::vector<int>& list = around_[index(a_.last_of(way_of(half)))];
    const auto back = std::find(list.begin(), list.end(), half ^ 1);
    return back == list.begin() ? list.back() : *(back - 1);
  }

  void trace() {
    cycle_of_.assign(2 * a_.pieces.size(), -1);
    for (int h = 0; h < static_cast<int>(cycle_of_.size()); ++h) {
      if (cycle_of_[index(h)] >= 0) continue;
      Traced cycle;
      for (int at = h; cycle_of_[index(at)] < 0; at = next(at)) {
        cycle_of_[index(at)] = static_cast<int>(cycles_.size());
        cycle.halves.push_back(at);
        add_chords(way_of(at), cycle.polygon);
      }
      for (std::size_t i = 0; i < cycle.polygon.size(); ++i)
        cycle.area += 0.5 * cross(cycle.polygon[i] - cycle.polygon[0],
                                  cycle.polygon[(i + 1) % cycle.polygon.size()] - cycle.polygon[0]);
      cycles_.push_back(std::move(cycle));
    }
    for (Traced& cycle : cycles_) {
      const bool tree = std::all_of(cycle.halves.begin(), cycle.halves.end(),
                                    [&](int h) { return cycle_of_[index(h)] == cycle_of_[index(h ^ 1)]; });
      cycle.outer = !tree && cycle.area > 0.0;
    }
  }

  static bool contains(const std::vector<Vector2>& polygon, const Vector2& p) {
    bool inside = false;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
      const Vector2 &a = polygon[i], &b = polygon[j];
      if ((a.y() > p.y()) != (b.y() > p.y()) &&
          p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x())
        inside = !inside;
    }
    return inside;
  }

  // The smallest face whose outer cycle is around p and of another component; -1: none.
  int face_around(const Vector2& p, int component) const {
    int best = -1;
    double least = 1e300;
    for (const Traced& cycle : cycles_) {
      if (!cycle.outer || cycle.area >= least || component_of(cycle) == component) continue;
      if (!contains(cycle.polygon, p)) continue;
      best = cycle.face;
      least = cycle.area;
    }
    return best;
  }

  int component_of(const Traced& cycle) const {
    return component_[index(a_.first_of(way_of(cycle.halves.front())))];
  }

  void find_components() {
    component_.assign(a_.vertices.size(), -1);
    int count = 0;
    for (std::size_t start = 0; start < component_.size(); ++start) {
      if (component_[start] >= 0) continue;
      std::vector<int> waiting{static_cast<int>(start)};
      component_[start] = count;
      while (!waiting.empty()) {
        const int v = waiting.back();
        waiting.pop_back();
        for (const int h : around_[index(v)]) {
          const int w = a_.last_of(way_of(h));
          if (component_[index(w)] >= 0) continue;
          component_[index(w)] = count;
          waiting.push_back(w);
        }
      }
      ++count;
    }
  }

  static Cycle ways_of(const Traced& cycle) {
    Cycle ways;
    for (const int h : cycle.halves) ways.push_back(way_of(h));
    return ways;
  }

  void make_faces() {
    find_components();
    a_.faces.clear();
    for (Traced& cycle : cycles_) {
      if (!cycle.outer) continue;
      cycle.face = static_cast<int>(a_.faces.size());
      a_.faces.push_back({-1, ways_of(cycle), {}, {}});
    }
    for (Traced& cycle : cycles_) {
      if (cycle.outer) continue;
      cycle.face = face_around(cycle.polygon.front(), component_of(cycle));
      if (cycle.face >= 0) a_.faces[index(cycle.face)].inner.push_back(ways_of(cycle));
    }
    a_.side.resize(a_.pieces.size());
    for (std::size_t h = 0; h < cycle_of_.size(); ++h)
      a_.side[h / 2][h % 2] = cycles_[index(cycle_of_[h])].face;
  }

  double signed_area(const std::vector<Way>& ways) const {
    std::vector<Vector2> polygon;
    for (const Way& way : ways) add_chords(way, polygon);
    double twice = 0.0;
    for (std::size_t i = 0; i < polygon.size(); ++i)
      twice += cross(polygon[i] - polygon[0], polygon[(i + 1) % polygon.size()] - polygon[0]);
    return 0.5 * twice;
  }

  // Which loops are around which face: 1 step in or out at each piece of a loop, from the outside (the last row) on.
  void wind() {
    const std::size_t faces = a_.faces.size(), loops = a_.loops.size();
    std::vector<std::vector<std::pair<int, int>>> steps(a_.pieces.size());  // loop, step from right to left
    for (std::size_t l = 0; l < loops; ++l) {
      const int sense = signed_area(a_.loops[l].ways) < 0.0 ? -1 : 1;
      for (const Way& way : a_.loops[l].ways)
        steps[index(way.piece)].emplace_back(static_cast<int>(l), way.back ? -sense : sense);
    }
    std::vector<std::vector<int>> pieces_of(faces + 1);
    const auto row = [&](int face) { return face < 0 ? faces : index(face); };
    for (std::size_t p = 0; p < a_.pieces.size(); ++p)
      for (const int face : a_.side[p]) pieces_of[row(face)].push_back(static_cast<int>(p));
    winding_.assign(faces + 1, {});
    winding_[faces].assign(loops, 0);
    std::vector<std::size_t> waiting{faces};
    while (!waiting.empty()) {
      const std::size_t from = waiting.back();
      waiting.pop_back();
      for (const int p : pieces_of[from]) {
        const std::size_t left = row(a_.side[index(p)][0]), right = row(a_.side[index(p)][1]);
        const std::size_t to = left == from ? right : left;
        if (!winding_[to].empty() || to == from) continue;
        winding_[to] = winding_[from];
        if (winding_[to].empty()) winding_[to].assign(loops, 0);
        for (const auto& [loop, step] : steps[index(p)]) winding_[to][index(loop)] += to == left ? step : -step;
        waiting.push_back(to);
      }
    }
  }

  Vector2 middle_of(const Face& face) const {
    std::vector<Vector2> polygon;
    for (const Way& way : face.outer) add_chords(way, polygon);
    return std::accumulate(polygon.begin(), polygon.end(), Vector2(0.0, 0.0)) /
           static_cast<double>(polygon.size());
  }

  void assign_areas() {
    std::set<std::pair<int, int>> reported;
    std::set<std::size_t> outside;
    for (std::size_t f = 0; f < a_.faces.size(); ++f) {
      Face& face = a_.faces[f];
      std::vector<int> state(section_.areas.size(), 0);  // 1 within the outline, 2 or more within a hole
      for (std::size_t l = 0; l < a_.loops.size(); ++l)
        if (winding_[f].size() > l && winding_[f][l] != 0)
          state[index(a_.loops[l].area)] += a_.loops[l].hole ? 2 : 1;
      for (std::size_t l = 0; l < a_.loops.size(); ++l)
        if (a_.loops[l].hole && winding_[f][l] != 0 && state[index(a_.loops[l].area)] % 2 == 0)
          outside.insert(l);
      for (std::size_t k = 0; k < state.size(); ++k) {
        if (state[k] != 1) continue;
        if (face.area < 0)
          face.area = static_cast<int>(k);
        else if (reported.insert({face.area, static_cast<int>(k)}).second)
          report_overlap(face, static_cast<int>(k));
      }
    }
    for (const std::size_t l : outside)
      faults_.push_back({"S255", SectionItem::area, a_.loops[l].area,
                         name_of(section_, SectionItem::area, a_.loops[l].area) + ": hole " +
                             std::to_string(a_.loops[l].index + 1) + " reaches outside of the outline"});
  }

  void report_overlap(const Face& face, int other) {
    faults_.push_back({"S256", SectionItem::area, other,
                       name_of(section_, SectionItem::area, other) + " overlaps " +
                           name_of(section_, SectionItem::area, face.area) + " around " +
                           text_of(middle_of(face)) +
                           "; areas may share edges only, or fill a hole of the other"});
  }

  void place_points() {
    for (std::size_t v = 0; v < a_.vertices.size(); ++v) {
      if (a_.isolated[v] == 0) continue;
      const int face = face_around(a_.vertices[v], -1);
      if (face >= 0 && a_.faces[index(face)].area >= 0)
        a_.faces[index(face)].vertices.push_back(static_cast<int>(v));
    }
  }

  bool inside(Way way) const {
    return a_.area_left_of(way) >= 0 || a_.area_left_of({way.piece, !way.back}) >= 0;
  }

  void check_lines() {
    std::vector<char> touches(a_.vertices.size(), 0);
    for (std::size_t p = 0; p < a_.pieces.size(); ++p)
      if (inside({static_cast<int>(p), false}))
        touches[index(a_.pieces[p].first)] = touches[index(a_.pieces[p].last)] = 1;
    for (std::size_t i = 0; i < a_.lines.size(); ++i) check_line(static_cast<int>(i), touches);
  }

  void check_line(int i, const std::vector<char>& touches) {
    const SectionLine& line = section_.lines[index(i)];
    const std::string who = name_of(section_, SectionItem::line, i);
    bool attached = false, joins = false;
    const Way* out = nullptr;
    for (const Way& way : a_.lines[index(i)]) {
      attached = attached || touches[index(a_.first_of(way))] != 0 || touches[index(a_.last_of(way))] != 0;
      joins = joins || (a_.area_left_of(way) >= 0 && a_.area_left_of({way.piece, !way.back}) >= 0);
      if (out == nullptr && !inside(way)) out = &way;
    }
    if (out != nullptr && (!line.beam || !attached))
      faults_.push_back({"S257", SectionItem::line, i,
                         who + " lies outside of all areas around " +
                             text_of(a_.pieces[index(out->piece)].curve.at(0.5)) +
                             (line.beam ? " and touches none" : "; only lines with a beam may stick out")});
    else if (!line.beam && line.interface != InterfaceSide::none && !joins)
      faults_.push_back({"S257", SectionItem::line, i,
                         who + " has interfaces but no beam and nowhere an area on both sides"});
  }

  const Section& section_;
  Arrangement& a_;
  Faults& faults_;
  std::vector<std::vector<int>> around_;  // by vertex: halves that leave it, counter-clockwise
  std::vector<int> cycle_of_;             // by half
  std::vector<Traced> cycles_;
  std::vector<int> component_;             // by vertex
  std::vector<std::vector<int>> winding_;  // by face, then loop
};

}  // namespace

void find_faces(const Section& section, Arrangement& arrangement, Faults& faults) {
  FaceFinder(section, arrangement, faults).find();
}

}  // namespace sage::section
