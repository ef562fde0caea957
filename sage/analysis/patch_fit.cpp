#include "sage/analysis/patch_fit.hpp"

#include <algorithm>
#include <cmath>

#include "sage/core/dense.hpp"

namespace sage {

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

int terms_of(int degree) {
  return (degree + 1) * (degree + 2) / 2;
}

}  // namespace

Eigen::MatrixXd sample_map(const Element& element) {
  const Eigen::Index points = element.traits().points;
  const std::span<const double> map = element.point_to_sample();
  if (!map.empty())
    return Eigen::Map<const RowMajor>(map.data(), static_cast<Eigen::Index>(map.size()) / points, points);
  if (element.degree() > 1) return {};
  // A triangle's stress is best in its middle.
  return Eigen::MatrixXd::Constant(1, points, 1.0 / static_cast<double>(points));
}

PatchPolynomial::PatchPolynomial(const std::vector<const Eigen::Matrix2Xd*>& samples, int degree)
    : degree_(degree) {
  Eigen::Index count = 0;
  Vector2 low = samples.front()->col(0), high = low;
  for (const Eigen::Matrix2Xd* at : samples) {
    count += at->cols();
    low = low.cwiseMin(at->rowwise().minCoeff());
    high = high.cwiseMax(at->rowwise().maxCoeff());
  }
  if (3 * terms_of(degree_ + 1) <= 2 * count) ++degree_;
  while (degree_ > 0 && terms_of(degree_) > count) --degree_;
  centre_ = 0.5 * (low + high);
  scale_ = 0.5 * (high - low).cwiseMax(1e-300);
  fill(samples, count);
  // Two rows of places can't tell y^2 from 1, nor can six on a conic tell all of degree 2.
  while (degree_ > 0 && !independent()) {
    --degree_;
    fill(samples, count);
  }
}

void PatchPolynomial::fill(const std::vector<const Eigen::Matrix2Xd*>& samples, Eigen::Index count) {
  V_.resize(count, terms_of(degree_));
  Eigen::Index row = 0;
  for (const Eigen::Matrix2Xd* at : samples)
    for (Eigen::Index i = 0; i < at->cols(); ++i, ++row) V_.row(row) = terms(at->col(i));
}

// What is less certain by 1000 than the rest is none of the field: bent rows of places are nearly straight.
bool PatchPolynomial::independent() const {
  constexpr double kLeast = 1e-3;
  return dense_matrix::rank(V_, kLeast) == V_.cols();
}

Eigen::RowVectorXd PatchPolynomial::terms(const Vector2& x) const {
  const double a = (x.x() - centre_.x()) / scale_.x(), b = (x.y() - centre_.y()) / scale_.y();
  Eigen::RowVectorXd row(terms_of(degree_));
  Eigen::Index k = 0;
  for (int d = 0; d <= degree_; ++d)
    for (int j = 0; j <= d; ++j) row(k++) = std::pow(a, d - j) * std::pow(b, j);
  return row;
}

Patches::Patches(const Model& model, const std::vector<char>& of_these,
                 const std::vector<ElementRef>& elements) {
  std::map<std::pair<int, int>, int> uses;
  for (std::size_t k = 0; k < elements.size(); ++k) {
    const Group& group = model.groups[elements[k].group];
    if (!of_these[elements[k].group]) continue;
    const int* nodes = group.nodes_of(elements[k].element);
    for (const auto& edge : group.element->edges()) {
      around_[nodes[edge[0]]].push_back(k);
      ++uses[std::minmax(nodes[edge[0]], nodes[edge[1]])];
    }
  }
  for (const auto& [ends, count] : uses)
    if (count == 1) on_boundary_[ends.first] = on_boundary_[ends.second] = true;
}

std::vector<std::size_t> Patches::neighbours(const Element& element, const int* nodes) const {
  std::vector<std::size_t> all;
  for (const auto& edge : element.edges()) {
    const std::vector<std::size_t>& patch = around(nodes[edge[0]]);
    all.insert(all.end(), patch.begin(), patch.end());
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace sage
