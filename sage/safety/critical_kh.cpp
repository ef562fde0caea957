#include "sage/safety/critical_kh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "sage/safety/insert_stage.hpp"

namespace sage::safety {

namespace {

constexpr int kMostTrials = 16;
constexpr double kFirst = 0.1, kLargest = 2.0;  // in multiples of gravity
constexpr int kIncrements = 5;                  // of the stage of the earthquake

double middle(const KhTrial& trial) {
  if (trial.lower && trial.upper) return 0.5 * (*trial.lower + *trial.upper);
  return trial.lower.value_or(trial.upper.value_or(1.0));
}

class Search {
 public:
  explicit Search(double tolerance) : tolerance_(tolerance) {}

  const CriticalKh& found() const { return found_; }
  bool is_done() const { return found_.lower && found_.upper && width() <= tolerance_ * (1.0 + 1e-9); }
  void take(const KhTrial& trial) {
    found_.trials.push_back(trial);
    if (trial.stands() && trial.kh >= found_.lower.value_or(0.0)) found_.lower = trial.kh;
    if (trial.falls() && trial.kh <= found_.upper.value_or(kLargest)) found_.upper = trial.kh;
  }

  double next() const {
    if (!found_.upper) return std::min(rising(), kLargest);
    // Where the line through both ends has F = 1, and from there towards the end that is farther off.
    const double F_low = middle(of(*found_.lower)), F_high = middle(of(*found_.upper));
    const double root = *found_.lower + width() * std::clamp((F_low - 1.0) / (F_low - F_high), 0.0, 1.0);
    const double aside = 0.4 * tolerance_, margin = 0.15 * width();
    const double kh = root - *found_.lower > *found_.upper - root ? root - aside : root + aside;
    const double inside = std::clamp(kh, *found_.lower + margin, *found_.upper - margin);
    if (!was_tried(inside)) return inside;
    for (const double part : {0.5, 0.3, 0.7, 0.15, 0.85})
      if (const double other = *found_.lower + part * width(); !was_tried(other)) return other;
    return inside;
  }

  CriticalKh conclude(bool stopped) {
    found_.stopped = stopped;
    if (stopped)
      found_.incomplete = "the search was interrupted";
    else if (!found_.lower)
      found_.incomplete = "the factor of safety is not above 1 without an earthquake";
    else if (!found_.upper && *found_.lower >= kLargest)
      found_.incomplete = fmt::format("still in equilibrium at k_h = {:g}", kLargest);
    else if (!is_done())
      found_.incomplete = fmt::format(
          "the bracket is wider than {:g}: at accelerations within it neither equilibrium nor "
          "collapse could be shown",
          tolerance_);
    return std::move(found_);
  }

 private:
  double width() const { return *found_.upper - *found_.lower; }
  const KhTrial& of(double kh) const { return *std::ranges::find(found_.trials, kh, &KhTrial::kh); }
  bool was_tried(double kh) const {
    return std::ranges::any_of(found_.trials,
                               [&](const KhTrial& t) { return std::abs(t.kh - kh) < 0.1 * tolerance_; });
  }
  // Nothing falls yet: along the line through the last two trials to a little beyond F = 1.
  double rising() const {
    const KhTrial& last = found_.trials.back();
    if (found_.trials.size() < 2) return kFirst;
    const KhTrial& before = found_.trials[found_.trials.size() - 2];
    const double slope = (middle(last) - middle(before)) / (last.kh - before.kh);
    const double root = slope < 0.0 ? last.kh + (1.0 - middle(last)) / slope : 2.0 * last.kh;
    return std::clamp(root + 0.5 * tolerance_, last.kh + tolerance_, 3.0 * last.kh);
  }

  double tolerance_;
  CriticalKh found_;
};

}  // namespace

CriticalKh find_critical_kh(const std::function<Safety(double kh)>& find, double tolerance) {
  Search search(tolerance);
  double kh = 0.0;
  for (int trial = 0; trial < kMostTrials; ++trial) {
    const Safety safety = find(kh);
    if (safety.stopped) return search.conclude(true);
    search.take({kh, safety.lower, safety.upper, safety.complete()});
    if (!search.found().lower || search.is_done() || kh >= kLargest) break;
    kh = search.next();
  }
  return search.conclude(false);
}

int add_earthquake(Model& model, int stage, double kh) {
  const int last = chosen_stage(model, stage);
  const Stage& before = model.stages[static_cast<std::size_t>(last)];
  Stage earthquake;
  earthquake.number = before.number + 1;
  earthquake.title = "earthquake";
  earthquake.increments = kIncrements;
  earthquake.max_iterations = before.max_iterations;
  earthquake.tolerance = before.tolerance;
  earthquake.gravity = {kh, 0.0};
  earthquake.strength_factor = before.strength_factor;  // its strengths are those of the stage before
  earthquake.where = before.where;
  return insert_behind(model, last, std::move(earthquake));
}

std::string to_text(const CriticalKh& found) {
  std::string text = fmt::format("{:>10}{:>12}{:>12}\n", "k_h", "F lower", "F upper");
  const auto cell = [](std::optional<double> factor) {
    return factor ? fmt::format("{:.6g}", *factor) : std::string("-");
  };
  for (const KhTrial& trial : found.trials)
    text += fmt::format("{:>10.5g}{:>12}{:>12}{}\n", trial.kh, cell(trial.lower), cell(trial.upper),
                        trial.stands()  ? "  stands"
                        : trial.falls() ? "  falls"
                                        : "");
  if (found.lower && found.upper)
    text += fmt::format("critical k_h between {:.5g} and {:.5g}\n", *found.lower, *found.upper);
  else if (found.lower)
    text += fmt::format("critical k_h above {:.5g}\n", *found.lower);
  else
    text += "critical k_h unknown\n";
  if (!found.incomplete.empty()) text += "  NOT PROVED: " + found.incomplete + "\n";
  return text;
}

std::string to_csv(const CriticalKh& found, int digits) {
  std::string text = "kh,lower,upper,stands,falls\n";
  const auto cell = [&](std::optional<double> factor) {
    return factor ? fmt::format("{:.{}g}", *factor, digits) : std::string();
  };
  for (const KhTrial& t : found.trials)
    text += fmt::format("{:.{}g},{},{},{},{}\n", t.kh, digits, cell(t.lower), cell(t.upper), t.stands() ? 1 : 0,
                        t.falls() ? 1 : 0);
  return text;
}

}  // namespace sage::safety
