#include "sage/output/sampler.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sage/output/values.hpp"

namespace sage {

namespace {

constexpr double kEdge = 1e-6;  // places so close outside an element (of its size) count as on its edge

void solid_stress(const GroupData& data, std::size_t point, double* values) {
  const bool solid = data.state.law_size() == 4;
  for (std::size_t i = 0; i < 4; ++i) values[i] = solid ? data.state.committed.sigma[4 * point + i] : 0.0;
}

bool in_parent(const Vector2& q, bool triangle) {
  constexpr double tolerance = 2.0 * kEdge;
  if (triangle) return q.minCoeff() >= -tolerance && q.sum() <= 1.0 + tolerance;
  return q.cwiseAbs().maxCoeff() <= 1.0 + tolerance;
}

}  // namespace

Sampler::Sampler(const Model& model, const Solution& solution)
    : model_(&model),
      solution_(solution),
      layout_(nodal_layout(model, *solution.activity)),
      stress_(nodal_average(model, solution, layout_, 4, solid_stress)) {
  Eigen::Matrix2Xd x;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (layout_.of_group[g].empty() || group.element->traits().law_size != 4) continue;
    for (int e = 0; e < group.elements(); ++e) {
      element_coordinates(model.mesh, group, e, x);
      const Vector2 low = x.rowwise().minCoeff(), high = x.rowwise().maxCoeff();
      const Vector2 margin = Vector2::Constant(0.05 * (high - low).maxCoeff());  // curved edges bulge
      boxes_.push_back({g, e, low - margin, high + margin});
    }
  }
}

// Newton for the place in the parent shape; exact in one step where the map is affine.
bool Sampler::inside(const Box& box, const Vector2& place, std::vector<double>& N) const {
  constexpr int kSteps = 20;
  const Group& group = model_->groups[box.group];
  Eigen::Matrix2Xd x;
  element_coordinates(model_->mesh, group, box.element, x);
  const auto nodes = static_cast<std::size_t>(x.cols());
  N.resize(nodes);
  std::vector<double> dN(2 * nodes);
  const bool triangle = group.element->edges().size() == 3;
  Vector2 q = triangle ? Vector2(1.0 / 3.0, 1.0 / 3.0) : Vector2(0.0, 0.0);
  for (int step = 0; step < kSteps; ++step) {
    if (!group.element->shape_functions(q, N, dN)) return false;
    const Vector2 missing = place - x * Eigen::Map<const Eigen::VectorXd>(N.data(), x.cols());
    const Matrix2 J = x * Eigen::Map<const Eigen::MatrixX2d>(dN.data(), x.cols(), 2);
    const double det = J(0, 0) * J(1, 1) - J(0, 1) * J(1, 0);
    if (det == 0.0 || !std::isfinite(det)) return false;
    const Vector2 change((J(1, 1) * missing.x() - J(0, 1) * missing.y()) / det,
                         (-J(1, 0) * missing.x() + J(0, 0) * missing.y()) / det);
    q += change;
    if (q.cwiseAbs().maxCoeff() > 10.0) return false;  // far outside
    if (change.cwiseAbs().maxCoeff() < 1e-12) break;
  }
  return in_parent(q, triangle) && group.element->shape_functions(q, N, dN);
}

Sample Sampler::at(const Vector2& place) const {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  Sample sample;
  sample.at = place;
  std::vector<double> N;
  for (const Box& box : boxes_) {
    if ((place.array() < box.low.array()).any() || (place.array() > box.high.array()).any()) continue;
    if (!inside(box, place, N)) continue;
    const Group& group = model_->groups[box.group];
    const std::size_t first = static_cast<std::size_t>(box.element) * group.node_count();
    Vector4 sigma = Vector4::Zero();
    for (std::size_t i = 0; i < N.size(); ++i) {
      sample.u += N[i] * solution_.u->segment<2>(2 * group.nodes[first + i]);
      const auto entry = static_cast<std::size_t>(layout_.of_group[box.group][first + i]);
      sigma += N[i] * Eigen::Map<const Vector4>(stress_.data() + 4 * entry);
    }
    sample.element = group.element_numbers[static_cast<std::size_t>(box.element)];
    for (int i = 0; i < 4; ++i) sample.stress[i] = outward(sigma[i]);
    sample.mean = mean_stress(sigma.data());
    sample.deviator = deviator_stress(sigma.data());
    return sample;
  }
  sample.u.setConstant(kUnknown);
  sample.stress.setConstant(kUnknown);
  sample.mean = sample.deviator = kUnknown;
  return sample;
}

}  // namespace sage
