// The pattern with the 64-bit indices that the "_l" and "dl" interfaces of SuiteSparse take.
#pragma once

#include <cstdint>
#include <type_traits>
#include <vector>

#include <SuiteSparse_config.h>

#include "solvers/assembled_matrix.hpp"

namespace sage {

static_assert(sizeof(SuiteSparse_long) == 8, "factors may have more than 2^31 terms");

struct LongColumns {
  std::vector<SuiteSparse_long> start, row;
  explicit LongColumns(const AssembledMatrix& matrix)
      : start(matrix.column_start().begin(), matrix.column_start().end()),
        row(matrix.row().begin(), matrix.row().end()) {}
  LongColumns() = default;
  std::size_t memory_bytes() const { return (start.size() + row.size()) * sizeof(SuiteSparse_long); }
};

}  // namespace sage
