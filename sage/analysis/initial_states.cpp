#include "sage/analysis/initial_states.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "sage/analysis/step_time.hpp"
#include "sage/core/start_adjustment.hpp"
#include "sage/model/law_table.hpp"
#include "sage/model/spread_loads.hpp"

namespace sage {

namespace {

// Compression-positive vertical and horizontal stress at a level.
Vector4 geostatic_stress(const InitialStress& initial, double y, double u) {
  const double surface = initial.value[0], unit_weight = initial.value[1], K0 = initial.value[2];
  const double vertical = initial.value[3] + unit_weight * (surface - y) - u;
  return {K0 * vertical, vertical, K0 * vertical, 0.0};
}

// The same from the weight above.  K0 = K0nc OCR^sin(phi) (Mayne & Kulhawy 1982) with sin(phi) = 1 - K0nc (Jaky 1944), OCR of
// the effective vertical stress.
Vector4 stress_at_rest(const InitialStress& initial, double weight_above, double u) {
  const double K0nc = initial.value[0], ocr = initial.value[1], pop = initial.value[2];
  const double vertical = initial.value[3] + weight_above - u;
  const double preconsolidation = std::max(ocr * vertical, vertical + pop);
  const double K0 = vertical > 0.0 ? K0nc * std::pow(preconsolidation / vertical, 1.0 - K0nc) : K0nc;
  return {K0 * vertical, vertical, K0 * vertical, 0.0};
}

// Stress of a solid point as the deck states it, turned to tension positive.  u: pore pressure there.  above: known where
// some card needs it.
Vector4 solid_stress(const InitialStress& initial, const Vector2& x, double u, const Overburden* above) {
  switch (initial.kind) {
    case InitialKind::at_rest:
      return -stress_at_rest(initial, above->above(x).stress, u);
    case InitialKind::geostatic:
      return -geostatic_stress(initial, x.y(), u);
    case InitialKind::uniform:
    case InitialKind::traction:
      return -Vector4(initial.value[0], initial.value[1], initial.value[2], initial.value[3]);
    case InitialKind::zero:
    case InitialKind::history:
    case InitialKind::lock_off:
    case InitialKind::material:
    case InitialKind::parameter:
      break;
  }
  return Vector4::Zero();
}

// The initial stress stated for the group (by deck number) whose traction an interface takes.  Of several cards the
// last one stands, as in the group itself; the last are those of the stage that the interface's own card belongs to.
const InitialStress* neighbour_of(const Model& model, const InitialStress& joint) {
  const int number = static_cast<int>(joint.value[0]);
  const InitialStress* found = nullptr;
  const auto look = [&](const std::vector<InitialStress>& list) {
    bool own = false;
    for (const InitialStress& initial : list) {
      own = own || &initial == &joint;
      const Group& group = model.groups[initial.group];
      const bool of_stress = states_stress(initial.kind) || initial.kind == InitialKind::zero;
      if (of_stress && group.number == number && group.solid()) found = &initial;
    }
    return own;
  };
  if (look(model.initials)) return found;
  for (const Stage& stage : model.stages)
    if (look(stage.initials)) break;
  return found;
}

// Shear and normal traction of a solid stress on the interface through nodes 1 and 2; [shear, normal].
Vector2 traction(const Vector4& sigma, const Eigen::Matrix2Xd& x) {
  const Vector2 s = (x.col(1) - x.col(0)).normalized();
  const Vector2 n(-s.y(), s.x());
  Matrix2 S;
  S << sigma[0], sigma[3], sigma[3], sigma[1];
  const Vector2 t = S * n;
  return {t.dot(s), t.dot(n)};
}

// Points of a group that start otherwise than stated.
struct StartCount {
  long refused = 0, adjusted = 0;
};

template <int N>
void start_point(const Law<N>& law, const Vector<N>& sigma, std::size_t point, StateStore& state,
                 StartCount& count) {
  const auto history = static_cast<std::size_t>(state.history_size());
  Vector<N>::Map(state.committed.sigma.data() + point * N) = sigma;
  const bool carried = law.initialise(sigma, {state.committed.h.data() + point * history, history});
  count.refused += carried ? 0 : 1;
  count.adjusted += adjusts_start(law, sigma) ? 1 : 0;
}

// At a point of an element; x: its nodes.  neighbour: whose traction an interface takes.  u: pore pressure.  spacing: of
// bars.
template <int N>
Vector<N> initial_stress(const InitialStress& initial, const InitialStress* neighbour, const Group& group,
                         const Eigen::Matrix2Xd& x, int point, double u, double spacing,
                         const Overburden* above) {
  if constexpr (N == 4)
    if (group.solid()) return solid_stress(initial, group.element->position(x, point), u, above);
  if constexpr (N == 2)
    if (neighbour != nullptr)
      return traction(solid_stress(*neighbour, group.element->position(x, point), u, above), x);
  Vector<N> sigma = Vector<N>::Zero();
  if (initial.kind == InitialKind::uniform)
    for (int i = 0; i < N; ++i) sigma[i] = -initial.value[i];
  if (initial.kind == InitialKind::lock_off) sigma[0] = -initial.value[0] / spacing;
  return sigma;
}

template <int N>
bool start_point_with(const Law<N>& law, const InitialStress& initial, std::size_t point, StateStore& state) {
  const auto history = static_cast<std::size_t>(state.history_size());
  const std::span<const Quantity> quantities = law.traits().history;
  const std::span<double> h(state.committed.h.data() + point * history, quantities.size());
  const auto first = static_cast<std::size_t>(initial.value[0]) - 1;
  for (std::size_t i = 1; i < initial.value.size() && first + i - 1 < quantities.size(); ++i)
    if (!std::isnan(initial.value[i])) h[first + i - 1] = inward(quantities[first + i - 1], initial.value[i]);
  return law.accepts_history(Vector<N>::Map(state.committed.sigma.data() + point * N), h);
}

// What a geostatic card takes from the total stress at a point; of an interface that of its neighbour.
double pressure_at(const Model& model, const PorePressure* water, const GroupData& data,
                   const InitialStress* neighbour, const Eigen::Matrix2Xd& x, int element, int point) {
  if (water == nullptr) return 0.0;
  if (neighbour == nullptr)
    return water->at_point(static_cast<std::size_t>(data.group - model.groups.data()), element, point);
  const auto g = static_cast<std::size_t>(neighbour->group);
  const WaterCard* const card = water->card(g);
  return card != nullptr && card->by_place() ? water->at(g, 0, data.group->element->position(x, point), {})
                                             : 0.0;
}

void report_start(const StartCount& count, const InitialStress& initial, const Group& group, int points,
                  Diagnostics& diagnostics) {
  if (count.refused > 0)
    diagnostics.warning("S520", initial.where,
                        "the initial stress of group " + std::to_string(group.number) +
                            " lies outside the yield surface of its law at " + std::to_string(count.refused) +
                            " point(s); the first increment will shed it");
  if (count.adjusted > 0)
    diagnostics.warning("S585", initial.where,
                        "the initial stress of group " + std::to_string(group.number) +
                            " lies outside the yield surface that its parameters state at " +
                            std::to_string(count.adjusted) + " of " +
                            std::to_string(static_cast<long>(group.elements()) * points) +
                            " point(s); there the surface starts through the stress");
}

}  // namespace

void apply_initial_stress(const Model& model, const InitialStress& initial, const PorePressure* water,
                          const Overburden* above, GroupData& data, Diagnostics& diagnostics) {
  const Group& group = *data.group;
  const ElementTraits& traits = group.element->traits();
  const InitialStress* neighbour =
      initial.kind == InitialKind::traction ? neighbour_of(model, initial) : nullptr;
  if (initial.kind == InitialKind::traction && neighbour == nullptr)
    throw InputError("S236", initial.where,
                     "group " + std::to_string(static_cast<int>(initial.value[0])) +
                         ", whose traction the interface should take, has no initial stress card");
  data.state.make_room();
  const double spacing = spacing_of(data.law);
  Eigen::Matrix2Xd x;
  StartCount count;
  for (int e = 0; e < group.elements(); ++e) {
    element_coordinates(model.mesh, group, e, x);
    for (int p = 0; p < traits.points; ++p) {
      const auto point = static_cast<std::size_t>(e * traits.points + p);
      const double u = pressure_at(model, water, data, neighbour, x, e, p);
      std::visit(
          [&]<int N>(const Law<N>* law) {
            start_point<N>(*law, initial_stress<N>(initial, neighbour, group, x, p, u, spacing, above), point,
                           data.state, count);
          },
          data.law);
    }
  }
  report_start(count, initial, group, traits.points, diagnostics);
}

void apply_initial_history(const Model& model, const InitialStress& initial, GroupData& data) {
  const Group& group = *data.group;
  const ElementTraits& traits = group.element->traits();
  data.state.make_room();
  for (int e = 0; e < group.elements(); ++e)
    for (int p = 0; p < traits.points; ++p) {
      const auto point = static_cast<std::size_t>(e * traits.points + p);
      const bool accepted = std::visit(
          [&](const auto* law) { return start_point_with(*law, initial, point, data.state); }, data.law);
      if (accepted) continue;
      throw InputError("S236", initial.where,
                       "group " + std::to_string(group.number) + ": " + model.material_of(group).law_name +
                           " can't go on from this history at its initial stress, at point " +
                           std::to_string(p + 1) + " of element " + std::to_string(group.element_numbers[e]));
    }
}

namespace {

OwnStart own_start_of(const Model& model, const Group& group) {
  const Material& material = model.material_of(group);
  if (material.entry == nullptr || !material.entry->own_start) return {};
  return material.entry->own_start(material.parameters, material.name);
}

}  // namespace

bool has_own_start(const Model& model) {
  return std::ranges::any_of(
      model.groups, [&](const Group& group) { return static_cast<bool>(own_start_of(model, group).at); });
}

bool has_own_stress(const Model& model, const Group& group) {
  return own_start_of(model, group).stress;
}

void apply_own_starts(const Model& model, std::vector<GroupData>& groups) {
  Eigen::Matrix2Xd x;
  for (GroupData& data : groups) {
    const OwnStart start = own_start_of(model, *data.group);
    if (!start.at) continue;
    data.state.make_room();
    const ElementTraits& traits = data.group->element->traits();
    const auto size = static_cast<std::size_t>(traits.law_size);
    const auto history = static_cast<std::size_t>(data.state.history_size());
    for (int e = 0; e < data.group->elements(); ++e) {
      element_coordinates(model.mesh, *data.group, e, x);
      for (int p = 0; p < traits.points; ++p) {
        const auto point = static_cast<std::size_t>(e * traits.points + p);
        PointStates& states = data.state.committed;
        start.at(context_of(data, e, x, p, {.stage = 1}), {states.sigma.data() + point * size, size},
                 {states.h.data() + point * history, history});
      }
    }
  }
}

namespace {

// Of the active solids, where some card of the model needs it: an interface may take the traction of a group that another card
// speaks of.
std::optional<Overburden> overburden_for(const Model& model, const GroundOfStage& ground) {
  const auto needs = [](const std::vector<InitialStress>& list) {
    return std::ranges::find(list, InitialKind::at_rest, &InitialStress::kind) != list.end();
  };
  const bool any = needs(model.initials) ||
                   std::ranges::any_of(model.stages, [&](const Stage& stage) { return needs(stage.initials); });
  return any ? std::optional<Overburden>(std::in_place, model, ground.active, ground.stage) : std::nullopt;
}

}  // namespace

void apply_initials(const Model& model, const GroundOfStage& ground, const std::vector<InitialStress>& initials,
                    const PorePressure* water, std::vector<GroupData>& groups, Diagnostics& diagnostics) {
  const std::optional<Overburden> above = overburden_for(model, ground);
  for (const InitialStress& initial : initials)
    if (states_stress(initial.kind) || initial.kind == InitialKind::zero)
      apply_initial_stress(model, initial, water, above ? &*above : nullptr, groups[initial.group],
                           diagnostics);
  for (const InitialStress& initial : initials)
    if (initial.kind == InitialKind::history) apply_initial_history(model, initial, groups[initial.group]);
}

namespace {

// Number of points where the law that comes into force can't carry the stress.
long apply_choice(const LawChoice& choice, GroupData& data) {
  data.state.make_room();
  const auto history = static_cast<std::size_t>(data.state.history_size());
  PointStates& states = data.state.committed;
  long refused = 0;
  std::visit(
      [&]<int N>(const Law<N>* law) {
        const auto* const table = dynamic_cast<const ChoosesLaw<N>*>(law);
        for (std::size_t p = 0; table != nullptr && p < states.status.size(); ++p) {
          const int number = choice.of_point[choice.of_point.size() == 1 ? 0 : p];
          const bool carried =
              table->choose(number, choice.anew, Eigen::Map<const Vector<N>>(states.sigma.data() + p * N),
                            {states.h.data() + p * history, history});
          refused += carried ? 0 : 1;
        }
      },
      data.law);
  return refused;
}

}  // namespace

bool chooses_laws(const Model& model, int stage) {
  return std::ranges::any_of(model.groups, [&](const Group& group) {
    return std::ranges::find(group.choices, stage, &LawChoice::stage) != group.choices.end();
  });
}

void apply_law_choices(const Model& model, int stage, std::vector<GroupData>& groups,
                       Diagnostics& diagnostics) {
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (const LawChoice& choice : model.groups[g].choices) {
      if (choice.stage != stage) continue;
      const long refused = apply_choice(choice, groups[g]);
      if (refused > 0)
        diagnostics.warning(
            "S612", choice.where,
            "group " + std::to_string(model.groups[g].number) + ": at " + std::to_string(refused) + " of " +
                std::to_string(groups[g].state.committed.status.size()) +
                " point(s) the stress lies outside the yield surface of the law that comes into "
                "force; it returns to that surface, and the stage lets go what this leaves");
    }
}

namespace {

bool changes_drainage(const WaterCard& card, int stage) {
  return card.stage == stage && !card.pressure();
}

void take_drainage(const WaterCard& card, GroupData& data) {
  const Group& group = *data.group;
  if (group.excess < 0) return;
  data.state.make_room();
  const auto history = static_cast<std::size_t>(data.state.history_size());
  const std::size_t points = static_cast<std::size_t>(group.elements() * group.element->traits().points);
  for (std::size_t p = 0; p < points; ++p) {
    double* const own = data.state.committed.h.data() + p * history + group.excess;
    own[1] = card.kind == WaterKind::undrained ? card.value : 0.0;
    own[2] = 0.0;
    if (card.kind == WaterKind::undrained) continue;
    for (std::size_t c = 0; c < 3; ++c) data.state.committed.sigma[4 * p + c] += own[0];
    own[0] = 0.0;
  }
}

}  // namespace

bool changes_drainage(const Model& model, int stage) {
  return std::ranges::any_of(model.water, [&](const WaterCard& card) { return changes_drainage(card, stage); });
}

void apply_drainage(const Model& model, int stage, std::vector<GroupData>& groups) {
  for (const WaterCard& card : model.water)
    if (changes_drainage(card, stage))
      for (std::size_t g = 0; g < groups.size(); ++g)
        if (card.group < 0 || card.group == static_cast<int>(g)) take_drainage(card, groups[g]);
}

}  // namespace sage
