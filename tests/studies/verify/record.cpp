#include "tests/studies/verify/record.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "sage/convergence/attempt.hpp"
#include "sage/messages/error.hpp"

namespace sage::verify {

namespace {

// A text of several lines in one.
std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

WholeRun completed(WholeRun run) {
  if (!run.completed()) throw std::runtime_error(one_line(run.failure));
  return run;
}

// Shares of a gate; no number is never within one.
double share(double error, double gate) {
  if (!std::isfinite(error)) return std::numeric_limits<double>::infinity();
  return std::abs(error) / gate;
}

}  // namespace

const char* name_of(Where where) {
  switch (where) {
    case Where::plane_strain:
      return "plane strain";
    case Where::axisymmetric:
      return "axisymmetric";
    case Where::point:
      return "one point";
  }
  return "";
}

const char* name_of(Grade grade) {
  switch (grade) {
    case Grade::exact:
      return "closed form";
    case Grade::computed:
      return "converged computation";
    case Grade::published:
      return "published value";
    case Grade::twofold:
      return "two ways";
  }
  return "";
}

WholeRun Record::run(const DeckWriter& deck) const {
  return completed(bench_.run(deck.text()));
}

WholeRun Record::run(Model model, std::span<Observer* const> others) const {
  return completed(bench_.run(std::move(model), {}, others));
}

WholeRun Record::try_run(const DeckWriter& deck, int max_cuts) const {
  RunSettings settings;
  settings.max_cuts = max_cuts;
  return bench_.run(deck.text(), {}, settings);
}

Row& Record::add(Where where, const std::string& what) {
  const auto now = Clock::now();
  Row& row = rows_.emplace_back();
  row.where = where;
  row.what = what;
  row.seconds = std::chrono::duration<double>(now - last_).count();
  last_ = now;
  return row;
}

void Record::near(Where where, const std::string& what, double computed, double reference, double gate) {
  Row& row = add(where, what);
  row.computed = computed;
  row.reference = reference;
  row.error = computed / reference - 1.0;
  row.gate = gate;
  row.used = share(row.error, gate);
  row.pass = row.used <= 1.0;
}

void Record::within(Where where, const std::string& what, double computed, double reference, double gate) {
  Row& row = add(where, what);
  row.computed = computed;
  row.reference = reference;
  row.error = computed - reference;
  row.gate = gate;
  row.relative = false;
  row.used = share(row.error, gate);
  row.pass = row.used <= 1.0;
}

void Record::order(Where where, const std::string& what, const std::vector<double>& size,
                   const std::vector<double>& error, double theory, double slack) {
  Row& row = add(where, what);
  const std::size_t n = error.size();
  row.computed = row.error = error[n - 1];
  row.reference = 0.0;
  row.relative = false;
  row.order = std::log(error[n - 2] / error[n - 1]) / std::log(size[n - 2] / size[n - 1]);
  row.theory = theory;
  row.pass = row.order >= theory - slack;
  row.used = row.pass ? (theory - slack) / row.order : std::max((theory - slack) / row.order, 1.01);
  sequences_.push_back({what, where, size, error, theory});
}

void Record::stopped(const std::string& reason) {
  Row& row = add(rows_.empty() ? Where::plane_strain : rows_.back().where, "stopped: " + one_line(reason));
  row.used = std::numeric_limits<double>::infinity();
}

bool CaseResult::pass() const {
  return !rows.empty() && std::all_of(rows.begin(), rows.end(), [](const Row& row) { return row.pass; });
}

Bracket printed_bracket(const WholeRun& run) {
  Bracket bracket;
  const std::size_t at = run.failure.find("limit load: between");
  if (at != std::string::npos)
    std::sscanf(run.failure.c_str() + at, "limit load: between %lf and %lf", &bracket.from, &bracket.to);
  return bracket;
}

double bisect(double low, double high, double width, const std::function<bool(double)>& stands) {
  if (!stands(low) || stands(high)) return kNone;
  while (high - low > width) {
    const double middle = 0.5 * (low + high);
    (stands(middle) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

CaseResult run_case(const Case& one, const Workbench& bench) {
  Record record(bench);
  const convergence::Attempt attempt = convergence::attempt([&] { one.run(record); });
  if (attempt.threw) record.stopped(attempt.thrown);
  return {&one, record.rows(), record.sequences(), attempt.seconds};
}

}  // namespace sage::verify
