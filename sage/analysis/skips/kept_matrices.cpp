#include "sage/analysis/skips/kept_matrices.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "sage/analysis/element_work.hpp"
#include "sage/math/rounding.hpp"

namespace sage {

void keep_matrices(GroupData& data) {
  // Bytes.  Where one matrix serves all steps of a size, keeping them spares a factorisation in every step.
  const std::size_t most = std::size_t{1} << (has_matrix_of_step(data) ? 28 : 26);
  const auto elements = static_cast<std::size_t>(data.group->elements());
  if (elements * data.matrix_size() * sizeof(double) > most) return;
  data.matrix.resize(elements);
  for (std::size_t e = 0; e < elements; ++e) data.matrix[e] = static_cast<int>(e);
  data.K.assign(elements * data.matrix_size(), 0.0);
}

bool replace_matrix(GroupData& data, int element, const double* K) {
  const std::size_t size = data.matrix_size();
  double* kept = data.K.data() + static_cast<std::size_t>(element) * size;
  if (std::memcmp(kept, K, size * sizeof(double)) == 0) return false;
  std::copy_n(K, size, kept);
  return true;
}

// Steps of one size differ by the rounding of their times.  Matrices of flowing pore water depend on theta times the step
// alone.
bool matrices_stand(const GroupData& data, const StepTime& now) {
  constexpr double kRounding = rounding::kText;
  const auto [dt, flow_dt, theta] = data.step_of_matrices;
  const auto same = [](double a, double b) { return std::abs(a - b) <= kRounding * b; };
  return data.keeps_matrices() && now.dt > 0.0 && dt > 0.0 && same(now.theta * now.flow_dt, theta * flow_dt) &&
         (same(now.dt, dt) || data.group->entry->has_pores());
}

}  // namespace sage
