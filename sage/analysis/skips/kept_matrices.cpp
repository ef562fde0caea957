#include "sage/analysis/skips/kept_matrices.hpp"

#include <algorithm>
#include <cstring>

namespace sage {

void keep_matrices(GroupData& data) {
  constexpr std::size_t kMostKept = std::size_t{1} << 26;  // bytes
  const auto elements = static_cast<std::size_t>(data.group->elements());
  if (elements * data.matrix_size() * sizeof(double) > kMostKept) return;
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

}  // namespace sage
