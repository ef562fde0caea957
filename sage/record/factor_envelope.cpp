#include "sage/record/factor_envelope.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sage/analysis/extent.hpp"
#include "sage/record/number.hpp"
#include "sage/record/without_rounding.hpp"

namespace sage {

namespace {

std::string quantity_unit(const Model& model, std::size_t quantity) {
  return unit_text(end_field(quantity).dimension, model.units);
}

// The largest force of a table, beside which what rounding leaves is shown as 0.  A moment counts as a force at the end
// of a lever as long as the mesh.
class ForceScale {
 public:
  explicit ForceScale(const Model& model) : lever_(Extent(model).size()) {}
  void add(std::size_t quantity, double value) {
    largest_ = std::max(largest_, std::abs(value) / lever(quantity));
  }
  double shown(std::size_t quantity, double value) const {
    return without_rounding(value, largest_ * lever(quantity));
  }

 private:
  double lever(std::size_t quantity) const {
    return end_field(quantity).dimension == Dimension::moment ? lever_ : 1.0;
  }

  double lever_, largest_ = 0.0;
};

void cell(std::string& text, double value, const std::string& set, long stage, int digits) {
  append_optional_cell(text, value, digits);
  text += std::isnan(value) ? ",," : fmt::format(",{},{}", set, stage);
}

}  // namespace

std::vector<FactoredRange> factored_ranges(const Model& model, const std::vector<FactoredEnds>& sets) {
  std::vector<FactoredRange> ranges;
  for (std::size_t g = 0; g < model.groups.size(); ++g)
    for (const std::size_t q : end_quantities(model)) {
      FactoredRange range{g, q, {}, {}};
      bool any = false;
      for (std::size_t s = 0; s < sets.size(); ++s)
        for (const EnvelopeEnd& row : sets[s].rows) {
          if (row.group != static_cast<std::int64_t>(g) || std::isnan(row.low[q])) continue;
          const double low = sets[s].set.effects * row.low[q], high = sets[s].set.effects * row.high[q];
          const int element = model.groups[g].element_numbers[row.element];
          if (!any || low < range.least.value)
            range.least = {low, s, static_cast<int>(row.low_stage[q]) + 1, element};
          if (!any || high > range.largest.value)
            range.largest = {high, s, static_cast<int>(row.high_stage[q]) + 1, element};
          any = true;
        }
      const bool zero =
          range.least.value == 0.0 && range.largest.value == 0.0;  // such as hoop forces in plane strain
      if (any && !zero) ranges.push_back(range);
    }
  return ranges;
}

std::string factored_text(const Model& model, const std::vector<FactoredEnds>& sets) {
  const std::vector<FactoredRange> ranges = factored_ranges(model, sets);
  if (ranges.empty()) return {};
  std::string text = fmt::format(
      "section forces under {} set(s) of factors, times the factor on effects\n{:>22}{:>16}{:>12}  "
      "{:<12}{:>5}{:>12}  {:<12}{:>5}\n",
      sets.size(), "group", "quantity", "least", "set", "stage", "largest", "set", "stage");
  ForceScale scale(model);
  for (const FactoredRange& range : ranges)
    for (const FactoredExtreme& one : {range.least, range.largest}) scale.add(range.quantity, one.value);
  for (const FactoredRange& range : ranges) {
    const double least = scale.shown(range.quantity, range.least.value);
    const double largest = scale.shown(range.quantity, range.largest.value);
    if (least == 0.0 && largest == 0.0) continue;
    const Group& group = model.groups[range.group];
    text += fmt::format("{:>22.22}{:>16}{:>12.5g}  {:<12.12}{:>5}{:>12.5g}  {:<12.12}{:>5}\n",
                        group.name.empty() ? std::to_string(group.number) : group.name,
                        kEndQuantities[range.quantity], least, sets[range.least.set].set.name,
                        range.least.stage, largest, sets[range.largest.set].set.name, range.largest.stage);
  }
  return text;
}

std::string factored_csv(const Model& model, const std::vector<FactoredEnds>& sets, int digits) {
  const std::vector<std::size_t> quantities = end_quantities(model);
  std::string text = "# " + model.title + "\n";
  for (const FactoredEnds& one : sets) text += "# " + text_of(one.set) + "\n";
  text += "# least and largest at the ends of all stages, times the factor on effects\n";
  text += fmt::format("factors,group,element,end,node,x[{0}],y[{0}]", model.units.length);
  for (const std::size_t q : quantities)
    text += fmt::format(
        ",{0}_least[{1}],{0}_least_set,{0}_least_stage,{0}_largest[{1}],{0}_largest_set,{0}_largest_stage",
        kEndQuantities[q], quantity_unit(model, q));
  text += '\n';
  const auto begin = [&](const std::string& name, const EnvelopeEnd& row) {
    const Group& group = model.groups[row.group];
    text += fmt::format("{},{},{},{},{}", name, group.number, group.element_numbers[row.element], row.end,
                        model.mesh.number[row.node]);
    for (int c = 0; c < 2; ++c) append_result_cell(text, model.mesh.x(c, row.node), digits);
  };
  for (const FactoredEnds& one : sets)
    for (const EnvelopeEnd& row : one.rows) {
      begin(one.set.name, row);
      for (const std::size_t q : quantities) {
        cell(text, one.set.effects * row.low[q], one.set.name, static_cast<long>(row.low_stage[q]) + 1, digits);
        cell(text, one.set.effects * row.high[q], one.set.name, static_cast<long>(row.high_stage[q]) + 1,
             digits);
      }
      text += '\n';
    }
  const std::size_t ends = sets.empty() ? 0 : sets.front().rows.size();
  for (std::size_t i = 0; i < ends; ++i) {
    begin("all", sets.front().rows[i]);
    for (const std::size_t q : quantities) {
      std::size_t low = 0, high = 0;
      const auto value = [&](std::size_t s, bool least) {
        if (i >= sets[s].rows.size()) return std::nan("");
        return sets[s].set.effects * (least ? sets[s].rows[i].low[q] : sets[s].rows[i].high[q]);
      };
      for (std::size_t s = 1; s < sets.size(); ++s) {
        if (value(s, true) < value(low, true)) low = s;
        if (value(s, false) > value(high, false)) high = s;
      }
      cell(text, value(low, true), sets[low].set.name, static_cast<long>(sets[low].rows[i].low_stage[q]) + 1,
           digits);
      cell(text, value(high, false), sets[high].set.name,
           static_cast<long>(sets[high].rows[i].high_stage[q]) + 1, digits);
    }
    text += '\n';
  }
  return text;
}

}  // namespace sage
