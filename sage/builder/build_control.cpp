// The displacement that controls the load of a stage.
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "sage/builder/builder.hpp"
#include "sage/messages/parse_number.hpp"
#include "sage/model/activity.hpp"

namespace sage::builder {

namespace {

// Loads, supports and groups that let the load grow.
bool has_load(const Stage& stage) {
  const auto releases = [](const Fixity& f) { return std::ranges::count(f.code, FixityCode::released) > 0; };
  return !stage.loads.empty() || !stage.pressures.empty() || !stage.births.empty() || !stage.deaths.empty() ||
         !stage.gravity.isZero(0.0) || std::ranges::any_of(stage.fixities, releases) ||
         std::ranges::any_of(stage.turned_fixities, releases);
}

bool are_tied(const Builder& b, const LoadControl& control) {
  if (control.other < 0) return false;
  const int one = DofMap::displacement(control.node, control.component);
  const int other = DofMap::displacement(control.other, control.component);
  const Activity activity(b.model);
  return std::ranges::any_of(activity.tied, [&](const std::vector<TiedDof>& set) {
    const auto has = [&](int dof) { return std::ranges::find(set, dof, &TiedDof::dof) != set.end(); };
    return has(one) && has(other);
  });
}

// Why the stage cannot be controlled; empty = it can.
std::string refusal(const Builder& b, const Stage& stage) {
  if (are_tied(b, stage.control)) return "its two displacements are tied to each other";
  if (stage.method != Method::newton) return "it needs Newton's method (method 0)";
  if (b.model.large_strain) return "it is not possible with large strain";
  if (b.model.has_pores() || !stage.field_loads.empty() || !stage.field_fixities.empty() ||
      !stage.exits.empty())
    return "it is not possible with unknowns besides displacements (pore pressures, heads)";
  if (stage.moves_supports()) return "a stage whose load is controlled must not prescribe displacements";
  if (stage.has_histories()) return "its loads have tables of time, which state the loads already";
  if (!has_load(stage)) return "the stage has no load that could grow or fall";
  if (&stage != &b.model.stages.back())
    return "only the last stage can be controlled, since it may end at any load factor";
  return {};
}

}  // namespace

void read_control(Builder& b, const CardView& card, Stage& stage) {
  constexpr const char* kField = "load_control";
  const std::string text = b.text(card, kField);
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; stream >> word;) words.push_back(word);
  if (words.empty()) return;
  const auto fail = [&] {
    b.error(
        "S581", card.where(kField),
        "'" + text +
            "' is no control of the load; expected: node, x or y, and a growth that is not 0, as 12 y -0.05, "
            "or two nodes, as 12 15 y 0.02");
  };
  const auto number_of = [](const std::string& word) {
    return parse_number<double>(word).value_or(std::nan(""));
  };
  const std::size_t nodes = words.size() - 2;
  if (words.size() < 3 || words.size() > 4 || (words[nodes] != "x" && words[nodes] != "y")) return fail();
  LoadControl control;
  control.component = words[nodes] == "x" ? 0 : 1;
  control.growth = number_of(words.back());
  if (!std::isfinite(control.growth) || control.growth == 0.0) return fail();
  for (std::size_t i = 0; i < nodes; ++i) {
    const double number = number_of(words[i]);
    if (!(number >= 1.0 && number <= static_cast<double>(kLargestNumber) && number == std::floor(number)))
      return fail();
    (i == 0 ? control.node : control.other) = b.node(card, kField, static_cast<std::int64_t>(number));
  }
  if (control.node < 0 || (nodes == 2 && control.other < 0)) return;
  if (control.node == control.other) return fail();
  stage.control = control;
}

void check_controls(Builder& b) {
  for (const Stage& stage : b.model.stages) {
    if (!stage.is_controlled()) continue;
    const std::string reason = refusal(b, stage);
    if (!reason.empty()) b.error("S581", stage.where, "load_control: " + reason);
  }
}

}  // namespace sage::builder
