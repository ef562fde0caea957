#include "sage/model/partial_factors.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include "sage/messages/parse_number.hpp"
#include "sage/messages/split_at.hpp"
#include "sage/model/law_table.hpp"
#include "sage/model/strength.hpp"

namespace sage {

namespace {

// Without blanks at both ends.
std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string_view::npos ? std::string_view()
                                         : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

// Shortest digits that give the same number back, or so many significant ones.
std::string digits_of(double value, int digits = 0) {
  std::array<char, 40> text{};
  char* const end = text.data() + text.size();
  const auto done = digits == 0 ? std::to_chars(text.data(), end, value)
                                : std::to_chars(text.data(), end, value, std::chars_format::general, digits);
  return {text.data(), done.ptr};
}

struct FactorKey {
  std::string_view name;
  double PartialFactors::*value;
};
constexpr std::array<FactorKey, 9> kFactorKeys{{{"permanent", &PartialFactors::permanent},
                                                {"variable", &PartialFactors::variable},
                                                {"structural_permanent", &PartialFactors::structural_permanent},
                                                {"structural_variable", &PartialFactors::structural_variable},
                                                {"effects", &PartialFactors::effects},
                                                {"friction", &PartialFactors::friction},
                                                {"cohesion", &PartialFactors::cohesion},
                                                {"undrained", &PartialFactors::undrained},
                                                {"resistance", &PartialFactors::resistance}}};

// EN 1997-1:2004, tables A.3, A.4, A.13 and A.14.  Where A1 applies to effects, permanent actions keep their value, variable
// ones get 1.5/1.35, and effects 1.35.
const std::vector<PartialFactors>& known_sets() {
  constexpr double kA1 = 1.35, kRatio = 1.5 / 1.35;
  static const std::vector<PartialFactors> list{
      {.name = "DA1-1", .variable = kRatio, .structural_variable = kRatio, .effects = kA1},
      {.name = "DA1-2",
       .variable = 1.3,
       .structural_variable = 1.3,
       .friction = 1.25,
       .cohesion = 1.25,
       .undrained = 1.4},
      {.name = "DA2*", .variable = kRatio, .structural_variable = kRatio, .effects = kA1, .resistance = 1.1},
      {.name = "DA3",
       .variable = 1.3,
       .structural_permanent = kA1,
       .structural_variable = 1.5,
       .friction = 1.25,
       .cohesion = 1.25,
       .undrained = 1.4},
      {.name = "characteristic"}};
  return list;
}

PartialFactors known_set(std::string_view name, bool own) {
  const auto found = std::ranges::find(known_sets(), name, &PartialFactors::name);
  if (found != known_sets().end()) return *found;
  if (!own)
    throw std::invalid_argument("there is no set of factors '" + std::string(name) + "'; known are " +
                                names_of_factor_sets() + ", or NAME:friction=1.25,...");
  PartialFactors set;
  set.name = std::string(name);
  return set;
}

void set_factor(PartialFactors& set, std::string_view part) {
  const std::size_t equals = part.find('=');
  const std::string_view name = part.substr(0, equals);
  const auto* const key = std::ranges::find(kFactorKeys, name, &FactorKey::name);
  std::string known;
  for (const FactorKey& one : kFactorKeys) known += (known.empty() ? "" : ", ") + std::string(one.name);
  if (key == kFactorKeys.end() || equals == std::string_view::npos)
    throw std::invalid_argument("'" + std::string(part) +
                                "' is no factor; KEY=VALUE was expected, with one of " + known);
  const std::string_view digits = part.substr(equals + 1);
  const std::optional<double> value = parse_number<double>(digits);
  const bool action = name == "permanent" || name.ends_with("variable") || name == "structural_permanent";
  if (!value || !(*value <= 100.0) || !(action ? *value >= 0.0 : *value >= 0.01))
    throw std::invalid_argument("'" + std::string(part) + "': a number from " + (action ? "0" : "0.01") +
                                " to 100 was expected");
  set.*key->value = *value;
}

// Strengths of soil and interfaces.
bool factor_strength(Material& material, const PartialFactors& set) {
  const StrengthFactors factors{set.friction, set.cohesion, set.undrained};
  const auto divide = [&](std::vector<double>& parameters, const MaterialEntry& entry) {
    return is_soil_or_joint(entry) && divide_strength(parameters, entry, factors);
  };
  bool any = divide(material.parameters, *material.entry);
  for (LawVariant& one : material.variants) any = divide(one.parameters, *one.entry) || any;
  return any;
}

bool divides_strength(const PartialFactors& set) {
  return set.friction != 1.0 || set.cohesion != 1.0 || set.undrained != 1.0;
}

// An elastic law has no strength.  Interface laws that name none (goodman) have none either: they only open.
bool keeps_strength(const Material& material) {
  return part_of(*material.entry) == ModelPart::soil && !has_strength(material) &&
         !has_constant_stiffness(material.law_ref());
}

std::string numbered(int number, const std::string& name) {
  return std::to_string(number) + (name.empty() ? "" : " " + name);
}

bool among(const std::vector<int>& stages, std::size_t stage) {
  return std::ranges::find(stages, static_cast<int>(stage) + 1) != stages.end();
}

std::string list_of(const std::vector<int>& numbers) {
  std::string text;
  for (const int one : numbers) text += (text.empty() ? "" : ", ") + std::to_string(one);
  return text;
}

}  // namespace

std::vector<PartialFactors> partial_factors(std::string_view text) {
  std::vector<PartialFactors> sets;
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) {
    for (const std::string_view name : split_at(',', text))
      sets.push_back(known_set(without_blanks(name), false));
    return sets;
  }
  const std::string_view name = without_blanks(text.substr(0, colon));
  if (name.empty() || name.find_first_of("/\\") != std::string_view::npos)
    throw std::invalid_argument("a set of factors needs a name without slashes, as in NAME:friction=1.25");
  sets.push_back(known_set(name, true));
  for (const std::string_view part : split_at(',', text.substr(colon + 1)))
    set_factor(sets.back(), without_blanks(part));
  return sets;
}

std::string text_of(const PartialFactors& set) {
  std::string text = set.name;
  for (const FactorKey& key : kFactorKeys)
    text +=
        (text.size() == set.name.size() ? ":" : ",") + std::string(key.name) + "=" + digits_of(set.*key.value);
  return text;
}

std::string factor_word(const PartialFactors& set) {
  std::string word;
  for (const char c : set.name) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.';
    word += plain ? std::string(1, c) : c == '*' ? "star" : "_";
  }
  return word;
}

std::string names_of_factor_sets() {
  std::string text;
  for (const PartialFactors& set : known_sets()) text += (text.empty() ? "" : ", ") + set.name;
  return text;
}

std::string apply_factors(Model& model, const PartialFactors& set, const ActionStages& stages) {
  for (std::size_t s = 0; s < model.stages.size(); ++s) {
    Stage& stage = model.stages[s];
    const bool variable = among(stages.variable, s), structural = among(stages.structural, s);
    const double factor = structural ? (variable ? set.structural_variable : set.structural_permanent)
                                     : (variable ? set.variable : set.permanent);
    stage.gravity *= set.permanent;
    for (NodalLoad& load : stage.loads) load.force *= factor;
    for (EdgeLoad& load : stage.pressures) load.normal *= factor, load.shear *= factor;
  }
  const bool weaker = divides_strength(set);
  if (weaker)
    for (Material& material : model.materials)
      if (factor_strength(material, set)) material.law = make_law(material, model.units);
  const auto number = [](double value) { return digits_of(value, 5); };
  std::string text = "factors " + set.name + ": permanent actions x " + number(set.permanent) +
                     ", variable x " + number(set.variable);
  if (!stages.structural.empty())
    text +=
        ", of structures x " + number(set.structural_permanent) + " and x " + number(set.structural_variable);
  text += stages.variable.empty() ? "; no stage is variable"
                                  : "; variable are the loads of stage(s) " + list_of(stages.variable);
  if (weaker)
    text += "; tan(phi) / " + number(set.friction) + ", c / " + number(set.cohesion) + ", c_u / " +
            number(set.undrained);
  return text;
}

std::vector<std::string> undivided_materials(const Model& model, const PartialFactors& set) {
  std::vector<std::string> list;
  if (!divides_strength(set)) return list;
  for (std::size_t m = 0; m < model.materials.size(); ++m) {
    const Material& material = model.materials[m];
    if (!keeps_strength(material)) continue;
    std::string groups;
    for (const Group& group : model.groups)
      if (group.material == static_cast<int>(m))
        groups += (groups.empty() ? " of group " : ", ") + numbered(group.number, group.name);
    if (!groups.empty())
      list.push_back(numbered(material.number, material.name) + " (" + material.law_name + ")" + groups);
  }
  return list;
}

}  // namespace sage
