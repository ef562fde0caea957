#include "sage/sweep/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sage/messages/near_names.hpp"

namespace sage::sweep {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<const char*, 4> kSafety{"safety.factor", "safety.lower", "safety.upper", "safety.trials"};
constexpr std::array<const char*, 3> kRun{"run.increments", "run.stages", "run.motion"};
constexpr std::array<std::pair<const char*, Quantity::Pick>, 5> kPicks{{{"", Quantity::Pick::last},
                                                                        {".first", Quantity::Pick::first},
                                                                        {".max", Quantity::Pick::largest},
                                                                        {".min", Quantity::Pick::smallest},
                                                                        {".mean", Quantity::Pick::mean}}};

double picked(const std::vector<double>& values, Quantity::Pick pick) {
  if (values.empty()) return kNone;
  switch (pick) {
    case Quantity::Pick::first:
      return values.front();
    case Quantity::Pick::largest:
      return *std::ranges::max_element(values);
    case Quantity::Pick::smallest:
      return *std::ranges::min_element(values);
    case Quantity::Pick::mean: {
      double sum = 0.0;
      for (const double value : values) sum += value;
      return sum / static_cast<double>(values.size());
    }
    case Quantity::Pick::last:
      break;
  }
  return values.back();
}

double of_safety(int place, const safety::Safety& found) {
  const double lower = found.lower.value_or(kNone), upper = found.upper.value_or(kNone);
  if (place == 0) return 0.5 * (lower + upper);
  if (place == 1) return lower;
  return place == 2 ? upper : static_cast<double>(found.trials.size());
}

}  // namespace

Quantity quantity_of(const std::string& name, const Model& model, const std::string& study_file) {
  Quantity quantity;
  quantity.name = name;
  std::vector<std::string> known;
  for (std::size_t r = 0; r < model.reports.size(); ++r) {
    const std::vector<ReportColumn> columns = report_columns(model, model.reports[r]);
    for (std::size_t c = 0; c < columns.size(); ++c)
      for (const auto& [ending, pick] : kPicks) {
        std::string one = fmt::format("report{}.{}", r + 1, columns[c].name);
        if (*ending == '\0') known.push_back(one);
        one += ending;
        if (one != name) continue;
        quantity.report = r;
        quantity.column = c;
        quantity.pick = pick;
        return quantity;
      }
  }
  const auto find = [&](const auto& table, Quantity::Source source) {
    for (std::size_t i = 0; i < table.size(); ++i) {
      known.emplace_back(table[i]);
      if (name != table[i]) continue;
      quantity.source = source;
      quantity.place = static_cast<int>(i);
      return true;
    }
    return false;
  };
  if (find(kSafety, Quantity::Source::safety) || find(kRun, Quantity::Source::run)) return quantity;
  throw InputError(
      "S734", {study_file, 0, 0, 0},
      fmt::format("no result has the name {}; there are: {} (of reports the last row, or with .first, "
                  ".max, .min or .mean){}",
                  name, fmt::join(known, ", "), did_you_mean(name, known)));
}

double value_of(const Quantity& quantity, const Reports& reports, const RunResult& run,
                const safety::Safety* found) {
  if (quantity.source == Quantity::Source::safety)
    return found == nullptr ? kNone : of_safety(quantity.place, *found);
  if (quantity.source == Quantity::Source::run)
    return quantity.place == 0 ? run.increments_done : quantity.place == 1 ? run.stages_done : run.motion;
  if (quantity.report >= reports.count()) return kNone;
  std::vector<double> values;
  for (std::size_t row = 0; row < reports.rows(quantity.report); ++row) {
    const double value = reports.values(quantity.report, row)[quantity.column];
    if (quantity.pick == Quantity::Pick::last || std::isfinite(value)) values.push_back(value);
  }
  return picked(values, quantity.pick);
}

}  // namespace sage::sweep
