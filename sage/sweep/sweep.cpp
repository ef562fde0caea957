#include "sage/sweep/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <limits>
#include <set>
#include <thread>
#include <unordered_map>
#include <utility>

#include "sage/core/short_names.hpp"
#include "sage/messages/near_names.hpp"
#include "sage/model/fingerprint.hpp"
#include "sage/platform/checksum.hpp"
#include "sage/record/values.hpp"

namespace sage::sweep {

namespace {

NamedModel named_model(const Study& study, const Deck& deck, const Catalogue& catalogue,
                       const BuildOptions& build) {
  NamedModel named(deck, catalogue, build);
  for (const NamedValue& value : study.fixed) named.set(value);
  return named;
}

std::string words(const Diagnostic& diagnostic) {
  return with_code(one_line(diagnostic.message), diagnostic.code);
}

const char* status_of(RunStatus status) {
  switch (status) {
    case RunStatus::completed:
      return kAnswered;
    case RunStatus::not_converged:
      return "not converged";
    case RunStatus::singular:
      return "singular";
    case RunStatus::stopped:
      return "stopped";
    case RunStatus::failed:
      break;
  }
  return "failed";
}

// Codes of a run's warnings, each once.
class WarningCodes final : public Observer {
 public:
  void on_warning(const Diagnostic& diagnostic) override {
    if (diagnostic.severity == Severity::warning) codes_.insert(to_string(diagnostic.code));
  }
  bool wants_states(const Model&, const StepReport&) const override { return false; }
  bool wants_nodes(const Model&, const StepReport&, std::span<const char>) const override { return false; }
  std::string text() const { return fmt::format("{}", fmt::join(codes_, " ")); }

 private:
  std::set<std::string> codes_;
};

CaseOutcome failed(std::string status, const std::string& reason, std::size_t quantities) {
  return {std::move(status),
          std::vector<double>(quantities, std::numeric_limits<double>::quiet_NaN()),
          {},
          one_line(reason)};
}

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

}  // namespace

Sweep::Sweep(Study study, const Deck& deck, const Catalogue& catalogue, const BuildOptions& build)
    : study_(std::move(study)),
      catalogue_(&catalogue),
      named_(named_model(study_, deck, catalogue, build)),
      model_(named_.build()) {
  find_quantities();
  check_values();
  for (const NamedValue& value : study_.fixed) check_used(value.name);
  for (std::size_t name = 0; name < study_.names.size(); ++name) {
    check_used(study_.names[name]);
    check_field(name);
    check_read(name);
  }
  allowed_ = study_.allowed;
  for (const Diagnostic& one : model_.diagnostics.list()) allowed_.push_back(to_string(one.code));
  std::string key;
  for (const Quantity& quantity : quantities_) key += quantity.name + '\n';
  options_key_ = checksum(key);
}

void Sweep::find_quantities() {
  std::vector<std::string> names = study_.collect;
  if (study_.failure && std::ranges::find(names, study_.failure->quantity) == names.end())
    names.push_back(study_.failure->quantity);
  if (names.empty())
    throw InputError("S732", {study_.file, 0, 0, 0},
                     "what is to be collected? collect = [\"report1.ratio\"] or --collect");
  for (const std::string& name : names) quantities_.push_back(quantity_of(name, model_, study_.file));
  std::vector<std::string> known = study_.names;
  known.insert(known.end(), names.begin(), names.end());
  for (const std::string& name : {study_.plot_x, study_.plot_y})
    if (!name.empty() && std::ranges::find(known, name) == known.end())
      throw InputError(
          "S734", {study_.file, 0, 0, 0},
          "[plot]: " + name + " is no name and no quantity of the study" + did_you_mean(name, known));
}

// All of them, so that none waits for its case.
void Sweep::check_values() const {
  std::vector<std::string> all = study_.names;
  for (const NamedValue& value : study_.fixed) all.push_back(value.name);
  named_.expect_apart(all);
  for (std::size_t name = 0; name < study_.names.size(); ++name) {
    named_.get(study_.names[name]);  // known?
    for (std::size_t index = 0; index < study_.cases.size(); ++index) {
      const auto& value = study_.cases[index][name];
      const auto* number = std::get_if<double>(&value);
      if (number == nullptr || !std::isnan(*number)) named_.check({study_.names[name], value});
    }
  }
}

// Parameters of a material that no group has change nothing.
void Sweep::check_used(const std::string& name) const {
  constexpr std::string_view kMaterial = "material.";
  if (!name.starts_with(kMaterial)) return;
  const std::string key = name.substr(kMaterial.size(), name.rfind('.') - kMaterial.size());
  for (std::size_t m = 0; m < model_.materials.size(); ++m) {
    const Material& material = model_.materials[m];
    if (material.name != key && std::to_string(material.number) != key) continue;
    const bool used = std::ranges::any_of(model_.groups, [&](const Group& group) {
      return group.material == static_cast<int>(m) || group.second_material == static_cast<int>(m);
    });
    if (used) return;
  }
  throw InputError("S734", {study_.file, 0, 0, 0}, name + " is read by nothing: no group has this material");
}

// A field is of a parameter of a law: points have laws of their own, and nothing else.
void Sweep::check_field(std::size_t name) const {
  if (study_.field_of[name] < 0) return;
  const std::string& full = study_.names[name];
  const std::string parameter = full.substr(full.rfind('.') + 1);
  const bool known = std::ranges::any_of(model_.materials, [&](const Material& material) {
    return (full == "material." + material.name + "." + parameter ||
            full == "material." + std::to_string(material.number) + "." + parameter) &&
           parameter_place(*material.entry, parameter) >= 0;
  });
  if (!known)
    throw InputError("S617", {study_.file, 0, 0, 0},
                     full +
                         " can't differ from place to place: a correlation_length is for parameters of laws, "
                         "material.NAME.PARAMETER");
}

// Two values that differ must give two models.
void Sweep::check_read(std::size_t name) const {
  const auto as_in_deck = [](const auto& value) {
    const auto* number = std::get_if<double>(&value);
    return number != nullptr && std::isnan(*number);
  };
  const auto differs = [&](const auto& row) {
    const auto& first = study_.cases.front()[name];
    return row[name] != first && !(as_in_deck(row[name]) && as_in_deck(first));
  };
  const auto other = std::ranges::find_if(study_.cases, differs);
  if (other == study_.cases.end()) return;
  const auto model_of = [&](const std::variant<double, std::string>& value) {
    NamedModel one = named_;
    study_.put(one, name, value);
    return fingerprint(one.build());
  };
  bool alike = false;
  try {
    alike = model_of(study_.cases.front()[name]) == model_of((*other)[name]);
  } catch (const InputError&) {
    return;  // the case says so
  }
  if (alike)
    throw InputError("S734", {study_.file, 0, 0, 0},
                     study_.names[name] + " is read by nothing: two of its values give the same model");
}

// A warning that the deck has not without the values of the case; empty: there is none.
std::string Sweep::new_warning(const Model& model) const {
  for (const Diagnostic& one : model.diagnostics.list())
    if (one.severity == Severity::warning && std::ranges::find(allowed_, to_string(one.code)) == allowed_.end())
      return words(one);
  return {};
}

Model Sweep::build(std::size_t index) const {
  NamedModel one = named_;
  for (std::size_t i = 0; i < study_.names.size(); ++i) study_.put(one, i, study_.cases[index][i]);
  return one.build();
}

CaseOutcome Sweep::compute(std::size_t index, const Model& model, const RunSettings& settings,
                           std::span<const std::unique_ptr<Observer>> more) const {
  const auto of = [&](Quantity::Source source) {
    return std::ranges::any_of(quantities_, [&](const Quantity& q) { return q.source == source; });
  };
  CaseOutcome outcome{kAnswered, {}, {}, {}};
  Reports reports;
  WarningCodes warnings;
  RunResult result;
  const bool counts = of(Quantity::Source::report) || of(Quantity::Source::run);
  if (counts || !more.empty()) {
    std::vector<Observer*> observers{&reports, &warnings};
    for (const std::unique_ptr<Observer>& one : more) observers.push_back(one.get());
    result = sage::run(model, *catalogue_, settings, observers);
    if (counts && result.status != RunStatus::completed)
      return failed(status_of(result.status), first_line(result.reason), quantities_.size());
  }
  safety::Safety found;
  if (of(Quantity::Source::safety)) {
    Model own = build(index);
    found = safety::find_safety(own, *catalogue_, settings, {});
    if (found.stopped) return failed("stopped", "", quantities_.size());
    if (!found.complete()) return failed("not converged", first_line(found.incomplete), quantities_.size());
  }
  for (const Quantity& quantity : quantities_)
    outcome.values.push_back(value_of(quantity, reports, result, &found));
  outcome.warnings = warnings.text();
  return outcome;
}

// The cases of one call, shared by its threads.
class Sweep::Work {
 public:
  Work(const Sweep& sweep, Journal& journal, const SweepOptions& options)
      : sweep_(sweep), journal_(journal), options_(options), next_(static_cast<std::size_t>(options.part)) {
    result_.rows.resize(sweep.study_.cases.size());
    settings_.choose_solver = options.choose_solver;
    settings_.stop_asked = [this] { return stopped(); };
  }

  SweepResult run();

 private:
  bool stopped() const { return stop_.load() || (options_.stop_asked && options_.stop_asked()); }
  void work();
  void take(std::size_t index);
  void finish();

  const Sweep& sweep_;
  Journal& journal_;
  const SweepOptions& options_;
  RunSettings settings_;
  SweepResult result_;
  std::atomic<std::size_t> next_, done_{0}, ran_{0};
  std::atomic<bool> stop_{false};
  std::unordered_map<CaseKey, std::size_t> begun_;  // by which case
  std::mutex lock_;
  std::condition_variable ended_;
  int working_ = 0;
  std::exception_ptr error_;
};

// Its model, and unless the journal or another case has its outcome, its run.
void Sweep::Work::take(std::size_t index) {
  CaseRow& row = result_.rows[index];
  const std::size_t count = sweep_.quantities_.size();
  try {
    const Model model = sweep_.build(index);
    if (const std::string warning = sweep_.new_warning(model); !warning.empty()) {
      row.outcome = failed("warning", warning, count);
      row.done = true;
      return;
    }
    Checksum sum;
    for (const std::uint64_t part : {fingerprint(model), sweep_.options_key_, options_.program})
      sum.add({reinterpret_cast<const char*>(&part), sizeof part});
    row.key = sum.value();
    {
      const std::lock_guard<std::mutex> held(lock_);
      if (!begun_.try_emplace(row.key, index).second) return;
    }
    std::vector<std::unique_ptr<Observer>> more;
    if (options_.observers) more = options_.observers(index, row.key);
    const bool is_kept = journal_.find(row.key) != nullptr;
    if (is_kept && more.empty()) return;
    CaseOutcome outcome;
    try {
      outcome = sweep_.compute(index, model, settings_, more);
    } catch (const OutputError&) {
      throw;
    } catch (const std::exception& error) {
      outcome = failed("failed", message_of(error), count);
    }
    if (outcome.status == "stopped") return;
    if (!is_kept) journal_.add(row.key, outcome);
    ++ran_;
  } catch (const InputError& error) {
    row.outcome = failed("input", words(error.diagnostics().list().front()), count);
    row.done = true;
  }
}

void Sweep::Work::work() {
  try {
    while (!stopped()) {
      const std::size_t index = next_.fetch_add(static_cast<std::size_t>(options_.parts));
      if (index >= result_.rows.size()) break;
      take(index);
      ++done_;
    }
  } catch (...) {
    const std::lock_guard<std::mutex> held(lock_);
    if (!error_) error_ = std::current_exception();
    stop_ = true;
  }
  const std::lock_guard<std::mutex> held(lock_);
  --working_;
  ended_.notify_all();
}

// Outcomes from the journal, and who has the model of whom.
void Sweep::Work::finish() {
  std::unordered_map<CaseKey, std::size_t> first;
  for (std::size_t index = 0; index < result_.rows.size(); ++index) {
    CaseRow& row = result_.rows[index];
    if (row.key != 0) {
      if (const CaseOutcome* outcome = journal_.find(row.key)) {
        row.outcome = *outcome;
        row.done = true;
      }
      const auto [found, is_new] = first.try_emplace(row.key, index);
      if (!is_new) row.same = found->second + 1;
    }
    result_.left += row.done ? 0 : 1;
    result_.kept += row.done && row.key != 0 && row.same == 0 ? 1 : 0;
  }
  result_.ran = ran_;
  result_.kept -= std::min(result_.kept, result_.ran);
}

SweepResult Sweep::Work::run() {
  working_ = options_.threads;
  std::vector<std::thread> threads;
  for (int i = 0; i < options_.threads; ++i) threads.emplace_back([this] { work(); });
  {
    std::unique_lock<std::mutex> held(lock_);
    while (working_ > 0) {
      constexpr std::chrono::milliseconds kPause(200);
      ended_.wait_for(held, kPause);
      if (options_.progress) options_.progress(done_, result_.rows.size());
    }
  }
  for (std::thread& thread : threads) thread.join();
  if (error_) std::rethrow_exception(error_);
  finish();
  return std::move(result_);
}

SweepResult Sweep::run(Journal& journal, const SweepOptions& options) const {
  return Work(*this, journal, options).run();
}

}  // namespace sage::sweep
