// Strength reduction: the whole body once for every factor, with its strengths divided by it.
#include <algorithm>

#include "sage/builder/builder.hpp"
#include "sage/deck/text.hpp"
#include "sage/model/law_table.hpp"
#include "sage/model/strength.hpp"

namespace sage::builder {

namespace {

// The material with its strengths divided by a factor.
Material reduced(const Material& from, double factor, const UnitSystem& units) {
  Material m = twin_of(from, units);
  const bool weaker = is_soil_or_joint(*m.entry) && reduce_strength(m, {factor, DilationRule::reduced});
  m.law = make_law(m, units);
  if (weaker) m.name += (m.name.empty() ? "strength / " : ", strength / ") + rounded_text(factor, 6);
  return m;
}

struct Factor {
  double value = 1.0;
  SourcePosition where;
};

std::vector<Factor> read_strength_factors(Builder& b) {
  std::vector<Factor> factors;
  for (const CardView& card : b.deck.all("strength_factors"))
    for (const FieldValue& value : card.list("factors")) {
      if (value.number > 0.0 && value.number < 1e6)
        factors.push_back({value.number, card.where(value)});
      else
        b.error("S241", card.where(value),
                "a strength factor must be above 0 and below 1000000, not " + rounded_text(value.number, 6));
    }
  return factors;
}

// Bodies of later factors take numbers that the deck leaves free: 1003 is number 3 of the second.
int stride_over(int largest) {
  int stride = 10;
  while (stride <= largest && stride < 100'000'000) stride *= 10;
  return stride;
}

struct Numbers {
  int material = 0, group = 0, element = 0;
};

Numbers strides(const Model& model) {
  Numbers largest;
  for (const Material& m : model.materials) largest.material = std::max(largest.material, m.number);
  for (const Group& group : model.groups) {
    largest.group = std::max(largest.group, group.number);
    for (const int e : group.element_numbers) largest.element = std::max(largest.element, e);
  }
  return {stride_over(largest.material), stride_over(largest.group), stride_over(largest.element)};
}

}  // namespace

namespace {

// One step that every factor can repeat.
bool fits(Builder& b) {
  const Model& model = b.model;
  if (model.stages.size() == 1 && model.initials.empty() && model.stages[0].births.empty() &&
      model.stages[0].deaths.empty())
    return true;
  b.error("S241", b.deck.all("strength_factors").front().where(),
          "strength factors need a deck whose loads come in one step on bodies without start stress; this one "
          "has " +
              std::to_string(model.stages.size()) + " stage(s)" +
              (model.initials.empty() ? "" : " and start stress"));
  return false;
}

// The stage of factor k >= 1: the bodies of the one before make place for their twins.
Stage stage_of(Builder& b, int k, const Factor& factor, std::size_t groups, const Numbers& stride,
               int first_material) {
  Model& model = b.model;
  const int first_group = static_cast<int>(model.groups.size());
  Stage stage;
  stage.number = k + 1;
  stage.where = factor.where;
  stage.increments = model.stages[0].increments;
  stage.fixities = model.stages[0].fixities;  // displacements are those of a stage alone
  stage.turned_fixities = model.stages[0].turned_fixities;
  for (EdgeLoad load : model.stages[0].pressures) {  // those of the body before end with it
    load.group += first_group;
    stage.pressures.push_back(load);
  }
  for (std::size_t g = 0; g < groups; ++g) {
    Group group = model.groups[g];
    group.number += k * stride.group;
    group.material += first_material;
    for (int& number : group.element_numbers) number += k * stride.element;
    stage.births.push_back(first_group + static_cast<int>(g));
    stage.deaths.push_back(first_group + static_cast<int>(g) - static_cast<int>(groups));
    model.groups.push_back(std::move(group));
  }
  return stage;
}

}  // namespace

// Every factor is an analysis of its own, as such programs have it: its body takes the place of the one before,
// without stress or strain, and what that one carried comes on anew over the stage.
void build_strength_stages(Builder& b) {
  const std::vector<Factor> factors = read_strength_factors(b);
  if (factors.empty() || b.problems.errors() > 0 || !fits(b)) return;
  Model& model = b.model;
  const std::size_t materials = model.materials.size(), groups = model.groups.size();
  const Numbers stride = strides(model);
  if (static_cast<std::int64_t>(stride.element) * static_cast<std::int64_t>(factors.size()) > kLargestNumber) {
    b.error("S241", factors.back().where, "there are too many strength factors for so large element numbers");
    return;
  }
  if (std::ranges::none_of(model.materials, [](const Material& m) { return has_strength(*m.entry); }))
    b.warning("S241", factors.front().where,
              "strength factors are given, but no material has a strength: every factor gives the same answer");
  for (std::size_t k = 1; k < factors.size(); ++k) {
    const int first_material = static_cast<int>(model.materials.size());
    for (std::size_t m = 0; m < materials; ++m) {
      model.materials.push_back(reduced(model.materials[m], factors[k].value, model.units));
      model.materials.back().number += static_cast<int>(k) * stride.material;
    }
    model.stages.push_back(stage_of(b, static_cast<int>(k), factors[k], groups, stride, first_material));
  }
  for (std::size_t m = 0; m < materials; ++m)
    model.materials[m] = reduced(model.materials[m], factors[0].value, model.units);
  for (std::size_t k = 0; k < factors.size(); ++k) {
    model.stages[k].title = "strength / " + rounded_text(factors[k].value, 6);
    model.stages[k].strength_factor = factors[k].value;
  }
}

}  // namespace sage::builder
