#include "sage/analysis/elastic_matrices.hpp"

#include <algorithm>

namespace sage {

void ElasticMatrices::analyse(const ElementEquations& elements) {
  matrices_.clear();
  from_.assign(1, 0);
  for (int e = 0; e < elements.count(); ++e) {
    const std::size_t dofs = elements.of(e).size();
    from_.push_back(from_.back() + dofs * dofs);
  }
}

void ElasticMatrices::begin() {
  matrices_.assign(from_.back(), 0.0);
  is_taking_ = true;
}

void ElasticMatrices::end(Outcome pass) {
  is_taking_ = false;
  if (pass == Outcome::cut_step) matrices_.clear();
}

void ElasticMatrices::keep(int element, const double* K) {
  const auto e = static_cast<std::size_t>(element);
  std::copy_n(K, from_[e + 1] - from_[e], matrices_.data() + from_[e]);
}

void ElasticMatrices::add(double share, LinearSolver& solver) const {
  std::vector<double> scaled;
  for (std::size_t e = 0; e + 1 < from_.size(); ++e) {
    scaled.assign(matrices_.data() + from_[e], matrices_.data() + from_[e + 1]);
    for (double& term : scaled) term *= share;
    solver.add(static_cast<int>(e), scaled.data());
  }
}

}  // namespace sage
