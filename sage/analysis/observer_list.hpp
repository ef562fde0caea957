// All observers of a run, and the time that they take.
#pragma once

#include <span>

#include "sage/analysis/observer.hpp"

namespace sage {

class ObserverList {
 public:
  ObserverList(std::span<Observer* const> observers, Profile& profile)
      : observers_(observers), profile_(&profile) {}

  template <class Call>
  void tell(Call call) {
    const Profile::Scope scope(*profile_, phase::kOutput);
    outside([&] {
      for (Observer* observer : observers_) call(*observer);
    });
  }
  // Calls what belongs to the caller of the run.
  template <class Call>
  void outside(Call call) {
    is_outside_ = true;
    call();
    is_outside_ = false;
  }
  // True behind an exception that came from there.
  bool is_outside() const { return is_outside_; }

  void warn(const Diagnostic& diagnostic) {
    tell([&](Observer& o) { o.on_warning(diagnostic); });
  }
  bool wants_states(const Model& model, const StepReport& report) {
    return any([&](const Observer& o) { return o.wants_states(model, report); });
  }
  bool wants_structures(const Model& model, const StepReport& report) {
    return any([&](const Observer& o) { return o.wants_structures(model, report); });
  }
  bool wants_nodes(const Model& model, const StepReport& report, std::span<const char> behind) {
    return any([&](const Observer& o) { return o.wants_nodes(model, report, behind); });
  }
  void exchange(Archive& archive) {
    outside([&] {
      for (Observer* observer : observers_) observer->exchange(archive);
    });
  }

 private:
  template <class Ask>
  bool any(Ask ask) {
    bool wanted = false;
    outside([&] {
      for (const Observer* observer : observers_) wanted = wanted || ask(*observer);
    });
    return wanted;
  }

  std::span<Observer* const> observers_;
  Profile* profile_;
  bool is_outside_ = false;
};

}  // namespace sage
