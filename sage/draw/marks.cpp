#include "sage/draw/marks.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <set>
#include <vector>

#include "sage/core/unit_suffix.hpp"
#include "sage/draw/svg.hpp"

namespace sage {

namespace {

constexpr double kApart = 26.0;  // px: nearer to one another marks can't be told apart

// Lets one place in each square of the paper through, and none so near to a line of symmetry that its reflection
// would crowd it; one on that line is its own reflection.
class Thinning {
 public:
  explicit Thinning(const View& view)
      : seam_(view.at({view.left, view.bottom})), left_(view.mirror_left), down_(view.mirror_down) {}

  bool lets(const Vector2& at) {
    const auto crowds = [](double away) { return std::abs(away) > 0.5 && std::abs(away) < 0.5 * kApart; };
    const Vector2 away = at - seam_;
    if ((left_ && crowds(away.x())) || (down_ && crowds(away.y()))) return false;
    const auto cell = [](double v) { return static_cast<int>(std::floor(v / kApart)); };
    return taken_.insert({cell(away.x()), cell(away.y())}).second;
  }

 private:
  Vector2 seam_;
  bool left_, down_;
  std::set<std::pair<int, int>> taken_;
};

using EachPoint = std::function<void(const Vector2& at, const PointState& point)>;

// The integration points of all active elements, at their places on the paper.
void for_each_point(const Scenery& scenery, const EachPoint& visit) {
  const std::span<const GroupData> groups = scenery.solution.groups();
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const Group& group = scenery.model.groups[g];
    if (scenery.layout.of_group[g].empty()) continue;
    const int points = group.element->traits().points;
    for (int e = 0; e < group.elements(); ++e) {
      const Eigen::Matrix2Xd nodes = scenery.nodes_of(group, e, scenery.view.deformation);
      for (int p = 0; p < points; ++p)
        visit(group.element->position(nodes, p),
              PointState(scenery.model.mesh, groups[g], static_cast<std::size_t>(e * points + p)));
    }
  }
}

struct Arrow {
  Vector2 from, along;  // on the paper; along is the displacement, y down
};

void append_arrow(std::string& path, const Vector2& from, const Vector2& along) {
  constexpr double kHead = 6.0;
  const Vector2 to = from + along, back = -kHead * along.normalized(), side = {-0.5 * back.y(), 0.5 * back.x()};
  const Vector2 one = to + back + side, other = to + back - side;
  fmt::format_to(std::back_inserter(path),
                 "M{:.1f} {:.1f}L{:.1f} {:.1f}M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}", from.x(), from.y(),
                 to.x(), to.y(), one.x(), one.y(), to.x(), to.y(), other.x(), other.y());
}

struct Cross {
  Vector2 at;
  Eigen::Matrix2d along;  // columns: principal directions in the plane
  Vector2 stress;         // compression positive
};

void append_cross(std::string (&paths)[2], const Cross& cross, double scale) {
  for (int k = 0; k < 2; ++k) {
    const double half = 0.5 * scale * std::abs(cross.stress[k]);
    if (half < 0.25) continue;
    const Vector2 arm = half * Vector2(cross.along(0, k), -cross.along(1, k));
    const Vector2 a = cross.at - arm, b = cross.at + arm;
    fmt::format_to(std::back_inserter(paths[cross.stress[k] < 0.0 ? 1 : 0]), "M{:.1f} {:.1f}L{:.1f} {:.1f}",
                   a.x(), a.y(), b.x(), b.y());
  }
}

struct PointCount {
  long yielded = 0, all = 0;
};

// "full points: 3 of 8 integration points at strength", soil, joints and structures apart where there are several.
std::string count_text(const std::array<PointCount, kElementKinds.size()>& counts) {
  constexpr std::pair<ElementKind, const char*> kNames[] = {{ElementKind::solid, "soil"},
                                                            {ElementKind::interface, "interfaces"},
                                                            {ElementKind::structure, "structures"}};
  const bool several = std::ranges::count_if(counts, [](const PointCount& c) { return c.all > 0; }) > 1;
  std::string text;
  for (const auto& [kind, name] : kNames) {
    const PointCount& count = counts[static_cast<std::size_t>(kind)];
    if (count.all == 0) continue;
    text += text.empty() ? fmt::format("full points: {} of {} integration points", count.yielded, count.all)
                         : fmt::format(", {} of {}", count.yielded, count.all);
    if (several) text += std::string(" of ") + name;
  }
  return text.empty() ? "full points: none" : text + " at strength";
}

// " m"; empty where the unit is not known.
std::string behind_number(const std::string& unit) {
  return unit_suffix(unit).empty() ? "" : " " + unit;
}

}  // namespace

std::string draw_arrows(std::string& out, const Scenery& scenery) {
  constexpr double kShortest = 1.5;  // px
  std::vector<Arrow> arrows;
  Thinning thinning(scenery.view);
  double largest = 0.0;
  for (int node : scenery.layout.node) {
    const Vector2 at = scenery.moved(node, scenery.view.deformation);
    const Vector2 u = scenery.solution.u->segment<2>(DofMap::displacement(node));
    largest = std::max(largest, u.norm());
    if (thinning.lets(at)) arrows.push_back({at, {u.x(), -u.y()}});
  }
  if (largest == 0.0 || scenery.view.rounding) return "arrows: none, nothing has moved";
  std::string path;
  for (const Arrow& arrow : arrows) {
    const Vector2 along = kLongestArrow / largest * arrow.along;
    if (along.norm() >= kShortest) append_arrow(path, arrow.from, along);
  }
  fmt::format_to(std::back_inserter(out),
                 "<path fill=\"none\" stroke=\"#000000\" stroke-width=\"1.2\" d=\"{}\"/>\n", path);
  return fmt::format("arrows: displacement, the longest {:.4g}{}", largest,
                     behind_number(scenery.model.units.length));
}

std::string draw_crosses(std::string& out, const Scenery& scenery) {
  std::vector<Cross> crosses;
  Thinning thinning(scenery.view);
  double largest = 0.0;
  for_each_point(scenery, [&](const Vector2& at, const PointState& point) {
    if (!point.solid || !thinning.lets(at)) return;
    const Vector4& s = point.stress;  // xx yy zz xy
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> principal(
        (Eigen::Matrix2d() << s[0], s[3], s[3], s[1]).finished());
    crosses.push_back({at, principal.eigenvectors(), principal.eigenvalues()});
    largest = std::max(largest, crosses.back().stress.cwiseAbs().maxCoeff());
  });
  if (largest == 0.0) return "crosses: none, there is no stress";
  std::string paths[2];
  for (const Cross& cross : crosses) append_cross(paths, cross, kApart / largest);
  const char* looks[2] = {"stroke=\"#000000\"", "stroke=\"#b2182b\" stroke-dasharray=\"2 2\""};
  for (int k = 0; k < 2; ++k)
    fmt::format_to(std::back_inserter(out), "<path fill=\"none\" {} stroke-width=\"1.4\" d=\"{}\"/>\n",
                   looks[k], paths[k]);
  return fmt::format("crosses: principal stresses in the plane, the longest {:.4g}{}; tension dashed", largest,
                     behind_number(scenery.model.units.stress));
}

std::string draw_yielded(std::string& out, const Scenery& scenery) {
  std::string full, dots;
  std::array<PointCount, kElementKinds.size()> counts{};
  for_each_point(scenery, [&](const Vector2& at, const PointState& point) {
    if (point.kind == ElementKind::flow) return;  // water has no strength
    const PointStatus status = point.view.status;
    const bool yields = status != PointStatus::elastic && status != PointStatus::unloading;
    PointCount& count = counts[static_cast<std::size_t>(point.kind)];
    ++count.all;
    count.yielded += yields ? 1 : 0;
    const double radius = yields ? 2.2 : 0.7;
    fmt::format_to(std::back_inserter(yields ? full : dots), "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>\n",
                   at.x(), at.y(), radius);
  });
  out += "<g fill=\"#555555\">\n" + dots +
         "</g>\n<g fill=\"#d55e00\" stroke=\"#ffffff\" stroke-width=\"0.6\">\n" + full + "</g>\n";
  return count_text(counts);
}

}  // namespace sage
