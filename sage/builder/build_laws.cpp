// Laws that differ by point or by stage: parameters that grow with depth, other materials in later stages, lock-off of bars.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "sage/builder/builder.hpp"
#include "sage/core/short_names.hpp"
#include "sage/deck/text.hpp"
#include "sage/model/activity.hpp"
#include "sage/model/law_table.hpp"
#include "sage/model/undrained.hpp"
#include "sage/model/water.hpp"

namespace sage::builder {

namespace {

// A material as a group has it from a stage on.
struct Phase {
  int stage = 0;
  int material = 0;   // index
  bool held = false;  // a stage of lock-off
  bool anew = false;  // as in LawChoice
  std::vector<const InitialStress*> fields;
  SourcePosition where;
};

std::string group_name(const Group& group) {
  return "group " + std::to_string(group.number);
}

int place_of_material(const Model& model, int number) {
  for (std::size_t m = 0; m < model.materials.size(); ++m)
    if (model.materials[m].number == number && !model.materials[m].twin) return static_cast<int>(m);
  return -1;
}

bool changes_law(const InitialStress& initial) {
  return is_about_law(initial.kind) || initial.kind == InitialKind::lock_off;
}

// Of one group, stage by stage; a single one where nothing changes.
std::vector<Phase> phases_of(const Model& model, int g) {
  std::vector<Phase> phases;
  Phase now;
  now.material = place_of_material(model, model.material_of(model.groups[g]).number);
  for (const InitialStress& initial : model.initials)
    if (initial.group == g && initial.kind == InitialKind::parameter) {
      now.fields.push_back(&initial);
      now.where = initial.where;
    }
  for (std::size_t s = 0; s < model.stages.size(); ++s) {
    bool changes = s == 0 || now.held;
    now.anew = now.held;
    now.held = false;
    now.stage = static_cast<int>(s);
    for (const InitialStress& initial : model.stages[s].initials) {
      if (initial.group != g || !changes_law(initial)) continue;
      changes = true;
      now.where = initial.where;
      if (initial.kind == InitialKind::lock_off) now.held = true;
      if (initial.kind == InitialKind::parameter) now.fields.push_back(&initial);
      if (initial.kind != InitialKind::material) continue;
      now.material = place_of_material(model, static_cast<int>(initial.value[0]));
      now.anew = true;
      now.fields.clear();
    }
    if (changes) phases.push_back(now);
  }
  if (now.held) {  // for a stage that a safety factor puts behind the last one
    now.stage = static_cast<int>(model.stages.size());
    now.held = false;
    now.anew = true;
    phases.push_back(now);
  }
  return phases;
}

// Parameters of a material that options place: index, and value by place.
std::vector<std::pair<std::size_t, const PlacedParameter*>> placed_in(const BuildOptions& options,
                                                                      const Material& material) {
  std::vector<std::pair<std::size_t, const PlacedParameter*>> placed;
  for (const PlacedParameter& one : options.placed)
    if (one.material == material.name || one.material == std::to_string(material.number))
      if (const int index = parameter_place(*material.entry, one.parameter); index >= 0)
        placed.emplace_back(static_cast<std::size_t>(index), &one);
  return placed;
}

bool is_plain(const Builder& b, const std::vector<Phase>& phases) {
  return phases.empty() ||
         (phases.size() == 1 && phases[0].fields.empty() && !phases[0].held && !phases[0].anew &&
          placed_in(b.options, b.model.materials[phases[0].material]).empty());
}

// Effective vertical stress (compression +) of the ground before anything is done to it: as initial cards state it, or else
// the weight of what is active in the first stage above a place, less the pore pressure of that stage.
class GroundStress {
 public:
  GroundStress(const Model& model, int group) : group_(group) {
    Activity activity(model);
    activity.enter(model.stages.front());
    const std::vector<InitialStress>* const lists[] = {&model.initials, &model.stages.front().initials};
    for (const std::vector<InitialStress>* list : lists)
      for (const InitialStress& initial : *list)
        if (initial.group == group &&
            (initial.kind == InitialKind::uniform || initial.kind == InitialKind::geostatic ||
             initial.kind == InitialKind::at_rest))
          stated_ = &initial;
    if (stated_ == nullptr || stated_->kind == InitialKind::at_rest) above_.emplace(model, activity.group, 0);
    if (!model.water.empty()) water_.emplace(model, 0, activity.group, activity.dof_map, nullptr);
  }

  double at(int element, int point, const Vector2& place) const {
    if (stated_ != nullptr && stated_->kind == InitialKind::uniform) return stated_->value[1];
    const double u = water_ ? water_->at_point(static_cast<std::size_t>(group_), element, point) : 0.0;
    if (stated_ == nullptr) return above_->above(place).stress - u;
    const auto& v = stated_->value;
    if (stated_->kind == InitialKind::at_rest) return v[3] + above_->above(place).stress - u;
    return v[3] + v[1] * (v[0] - place.y()) - u;
  }

 private:
  int group_;
  const InitialStress* stated_ = nullptr;
  std::optional<Overburden> above_;
  std::optional<PorePressure> water_;
};

// What a field adds to its parameter at a level and a stress.
double growth_at(const InitialStress& field, double y, double stress) {
  return field.value[2] * std::max(0.0, field.value[1] - y) + field.value[3] * std::max(0.0, stress);
}

bool wants_stress(const InitialStress* field) {
  return field->value[3] != 0.0;
}

// The laws of a group's twin material, and which of them its points have.
class TableMaker {
 public:
  TableMaker(const Builder& b, const Group& group, Material& twin)
      : model_(b.model), options_(b.options), group_(group), twin_(twin) {}

  LawChoice choice_of(const Phase& phase) {
    LawChoice choice{phase.stage, phase.anew, {}, phase.where};
    const Material& material = model_.materials[phase.material];
    const auto placed = placed_in(options_, material);
    if (phase.fields.empty() && placed.empty()) {
      choice.of_point = {place(material, material.parameters, phase.held)};
      return choice;
    }
    std::optional<GroundStress> ground;
    if (std::ranges::any_of(phase.fields, wants_stress))
      ground.emplace(model_, static_cast<int>(&group_ - model_.groups.data()));
    Eigen::Matrix2Xd x;
    for (int e = 0; e < group_.elements(); ++e) {
      element_coordinates(model_.mesh, group_, e, x);
      for (int p = 0; p < group_.element->traits().points; ++p) {
        std::vector<double> parameters = material.parameters;
        const Vector2 at = group_.element->position(x, p);
        for (const auto& [index, one] : placed) parameters[index] = one->value(at);
        const double stress = ground ? ground->at(e, p, at) : 0.0;
        for (const InitialStress* field : phase.fields)
          parameters[static_cast<std::size_t>(field->value[0]) - 1] += growth_at(*field, at.y(), stress);
        choice.of_point.push_back(place(material, parameters, phase.held));
      }
    }
    return choice;
  }

 private:
  int place(const Material& material, const std::vector<double>& parameters, bool held) {
    const Key key{material.number, held, parameters};
    const auto [at, added] = places_.try_emplace(key, static_cast<int>(twin_.variants.size()));
    if (added) twin_.variants.push_back({material.entry, parameters, material.name, held});
    return at->second;
  }

  using Key = std::tuple<int, bool, std::vector<double>>;

  const Model& model_;
  const BuildOptions& options_;
  const Group& group_;
  Material& twin_;
  std::map<Key, int> places_;
};

void make_table(Builder& b, int g, const std::vector<Phase>& phases) {
  Model& model = b.model;
  Group& group = model.groups[g];
  const Material& own = model.material_of(group);
  if (own.entry->own_start && own.entry->own_start(own.parameters, own.name).at)
    return b.error("S611", phases.back().where,
                   group_name(group) +
                       ": the routine of its material states its first values, and so its law can't "
                       "differ by point or stage");
  const bool placed = std::ranges::any_of(phases, [&](const Phase& phase) {
    return !placed_in(b.options, model.materials[phase.material]).empty();
  });
  if (placed && (group.flow() || !(group.solid() || group.interface() || group.entry->law_size == 1)))
    return b.error(
        "S617", b.at_line(0),
        group_name(group) +
            ": parameters that differ from place to place are for solids, interfaces and bars; it is of " +
            group.entry->name);
  Material twin = twin_of(model.material_of(group), model.units);
  twin.twin = true;
  TableMaker maker(b, group, twin);
  for (const Phase& phase : phases) group.choices.push_back(maker.choice_of(phase));
  try {
    twin.law = make_law(twin, model.units);
  } catch (const ParameterError& error) {
    const auto& rows = twin.entry->parameters;
    const auto at = static_cast<std::size_t>(std::max(0, error.parameter()));
    const bool known = error.parameter() >= 0 && at < rows.size();
    b.error("S611", phases.back().where.file.empty() ? b.at_line(0) : phases.back().where,
            group_name(group) + ": somewhere in it the law can't have such parameters: " + error.what() +
                (known ? " [" + rows[at].name + "]" : ""));
    return;
  }
  group.material = static_cast<int>(model.materials.size());
  if (twin.undrained) group.excess = static_cast<int>(history_of(twin.law_ref()).size() - UndrainedLaw::kOwn);
  model.materials.push_back(std::move(twin));
}

// A bar whose force is held has no stiffness: nothing else holds a node between two of them.
void check_held_nodes(Builder& b, const Activity& activity, const std::vector<const InitialStress*>& cards) {
  const Model& model = b.model;
  std::set<int> held_groups;
  for (const InitialStress* card : cards) held_groups.insert(card->group);
  std::vector<char> borne(static_cast<std::size_t>(model.mesh.nodes()), 0);
  for (std::size_t g = 0; g < model.groups.size(); ++g)
    if (activity.group[g] && !held_groups.contains(static_cast<int>(g)))
      for (const int node : model.groups[g].nodes) borne[node] = 1;
  for (const InitialStress* card : cards)
    for (const int node : model.groups[card->group].nodes) {
      const auto dof = static_cast<std::size_t>(DofMap::displacement(node));
      if (borne[node] || (activity.held[dof] && activity.held[dof + 1])) continue;
      b.error("S613", card->where,
              "node " + std::to_string(model.mesh.number[node]) +
                  " is held by nothing while the force of its bars is: in the stage of lock-off a bar has no "
                  "stiffness; support the node, or make the free length one element");
      return;
    }
}

// Groups that are there when their law changes.
void check_present(Builder& b, const Activity& activity, const Stage& now) {
  for (const InitialStress& initial : now.initials) {
    if (!changes_law(initial)) continue;
    const Group& group = b.model.groups[initial.group];
    if (!activity.group[initial.group])
      b.error("S614", initial.where,
              group_name(group) + " is not there in stage " + std::to_string(now.number) +
                  ": its law can't change");
  }
}

// Stress or history that a card states for a group whose law has changed before.
void check_stated_later(Builder& b) {
  std::map<int, int> changed;  // group, number of the stage
  for (const Stage& stage : b.model.stages) {
    for (const InitialStress& initial : stage.initials) {
      if (initial.kind == InitialKind::material) changed.try_emplace(initial.group, stage.number);
      if (!changes_law(initial) && changed.contains(initial.group))
        b.error("S614", initial.where,
                group_name(b.model.groups[initial.group]) + " goes on with another material from stage " +
                    std::to_string(changed.at(initial.group)) +
                    " on with the stress that it has: no card states another");
    }
  }
}

void warn_of_weights(Builder& b) {
  for (const Stage& stage : b.model.stages)
    for (const InitialStress& initial : stage.initials) {
      if (initial.kind != InitialKind::material) continue;
      const Group& group = b.model.groups[initial.group];
      const int place = place_of_material(b.model, static_cast<int>(initial.value[0]));
      const double before = b.model.material_of(group).unit_weight,
                   after = b.model.materials[place].unit_weight;
      if (before != after)
        b.warning("S615", initial.where,
                  group_name(group) + " keeps its unit weight, " + rounded_text(before) + ", and not the " +
                      rounded_text(after) + " of material " +
                      std::to_string(static_cast<int>(initial.value[0])) + ", with which it goes on");
    }
}

bool refuse(Builder& b, const SourcePosition& where, const std::string& words, Code code = "S614") {
  b.error(code, where, words);
  return false;
}

// The material that a group has where a card stands; before: cards of the same stage that stand before it.
const Material& material_here(const Builder& b, const InitialStress& initial,
                              const std::vector<InitialStress>& before) {
  const auto change_in = [&](const std::vector<InitialStress>& list) -> const Material* {
    const Material* found = nullptr;
    for (const InitialStress& one : list)
      if (one.kind == InitialKind::material && one.group == initial.group)
        found = &b.model.materials[place_of_material(b.model, static_cast<int>(one.value[0]))];
    return found;
  };
  if (const Material* found = change_in(before)) return *found;
  for (auto stage = b.model.stages.rbegin(); stage != b.model.stages.rend(); ++stage)
    if (const Material* found = change_in(stage->initials)) return *found;
  return b.model.material_of(b.model.groups[initial.group]);
}

bool read_material(Builder& b, const CardView& card, const Group& group, InitialStress& initial) {
  const char* const field = card.blank("material") ? "v1" : "material";
  const int number = card.integer(field);
  initial.value[0] = number;
  const int place = place_of_material(b.model, number);
  const MaterialEntry* law = place < 0 ? nullptr : b.model.materials[place].entry.get();
  if (law == nullptr)
    return refuse(b, card.where(field),
                  "material " + std::to_string(number) + " is not defined by any material card", "S204");
  const MaterialEntry& own = *b.model.material_of(group).entry;
  if (law->law_size == own.law_size && law->flow == own.flow && law->of_pores == own.of_pores && !own.flow)
    return true;
  return refuse(b, card.where(field),
                group_name(group) + ", whose law is " + own.name + ", can't go on with material " +
                    std::to_string(number) + " (" + law->name + ")",
                "S225");
}

bool read_parameter(Builder& b, const CardView& card, const Group& group, InitialStress& initial,
                    const std::vector<InitialStress>& before) {
  const Material& material = material_here(b, initial, before);
  const bool named = !card.blank("parameter");
  const std::string name = named ? b.text(card, "parameter") : rounded_text(initial.value[0]);
  if (named) initial.value[0] = material.entry->find(name) + 1;
  const double number = initial.value[0];
  const auto& rows = material.entry->parameters;
  const bool known = number >= 1.0 && number <= static_cast<double>(material.parameters.size()) &&
                     number == std::floor(number);
  std::string all;
  for (std::size_t i = 0; i < rows.size(); ++i)
    all += (i > 0 ? ", " : "") + std::to_string(i + 1) + " " + rows[i].name;
  if (!known)
    return refuse(
        b, card.where(named ? "parameter" : "v1"),
        group_name(group) + ": " + material.law_name + " has no parameter " + name + "; known: " + all);
  if (initial.value[2] == 0.0 && initial.value[3] == 0.0)
    return refuse(
        b, card.where("v3"),
        "the parameter grows by nothing: kind 7 needs value 3, its growth with depth, or value 4, its "
        "growth with the effective vertical stress");
  if (initial.value[3] != 0.0 && !group.solid())
    return refuse(b, card.where("v4"),
                  group_name(group) + " is no solid: its parameters can't grow with the stress of the ground");
  if (group.solid() || group.interface() || group.entry->law_size == 1) return true;
  return refuse(b, card.where("kind"),
                "kind 7 (a parameter that grows) is for solids, interfaces and bars; " + group_name(group) +
                    " is of " + group.entry->name);
}

}  // namespace

bool read_law_card(Builder& b, const CardView& card, bool in_stage, InitialStress& initial,
                   const std::vector<InitialStress>& before) {
  const Group& group = b.model.groups[initial.group];
  if (!group.element || !b.materials_known) return false;
  if (group.flow())
    return refuse(b, card.where("group"),
                  group_name(group) + " holds elements of flow: their law can't change");
  if (initial.kind == InitialKind::parameter) return read_parameter(b, card, group, initial, before);
  if (!in_stage)
    return refuse(b, card.where("kind"),
                  "a lock-off (kind 5) or another material (kind 6) belongs on an initial card of a stage");
  if (initial.kind == InitialKind::material) return read_material(b, card, group, initial);
  if (card.blank("v1"))
    return refuse(b, card.where("v1"), "a lock-off (kind 5) needs its force, value 1; compression is positive");
  if (group.structure() && group.entry->law_size == 1) return true;
  return refuse(
      b, card.where("kind"),
      "kind 5 (lock-off) is for bars and springs; " + group_name(group) + " is of " + group.entry->name);
}

void build_laws(Builder& b) {
  const Model& model = b.model;
  if (b.options.placed.empty() && std::ranges::none_of(model.initials, changes_law) &&
      std::ranges::none_of(model.stages,
                           [](const Stage& stage) { return std::ranges::any_of(stage.initials, changes_law); }))
    return;
  const int before = b.problems.errors();
  Activity activity(model);
  for (const Stage& stage : model.stages) {
    activity.enter(stage);
    check_present(b, activity, stage);
    std::vector<const InitialStress*> locks;
    for (const InitialStress& initial : stage.initials)
      if (initial.kind == InitialKind::lock_off) locks.push_back(&initial);
    if (!locks.empty()) check_held_nodes(b, activity, locks);
  }
  check_stated_later(b);
  warn_of_weights(b);
  if (b.problems.errors() > before) return;
  for (std::size_t g = 0; g < b.model.groups.size(); ++g)
    if (const std::vector<Phase> phases = phases_of(b.model, static_cast<int>(g)); !is_plain(b, phases))
      make_table(b, static_cast<int>(g), phases);
}

}  // namespace sage::builder
