#include "sage/analysis/pore_steps.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sage/analysis/explain.hpp"
#include "sage/analysis/stage_warnings.hpp"

namespace sage {

namespace {

constexpr double kFirstPart = 1.0 - 0.5 * std::numbers::sqrt2, kSecondTheta = std::numbers::sqrt2 - 1.0;
// The error of one step of p' = -z p is at most these shares of what the rates show, for every z > 0.
constexpr double kOfThirdDerivative = 0.0691, kOfSecondDerivative = 0.2262;
constexpr double kSmallestStep = 1e-10;  // share of the stage

bool has_flow(const Stage& stage) {
  return stage.pores == PoreWater::flows;
}

// Integral of the pressure, and the root of the integral of its square.
struct PoreSums {
  double mean = 0.0, square = 0.0, largest = 0.0;
};
PoreSums pore_sums(const RunParts& run) {
  PoreSums sums;
  const Eigen::VectorXd &volumes = run.state.path.pores.volumes, &u = run.state.u;
  for (const auto& [dof, supported] : run.system.activity().pores) {
    sums.mean += volumes[dof] * u[dof];
    sums.square += volumes[dof] * u[dof] * u[dof];
    sums.largest = std::max(sums.largest, std::abs(u[dof]));
  }
  sums.square = std::sqrt(sums.square / volumes.sum());
  return sums;
}

void note_sums(const RunParts& run, const PoreSums& sums) {
  PorePath& pores = run.state.path.pores;
  pores.largest = std::max(pores.largest, sums.square);
  pores.most = std::max(pores.most, std::abs(sums.mean));
  pores.water_pressure = sums.mean;
}

double degree_of(const PorePath& pores) {
  return pores.most > 0.0 ? 1.0 - std::abs(pores.water_pressure) / pores.most : 1.0;
}

}  // namespace

Eigen::VectorXd pore_volumes(const Model& model, std::span<const GroupData> groups, const DofMap& map) {
  const int field = model.pore_field();
  Eigen::VectorXd volumes = Eigen::VectorXd::Zero(map.dofs());
  std::vector<double> geometry;
  Eigen::Matrix2Xd x;
  for (const GroupData& data : groups) {
    const ElementTraits& traits = data.group->element->traits();
    if (!data.active || !data.group->solid() || !data.group->entry->has_pores()) continue;
    geometry.resize(traits.geometry_size());
    const int corners = data.group->entry->corners;
    for (int e = 0; e < data.group->elements(); ++e) {
      element_coordinates(model.mesh, *data.group, e, x);
      data.group->element->geometry(x, geometry);
      double volume = 0.0;
      for (int p = 0; p < traits.points; ++p) volume += geometry[p * (1 + traits.law_size * traits.dofs)];
      for (int i = 0; i < corners; ++i) volumes[map.of(data.group->nodes_of(e)[i], field)] += volume / corners;
    }
  }
  return volumes;
}

bool PoreSteps::chooses() const {
  return has_flow(run_.stage()) && run_.stage().time_error > 0.0;
}

void PoreSteps::open_stage(const RunParts& run) {
  if (!has_flow(run.stage())) return;
  resume(run);
  if (run.state.path.pores.volumes.size() > 0) note_sums(run, pore_sums(run));
}

void PoreSteps::resume(const RunParts& run) {
  const Stage& stage = run.stage();
  if (!has_flow(stage) || (stage.time_error == 0.0 && !stage.may_end_early())) return;
  run.state.path.pores.volumes = pore_volumes(run.model, run.assembly().groups(), run.assembly().dof_map());
}

double PoreSteps::next(double end) const {
  const double wanted = std::max(run_.state.path.pores.size, kSmallestStep), left = end - run_.state.reached;
  return wanted >= left ? left : wanted > 0.5 * left ? 0.5 * left : wanted;
}

void PoreSteps::begin_part(Part part, double size) {
  PorePath& pores = run_.state.path.pores;
  const bool is_first = part == Part::first;
  (is_first ? start_ : middle_) = run_.state.u;
  pores.theta = is_first ? 1.0 : kSecondTheta;
  pores.theta_share = size * (is_first ? kFirstPart : 1.0 - kFirstPart);
}

double PoreSteps::root_mean_square(const Eigen::VectorXd& pressures) const {
  const Eigen::VectorXd& volumes = run_.state.path.pores.volumes;
  double sum = 0.0;
  for (const auto& [dof, supported] : run_.system.activity().pores)
    if (!supported) sum += volumes[dof] * pressures[dof] * pressures[dof];
  return std::sqrt(sum / volumes.sum());
}

double PoreSteps::error_of(double dt, const Eigen::VectorXd& first_rate,
                           const Eigen::VectorXd& last_rate) const {
  const Eigen::VectorXd& rate = run_.state.path.pores.rate;
  const double alone = kOfSecondDerivative * root_mean_square(run_.state.u - start_ - dt * first_rate);
  if (rate.size() == 0) return alone;
  const Eigen::VectorXd third =
      2.0 * dt * ((last_rate - first_rate) / (1.0 - kFirstPart) - (first_rate - rate) / kFirstPart);
  return std::min(alone, kOfThirdDerivative * root_mean_square(third));
}

// The first step of a stage takes next to no time.  Its first part balances what supports have changed at once, which is no
// error of time; the second one starts the rates.
bool PoreSteps::open_in_no_time(double dt) {
  PorePath& pores = run_.state.path.pores;
  const Eigen::VectorXd change = run_.state.u - middle_;
  pores.rate = change / ((1.0 - kFirstPart) * dt);
  pores.error += root_mean_square(change) / (1.0 - kFirstPart);
  ++pores.steps;
  return true;
}

void PoreSteps::begin_increment() {
  if (run_.stage().has_histories() && run_.state.path.pores.steps > 0) run_.state.path.pores.rate.resize(0);
}

bool PoreSteps::accept(double size) {
  PorePath& pores = run_.state.path.pores;
  const double dt = size * run_.stage().duration;
  if (pores.steps == 0) return open_in_no_time(dt);
  const Eigen::VectorXd first = (middle_ - start_) / (kFirstPart * dt);
  Eigen::VectorXd last =
      ((run_.state.u - middle_) / ((1.0 - kFirstPart) * dt) - (1.0 - kSecondTheta) * first) / kSecondTheta;
  const double error = error_of(dt, first, last);
  const double scale = std::max(pores.largest, pore_sums(run_).square);
  const double allowed = run_.stage().time_error * scale;
  const double change = error > 0.0 ? std::clamp(0.9 * std::cbrt(allowed / error), 0.2, 2.0) : 2.0;
  const bool good = error <= allowed || size <= 2.0 * kSmallestStep;
  pores.size = good ? std::max(size * change, std::min(pores.size, size)) : size * std::min(change, 0.8);
  if (!good) return false;
  pores.rate = std::move(last);
  pores.error += error;
  ++pores.steps;
  return true;
}

void PoreSteps::go_back(const std::string& kept, double reached) {
  RunState& state = run_.state;
  run_.restore_state(kept);
  state.reached = reached;
  state.path.policy->forget(SteppingPolicy::Past::last_step);
  if (!state.path.pore_end.empty()) run_.set_water(reached);
  run_.set_step_time(reached, 0.0);
  run_.assembly().evaluate(state.du, nullptr);
}

bool PoreSteps::measure() const {
  PorePath& pores = run_.state.path.pores;
  const Stage& stage = run_.stage();
  if (pores.volumes.size() == 0) return false;
  const PoreSums sums = pore_sums(run_);
  note_sums(run_, sums);
  pores.ended = (stage.end_degree > 0.0 && degree_of(pores) >= stage.end_degree) ||
                (stage.end_pressure > 0.0 && sums.largest <= stage.end_pressure);
  return pores.ended;
}

std::vector<Diagnostic> PoreSteps::remarks(const RunParts& run) {
  const Stage& stage = run.stage();
  const PorePath& pores = run.state.path.pores;
  std::vector<Diagnostic> list;
  if (pores.volumes.size() == 0) return list;
  const std::string reached = "degree of consolidation " + short_number(degree_of(pores)) +
                              ", largest excess pressure " + short_number(pore_sums(run).largest);
  if (stage.may_end_early() && pores.ended)
    list.push_back(stage_message(stage, "S580",
                                 "ended after a time of " + short_number(run.state.reached * stage.duration) +
                                     " of " + short_number(stage.duration) + ": " + reached,
                                 Severity::note));
  else if (stage.may_end_early())
    list.push_back(stage_message(stage, "S580",
                                 "the duration of " + short_number(stage.duration) +
                                     " is over before the degree or pressure that ends it: " + reached));
  if (stage.time_error > 0.0)
    list.push_back(stage_message(stage, "S600",
                                 std::to_string(pores.steps) +
                                     " steps in time; their errors add up to at most " +
                                     short_number(pores.largest > 0.0 ? pores.error / pores.largest : 0.0) +
                                     " of the largest excess pressure (both root mean squares over the volume)",
                                 Severity::note));
  return list;
}

}  // namespace sage
