// --verbose of a run: what was chosen and why, how each increment went, and where the time went.
#pragma once

#include "sage/app/run_deck.hpp"

namespace sage::app {

class Verbose final : public Observer {
 public:
  explicit Verbose(const RunRequest& request) : request_(&request) {}

  void on_start(const Model& model, const Scene& scene, std::string_view solver, int equations) override;
  void on_increment(const Model& model, const StepReport& report, const Solution&) override;
  bool wants_states(const Model&, const StepReport&) const override { return false; }
  bool wants_nodes(const Model&, const StepReport&, std::span<const char>) const override { return false; }
  // At the end: the phases.
  void say_times(const Profile& profile) const;

 private:
  void tell(const std::string& text) const;
  std::string why_solver(const Model& model, int equations, bool symmetric) const;

  const RunRequest* request_;
};

}  // namespace sage::app
