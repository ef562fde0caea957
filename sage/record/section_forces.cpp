#include "sage/record/section_forces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "sage/math/quadrature.hpp"
#include "sage/model/section_cut.hpp"
#include "sage/record/field_reader.hpp"

namespace sage {

namespace {

constexpr double kNoForce = std::numeric_limits<double>::quiet_NaN();

// Points of a piece.  The smooth stress of quadratic elements has degree 5 along a line, an element's own that of its shape
// functions, at most twice its degree; the arm and the radius add one each.
int points_on(const Group& group) {
  return std::max(4, group.element->traits().degree + 2);
}

}  // namespace

SectionSum::SectionSum(const Model& model, const Report& report, const std::vector<char>& active,
                       const ProbeMaker& probes) {
  const double whole = (report.end - report.place).norm(), middle = 0.5 * whole;
  along_ = (report.end - report.place) / whole;
  across_ = {along_.y(), -along_.x()};
  const double radius = 0.5 * (report.place.x() + report.end.x());
  std::map<std::pair<std::size_t, std::size_t>, Term> terms;
  const auto term = [&](const Probe::Point& p) -> Term& {
    Term& one = terms[{p.group, p.point}];
    one.group = p.group;
    one.point = p.point;
    return one;
  };
  for (const CutPiece& piece : cut_pieces(model, report.place, report.end, active, report.group)) {
    const auto place = [&](double way) -> Vector2 { return report.place + way * along_; };
    const double half = 0.5 * (piece.to - piece.from), centre = piece.from + half;
    const Probe holder = probes.at(place(centre), report.group);
    if (!holder.active()) continue;
    const Group& group = model.groups[static_cast<std::size_t>(holder.group)];
    estimates_ = estimates_ && !ProbeMaker::uses_own_stress(group);
    const bool smooth = probes.is_surrounded(holder);
    length_ += 2.0 * half;
    for (const LinePoint& g : gauss_line(points_on(group))) {
      const double way = centre + half * g.xi, line = half * g.w;
      const Vector2 at = place(way);
      const double surface = model.geometry == Geometry::axisymmetric ? line * at.x() / radius : line;
      const double power[2] = {1.0, way - middle};
      const Probe patch = probes.at(at, report.group), own = probes.own_at(at, report.group);
      for (const Probe::Point& p : (smooth ? patch : own).points)
        for (const int i : {0, 1}) {
          term(p).used[i] += p.weight * surface * power[i];
          term(p).plane[i] += p.weight * line * power[i];
        }
      for (const Probe::Point& p : (smooth ? own : patch).points)
        for (const int i : {0, 1}) term(p).other[i] += p.weight * surface * power[i];
    }
  }
  for (const auto& [key, one] : terms) terms_.push_back(one);
}

SectionForces SectionSum::forces(const Model& model, const Solution& solution) const {
  SectionForces sum;
  sum.length = length_;
  double other[3] = {0.0, 0.0, 0.0};
  for (const Term& one : terms_) {
    const PointState state(model.mesh, solution.groups()[one.group], one.point);
    // Compression positive: the shear stress is reversed too.
    const Vector4 total = state.view.effective + state.view.pore_pressure * Vector4(1.0, 1.0, 1.0, 0.0);
    const Vector2 traction(total[0] * across_.x() + total[3] * across_.y(),
                           total[3] * across_.x() + total[1] * across_.y());
    const double normal = traction.dot(across_), tangential = -traction.dot(along_);
    sum.axial += one.used[0] * normal;
    sum.shear += one.used[0] * tangential;
    sum.moment += one.used[1] * normal;
    sum.hoop += one.plane[0] * total[2];
    sum.hoop_moment += one.plane[1] * total[2];
    other[0] += one.other[0] * normal;
    other[1] += one.other[0] * tangential;
    other[2] += one.other[1] * normal;
  }
  if (terms_.empty()) sum.axial = sum.shear = sum.moment = sum.hoop = sum.hoop_moment = kNoForce;
  const double used[3] = {sum.axial, sum.shear, sum.moment};
  for (int i = 0; i < 3; ++i) sum.error[i] = estimates_ ? other[i] - used[i] : kNoForce;
  return sum;
}

}  // namespace sage
