#include "sage/analysis/elastic_matrices.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "sage/analysis/assembly.hpp"
#include "sage/analysis/tangent.hpp"

namespace sage {

namespace {

template <int N>
void initialise(const Law<N>& law, const double* sigma, std::span<double> h) {
  law.initialise(Eigen::Map<const Vector<N>>(sigma), h);
}

// Interfaces pressed by their mean pressure, structures without force.
void make_elastic(GroupData& data) {
  PointStates& states = data.state.committed;
  const auto history = static_cast<std::size_t>(data.state.history_size());
  const auto size = static_cast<std::size_t>(data.state.law_size());
  double pressure = 0.0;
  for (std::size_t p = 0; data.group->interface() && p < states.status.size(); ++p)
    pressure += std::abs(states.sigma[p * size + 1]) / static_cast<double>(states.status.size());
  std::ranges::fill(states.sigma, 0.0);
  std::visit(
      [&](const auto* law) {
        const std::span<const Quantity> names = law->traits().history;
        for (std::size_t p = 0; p < states.status.size(); ++p) {
          if (data.group->interface()) states.sigma[p * size + 1] = pressure > 0.0 ? -pressure : -1.0;
          for (std::size_t i = 0; i < history; ++i) states.h[p * history + i] = names[i].initial;
          initialise(*law, states.sigma.data() + p * size, {states.h.data() + p * history, history});
        }
      },
      data.law);
}

}  // namespace

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

Outcome evaluate_elastic(Assembly& assembly, Tangent& tangent) {
  std::vector<GroupData>& groups = assembly.groups();
  std::vector<PointStates> committed;
  for (GroupData& data : groups) {
    committed.push_back(data.state.committed);
    if (data.active && !data.constant && !data.group->solid() && !data.group->flow()) make_elastic(data);
  }
  const Outcome outcome = assembly.evaluate(Eigen::VectorXd::Zero(assembly.dof_map().dofs()), &tangent);
  for (std::size_t g = 0; g < groups.size(); ++g) std::swap(groups[g].state.committed, committed[g]);
  return outcome;
}

}  // namespace sage
