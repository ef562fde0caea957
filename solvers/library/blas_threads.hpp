// How many threads the BLAS may use for a system.
#pragma once

namespace sage {

// One below 50 000 equations, where a second thread costs more than it saves; all above.  Does nothing where
// the BLAS is not OpenBLAS.
void set_blas_threads(int equations);

}  // namespace sage
