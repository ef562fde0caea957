#include "sage/analysis/patch_fit.hpp"

#include <algorithm>
#include <numeric>

#include "sage/model/solid_edges.hpp"

namespace sage {

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace

Eigen::MatrixXd sample_map(const Element& element) {
  const Eigen::Index points = element.traits().points;
  const std::span<const double> map = element.point_to_sample();
  if (!map.empty())
    return Eigen::Map<const RowMajor>(map.data(), static_cast<Eigen::Index>(map.size()) / points, points);
  if (element.traits().degree > 1) return {};
  // A triangle's stress is best in its middle.
  return Eigen::MatrixXd::Constant(1, points, 1.0 / static_cast<double>(points));
}

void PatchFitter::set_places(const Eigen::Ref<const Eigen::Matrix2Xd>& places, int degree, int more) {
  // What is less certain by 1000 than the rest is none of the field: bent rows of places are nearly straight.  Terms of
  // high degree are that much alike by themselves.
  const double least = more > 1 ? 1e-6 : 1e-3;
  const Vector2 low = places.rowwise().minCoeff(), high = places.rowwise().maxCoeff();
  terms_.degree = std::min(degree, PolynomialTerms::kMostDegree - more);
  for (int i = 0; i < more; ++i)
    if (3 * PolynomialTerms{terms_.degree + 1, {}, {}}.count() <= 2 * places.cols()) ++terms_.degree;
  while (terms_.degree > 0 && terms_.count() > places.cols()) --terms_.degree;
  terms_.centre = 0.5 * (low + high);
  terms_.scale = 0.5 * (high - low).cwiseMax(1e-300);
  fill(places);
  // Two rows of places can't tell y^2 from 1, nor can six on a conic tell all of degree 2.
  while (terms_.degree > 0 && qr_.rank(least) < V_.cols()) {
    --terms_.degree;
    fill(places);
  }
}

void PatchFitter::fill(const Eigen::Ref<const Eigen::Matrix2Xd>& places) {
  V_.resize(places.cols(), terms_.count());
  for (Eigen::Index i = 0; i < places.cols(); ++i)
    terms_.at(places.col(i), [&](Eigen::Index k, double term) { V_(i, k) = term; });
  qr_.factorise(V_);
}

Patches::Patches(const Model& model, const std::vector<char>& of_these,
                 const std::vector<ElementRef>& elements) {
  const auto nodes = static_cast<std::size_t>(model.mesh.nodes());
  start_.assign(nodes + 1, 0);
  on_boundary_.assign(nodes, 0);
  std::vector<char> present(of_these.size(), 0);
  const auto for_edges = [&](auto visit) {
    for (std::size_t k = 0; k < elements.size(); ++k) {
      const Group& group = model.groups[elements[k].group];
      if (!of_these[elements[k].group]) continue;
      const int* node = group.nodes_of(elements[k].element);
      for (const auto& edge : group.element->edges()) visit(k, node[edge[0]]);
    }
  };
  for_edges([&](std::size_t k, int from) {
    ++start_[static_cast<std::size_t>(from) + 1];
    present[elements[k].group] = 1;
  });
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  items_.resize(start_.back());
  std::vector<std::size_t> end(start_.begin(), start_.end() - 1);
  for_edges([&](std::size_t k, int from) { items_[end[from]++] = k; });
  const SolidEdges edges(model, [&](std::size_t group) { return present[group] != 0; });
  edges.for_single([&](int node, const SolidEdge& edge) {
    for (const int vertex : {node, edge.other}) on_boundary_[vertex] = 1;
  });
}

std::vector<std::size_t> Patches::neighbours(const Element& element, const int* nodes) const {
  std::vector<std::size_t> all;
  for (const auto& edge : element.edges()) {
    const std::span<const std::size_t> patch = around(nodes[edge[0]]);
    all.insert(all.end(), patch.begin(), patch.end());
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace sage
