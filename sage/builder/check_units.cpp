// Units that do not belong together, and numbers that no soil has in the deck's units: likely a value in another
// unit.  Warnings and notes only.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "sage/builder/builder.hpp"
#include "sage/deck/text.hpp"

namespace sage::builder {

namespace {

struct NamedUnit {
  const char* name;
  double si;  // in m, N, Pa
};

constexpr NamedUnit kLengths[] = {{"m", 1.0},     {"cm", 0.01},   {"mm", 0.001},
                                  {"km", 1000.0}, {"in", 0.0254}, {"ft", 0.3048}};
constexpr NamedUnit kForces[] = {{"n", 1.0},        {"kn", 1e3},        {"mn", 1e6},      {"lbf", 4.4482216},
                                 {"lb", 4.4482216}, {"kip", 4448.2216}, {"kgf", 9.80665}, {"tf", 9806.65}};
constexpr NamedUnit kStresses[] = {{"pa", 1.0},        {"kpa", 1e3},       {"mpa", 1e6},
                                   {"kn/m2", 1e3},     {"n/mm2", 1e6},     {"psi", 6894.7573},
                                   {"psf", 47.880259}, {"ksf", 47880.259}, {"ksi", 6894757.3},
                                   {"bar", 1e5},       {"tsf", 95760.518}, {"kgf/cm2", 98066.5}};
constexpr double kAtmosphere = 101325.0, kWater = 9806.65;

// 0 = a unit that isn't known here.
template <std::size_t n>
double si(const NamedUnit (&units)[n], const std::string& name) {
  const std::string lower = lower_case(name);
  for (const NamedUnit& unit : units)
    if (lower == unit.name) return unit.si;
  return 0.0;
}

// The atmosphere and water are the same everywhere: a deck of known units can be checked.
void check_units_card(Builder& b) {
  if (!b.deck.has("units")) return;
  const CardView card = b.deck.one("units");
  const UnitSystem& units = b.model.units;
  const double length = si(kLengths, units.length), force = si(kForces, units.force);
  const double stress = si(kStresses, units.stress);
  const auto check = [&](const char* field, double given, double unit, double right, const std::string& name) {
    if (given == 0.0 || unit == 0.0 || std::abs(given * unit / right - 1.0) < 0.1) return;
    b.warning("S301", card.where(field),
              "the " + card.label(field) + " is " + rounded_text(given) + "; in these units it is about " +
                  rounded_text(right / unit) + " " + name);
  };
  check("atmospheric_pressure", units.atmospheric_pressure, stress, kAtmosphere, units.stress);
  check("water_unit_weight", units.water_unit_weight, length > 0.0 ? force / (length * length * length) : 0.0,
        kWater, unit_text(Dimension::unit_weight, units));
  if (stress > 0.0 && force > 0.0 && length > 0.0) {
    const double ratio = stress / (force / (length * length));
    if (std::abs(ratio - 1.0) > 0.01)
      b.warning("S302", card.where("stress"),
                "1 " + units.stress + " is " + rounded_text(ratio) + " " + units.force + "/" + units.length +
                    "^2: forces, lengths and stresses of a deck must belong together");
  }
}

// The atmosphere and the weight of water in the deck's units: as its card states them, else from the names of the
// units; 0 = unknown.
struct Scale {
  double atmosphere = 0.0;  // stress
  double water = 0.0;       // force/length^3
};

Scale scale_of(const UnitSystem& units) {
  Scale scale{units.atmospheric_pressure, units.water_unit_weight};
  const double length = si(kLengths, units.length), force = si(kForces, units.force);
  const double stress = si(kStresses, units.stress);
  if (scale.atmosphere == 0.0 && stress > 0.0) scale.atmosphere = kAtmosphere / stress;
  if (scale.water == 0.0 && length > 0.0 && force > 0.0)
    scale.water = kWater * length * length * length / force;
  return scale;
}

// A unit by what it makes of a known quantity: the density or weight of water, or the atmosphere.
struct OtherUnit {
  const char* name;
  double known;
  bool metric;
};

constexpr OtherUnit kWeights[] = {
    {"kg/m^3", 1000.0, true},    {"t/m^3", 1.0, true},      {"N/m^3", kWater, true},
    {"kN/m^3", 9.80665, true},   {"lb/ft^3", 62.43, false}, {"kip/ft^3", 0.06243, false},
    {"lb/in^3", 0.03613, false},
};
constexpr OtherUnit kPressures[] = {
    {"Pa", kAtmosphere, true}, {"kPa", 101.325, true}, {"MPa", 0.101325, true}, {"psi", 14.696, false},
    {"psf", 2116.2, false},    {"ksf", 2.1162, false}, {"tsf", 1.0581, false},
};

struct Span {
  double low, high;  // multiples of the known quantity
  bool holds(double ratio) const { return ratio >= low && ratio <= high; }
};

// The unit in which `value` is a usual one; nullptr = none.  Those of the deck's own system come first.
const OtherUnit* likely_unit(std::span<const OtherUnit> units, double value, double own, Span usual) {
  constexpr double kFactor = 2.0;  // nearer ones are the deck's own unit
  const double decade = std::log10(own / (units.data() == kWeights ? 9.80665 : 1.01325));
  const bool metric = std::abs(decade - std::round(decade)) < 0.01;
  for (const bool system : {metric, !metric})
    for (const OtherUnit& unit : units) {
      const double apart = std::abs(std::log(unit.known / own));
      if (unit.metric == system && apart > std::log(kFactor) && usual.holds(value / unit.known)) return &unit;
    }
  return nullptr;
}

// ": is it in kg/m^3? 1900 kg/m^3 are 18.6 kN/m^3".
std::string unit_question(std::span<const OtherUnit> units, double value, double own, Span usual,
                          const std::string& own_name) {
  const OtherUnit* unit = likely_unit(units, value, own, usual);
  if (unit == nullptr) return {};
  const std::string number = rounded_text(value);
  return ": is it in " + std::string(unit->name) + "? " + number + " " + unit->name + " are " +
         rounded_text(value / unit->known * own, 3) + (own_name == "-" ? "" : " " + own_name);
}

bool is_ground(const Material& material) {
  return material.entry != nullptr && material.entry->for_solids() &&
         (material.parameter(ParameterRole::strength) || material.parameter(ParameterRole::friction_angle));
}

double largest_gravity(const Model& model) {
  Vector2 total = Vector2::Zero();
  double largest = 0.0;
  for (const Stage& stage : model.stages) {
    total += stage.gravity;
    largest = std::max(largest, total.norm());
  }
  return largest;
}

constexpr Span kUsualWeight{0.9, 2.8};
// Of soils; other solids may be of steel.
constexpr Span kGroundWeights{0.25, 3.5}, kSolidWeights{0.25, 8.5};

void check_weight(Builder& b, const SourcePosition& where, const std::string& name, double weight, double water,
                  Span allowed) {
  const double ratio = std::abs(weight) / water;
  if (weight == 0.0 || allowed.holds(ratio)) return;
  const std::string unit = unit_text(Dimension::unit_weight, b.model.units);
  b.warning("S356", where,
            name + ": the unit weight is " + rounded_text(weight) + ", " + rounded_text(ratio, 3) +
                " times that of water; soils have 1 to 2.5 times" +
                unit_question(kWeights, std::abs(weight), water, kUsualWeight, unit));
}

constexpr double kLargestGravity = 3.0;  // more is an acceleration, or that of a centrifuge

// Densities under gravity as an acceleration have the right weight, in units that belong together.
bool are_densities(const Builder& b, const Scale& scale, double gravity) {
  if (scale.water == 0.0 || gravity <= kLargestGravity) return false;
  bool any = false;
  for (const Group& group : b.model.groups) {
    const Material& material = b.model.material_of(group);
    if (!group.solid() || material.unit_weight == 0.0) continue;
    any = true;
    if (!kGroundWeights.holds(material.unit_weight * gravity / scale.water)) return false;
  }
  return any;
}

void check_weights(Builder& b, double water) {
  for (const Material& material : b.model.materials) {
    if (material.entry == nullptr || !material.entry->for_solids() || material.twin) continue;
    const std::string name = "material " + std::to_string(material.number);
    const Span allowed = is_ground(material) ? kGroundWeights : kSolidWeights;
    check_weight(b, material.where, name, material.unit_weight, water, allowed);
    if (const auto own = material.parameter(ParameterRole::unit_weight))
      check_weight(b, material.where, name, *own, water, allowed);
  }
  const auto check_initials = [&](const std::vector<InitialStress>& initials) {
    for (const InitialStress& initial : initials)
      if (initial.kind == InitialKind::geostatic)
        check_weight(b, initial.where, "initial stress", initial.value[1], water, kSolidWeights);
  };
  check_initials(b.model.initials);
  for (const Stage& stage : b.model.stages) check_initials(stage.initials);
}

// 1 is the full weight.  Models for a centrifuge are small.
void check_gravity_factor(Builder& b, const Scale& scale) {
  constexpr double kSmallModel = 0.3, kLeastSpin = 15.0, kLargestSpin = 500.0;
  const double height = b.model.mesh.x.row(1).maxCoeff() - b.model.mesh.x.row(1).minCoeff();
  const bool small =
      scale.atmosphere > 0.0 && scale.water > 0.0 && height < kSmallModel * scale.atmosphere / scale.water;
  Vector2 total = Vector2::Zero();
  for (const Stage& stage : b.model.stages) {
    const double before = total.norm();
    total += stage.gravity;
    const double factor = total.norm();
    if (factor <= kLargestGravity || factor <= before) continue;
    if (small && factor >= kLeastSpin && factor <= kLargestSpin) continue;
    const std::string name = "stage " + std::to_string(stage.number) + ": gravity is ";
    if (are_densities(b, scale, factor)) {
      b.note("S311", stage.where,
             name + rounded_text(factor) + " times the unit weights, which then look like densities");
      return;
    }
    b.warning("S311", stage.where,
              name + rounded_text(factor) +
                  " times the unit weights, and 1 is the full weight: is an acceleration meant? A unit "
                  "weight is a weight already, no density");
    return;
  }
}

struct Range {
  Span allowed;
  const char* words;
};

void check_stress(Builder& b, const Material& material, const std::string& what, double value,
                  double atmosphere, const Range& range, Span usual) {
  const double ratio = value / atmosphere;
  if (value <= 0.0 || range.allowed.holds(ratio)) return;
  b.warning("S358", material.where,
            "material " + std::to_string(material.number) + ": " + what + " is " + rounded_text(value) + ", " +
                rounded_text(ratio, 3) + " times the atmosphere; soils have " + range.words +
                unit_question(kPressures, value, atmosphere, usual, b.model.units.stress));
}

// Stiff blocks and platens have no strength; their moduli have no upper limit.
void check_stresses(Builder& b, double atmosphere) {
  constexpr double kAny = 1e300;
  for (const Material& material : b.model.materials) {
    if (material.entry == nullptr || !material.entry->for_solids() || material.twin) continue;
    const bool ground = is_ground(material);
    const double phi = material.parameter(ParameterRole::friction_angle).value_or(0.0);
    const auto& rows = material.entry->parameters;
    for (std::size_t i = 0; i < std::min(rows.size(), material.parameters.size()); ++i) {
      const ParameterRole role = rows[i].role;
      const double value = material.parameters[i];
      // Elastic answers for E = 1 are multiples of E.
      const bool modulus = role == ParameterRole::youngs_modulus || role == ParameterRole::modulus;
      if (modulus && (ground || value != 1.0))
        check_stress(b, material, rows[i].name, value, atmosphere,
                     {{0.5, ground ? 1e5 : kAny}, "5 to 10000 times"}, {5.0, 2e4});
      if (role == ParameterRole::modulus_number)
        check_stress(b, material, rows[i].name + " times the atmosphere", value * atmosphere, atmosphere,
                     {{0.5, 1e5}, "5 to 10000 times"}, {1.0, -1.0});
      if (role == ParameterRole::strength)
        check_stress(b, material, rows[i].name, value, atmosphere,
                     {{phi > 0.0 ? 0.0 : 0.005, 10.0}, "up to 5 times"}, {0.01, 5.0});
    }
  }
}

}  // namespace

void check_units(Builder& b) {
  check_units_card(b);
  const Scale scale = scale_of(b.model.units);
  if (scale.water > 0.0 && !are_densities(b, scale, largest_gravity(b.model))) check_weights(b, scale.water);
  if (scale.atmosphere > 0.0) check_stresses(b, scale.atmosphere);
  check_gravity_factor(b, scale);
}

}  // namespace sage::builder
