// Optional interface of laws that may start from another history than their parameters say.
#pragma once

#include "sage/core/types.hpp"

namespace sage {

template <int N>
class StartAdjustment {
 public:
  // Whether Law::initialise() changes what the parameters state, such as a preconsolidation pressure, so that the law
  // carries this stress (tension +).  The run counts and reports such points.
  virtual bool adjusts_start(const Vector<N>& sigma) const = 0;

 protected:
  ~StartAdjustment() = default;
};

// Of any law: false where it has no such interface.
template <int N, class AnyLaw>
bool adjusts_start(const AnyLaw& law, const Vector<N>& sigma) {
  const auto* const adjustment = dynamic_cast<const StartAdjustment<N>*>(&law);
  return adjustment != nullptr && adjustment->adjusts_start(sigma);
}

}  // namespace sage
