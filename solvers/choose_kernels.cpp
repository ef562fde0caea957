#include "solvers/choose_kernels.hpp"

#include "sage/messages/error.hpp"

namespace sage {

namespace {

#ifdef SAGE_HAVE_AVX512
constexpr bool kBuildHasAvx512 = true;
const TileKernels& avx512_kernels() {
  return kAvx512Kernels;
}
#else
constexpr bool kBuildHasAvx512 = false;
const TileKernels& avx512_kernels() {
  return kBuildKernels;  // nobody asks
}
#endif

// All of x86-64-v4 that x86-64-v3 has not: the compiler may use any of it.
bool machine_has_avx512() {
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl");
}

#ifdef __AVX2__
constexpr bool kBuildHasAvx2 = true;
#else
constexpr bool kBuildHasAvx2 = false;
#endif

}  // namespace

std::string why_no_kernels(Kernels wanted) {
  if (wanted == Kernels::avx2 && !kBuildHasAvx2)
    return "this build is for processors without AVX2, and has the kernels sse2 alone";
  if (wanted == Kernels::avx512 && !kBuildHasAvx512)
    return std::string("this build has the kernels ") + kBuildKernels.name + " alone";
  if (wanted == Kernels::avx512 && !machine_has_avx512()) return "this processor has no AVX-512";
  return "";
}

const TileKernels& choose_kernels(Kernels wanted) {
  if (const std::string why = why_no_kernels(wanted); !why.empty())
    throw AnalysisError("S506", "kernels: " + why);
  const bool wide = kBuildHasAvx512 && wanted != Kernels::avx2 && machine_has_avx512();
  return wide ? avx512_kernels() : kBuildKernels;
}

}  // namespace sage
