// The kernels for processors with AVX-512.  This source alone is compiled for them.
#include "solvers/tile_code.hpp"

namespace sage {

namespace {

// 8 rows of 3 tiles take 24 of 32 registers.  Sums whose lanes are added up in the end have four as with AVX2: the same
// bits, and what they read comes from memory, which is no faster for wider registers.
struct Registers {
  static constexpr int kLanes = 8, kBlockRows = 8, kBlockParts = 1, kWidth = 3, kSums = 4;
  using Lanes = double __attribute__((vector_size(kLanes * sizeof(double)), may_alias));
  using Bits = std::int64_t __attribute__((vector_size(kLanes * sizeof(double))));
  using Sums = double __attribute__((vector_size(kSums * sizeof(double)), may_alias));
};

}  // namespace

constinit const TileKernels kAvx512Kernels = kernels_of<Registers>("avx512");

}  // namespace sage
