#include "sage/sweep/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "sage/draw/plot.hpp"

namespace sage::sweep {

namespace {

using Value = std::variant<double, std::string>;

std::string quoted_cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? std::string("\"\"") : std::string(1, c);
  return cell + '"';
}

std::string number_cell(double value, int digits) {
  return std::isnan(value) ? std::string() : fmt::format("{:.{}g}", value, digits);
}

std::string value_cell(const Value& value, int digits) {
  if (const auto* text = std::get_if<std::string>(&value)) return quoted_cell(*text);
  return number_cell(std::get<double>(value), digits);
}

std::size_t place_of(const Sweep& sweep, const std::string& quantity) {
  const std::vector<Quantity>& list = sweep.quantities();
  return static_cast<std::size_t>(
      std::ranges::find_if(list, [&](const Quantity& one) { return one.name == quantity; }) - list.begin());
}

bool fails(const FailureRule& rule, double value) {
  return rule.above ? value > rule.limit : value < rule.limit;
}

// The values of a case that are not drawn, in words, without those that one name leaves out.
std::string combination_of(const Study& study, std::size_t index, const std::string& without = {}) {
  std::string text;
  for (std::size_t i = 0; i < study.names.size(); ++i) {
    if (study.names[i] == without || std::ranges::find(study.random, study.names[i]) != study.random.end())
      continue;
    text += (text.empty() ? "" : ", ") + study.names[i] + " = " + value_cell(study.cases[index][i], 6);
  }
  return text;
}

std::string probability_words(const FailureRow& row, const FailureRule& rule) {
  std::string text =
      fmt::format("  {}{} of {} cases fail: probability {:.4g}, {:.4g} to {:.4g} with {:g} % confidence\n",
                  row.combination.empty() ? "" : row.combination + ": ", row.failures, row.cases,
                  row.probability.value, row.probability.low, row.probability.high, 100.0 * rule.confidence);
  if (row.without > 0) {
    const Probability all =
        probability_of(row.failures + row.without, row.cases + row.without, rule.confidence);
    text += fmt::format(
        "    {} have no answer and are not counted; if all of them fail: {:.4g}, {:.4g} to {:.4g}\n",
        row.without, all.value, all.low, all.high);
  }
  return text;
}

}  // namespace

std::string case_words(const Study& study, std::size_t index) {
  std::string text;
  for (std::size_t i = 0; i < study.names.size(); ++i)
    if (const std::string cell = value_cell(study.cases[index][i], 6); !cell.empty())
      text += (text.empty() ? "" : ", ") + study.names[i] + " = " + cell;
  return text;
}

std::string csv_text(const Sweep& sweep, const SweepResult& result, int digits,
                     const std::function<std::string(CaseKey)>& page) {
  const Study& study = sweep.study();
  std::string text = "case";
  for (const std::string& name : study.names) text += ',' + quoted_cell(name);
  for (const Quantity& quantity : sweep.quantities()) text += ',' + quantity.name;
  if (study.failure) text += ",fails";
  text += ",status,same_as,warnings,reason";
  text += page ? ",page\n" : "\n";
  for (std::size_t index = 0; index < result.rows.size(); ++index) {
    const CaseRow& row = result.rows[index];
    text += std::to_string(index + 1);
    for (const Value& value : study.cases[index]) text += ',' + value_cell(value, digits);
    for (std::size_t q = 0; q < sweep.quantities().size(); ++q)
      text +=
          ',' + (q < row.outcome.values.size() ? number_cell(row.outcome.values[q], digits) : std::string());
    if (study.failure) {
      const std::size_t q = place_of(sweep, study.failure->quantity);
      const double value = q < row.outcome.values.size() ? row.outcome.values[q] : std::nan("");
      text += std::isnan(value) ? "," : fails(*study.failure, value) ? ",1" : ",0";
    }
    text += ',' + row.outcome.status + ',' + (row.same == 0 ? "" : std::to_string(row.same)) + ',' +
            row.outcome.warnings + ',' + quoted_cell(row.outcome.reason);
    if (page) text += ',' + quoted_cell(page(row.key));
    text += '\n';
  }
  return text;
}

std::vector<FailureRow> failure_rows(const Sweep& sweep, const SweepResult& result) {
  const Study& study = sweep.study();
  std::vector<FailureRow> rows;
  if (!study.failure) return rows;
  const std::size_t q = place_of(sweep, study.failure->quantity);
  for (std::size_t index = 0; index < result.rows.size(); ++index) {
    const std::string combination = study.random.empty() ? std::string() : combination_of(study, index);
    auto row =
        std::ranges::find_if(rows, [&](const FailureRow& one) { return one.combination == combination; });
    if (row == rows.end()) {
      rows.push_back({combination, 0, 0, 0, {}});
      row = rows.end() - 1;
    }
    const std::vector<double>& values = result.rows[index].outcome.values;
    if (q >= values.size() || std::isnan(values[q])) {
      ++row->without;
      continue;
    }
    ++row->cases;
    row->failures += fails(*study.failure, values[q]) ? 1 : 0;
  }
  for (FailureRow& row : rows)
    row.probability = probability_of(row.failures, row.cases, study.failure->confidence);
  return rows;
}

std::string plot_text(const Sweep& sweep, const SweepResult& result) {
  const Study& study = sweep.study();
  const std::string x_name = study.plot_x.empty() ? study.names.front() : study.plot_x;
  const std::string y_name = study.plot_y.empty() ? sweep.quantities().front().name : study.plot_y;
  const auto value = [&](const std::string& name, std::size_t index) {
    const auto at = static_cast<std::size_t>(std::ranges::find(study.names, name) - study.names.begin());
    if (at < study.names.size()) {
      const auto* number = std::get_if<double>(&study.cases[index][at]);
      return number != nullptr ? *number : std::nan("");
    }
    const std::vector<double>& values = result.rows[index].outcome.values;
    const std::size_t q = place_of(sweep, name);
    return q < values.size() ? values[q] : std::nan("");
  };
  Plot plot{study.file, x_name, y_name, {}};
  constexpr std::size_t kMostLines = kLineStyles;
  const bool drawn = std::ranges::find(study.random, x_name) != study.random.end() || !study.random.empty();
  for (std::size_t index = 0; index < result.rows.size(); ++index) {
    const std::string name = combination_of(study, index, x_name);
    auto series = std::ranges::find_if(plot.series, [&](const PlotSeries& one) { return one.name == name; });
    if (series == plot.series.end() && plot.series.size() >= kMostLines) continue;
    if (series == plot.series.end()) {
      PlotSeries made;
      made.name = name;
      made.line = !drawn;
      made.markers = true;
      plot.series.push_back(made);
      series = plot.series.end() - 1;
    }
    series->x.push_back(value(x_name, index));
    series->y.push_back(value(y_name, index));
  }
  return plot_svg(plot);
}

std::string summary_text(const Sweep& sweep, const SweepResult& result) {
  const Study& study = sweep.study();
  std::map<std::string, long> failures;
  long same = 0, well = 0;
  std::string first, equal;
  for (std::size_t index = 0; index < result.rows.size(); ++index) {
    const CaseRow& row = result.rows[index];
    if (row.same > 0 && same++ < 5)
      equal += fmt::format("{}{} and {}", equal.empty() ? "" : ", ", row.same, index + 1);
    if (row.outcome.status == kAnswered) {
      ++well;
      continue;
    }
    ++failures[row.outcome.status];
    if (first.empty()) first = fmt::format("case {}: {}", index + 1, row.outcome.reason);
  }
  std::string text = fmt::format("{}: {} cases of {}: {} computed, {} kept from before\n", study.file,
                                 result.rows.size(), study.deck, result.ran, result.kept);
  text += fmt::format("  {} ok", well);
  for (const auto& [status, count] : failures) text += fmt::format(", {} {}", count, status);
  text += '\n';
  if (!first.empty()) text += "  first without an answer: " + first + "\n";
  if (same > 0)
    text += fmt::format("  {} with the model of another case: {}{}\n", same, equal, same > 5 ? " ..." : "");
  for (std::size_t q = 0; q < sweep.quantities().size(); ++q) {
    double low = std::numeric_limits<double>::infinity(), high = -low, sum = 0.0;
    long count = 0;
    for (const CaseRow& row : result.rows) {
      if (q >= row.outcome.values.size() || std::isnan(row.outcome.values[q])) continue;
      low = std::min(low, row.outcome.values[q]);
      high = std::max(high, row.outcome.values[q]);
      sum += row.outcome.values[q];
      ++count;
    }
    if (count > 0)
      text += fmt::format("  {}: {:.6g} to {:.6g}, mean {:.6g}\n", sweep.quantities()[q].name, low, high,
                          sum / static_cast<double>(count));
  }
  if (study.failure) {
    text += fmt::format("failure: {} {} {:g}\n", study.failure->quantity, study.failure->above ? '>' : '<',
                        study.failure->limit);
    for (const FailureRow& row : failure_rows(sweep, result)) text += probability_words(row, *study.failure);
  }
  return text;
}

}  // namespace sage::sweep
