// Large strain: the elements of every group, and what decks have that it can't be with.
#include <algorithm>

#include "sage/builder/builder.hpp"
#include "sage/core/contact.hpp"
#include "sage/core/elastic_shear.hpp"

namespace sage::builder {

namespace {

std::string group_of(const Group& group) {
  return "large strain: group " + std::to_string(group.number);
}

// "quad4, quad8, ...": the elements that have it.
std::string large_elements(const Catalogue& catalogue) {
  std::string text;
  for (const auto& [code, entry] : catalogue.elements.entries())
    if (entry.make_large) text += (text.empty() ? "" : ", ") + entry.name;
  return text.empty() ? "none" : text;
}

std::string large_formulations(const ElementEntry& entry, Geometry geometry) {
  std::string text;
  for (const Formulation& f : entry.formulations)
    if (entry.make_large(geometry, f.code) != nullptr)
      text += (text.empty() ? "" : ", ") + std::to_string(f.code) + " " + f.name;
  return text;
}

void take_element(Builder& b, Group& group) {
  const ElementEntry& entry = *group.entry;
  if (!entry.make_large)
    return b.error(
        "S551", group.where,
        group_of(group) + " is of " + entry.name +
            ", which is for small strain alone; elements for large strain: " + large_elements(b.catalogue));
  std::unique_ptr<Element> element = entry.make_large(b.model.geometry, group.formulation);
  if (element == nullptr)
    return b.error("S551", group.where,
                   group_of(group) + ": " + group.element_name +
                       " is for small strain alone; formulations of " + entry.name +
                       " for large strain: " + large_formulations(entry, b.model.geometry));
  group.element = std::move(element);
  group.element_name += ", large strain";
}

// Why the law can't be reused; empty where it can.
std::string objection(const Model& model, const Group& group) {
  const Material& material = model.material_of(group);
  if (material.undrained) return "stands in undrained ground";
  if (!group.choices.empty() || !material.variants.empty())
    return "changes from point to point or from stage to stage";
  if (group.interface()) return {};  // slip and gap are no strains
  const LawRef law = material.law_ref();
  const auto* const solid = std::get_if<const SolidLaw*>(&law);
  if (solid != nullptr && dynamic_cast<const ElasticShear*>(*solid) != nullptr) return {};
  return "has no elastic logarithmic strain";
}

void check_law(Builder& b, const Group& group) {
  const std::string reason = objection(b.model, group);
  if (reason.empty()) return;
  const Material& material = b.model.material_of(group);
  b.error("S552", material.where,
          group_of(group) + " has the law " + material.law_name + " (material " +
              std::to_string(material.number) + "), which " + reason +
              "; expected an isotropic law with elastic strains, for instance linear_elastic, drucker_prager, "
              "mohr_coulomb or modified_cam_clay");
}

// Water and displacements that begin anew.
void check_parts(Builder& b) {
  const auto refuse = [&](const SourcePosition& where, const std::string& what) {
    b.error("S553", where, "large strain: " + what);
  };
  for (const WaterCard& card : b.model.water) {
    refuse(card.where, "water cards are for small strain alone; expected a model without pore water");
    break;
  }
  for (const Stage& stage : b.model.stages)
    if (stage.resets_displacements)
      refuse(stage.where, "stage " + std::to_string(stage.number) +
                              " sets displacements to zero, but the elements stand where their displacements "
                              "have led them; expected a stage whose displacements go on");
}

bool has_stress(const std::vector<InitialStress>& initials) {
  return std::ranges::any_of(initials, [](const InitialStress& one) { return states_stress(one.kind); });
}

// An initial stress is balanced at first by forces that do not turn, which the stage lets go.
void warn_of_first_pressures(Builder& b) {
  for (std::size_t s = 0; s < b.model.stages.size(); ++s) {
    const Stage& stage = b.model.stages[s];
    const bool begins = (s == 0 && has_stress(b.model.initials)) || has_stress(stage.initials);
    if (!begins || stage.pressures.empty() || !stage.moves_supports()) continue;
    b.warning(
        "S558", stage.where,
        "stage " + std::to_string(stage.number) +
            " puts up the pressures that balance an initial stress, and moves supports: until its end a part "
            "of "
            "the initial stress is borne by forces that do not follow the edges; expected the pressures in a "
            "stage of their own, and the motion behind it");
  }
}

// At small strain bodies do not know where they are.
void refuse_contact(Builder& b) {
  for (const Group& group : b.model.groups)
    if (is_contact(*group.entry))
      b.error(
          "S556", group.where,
          "group " + std::to_string(group.number) + " is of " + group.entry->name +
              ", contact of a moved edge, which needs large strain; expected strain = \"large\" (a 1 in the "
              "field strain of the control card), or an interface");
}

}  // namespace

void take_large_strain(Builder& b) {
  if (!b.model.large_strain) return refuse_contact(b);
  check_parts(b);
  for (Group& group : b.model.groups) {
    const int before = b.problems.errors();
    take_element(b, group);
    if (b.problems.errors() == before) check_law(b, group);
  }
  if (b.problems.errors() > 0) return;
  warn_of_first_pressures(b);
  b.note(
      "S554", b.deck.one("control").where("strain"),
      "large strain: stresses are Cauchy stresses (force over present area), strains are logarithmic strains "
      "of the left stretch; pressures follow the motion, forces, weights and displacements do not turn");
}

}  // namespace sage::builder
