#include "sage/analysis/uniqueness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sage {

namespace {

constexpr double kNegative = -1e-6;  // smaller ones are zero: perfect plasticity has directions with none

Vector4 vector_at(const std::vector<double>& values, std::size_t point) {
  return Eigen::Map<const Vector4>(values.data() + 4 * point);
}

// det D = det D_e H/(H + n D_e m): zero in perfect plasticity whatever the flow, negative where the strength falls.
bool softens(const Matrix4& D, const Matrix4& elastic) {
  return D.determinant() < kNegative * elastic.determinant();
}

double acoustic_determinant(const Matrix4& D, double c, double s) {
  // Q = N^T D N with N the strain of a jump: columns [c 0 0 s], [0 s 0 c]
  Eigen::Matrix<double, 4, 2> N;
  N.col(0) << c, 0.0, 0.0, s;
  N.col(1) << 0.0, s, 0.0, c;
  const Matrix2 Q = N.transpose() * D * N;
  return Q(0, 0) * Q(1, 1) - Q(0, 1) * Q(1, 0);
}

}  // namespace

double smallest_acoustic_ratio(const Matrix4& D, const Matrix4& elastic) {
  constexpr int kDirections = 36;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kDirections; ++i) {
    const double angle = kPi * i / kDirections, c = std::cos(angle), s = std::sin(angle);
    const double reference = acoustic_determinant(elastic, c, s);
    if (reference > 0.0) least = std::min(least, acoustic_determinant(D, c, s) / reference);
  }
  return least;
}

namespace {

// A point of a solid at the end of a step, as its law has it.
struct StepEnd {
  std::size_t point;  // of the group
  PointStatus status;
  Matrix4 D;
};

// Calls visit(end, start) for the points of a group that are wanted(status); start() is the tangent where the step
// began, or D where the law has none.
template <class Wanted, class Visit>
void visit_tangents(const Assembly& assembly, const GroupData& data, StepKind step, const Wanted& wanted,
                    const Visit& visit) {
  const SolidLaw& law = *std::get<const SolidLaw*>(data.law);
  const bool done = step == StepKind::committed;
  const PointStates& now = done ? data.state.committed : data.state.trial;
  const PointStates& before = done ? data.state.trial : data.state.committed;
  const auto history = static_cast<std::size_t>(data.state.history_size());
  const int points = data.group->element->traits().points;
  std::vector<double> h(history);
  Eigen::Matrix2Xd x;
  for (std::size_t p = 0; p < now.status.size(); ++p) {
    if (!wanted(now.status[p])) continue;
    const std::span<const double> h0(before.h.data() + p * history, history);
    const Vector4 eps0 = vector_at(before.eps, p);
    PointIn<4> in{vector_at(before.sigma, p), eps0, vector_at(now.eps, p) - eps0, h0, nullptr};
    PointContext context;
    if (data.wants_context) {
      const int element = static_cast<int>(p) / points;
      element_coordinates(assembly.mesh(), *data.group, element, x);
      context = context_of(data, element, x, static_cast<int>(p) % points, assembly.step_time());
      in.context = &context;
    }
    PointOut<4> out;
    out.h1 = h;
    if (law.update(in, out) != Outcome::ok) continue;
    const StepEnd end{p, out.status, out.D};
    visit(end, [&]() -> Matrix4 {
      in.deps.setZero();
      return law.update(in, out) == Outcome::ok ? out.D : end.D;
    });
  }
}

// Under large strain the increment of a law is not the difference of strains.
bool is_active_solid(const GroupData& data) {
  const auto* law = std::get_if<const SolidLaw*>(&data.law);
  return data.active && law != nullptr && !data.group->element->traits().large_strain;
}

}  // namespace

UniquenessCount count_loss_of_uniqueness(const Assembly& assembly, StepKind step) {
  UniquenessCount count;
  const auto yielded = [&](PointStatus status) {
    count.plastic += status == PointStatus::yielded ? 1 : 0;
    return status == PointStatus::yielded;
  };
  for (const GroupData& data : assembly.groups()) {
    if (!is_active_solid(data) || std::get<const SolidLaw*>(data.law)->traits().symmetric) continue;
    const auto points = static_cast<std::size_t>(data.group->element->traits().points);
    visit_tangents(assembly, data, step, yielded, [&](const StepEnd& end, const auto& start) {
      if (end.status != PointStatus::yielded) return;
      const Matrix4 elastic = start();
      if (smallest_acoustic_ratio(end.D, elastic) >= kNegative) return;
      ++count.lost;
      const int number = data.group->element_numbers[end.point / points];
      if (count.elements.empty() || count.elements.back() != number) count.elements.push_back(number);
      if (softens(end.D, elastic)) ++count.softening;
    });
  }
  return count;
}

std::vector<std::size_t> points_without_stiffness(const Assembly& assembly, const GroupData& data) {
  constexpr double kNothing = 1e-5;  // laws keep 1e-7 of the elastic tangent where the true one is zero
  std::vector<std::size_t> found;
  if (!is_active_solid(data) || std::get<const SolidLaw*>(data.law)->traits().linear) return found;
  double largest = 0.0;
  std::vector<std::pair<std::size_t, double>> of_context;
  const auto any = [](PointStatus) { return true; };
  visit_tangents(assembly, data, StepKind::committed, any, [&](const StepEnd& end, const auto& start) {
    const double left = end.D.cwiseAbs().maxCoeff();
    if (data.wants_context) {  // user routines are not asked for a step of time without strain
      largest = std::max(largest, left);
      of_context.emplace_back(end.point, left);
    } else if (largest == 0.0 || left <= 1e-3 * largest) {
      const double before = start().cwiseAbs().maxCoeff();
      largest = std::max({largest, left, before});
      if (left < kNothing * before) found.push_back(end.point);
    }
  });
  for (const auto& [point, left] : of_context)
    if (left < kNothing * largest) found.push_back(point);
  return found;
}

}  // namespace sage
