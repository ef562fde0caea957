#include "tests/studies/figures/verdict.hpp"

#include <algorithm>
#include <cmath>

namespace sage::figures {

namespace {

constexpr Elements kElements[] = {Elements::full, Elements::b_bar};

bool lubricated(const char* scene) {
  return scene != nullptr && scene_named(scene).lubricated();
}

// A check with the elements, K_j and corner of one of its numbers.
struct Variant {
  Runs& runs;
  Elements elements;
  double k_j;
  bool away;

  // A swapped scene may be lubricated where the check's own is not: Table 7.2 then.
  const SpecimenRun& run(const std::string& name) const {
    return runs.get(name, elements, k_j > 0.0 ? k_j : 120.0);
  }
  GetRun get() const {
    return [this](const std::string& name) -> const SpecimenRun& { return run(name); };
  }
  double number(const Check& check, const SpecimenRun& a) const {
    return number_of(check, a, check.b.scene != nullptr ? &run(check.b.scene) : nullptr, away, get());
  }
};

Outcome outcome_of(Runs& runs, const Check& check, double k_j) {
  Outcome outcome;
  outcome.k_j = k_j;
  for (std::size_t e = 0; e < 2; ++e)
    for (std::size_t away = 0; away < 2; ++away) {
      const Variant variant{runs, kElements[e], k_j, away == 1};
      const double number = variant.number(check, variant.run(check.a.scene));
      outcome.number[e][away] = number;
      outcome.pass[e][away] = passes(check, number);
    }
  return outcome;
}

void append(std::string& list, const std::string& word) {
  list += (list.empty() ? "" : ", ") + word;
}

// The altered copy of each run, made once.
class Altered {
 public:
  const SpecimenRun& get(const SpecimenRun& run, Alteration how) {
    const auto key = std::pair(&run, how);
    const auto found = kept_.find(key);
    if (found != kept_.end()) return found->second;
    return kept_.emplace(key, altered(run, how)).first->second;
  }

 private:
  std::map<std::pair<const SpecimenRun*, Alteration>, SpecimenRun> kept_;
};

// What of a swapped scene may be missing: its strain, or its interface.
bool fails_swapped(const Check& check, const Variant& variant, const std::string& other) {
  const SpecimenRun& run = variant.run(other);
  const bool joint = check.measure == Measure::joint_most || check.measure == Measure::joint_most_ever;
  if (joint && run.joint_r.empty()) return false;
  if (check.b.scene != nullptr && check.a.quantity != Quantity::none &&
      run.cells.size() != variant.run(check.b.scene).cells.size())
    return false;
  return !passes(check, variant.number(check, run));
}

std::string seen_by(const Check& check, const Variant& variant, Altered& copies) {
  std::string seen;
  const SpecimenRun& run = variant.run(check.a.scene);
  for (const char* other : swaps(check.a.scene))
    if (fails_swapped(check, variant, other)) append(seen, std::string("swapped for ") + other);
  if (check.b.scene != nullptr) {
    Check same = check;
    same.a = check.b;
    if (!passes(check, variant.number(same, variant.run(check.b.scene))))
      append(seen, name_of(Alteration::same));
  }
  for (Alteration how : {Alteration::mirrored, Alteration::shuffled, Alteration::sign, Alteration::lifted})
    if (!passes(check, variant.number(check, copies.get(run, how)))) append(seen, name_of(how));
  return seen;
}

// On the first of its numbers that passes.
std::string shown_to_fail(Runs& runs, const Result& result, Altered& copies) {
  for (const Outcome& outcome : result.outcomes)
    for (std::size_t e = 0; e < 2; ++e)
      for (std::size_t away = 0; away < 2; ++away)
        if (outcome.pass[e][away])
          return seen_by(*result.check, {runs, kElements[e], outcome.k_j, away == 1}, copies);
  return "itself";
}

}  // namespace

const char* name_of(Verdict verdict) {
  constexpr const char* kNames[] = {"holds", "holds away from the corner", "artefact of full 4-node elements",
                                    "depends on K_j", "does not hold"};
  return kNames[static_cast<std::size_t>(verdict)];
}

Verdict verdict_of(const Outcome& outcome) {
  const auto& [full, b_bar] = outcome.pass;
  if (full[0] && b_bar[0]) return Verdict::holds;
  if (full[1] && b_bar[1]) return Verdict::away_from_corner;
  if (full[0] || full[1]) return Verdict::artefact;
  return Verdict::does_not_hold;
}

Verdict verdict_of(const std::vector<Outcome>& outcomes) {
  const Verdict first = verdict_of(outcomes.at(0));
  const bool alike =
      std::ranges::all_of(outcomes, [&](const Outcome& outcome) { return verdict_of(outcome) == first; });
  return alike ? first : Verdict::depends_on_k_j;
}

bool near_limit(const Check& check, const std::vector<Outcome>& outcomes) {
  const Verdict verdict = verdict_of(outcomes);
  std::vector<Outcome> others = outcomes;
  std::vector<std::pair<bool*, bool>> near;  // what may be otherwise, and as it is
  for (Outcome& outcome : others)
    for (std::size_t e = 0; e < 2; ++e)
      for (std::size_t away = 0; away < 2; ++away)
        if (is_near_limit(check, outcome.number[e][away]))
          near.emplace_back(&outcome.pass[e][away], outcome.pass[e][away]);
  for (unsigned long choice = 1; choice < 1ul << near.size(); ++choice) {
    for (std::size_t i = 0; i < near.size(); ++i) *near[i].first = near[i].second != ((choice >> i & 1ul) != 0);
    if (verdict_of(others) != verdict) return true;
  }
  return false;
}

std::string verdict_words(const Result& result) {
  return std::string(name_of(result.verdict)) + (result.near_limit ? " (near the limit)" : "");
}

double fitted_k_j(const scenes::Workbench& bench, double percent) {
  const Check check{.figure = 18,
                    .quote = "",
                    .measure = Measure::percent_most,
                    .a = {"lub", Quantity::conf, 10},
                    .word = ""};
  const auto change = [&](double k_j) {
    const SpecimenRun run = run_specimen(bench, scene_named("lub"), Elements::full, k_j, 40);
    return 100.0 * number_of(check, run, nullptr, true, {});
  };
  double low = std::log(1e-3), high = std::log(1e5);
  if (change(std::exp(low)) > percent || change(std::exp(high)) < percent) return 0.0;
  while (high - low > 1e-3) {
    const double middle = 0.5 * (low + high);
    (change(std::exp(middle)) < percent ? low : high) = middle;
  }
  return std::exp(0.5 * (low + high));
}

std::vector<Result> evaluate(Runs& runs, std::span<const Check> checks,
                             const std::vector<StiffnessChoice>& choices) {
  std::vector<Result> results;
  Altered copies;
  for (const Check& check : checks) {
    Result& result = results.emplace_back();
    result.check = &check;
    if (lubricated(check.a.scene) || lubricated(check.b.scene))
      for (const StiffnessChoice& choice : choices)
        result.outcomes.push_back(outcome_of(runs, check, choice.k_j));
    else
      result.outcomes.push_back(outcome_of(runs, check, 0.0));
    result.verdict = verdict_of(result.outcomes);
    result.near_limit = near_limit(check, result.outcomes);
    result.b_bar_only = result.verdict == Verdict::does_not_hold &&
                        std::ranges::all_of(result.outcomes, [](const Outcome& o) { return o.pass[1][1]; });
    result.shown_to_fail = shown_to_fail(runs, result, copies);
  }
  return results;
}

}  // namespace sage::figures
