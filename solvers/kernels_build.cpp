// The kernels for the processor that the whole program is compiled for.
#include "solvers/tile_code.hpp"

namespace sage {

namespace {

// 4 rows of 2 registers take 8 of 16.
struct Registers {
#if defined(__AVX2__)
  static constexpr int kLanes = 4;
#else
  static constexpr int kLanes = 2;
#endif
  static constexpr int kBlockRows = 4, kBlockParts = 2, kWidth = 1, kSums = kLanes;
  using Lanes = double __attribute__((vector_size(kLanes * sizeof(double)), may_alias));
  using Bits = std::int64_t __attribute__((vector_size(kLanes * sizeof(double))));
  using Sums = Lanes;
};

#if defined(__AVX2__)
constexpr const char* kName = "avx2";
#else
constexpr const char* kName = "sse2";
#endif

}  // namespace

constinit const TileKernels kBuildKernels = kernels_of<Registers>(kName);

}  // namespace sage
