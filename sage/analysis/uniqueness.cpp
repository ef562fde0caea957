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

UniquenessCount count_loss_of_uniqueness(const Assembly& assembly, StepKind step) {
  UniquenessCount count;
  Eigen::Matrix2Xd x;
  for (const GroupData& data : assembly.groups()) {
    const auto* law = std::get_if<const SolidLaw*>(&data.law);
    if (!data.active || law == nullptr || (*law)->symmetric()) continue;
    const bool done = step == StepKind::committed;
    const PointStates& now = done ? data.state.committed : data.state.trial;
    const PointStates& before = done ? data.state.trial : data.state.committed;
    const auto history = static_cast<std::size_t>(data.state.history_size());
    std::vector<double> h(history);
    for (std::size_t p = 0; p < now.status.size(); ++p) {
      if (now.status[p] != PointStatus::yielded) continue;
      ++count.plastic;
      const std::span<const double> h0(before.h.data() + p * history, history);
      PointIn<4> in{vector_at(before.sigma, p), vector_at(before.eps, p), Vector4::Zero(), h0, nullptr};
      PointContext context;
      if (data.wants_context) {
        const int points = data.group->element->traits().points;
        element_coordinates(assembly.mesh(), *data.group, static_cast<int>(p) / points, x);
        context =
            context_of(data, static_cast<int>(p) / points, x, static_cast<int>(p) % points, assembly.moment());
        in.context = &context;
      }
      PointOut<4> out;
      out.h1 = h;
      if ((*law)->update(in, out) != Outcome::ok) continue;
      const Matrix4 elastic = out.D;
      in.deps = vector_at(now.eps, p) - vector_at(before.eps, p);
      if ((*law)->update(in, out) != Outcome::ok || out.status != PointStatus::yielded) continue;
      if (smallest_acoustic_ratio(out.D, elastic) >= kNegative) continue;
      ++count.lost;
      if (softens(out.D, elastic)) ++count.softening;
    }
  }
  return count;
}

}  // namespace sage
