// In place of the sources in skips/, where the program is built without them.
#include "sage/analysis/stepping_policy.hpp"

namespace sage {

std::unique_ptr<SteppingPolicy> make_stepping_policy(const Skips& /*skips*/) {
  return std::make_unique<SteppingPolicy>();
}

}  // namespace sage
