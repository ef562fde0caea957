// Which kernels a machine can run.
#pragma once

#include <string>

#include "sage/core/linear_solver.hpp"
#include "solvers/tile_kernels.hpp"

namespace sage {

// Why these can't be had: "this processor has no AVX-512".  Empty where they can.
std::string why_no_kernels(Kernels wanted);

// automatic: the fastest.  Throws AnalysisError where those wanted can't be had.
const TileKernels& choose_kernels(Kernels wanted);

}  // namespace sage
