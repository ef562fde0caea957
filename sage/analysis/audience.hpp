// All observers of a run, and the seconds that they take.
#pragma once

#include <span>

#include "sage/analysis/observer.hpp"

namespace sage {

class Audience {
 public:
  Audience(std::span<Observer* const> observers, double& seconds) : observers_(observers), seconds_(&seconds) {}

  template <class Call>
  void tell(Call call) {
    const Timer timer(*seconds_);
    for (Observer* observer : observers_) call(*observer);
  }
  void warn(const Diagnostic& diagnostic) {
    tell([&](Observer& o) { o.on_warning(diagnostic); });
  }
  bool wants_states(const Model& model, const StepReport& report) const {
    for (const Observer* observer : observers_)
      if (observer->wants_states(model, report)) return true;
    return false;
  }
  void exchange(Archive& archive) {
    for (Observer* observer : observers_) observer->exchange(archive);
  }

 private:
  std::span<Observer* const> observers_;
  double* seconds_;
};

}  // namespace sage
