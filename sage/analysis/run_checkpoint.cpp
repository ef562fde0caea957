#include "sage/analysis/run_checkpoint.hpp"

namespace sage {

namespace {

[[noreturn]] void refuse() {
  throw InputError("S630", {}, "the checkpoint does not belong to this model");
}

void exchange_water(const RunParts& run, Archive& archive) {
  std::vector<GroupData>& groups = run.system.assembly().groups();
  StagePath& path = run.state.path;
  path.pore_start.resize(groups.size());
  path.pore_end.resize(groups.size());
  for (std::size_t g = 0; g < groups.size(); ++g) {
    archive(groups[g].pore);
    archive(path.pore_start[g]);
    archive(path.pore_end[g]);
  }
  archive(path.water_force);
}

// Within a stage the states before the last step are kept beside that step, because the tangent that the next
// step starts with was taken there.  factorised: the solver holds factors.
void exchange(const RunParts& run, Archive& archive, const RunPlace& place, bool& factorised) {
  const bool within = place.increment > 0;
  run.state.exchange_totals(archive);
  archive(run.result.stages_done);
  archive(run.result.increments_done);
  archive(run.result.motion);
  archive(static_cast<WorkCounts&>(run.result.work));
  archive(factorised);
  if (within) run.state.exchange_path(archive);
  run.system.assembly().exchange(archive, within);
  if (!run.model.water.empty()) exchange_water(run, archive);
}

// The last step's end is evaluated once more: that gives its tangent too.  What the run still had in hand is
// made again, so that the counters and the pivots on the record go on as if nothing had happened.
void evaluate_again(const RunParts& run, const RunPlace& place, bool factorised) {
  System& system = run.system;
  const bool within = place.increment > 0;
  if (!within && !factorised) return;
  if (within && system.assembly().wants_step_time()) {
    const double reached = run.end_of(place);
    system.assembly().set_step_time(run.step_time(place, reached, run.state.path.last_size));
  }
  const Eigen::VectorXd end = run.state.u;
  if (within && sees_unknowns(system.assembly())) run.state.u = run.state.u_before;
  if (system.assembly().evaluate(run.state.du, &system.tangent()) == Outcome::cut_step) refuse();
  run.state.u = end;
  if (within) system.assembly().commit_again(run.state.du);
  if (factorised) system.tangent().factorise(run.result.work);
}

}  // namespace

std::string checkpoint_bytes(const RunParts& run, RunPlace place) {
  Archive archive;
  archive(place);
  bool factorised = run.system.tangent().factorised();
  exchange(run, archive, place, factorised);
  run.observer_list.exchange(archive);
  return archive.take();
}

RunPlace resume_from(const RunParts& run, const std::string& bytes) {
  Archive archive(bytes);
  RunPlace place;
  archive(place);
  const bool within = place.increment > 0;
  const int opened = within ? place.stage : place.stage - 1;  // the last stage that was opened
  if (opened < 0 || opened >= static_cast<int>(run.model.stages.size())) refuse();
  System& system = run.system;
  for (int s = 0; s < opened; ++s) system.pass_stage(s);
  system.open_stage(opened);
  bool factorised = false;
  exchange(run, archive, place, factorised);
  const WorkCounts work = run.result.work;
  evaluate_again(run, place, factorised && (within || system.tangent().constant()));
  run.observer_list.tell([&](Observer& o) {
    o.on_start(run.model, system.scene(), system.tangent().solver().traits().name, system.equations());
  });
  run.observer_list.exchange(archive);
  run.state.place = place;
  if (within) run.state.reached = run.end_of(place);
  if (!archive.at_end()) throw InputError("S630", {}, "the checkpoint is longer than it should be");
  static_cast<WorkCounts&>(run.result.work) = work;
  return place;
}

}  // namespace sage
