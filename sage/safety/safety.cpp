#include "sage/safety/safety.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "sage/analysis/extent.hpp"
#include "sage/analysis/trials.hpp"
#include "sage/model/activity.hpp"
#include "sage/model/law_table.hpp"
#include "sage/safety/insert_stage.hpp"

namespace sage::safety {

namespace {

// A trial that began farther below its factor is repeated before its factor counts as an end of the bracket.
constexpr double kFarBelow = 2.5;  // tolerances
constexpr int kSecondEffort = 3;   // times the iterations, with all cuts
constexpr int kFirstCuts = 1;
// Of stages with divided strengths, relative force, at most; that of trials where a factor is tried again.
constexpr double kStageTolerance = 1e-5;
constexpr int kFiner = 3;  // times the increments of the stages; Start::anew
// Ends of the bracket that stay undecided before the search is given up: another factor beside them may find its end.
constexpr int kMostUndecided = 6;
constexpr double kBeside = 0.6;  // of the way to a factor that stayed undecided
// Of the stages with a factor on the way down: a lower one follows, and what failed is tried again from there.
constexpr int kCutsOfDescent = 3;

struct Largest {
  double displacement = 0.0;
  int node = -1;
};

Largest largest_of(const Model& model, const Eigen::VectorXd& u) {
  Largest largest;
  for (int node = 0; node < model.mesh.nodes(); ++node)
    for (int c = 0; c < 2; ++c) {
      const double moved = std::abs(u[DofMap::displacement(node, c)]);
      if (moved > largest.displacement) largest = {moved, node};
    }
  return largest;
}

std::vector<double> largest_of_groups(const Model& model, const Eigen::VectorXd& u) {
  std::vector<double> largest;
  for (const Group& group : model.groups) {
    double most = 0.0;
    for (int e = 0; e < group.elements(); ++e)
      for (std::size_t n = 0; n < group.node_count(); ++n)
        for (int c = 0; c < 2; ++c)
          most = std::max(most, std::abs(u[DofMap::displacement(group.nodes_of(e)[n], c)]));
    largest.push_back(most);
  }
  return largest;
}

// What the trial has moved.
void take_motion(FactorTrial& trial, const Model& model, const Eigen::VectorXd& u) {
  const Largest largest = largest_of(model, u);
  trial.displacement = largest.displacement;
  trial.node = largest.node;
  trial.displacement_of_groups = largest_of_groups(model, u);
}

long inelastic(const std::array<long, kStatuses>& points) {
  long count = 0;
  for (PointStatus s : kAtStrength) count += points[static_cast<std::size_t>(s)];
  return count;
}

// What is known of the last attempt of a factor, whether it was a trial or a run.
struct Attempt {
  const StepReport& report;
  bool law_refused = false;
};

std::string percent(double share) {
  return fmt::format("{:.2g} %", 100.0 * share);
}

std::string moved_words(const Model& model, const FactorTrial& trial) {
  if (trial.node < 0) return {};
  return fmt::format("node {} has moved {:.3g} {}", model.mesh.number[trial.node], trial.displacement,
                     model.units.length);
}

std::string why_not(const Model& model, const FactorTrial& trial, const Attempt& last) {
  const std::string moved = moved_words(model, trial);
  if (trial.verdict == Verdict::falls)
    return fmt::format("no equilibrium: it flows; after {} iterations {} of all forces are out of balance{}{}",
                       trial.iterations, percent(std::min(trial.out_of_balance, 1.0)),
                       moved.empty() ? "" : ", ", moved);
  const std::string tried =
      fmt::format("no equilibrium in {} iterations, {} let go", trial.iterations, percent(trial.released));
  if (last.law_refused) return tried + "; a law has no answer, which proves nothing";
  if (last.report.spares_ground)
    return tried + "; structures move in their joints, but the ground does not, which proves nothing";
  return tried + "; the ground does not go on moving: the iterations failed, which proves nothing";
}

std::string why(const FactorTrial& trial, double tolerance) {
  return fmt::format("equilibrium to {:.1e} of all forces ({:.0e} asked for)", trial.out_of_balance, tolerance);
}

// What a run of the stages came to.
class LastState final : public Observer {
 public:
  bool wants_states(const Model&, const StepReport&) const override { return false; }
  bool wants_nodes(const Model&, const StepReport&, std::span<const char>) const override { return false; }
  void on_increment(const Model&, const StepReport& step, const Solution& now) override { keep(step, now); }
  void on_failure(const Model&, const StepReport& step, const std::string&, const Solution& now) override {
    keep(step, now);
  }
  StepReport report;
  Eigen::VectorXd u;
  int iterations = 0;

 private:
  void keep(const StepReport& step, const Solution& now) {
    report = step;
    u = *now.u;
    iterations += step.total_iterations;
  }
};

class Finder final : public Trials {
 public:
  Finder(Model& model, const Catalogue& catalogue, const RunSettings& settings, const Options& options)
      : model_(model), catalogue_(catalogue), settings_(settings), options_(options), search_(options.limits) {}

  Safety find();

  bool next(const TrialResult* last, const Solution& now) override;
  int stage() const override { return safety_.stages; }
  void lost(const Eigen::VectorXd& u, std::vector<double> dissipation) override {
    lost_ = u;
    lost_dissipation_ = std::move(dissipation);
  }
  bool proves() const override { return repeated_ == factor_; }
  bool descends() const override { return options_.start == Start::carried && !search_.lower(); }
  int max_cuts() const override {
    return repeated_ == factor_ ? options_.cuts : std::min(options_.cuts, kFirstCuts);
  }

 private:
  void check() const;
  bool chosen(const Group& group) const;
  void choose_materials();
  void keep_other_strengths();
  void insert_trial_stage();
  Stage& trial_stage() { return model_.stages[safety_.stages]; }
  void set_factor(double factor);
  void prepare_stages();
  void run_from_start(double factor);
  void take(FactorTrial trial);
  void take_run(const RunResult& result, const LastState& last);
  void take_trial(const TrialResult& result);
  void keep_mechanism(const TrialResult& result, const Solution& now);
  std::optional<double> next_factor();
  bool must_repeat(const FactorTrial& end) const;
  void conclude();

  Model& model_;
  const Catalogue& catalogue_;
  RunSettings settings_;
  const Options& options_;
  FactorSearch search_;
  Safety safety_;
  std::vector<std::size_t> materials_;             // whose strength is divided
  std::vector<std::vector<double>> strength_;      // their parameters at factor 1
  std::vector<std::vector<LawVariant>> variants_;  // likewise
  Eigen::VectorXd u_start_;                        // when the strengths began to fall
  Eigen::VectorXd lost_;                           // where the last attempt of a failed run of the stages went
  std::vector<double> lost_dissipation_;           // likewise
  double factor_ = 0.0, from_ = 0.0;               // in hand; whose state it begins with
  double repeated_ = 0.0;                          // the last factor that was tried again
  std::vector<double> undecided_;                  // that stayed so when they were
  std::vector<int> increments_;                    // of the deck's stages
  std::vector<double> tolerances_;                 // likewise
};

bool Finder::chosen(const Group& group) const {
  const bool listed =
      options_.groups.empty() || std::ranges::find(options_.groups, group.number) != options_.groups.end();
  const std::optional<ModelPart> part = part_of(group);
  return listed && part && options_.divides(*part);
}

void Finder::check() const {
  const SourcePosition place{model_.file, 0, 0, 0};
  const int stages = static_cast<int>(model_.stages.size());
  if (stages == 0)
    throw InputError("S260", place, "a safety factor needs a stage with loads; the deck has none");
  if (model_.large_strain)
    throw InputError("S553", place, "large strain: factors of safety are for small strain alone");
  if (options_.stage >= stages)
    throw InputError("S260", place,
                     fmt::format("there is no stage {}; the deck has {}", options_.stage + 1, stages));
  for (const int number : options_.groups)
    if (std::ranges::none_of(model_.groups, [&](const Group& group) { return group.number == number; }))
      throw InputError("S260", place, fmt::format("there is no group {}", number));
}

// "1 clay (mohr_coulomb)"
std::string material_words(const Material& material) {
  return fmt::format("{}{}{} ({})", material.number, material.name.empty() ? "" : " ", material.name,
                     material.law_name);
}

// Of groups that stand at the end of the stages.  A material that chosen ones share with others gets a twin for them.
void Finder::choose_materials() {
  Activity activity(model_);
  for (int s = 0; s < safety_.stages; ++s) activity.enter(model_.stages[s]);
  const std::size_t given = model_.materials.size();
  for (std::size_t m = 0; m < given; ++m) {
    std::vector<Group*> with, without;
    for (std::size_t g = 0; g < model_.groups.size(); ++g)
      if (model_.groups[g].material == static_cast<int>(m) && activity.group[g] != 0)
        (chosen(model_.groups[g]) ? with : without).push_back(&model_.groups[g]);
    if (with.empty() && without.empty()) continue;
    const bool strong = has_strength(model_.materials[m]);
    if (with.empty() || !strong) {
      safety_.untouched.push_back(material_words(model_.materials[m]) +
                                  (strong ? ": not asked for" : ": its law names no strength"));
      continue;
    }
    std::size_t at = m;
    if (!without.empty()) {
      at = model_.materials.size();
      model_.materials.push_back(twin_of(model_.materials[m], model_.units));
      for (Group* group : with) group->material = static_cast<int>(at);
    }
    materials_.push_back(at);
    strength_.push_back(model_.materials[at].parameters);
    variants_.push_back(model_.materials[at].variants);
    safety_.reduced.push_back(material_words(model_.materials[at]));
  }
  if (materials_.empty()) {
    std::string text = "nothing that a safety factor could divide: no chosen group has a law with strength";
    for (const std::string& other : safety_.untouched) text += "\n  " + other;
    throw InputError("S260", {model_.file, 0, 0, 0}, text);
  }
}

// Factors that the deck states itself (strength_factors) are taken back: ours count from its strengths.
void Finder::keep_other_strengths() {
  const double stated = model_.stages[static_cast<std::size_t>(safety_.stages) - 1].strength_factor;
  if (stated <= 0.0 || stated == 1.0) return;
  for (std::size_t i = 0; i < materials_.size(); ++i) {
    const MaterialEntry& entry = *model_.materials[materials_[i]].entry;
    if (is_soil_or_joint(entry)) reduce_strength(strength_[i], entry, {1.0 / stated, DilationRule::reduced});
  }
}

void Finder::insert_trial_stage() {
  const int last = chosen_stage(model_, options_.stage);
  const Stage& before = model_.stages[static_cast<std::size_t>(last)];
  Stage trial;
  trial.number = before.number + 1;
  trial.title = "strength reduction";
  trial.max_iterations = options_.iterations;
  trial.tolerance = safety_.tolerance;
  trial.where = before.where;
  safety_.stages = insert_behind(model_, last, std::move(trial));
}

void Finder::set_factor(double factor) {
  factor_ = factor;
  for (std::size_t i = 0; i < materials_.size(); ++i) {
    Material& material = model_.materials[materials_[i]];
    material.parameters = strength_[i];
    material.variants = variants_[i];
    if (factor != 1.0 || options_.dilation == DilationRule::none)
      reduce_strength(material, {factor, options_.dilation});
    safety_.laws.push_back(std::move(material.law));
    material.law = make_law(material, model_.units);
  }
}

void Finder::take(FactorTrial trial) {
  if (trial.verdict == Verdict::stands)
    search_.stands(trial.factor);
  else
    search_.falls(trial.factor);
  safety_.trials.push_back(std::move(trial));
}

void Finder::take_run(const RunResult& result, const LastState& last) {
  FactorTrial trial;
  trial.factor = factor_;
  trial.iterations = last.iterations;
  trial.cuts = last.report.cuts;
  trial.page = result.reason;
  trial.yielded = inelastic(last.report.points);
  if (!last.report.iterations.empty()) trial.out_of_balance = last.report.iterations.back().force;
  if (lost_.size() > 0 || last.u.size() > 0) take_motion(trial, model_, lost_.size() > 0 ? lost_ : last.u);
  if (result.status == RunStatus::completed) {
    trial.reason = fmt::format("equilibrium at the end of stage {}", safety_.stages);
  } else {
    const Attempt attempt{last.report, false};
    trial.released = last.report.load_factor;
    trial.verdict = last.report.flows ? Verdict::falls : Verdict::undecided;
    trial.proved = last.report.proved;
    trial.dissipation = lost_dissipation_;
    trial.reason = fmt::format("stage {}: {}", last.report.stage + 1, why_not(model_, trial, attempt));
  }
  take(std::move(trial));
}

// Start::anew: the equilibrium of trials, and where an end is tried again smaller increments.
void Finder::prepare_stages() {
  if (options_.start != Start::anew) return;
  if (increments_.empty())
    for (const Stage& stage : model_.stages) {
      increments_.push_back(stage.increments);
      tolerances_.push_back(stage.tolerance);
    }
  for (std::size_t s = 0; s < increments_.size(); ++s) {
    Stage& stage = model_.stages[s];
    const bool again = repeated_ == factor_;
    const double enough = again ? safety_.tolerance : std::min(safety_.tolerance, kStageTolerance);
    stage.tolerance = std::max(tolerances_[s], enough);
    stage.increments = increments_[s] * (again ? kFiner : 1);
  }
}

// The stages with these strengths; from their end trials go on.
void Finder::run_from_start(double factor) {
  set_factor(factor);
  from_ = 0.0;
  prepare_stages();
  LastState last;
  Observer* observers[] = {&last};
  settings_.trials = this;
  lost_.resize(0);
  lost_dissipation_.clear();
  const std::size_t before = safety_.trials.size();
  RunSettings settings = settings_;
  if (options_.start == Start::anew && repeated_ != factor)
    settings.max_cuts = std::min(settings.max_cuts, options_.cuts);
  if (options_.start == Start::carried && factor > options_.limits.smallest)
    settings.max_cuts = std::min(settings.max_cuts, kCutsOfDescent);
  const RunResult result = [&] {
    const Profile::Scope scope(safety_.profile, phase::kAnalysis);
    RunResult of_run = run(model_, catalogue_, settings, observers);
    safety_.profile.add(of_run.work.profile);
    return of_run;
  }();
  if (result.status == RunStatus::failed) throw AnalysisError(*result.code, result.reason);
  safety_.stopped = result.status == RunStatus::stopped;
  if (!safety_.stopped && safety_.trials.size() == before) take_run(result, last);
}

void Finder::take_trial(const TrialResult& result) {
  FactorTrial trial;
  trial.factor = factor_;
  trial.from = from_;
  trial.iterations = result.report.total_iterations;
  trial.cuts = result.report.cuts;
  trial.page = result.reason;
  if (!result.report.iterations.empty()) trial.out_of_balance = result.report.iterations.back().force;
  trial.yielded = inelastic(result.report.points);
  take_motion(trial, model_, result.motion);
  if (result.equilibrium) {
    trial.reason = why(trial, safety_.tolerance);
  } else {
    const Attempt attempt{result.report, result.outcome == StepOutcome::law_cut};
    trial.released = result.report.load_factor;
    trial.verdict = result.report.flows ? Verdict::falls : Verdict::undecided;
    trial.proved = result.report.proved;
    trial.dissipation = result.dissipation;
    trial.reason = why_not(model_, trial, attempt);
  }
  take(std::move(trial));
}

// The state that stands, with the motion and the strain of a trial in place of its own.  How far an attempt without
// equilibrium went means nothing: its largest displacement becomes a part of the mesh.
void Finder::keep_mechanism(const TrialResult& result, const Solution& now) {
  constexpr double kShown = 0.05;
  const double largest = largest_of(model_, result.motion).displacement;
  if (!result.motion.allFinite() || !(largest > 0.0)) return;
  const double scale = kShown * Extent(model_).size() / largest;
  std::vector<GroupData> groups;
  for (std::size_t g = 0; g < now.groups().size(); ++g) {
    const GroupData& from = now.groups()[g];
    GroupData& data = groups.emplace_back(*from.group);
    data.law = from.law;
    data.active = from.active;
    data.state = from.state;
    std::vector<double>& eps = data.state.committed.eps;
    const std::vector<double>& strain = result.strain[g];
    for (std::size_t i = 0; i < eps.size(); ++i) eps[i] = strain.size() == eps.size() ? scale * strain[i] : 0.0;
  }
  const Eigen::VectorXd motion = scale * result.motion, none = Eigen::VectorXd::Zero(motion.size());
  safety_.mechanism = std::make_unique<Frame>(model_, result.report,
                                              Solution{&motion, &none, &none, nullptr, now.activity, groups});
  safety_.mechanism_factor = factor_;
}

// An end that was tried from far below, whose iterations failed, or whose motion proves nothing yet, deserves a second trial
// from the other end.
bool Finder::must_repeat(const FactorTrial& end) const {
  if (repeated_ == end.factor) return false;
  const bool far =
      options_.start == Start::carried && end.factor - end.from > kFarBelow * options_.limits.tolerance;
  return end.verdict == Verdict::undecided || !end.proved || far;
}

std::optional<double> Finder::next_factor() {
  trial_stage().max_iterations = options_.iterations;
  const bool at_once = options_.start == Start::anew && !safety_.trials.empty() &&
                       safety_.trials.back().verdict == Verdict::undecided;
  const FactorTrial* end = at_once               ? &safety_.trials.back()
                           : search_.bracketed() ? safety_.at(search_.upper())
                                                 : nullptr;
  if (end != nullptr && must_repeat(*end)) {
    repeated_ = end->factor;
    trial_stage().max_iterations = kSecondEffort * options_.iterations;
    return repeated_;
  }
  if (search_.bracketed() && end != nullptr && end->verdict == Verdict::undecided &&
      undecided_.size() < kMostUndecided) {
    undecided_.push_back(end->factor);
    search_.drop(end->factor);
  }
  std::optional<double> factor = search_.next();
  while (factor && search_.lower() && std::ranges::find(undecided_, *factor) != undecided_.end())
    factor = *search_.lower() + kBeside * (*factor - *search_.lower());
  return factor;
}

bool Finder::next(const TrialResult* last, const Solution& now) {
  if (last == nullptr) {
    u_start_ = *now.u;
    FactorTrial first;
    first.factor = factor_;
    first.reason = fmt::format("equilibrium at the end of stage {}", safety_.stages);
    if (options_.start == Start::anew) take_motion(first, model_, u_start_);
    take(std::move(first));
  } else {
    take_trial(*last);
    FactorTrial& trial = safety_.trials.back();
    const bool stands = trial.verdict == Verdict::stands;
    if (stands) take_motion(trial, model_, *now.u - u_start_);
    if (stands ? !search_.upper() : search_.upper() == factor_) keep_mechanism(*last, now);
  }
  if (options_.start == Start::anew) return false;
  const std::optional<double> factor = next_factor();
  if (!factor) return false;
  from_ = *search_.lower();
  set_factor(*factor);
  return true;
}

bool is_structure(const Group& group) {
  const std::optional<ModelPart> part = part_of(group);
  return part == ModelPart::anchors || part == ModelPart::walls;
}

// A law that softens, and the elastic part of the motion, may leave a group with less than nothing.  Ground flows in every
// collapse: what yields with it comes first.
std::vector<Failing> shares_of(const Model& model, const std::vector<double>& dissipation) {
  constexpr double kCounts = 0.005;
  std::vector<Failing> failing;
  double sum = 0.0;
  for (std::size_t g = 0; g < dissipation.size(); ++g) {
    if (!(dissipation[g] > 0.0)) continue;
    failing.push_back({g, dissipation[g]});
    sum += dissipation[g];
  }
  for (Failing& part : failing) part.share /= sum;
  const auto rank = [&](const Failing& part) {
    return part.share + (part.share > kCounts && is_structure(model.groups[part.group]) ? 1.0 : 0.0);
  };
  std::ranges::stable_sort(failing, std::ranges::greater{}, rank);
  return failing;
}

void Finder::conclude() {
  if (!search_.bracketed())
    for (const double factor : undecided_) search_.falls(factor);
  safety_.lower = search_.lower();
  safety_.upper = search_.upper();
  const FactorTrial* end = safety_.at(safety_.upper);
  if (end != nullptr && end->verdict == Verdict::falls) safety_.failing = shares_of(model_, end->dissipation);
  const SearchLimits& limits = options_.limits;
  if (safety_.stopped)
    safety_.incomplete = "the search was interrupted";
  else if (!safety_.lower)
    safety_.incomplete = fmt::format("no equilibrium even at F = {:g}, the smallest factor", limits.smallest);
  else if (!safety_.upper)
    safety_.incomplete = fmt::format("still in equilibrium at F = {:g}, the largest factor", limits.largest);
  else if (!search_.bracketed())
    safety_.incomplete = "the search ended early";
  else if (safety_.at(safety_.upper)->verdict == Verdict::undecided)
    safety_.incomplete =
        "at the upper end no equilibrium was found, but the ground does not go on moving there: F may be "
        "larger";
  else if (!safety_.at(safety_.upper)->proved)
    safety_.incomplete =
        "at the upper end no equilibrium was found, but it was not proved by motion: F may be larger";
}

Safety Finder::find() {
  check();
  safety_.tolerance = std::clamp(0.01 * options_.limits.tolerance, 1e-10, 1e-4);
  insert_trial_stage();
  choose_materials();
  keep_other_strengths();
  const auto go_on = [&] { return !safety_.stopped && (options_.start == Start::anew || !search_.lower()); };
  while (go_on()) {
    const std::optional<double> factor = next_factor();
    if (!factor) break;
    run_from_start(*factor);
  }
  conclude();
  safety_.profile.stop();
  return std::move(safety_);
}

}  // namespace

const FactorTrial* Safety::at(std::optional<double> factor) const {
  for (std::size_t i = trials.size(); i-- > 0;)
    if (factor && trials[i].factor == *factor) return &trials[i];
  return nullptr;
}

Safety find_safety(Model& model, const Catalogue& catalogue, const RunSettings& settings,
                   const Options& options) {
  return Finder(model, catalogue, settings, options).find();
}

}  // namespace sage::safety
