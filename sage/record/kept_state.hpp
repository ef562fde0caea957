// A copy of a solution that outlives the run: for pictures and tables that need two runs at once.
#pragma once

#include "sage/analysis/observer.hpp"

namespace sage {

class KeptState {
 public:
  // The model must outlive the copy.
  KeptState(const Model& model, const Solution& now);
  KeptState(const KeptState&) = delete;
  KeptState& operator=(const KeptState&) = delete;

  Solution view() const { return {&u_, &internal_, &external_, &assembly_, &activity_}; }

 private:
  Eigen::VectorXd u_, internal_, external_;
  Scene scene_;
  WorkCounters work_;
  Assembly assembly_;  // for its groups' states only
  Activity activity_;
};

}  // namespace sage
