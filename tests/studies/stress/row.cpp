#include "tests/studies/stress/row.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sage/convergence/attempt.hpp"

namespace sage::stress {

namespace {

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

// The line of the program's words that holds a text.
std::string line_with(const std::string& words, const std::string& text) {
  const std::size_t at = words.find(text);
  if (at == std::string::npos) return {};
  const std::size_t before = words.rfind('\n', at);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  return words.substr(begin, words.find('\n', at) - begin);
}

std::string outcome_of(const Ran& ran) {
  if (!ran.run) return "refused: " + first_line(ran.refusal);
  if (!ran.finite()) return "NUMBERS THAT ARE NOT FINITE";
  return ran.completed() ? "completed" : "stopped: " + first_line(ran.run->failure);
}

}  // namespace

double Trial::digits_lost() const {
  if (std::isnan(error)) return kUnknown;
  return std::clamp(std::log10(std::max(error, kUnit) / kUnit), 0.0, 16.0);
}

bool Ran::finite() const {
  if (!run) return true;
  for (const scenes::Snapshot& s : run->increments)
    if (!s.u.allFinite() || !s.internal.allFinite()) return false;
  return std::all_of(run->stress.begin(), run->stress.end(), [](const auto& s) { return s.allFinite(); });
}

std::string Ran::words() const {
  std::string text = refusal;
  if (!run) return text;
  for (const Diagnostic& d : run->model->diagnostics.list()) text += to_string(d) + "\n";
  for (const std::string& warning : run->warnings) text += warning + "\n";
  return text + run->failure;
}

namespace {

template <class Run>
Ran judged(const Run& run) {
  Ran ran;
  try {
    ran.run = run();
    if (ran.run->result.status != RunStatus::failed) return ran;
    ran.refusal = ran.run->failure;
    ran.run.reset();
  } catch (const InputError& error) {
    for (const Severity severity : {Severity::error, Severity::warning})
      for (const Diagnostic& d : error.diagnostics().list())
        if (d.severity == severity) ran.refusal += to_string(d) + "\n";
  }
  return ran;
}

}  // namespace

Ran Sweep::run(const std::string& deck, const BuildOptions& options, const RunSettings& settings) const {
  return judged([&] { return bench_->run(deck, options, settings); });
}
Ran Sweep::run(const ModelInput& input) const {
  return judged([&] { return bench_->run(build_model(input, catalogue())); });
}

Trial& Sweep::add(const std::string& label, double parameter) {
  Trial trial;
  trial.label = label;
  trial.parameter = parameter;
  trials.push_back(std::move(trial));
  return trials.back();
}

Trial& Sweep::right(const std::string& label, double parameter, const Ran& ran, double error, double allowed) {
  Trial& trial = add(label, parameter);
  trial.expected = fmt::format("right to {:.1e}", allowed);
  trial.outcome = outcome_of(ran);
  trial.error = std::abs(error);
  trial.allowed = allowed;
  trial.ok = ran.completed() && ran.finite() && trial.error <= allowed;  // false for NaN
  return trial;
}

Trial& Sweep::says(const std::string& label, double parameter, const Ran& ran, const std::string& text) {
  Trial& trial = add(label, parameter);
  trial.expected = "says \"" + text + "\"";
  const std::string line = line_with(ran.words(), text);
  trial.ok = !line.empty() && ran.finite();
  trial.outcome = trial.ok ? line : outcome_of(ran);
  return trial;
}

Trial& Sweep::silent(const std::string& label, double parameter, const Ran& ran, const std::string& text) {
  Trial& trial = add(label, parameter);
  trial.expected = "does not say \"" + text + "\"";
  trial.ok = ran.completed() && ran.finite() && line_with(ran.words(), text).empty();
  trial.outcome = outcome_of(ran);
  return trial;
}

Trial& Sweep::clean(const std::string& label, double parameter, const Ran& ran) {
  Trial& trial = add(label, parameter);
  trial.expected = "complete, or stops with a reason";
  trial.ok = ran.finite() && (ran.completed() || !ran.words().empty());
  trial.outcome = outcome_of(ran);
  return trial;
}

Trial& Sweep::holds(const std::string& label, double parameter, bool condition, const std::string& expected,
                    const std::string& outcome) {
  Trial& trial = add(label, parameter);
  trial.expected = expected;
  trial.outcome = outcome;
  trial.ok = condition;
  return trial;
}

bool RowResult::ok() const {
  return thrown.empty() && !trials.empty() &&
         std::all_of(trials.begin(), trials.end(), [](const Trial& t) { return t.ok; });
}

double RowResult::worst_digits() const {
  double worst = kUnknown;
  for (const Trial& t : trials)
    if (!std::isnan(t.digits_lost()))
      worst = std::isnan(worst) ? t.digits_lost() : std::max(worst, t.digits_lost());
  return worst;
}

RowResult evaluate(const Row& row, const scenes::Workbench& bench) {
  Sweep sweep(bench);
  const convergence::Attempt attempt = convergence::attempt([&] { row.run(sweep); });
  return {std::move(sweep.trials), attempt.thrown, attempt.seconds};
}

std::vector<Row> all_rows() {
  std::vector<Row> all;
  for (auto family : {material_rows, collapse_rows, interface_rows, shape_rows, support_rows, invariance_rows,
                      stage_rows, input_rows, water_rows, structure_rows, clay_rows, pore_rows})
    for (Row& row : family()) all.push_back(std::move(row));
  return all;
}

}  // namespace sage::stress
