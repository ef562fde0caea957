// Strength reduction of a material: c / F, tan(phi) / F.  What of a law is strength its catalogue entry says, by the
// roles of its parameters; so laws of other programs and plug-ins take part like those of this tree.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "sage/model/model.hpp"

namespace sage {

// Parts of a model whose strengths are divided together.
enum class ModelPart { soil, joints, anchors, walls };

struct PartName {
  ModelPart part;
  std::string_view name, divided;
};
inline constexpr PartName kParts[] = {
    {ModelPart::soil, "soil", "c, tan(phi) and tension limits of solids"},
    {ModelPart::joints, "joints", "c, tan(phi) and tension limits of interfaces"},
    {ModelPart::anchors, "anchors", "tension and compression of bars and springs"},
    {ModelPart::walls, "walls", "M_p and N_p of beams"},
};
std::string_view name_of(ModelPart part);

// To which part elements with this law, or those of a group, belong; nothing: they are of water.
std::optional<ModelPart> part_of(const MaterialEntry& entry);
std::optional<ModelPart> part_of(const Group& group);
// Soil and joints, whose strengths the factors of a deck's own divide.
bool is_soil_or_joint(const MaterialEntry& entry);

// What becomes of the dilation angle.
enum class DilationRule {
  reduced,  // tan(psi) / F: flow that is associated stays so
  kept,     // stays, but never above the friction angle that is left
  none,     // no volume change, at any factor
};

struct DilationRuleName {
  DilationRule rule;
  std::string_view name, what;
};
inline constexpr DilationRuleName kDilationRules[] = {
    {DilationRule::reduced, "reduced", "tan(psi) / F, like friction"},
    {DilationRule::kept, "kept", "psi stays, at most the friction angle that is left"},
    {DilationRule::none, "none", "psi = 0 at every factor"},
};

struct StrengthReduction {
  double factor = 1.0;
  DilationRule dilation = DilationRule::reduced;
};

// What divides tan(phi), cohesions and tensile strengths, and those of laws without friction.
struct StrengthFactors {
  double friction = 1.0, cohesion = 1.0, undrained = 1.0;
  DilationRule dilation = DilationRule::reduced;
};

// Some parameter of the law is a strength.
bool has_strength(const MaterialEntry& entry);
// Some law that points of the material may have in force has one.
bool has_strength(const Material& material);

// Some material of a solid group has a dilation angle below its friction angle: flow is not associated.
bool has_less_dilation(const Model& model);

// parameters: as the deck writes them, perhaps fewer than the entry has.  Cohesions, tensile strengths, forces and moments
// that a structure carries / F, angles of friction atan(tan(phi) / F), dilation by the rule.  Numbers that are not positive
// (0, or -1 for "none") stay.
// False: the law has no strength, nothing changes.
bool divide_strength(std::span<double> parameters, const MaterialEntry& entry, const StrengthFactors& factors);
bool reduce_strength(std::span<double> parameters, const MaterialEntry& entry,
                     const StrengthReduction& reduction);
// Of every law that points of the material may have in force; the law itself is to be made anew.
bool reduce_strength(Material& material, const StrengthReduction& reduction);

}  // namespace sage
