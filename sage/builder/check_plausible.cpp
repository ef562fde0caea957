// Valid numbers that are unlikely to be meant: gravity without weight, a pressure beyond Young's modulus.
// Warnings and notes only; thresholds are far from what sound decks hold.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <tuple>

#include "sage/builder/builder.hpp"
#include "sage/deck/text.hpp"
#include "sage/mesh/edges.hpp"
#include "sage/model/activity.hpp"
#include "sage/model/spread_loads.hpp"

namespace sage::builder {

namespace {

constexpr double kPi = 3.14159265358979323846;

// act(parameter, value) for each number that a material's law reads.
template <class Act>
void for_parameters(const Material& material, Act act) {
  for (std::size_t i = 0; material.entry != nullptr && i < material.parameters.size(); ++i)
    if (i < material.entry->parameters.size()) act(material.entry->parameters[i], material.parameters[i]);
}

// Largest modulus of a solid, as far as its law has one; 0 = none.
double stiffness(const Builder& b, const Material& material) {
  if (material.entry == nullptr || !material.entry->for_solids()) return 0.0;
  double largest = 0.0;
  for_parameters(material, [&](const Parameter& p, double value) {
    if (p.role == ParameterRole::youngs_modulus || p.role == ParameterRole::modulus)
      largest = std::max(largest, value);
    if (p.role == ParameterRole::modulus_number)
      largest = std::max(largest, value * b.model.units.atmospheric_pressure);
  });
  return largest;
}

struct Size {
  double length = 0.0;     // of the mesh
  double stiffness = 0.0;  // largest of all solids; 0 = unknown
};

Size size_of(const Builder& b) {
  Size size;
  const Mesh& mesh = b.model.mesh;
  size.length = (mesh.x.rowwise().maxCoeff() - mesh.x.rowwise().minCoeff()).maxCoeff();
  for (const Group& group : b.model.groups)
    size.stiffness = std::max(size.stiffness, stiffness(b, b.model.material_of(group)));
  return size;
}

void check_initial(Builder& b, const InitialStress& initial) {
  const Group& group = b.model.groups[initial.group];
  const bool solid = group.solid();
  const double modulus = stiffness(b, b.model.material_of(group));
  const std::string name = "group " + std::to_string(group.number) + ": ";
  if (initial.kind == InitialKind::geostatic) {
    const double k0 = initial.value[2], weight = initial.value[1];
    if (k0 < 0.0 || k0 > 10.0)
      b.warning("S303", initial.where,
                name + "the coefficient of earth pressure at rest is " + rounded_text(k0) +
                    "; soils have about 0.3 to 3");
    if (weight < 0.0)
      b.warning("S303", initial.where, name + "the unit weight of the initial stress is negative");
    const auto [low, high] = std::pair(b.model.mesh.x.row(1).minCoeff(), b.model.mesh.x.row(1).maxCoeff());
    if (initial.value[0] > high + 2.0 * (high - low) || initial.value[0] < low)
      b.warning("S303", initial.where,
                name + "the ground level of the initial stress, " + rounded_text(initial.value[0]) +
                    ", is far from the mesh, " + rounded_text(low) + " to " + rounded_text(high));
    if (modulus > 0.0 && std::abs(weight) * (high - low) + std::abs(initial.value[3]) > modulus)
      b.warning("S303", initial.where,
                name + "the initial stress exceeds the material's modulus, " + rounded_text(modulus));
  }
  if (initial.kind != InitialKind::uniform) return;
  if (group.structure()) return;  // what is much for a section is not known
  const std::size_t normals = solid ? 3 : 2;
  for (std::size_t i = solid ? 0 : 1; i < normals; ++i) {
    if (initial.value[i] >= 0.0) continue;
    b.note("S303", initial.where,
           name + "value " + std::to_string(i + 1) +
               " of the initial stress is tension (decks write compression positive)");
    break;
  }
  double largest = 0.0;
  for (std::size_t i = 0; i < 4; ++i) largest = std::max(largest, std::abs(initial.value[i]));
  if (modulus > 0.0 && largest > modulus)
    b.warning("S303", initial.where,
              name + "the initial stress, " + rounded_text(largest) + ", exceeds the material's modulus, " +
                  rounded_text(modulus));
}

// Elements that are needles: a coordinate with a digit too many stretches its elements long before they fold.
void check_slender(Builder& b) {
  constexpr double kSlender = 1e4;
  double worst = 0.0;
  int number = 0, line = 0, found = 0;
  for (const Group& group : b.model.groups) {
    if (!group.solid()) continue;
    const auto& edges = group.element->edges();
    for (int e = 0; e < group.elements(); ++e) {
      double longest = 0.0, shortest = 1e300;
      for (const std::vector<int>& edge : edges) {
        const int* n = group.nodes_of(e);
        const double length = (b.model.mesh.x.col(n[edge[0]]) - b.model.mesh.x.col(n[edge[1]])).norm();
        longest = std::max(longest, length);
        shortest = std::min(shortest, length);
      }
      if (longest <= kSlender * shortest) continue;
      ++found;
      if (longest <= worst * shortest) continue;
      worst = longest / shortest;
      number = group.element_numbers[e];
      line = group.element_lines[e];
    }
  }
  if (found > 0)
    b.warning("S304", b.at_line(line),
              std::to_string(found) +
                  " element(s) are more than 10000 times as long as wide, the worst is "
                  "element " +
                  std::to_string(number) + ", " + rounded_text(worst) + " times: is a coordinate wrong?");
}

// Where elements come in blocks, a number that is left out may be a hole in the mesh.
void note_missing_numbers(Builder& b) {
  FieldName columns("columns"), rows("rows");
  const auto is_block = [&](const CardView& card) {
    return card.integer(columns) > 1 || card.integer(rows) > 1;
  };
  if (std::ranges::none_of(b.deck.all("element"), is_block)) return;
  std::vector<int> numbers;
  b.element_place.for_each([&](int number, const ElementPlace&) { numbers.push_back(number); });
  for (std::size_t i = 1; i < numbers.size(); ++i) {
    if (numbers[i] == numbers[i - 1] + 1) continue;
    b.note("S305", b.at_line(0),
           "the element numbers are not consecutive: after " + std::to_string(numbers[i - 1]) + " comes " +
               std::to_string(numbers[i]) + "; is a block of elements cut short?");
    return;
  }
}

// Poisson's ratio below zero is possible, but no soil has it.
void check_poisson(Builder& b) {
  for (const Material& material : b.model.materials)
    for_parameters(material, [&](const Parameter& p, double value) {
      if (p.role == ParameterRole::poissons_ratio && value < 0.0)
        b.warning("S306", material.where,
                  "material " + std::to_string(material.number) + ": Poisson's ratio is negative, " +
                      rounded_text(value));
    });
}

// A strength beyond the modulus lets strains pass 1 before anything yields; a weight below zero lifts.
void check_strengths_and_weights(Builder& b) {
  for (const Material& material : b.model.materials) {
    const double modulus = stiffness(b, material);
    for_parameters(material, [&](const Parameter& p, double value) {
      const std::string name = "material " + std::to_string(material.number) + ": " + p.name + ", ";
      if (p.role == ParameterRole::strength && modulus > 0.0 && value > modulus)
        b.warning("S306", material.where,
                  name + rounded_text(value) + ", exceeds the material's modulus, " + rounded_text(modulus));
      if (p.role == ParameterRole::unit_weight && value < 0.0)
        b.warning("S306", material.where, name + rounded_text(value) + ", is a negative unit weight");
    });
  }
}

// Friction of a degree and less is no soil's; the same number in radians is.
void check_angles(Builder& b) {
  constexpr double kLeast = 0.05;
  for (const Material& material : b.model.materials)
    for_parameters(material, [&](const Parameter& p, double angle) {
      if (p.role != ParameterRole::friction_angle || angle < kLeast || angle > kPi / 2.0) return;
      b.warning("S306", material.where,
                "material " + std::to_string(material.number) + ": the friction angle is " +
                    rounded_text(angle) + " degrees; was it meant in radians, " +
                    rounded_text(angle / kRadiansPerDegree) + " degrees?");
    });
}

void check_fixities(Builder& b, const Stage& stage, const Activity& before, const Size& size) {
  int last_line = 0;
  std::set<int> held_here;  // by an earlier card: check_stages speaks of the contradiction
  for (const Fixity& f : stage.fixities) {
    for (std::size_t c = 0; c < 2; ++c)
      if (f.code[c] == FixityCode::fixed) held_here.insert(DofMap::displacement(f.node, static_cast<int>(c)));
    if (f.line == last_line) continue;  // one message a card
    for (std::size_t c = 0; c < 2; ++c) {
      if (std::abs(f.value[c]) > size.length) {
        last_line = f.line;
        b.warning("S307", b.at_line(f.line),
                  "the displacement " + rounded_text(f.value[c]) + " is larger than the mesh, " +
                      rounded_text(size.length) + "; strains are taken as small");
      }
      const auto component = static_cast<int>(c);
      if (f.code[c] == FixityCode::released && !before.holds(f.node, component) &&
          held_here.count(DofMap::displacement(f.node, component)) == 0) {
        last_line = f.line;
        b.note("S309", b.at_line(f.line),
               "code -1 releases node " + std::to_string(b.model.mesh.number[f.node]) +
                   (c == 0 ? " in x" : " in y") + ", which nothing held");
      }
    }
  }
}

void check_loads(Builder& b, const Stage& stage, const Size& size) {
  const double reach = b.model.geometry == Geometry::axisymmetric ? 2.0 * kPi * size.length : 1.0;
  int last_line = 0;
  for (const NodalLoad& load : stage.loads) {
    if (load.line == last_line || size.stiffness == 0.0) continue;
    if (load.force.cwiseAbs().maxCoeff() <= size.stiffness * size.length * reach) continue;
    last_line = load.line;
    b.warning("S308", b.at_line(load.line),
              "the force " + rounded_text(load.force.cwiseAbs().maxCoeff()) +
                  " would strain the whole mesh by more than 1 (largest modulus " +
                  rounded_text(size.stiffness) + ")");
  }
  for (const EdgeLoad& load : stage.pressures) {
    if (load.line == last_line) continue;
    const Group& group = b.model.groups[load.group];
    const double largest = std::max(load.normal.cwiseAbs().maxCoeff(), load.shear.cwiseAbs().maxCoeff());
    if (size.stiffness > 0.0 && largest > size.stiffness) {
      b.warning("S308", b.at_line(load.line),
                "the pressure or shear " + rounded_text(largest) + " exceeds the largest modulus, " +
                    rounded_text(size.stiffness));
    } else if (load.normal.minCoeff() < 0.0) {
      b.note("S310", b.at_line(load.line), "a negative pressure pulls at the edge");
    } else if (group.interface()) {
      b.note("S310", b.at_line(load.line),
             "the pressure acts on one side of an interface alone, towards the joint");
    } else {
      continue;
    }
    last_line = load.line;
  }
}

// A pressure on an edge that two elements share loads the body from inside.
void check_inner_edges(Builder& b, const Stage& stage, const Activity& activity) {
  const auto ends = [](const Group& group, int element, const std::vector<int>& edge) {
    const int* nodes = group.nodes_of(element);
    return mesh::edge_key(nodes[edge[0]], nodes[edge[1]]);
  };
  std::map<mesh::EdgeKey, int> uses;
  std::vector<char> loaded(static_cast<std::size_t>(b.model.mesh.nodes()), 0);
  const auto edge_of = [&](const EdgeLoad& load) {
    const Group& group = b.model.groups[load.group];
    return ends(group, load.element, group.element->edges()[load.edge]);
  };
  for (const EdgeLoad& load : stage.pressures) {
    const mesh::EdgeKey key = edge_of(load);
    uses[key] = 0;
    loaded[static_cast<std::size_t>(key.first)] = loaded[static_cast<std::size_t>(key.second)] = 1;
  }
  if (uses.empty()) return;
  for (std::size_t g = 0; g < b.model.groups.size(); ++g) {
    const Group& group = b.model.groups[g];
    if (!activity.group[g] || !group.solid() || group.overlay) continue;
    for (int e = 0; e < group.elements(); ++e)
      for (const std::vector<int>& edge : group.element->edges()) {
        const mesh::EdgeKey key = ends(group, e, edge);
        if (!loaded[static_cast<std::size_t>(key.first)] || !loaded[static_cast<std::size_t>(key.second)])
          continue;
        if (const auto it = uses.find(key); it != uses.end()) ++it->second;
      }
  }
  int last_line = -1;
  for (const EdgeLoad& load : stage.pressures) {
    if (uses[edge_of(load)] < 2 || load.line == last_line) continue;
    last_line = load.line;
    b.warning("S310", b.at_line(load.line),
              "the pressure acts on an edge inside the body, which two elements share");
  }
}

// Weight without gravity is allowed; gravity without weight is a mistake.
void check_gravity(Builder& b) {
  const Stage* first = nullptr;
  Vector2 total = Vector2::Zero();
  for (const Stage& stage : b.model.stages) {
    if (stage.gravity.norm() > 0.0 && first == nullptr) first = &stage;
    const Vector2 before = total;
    total += stage.gravity;
    const std::string name = "stage " + std::to_string(stage.number) + ": ";
    if (stage.gravity.x() != 0.0 && b.model.geometry == Geometry::axisymmetric)
      b.warning("S311", stage.where,
                name + "gravity_x is " + rounded_text(stage.gravity.x()) +
                    ": in axisymmetry it acts along the radius, all around; the axis is y");
    if (stage.gravity.norm() > 0.0 && before.norm() > 0.0 && total.norm() > 1.0 + 1e-9 &&
        std::max(stage.gravity.norm(), before.norm()) < 1.0 + 1e-9)
      b.note("S311", stage.where,
             name + "gravity is added to that of earlier stages: it is now " + rounded_text(total.norm()) +
                 " times the unit weights");
    if (total.y() > 1e-9) b.note("S311", stage.where, name + "gravity acts upwards (gravity_y > 0 in sum)");
    if (stage.increments > 10000)
      b.note("S313", stage.where,
             name + std::to_string(stage.increments) + " increments: each is a solution of its own");
  }
  bool weight = false;
  for (const Group& group : b.model.groups) weight = weight || b.model.material_of(group).unit_weight != 0.0;
  if (first != nullptr && !weight)
    b.warning("S312", first->where,
              "stage " + std::to_string(first->number) + ": gravity acts, but no material has a unit weight");
  for (const Material& material : b.model.materials) {
    if (material.unit_weight < 0.0)
      b.warning("S306", material.where,
                "material " + std::to_string(material.number) + ": the unit weight is negative");
    if (first == nullptr || !weight || !std::holds_alternative<std::unique_ptr<SolidLaw>>(material.law))
      continue;
    if (std::find(b.blank_weights.begin(), b.blank_weights.end(), material.number) != b.blank_weights.end())
      b.note("S312", material.where,
             "material " + std::to_string(material.number) +
                 ": its unit weight is left blank, which reads as 0, though gravity acts");
  }
  if (first == nullptr) return;
  const double height = b.model.mesh.x.row(1).maxCoeff() - b.model.mesh.x.row(1).minCoeff();
  for (const Group& group : b.model.groups) {
    const Material& material = b.model.material_of(group);
    const double modulus = stiffness(b, material);
    if (modulus == 0.0 || std::abs(material.unit_weight) * height <= modulus) continue;
    b.warning("S312", material.where,
              "material " + std::to_string(material.number) + ": the weight of a column as high as the mesh, " +
                  rounded_text(material.unit_weight * height) + ", exceeds its modulus, " +
                  rounded_text(modulus));
    break;
  }
}

// A plate's weight is its unit weight times its thickness; it was the unit weight alone in earlier versions.
void check_plate_weights(Builder& b) {
  const auto acts = [](const Stage& stage) { return !stage.gravity.isZero(0.0); };
  if (std::ranges::none_of(b.model.stages, acts)) return;
  std::set<int> done;
  for (const Group& group : b.model.groups) {
    const Material& material = b.model.material_of(group);
    const double thickness = material.parameter(ParameterRole::thickness).value_or(1.0);
    if (!group.structure() || material.unit_weight == 0.0 || thickness == 1.0) continue;
    if (!done.insert(group.material).second) continue;
    b.warning("S350", material.where,
              "material " + std::to_string(material.number) +
                  ": the weight of a plate is its unit weight times " + "its thickness, " +
                  rounded_text(weight_density(b.model, group)) + " " + b.model.units.stress +
                  "; earlier versions took " + rounded_text(material.unit_weight));
  }
}

// What is out of balance by more than this can carry a run past its limit load.
void check_tolerance(Builder& b, const Stage& stage) {
  constexpr double kLoose = 1e-3;
  if (stage.tolerance <= kLoose) return;
  b.warning("S314", stage.where,
            "stage " + std::to_string(stage.number) + ": its tolerance lets " +
                rounded_text(100.0 * stage.tolerance) +
                " % of the forces be out of balance: what it calls equilibrium may be none");
}

// Of two cards for one group the later one stands.
void check_twice_initial(Builder& b, const std::vector<InitialStress>& initials) {
  std::map<int, int> lines;  // by group
  for (const InitialStress& initial : initials) {
    if (!states_stress(initial.kind) && initial.kind != InitialKind::zero) continue;
    const auto [first, added] = lines.try_emplace(initial.group, initial.where.line);
    if (added || first->second == initial.where.line) continue;
    b.warning("S315", initial.where,
              "group " + std::to_string(b.model.groups[initial.group].number) +
                  " got an initial stress in line " + std::to_string(first->second) +
                  " already: this card replaces it");
    first->second = initial.where.line;
  }
}

void note_null_stage(Builder& b, const Stage& stage) {
  bool any = !stage.loads.empty() || !stage.pressures.empty() || !stage.births.empty() ||
             !stage.deaths.empty() || !stage.initials.empty() || stage.gravity.norm() > 0.0;
  for (const Fixity& f : stage.fixities)
    for (std::size_t c = 0; c < 2; ++c) any = any || f.value[c] != 0.0 || f.code[c] == FixityCode::released;
  for (const TurnedFixity& f : stage.turned_fixities)
    for (std::size_t c = 0; c < 2; ++c) any = any || f.value[c] != 0.0 || f.code[c] == FixityCode::released;
  for (const FieldFixity& f : stage.field_fixities)
    any = any || f.value != 0.0 || f.code == FixityCode::released;
  any = any || !stage.field_loads.empty() || !stage.exits.empty();
  const bool water =
      std::ranges::any_of(b.model.water, [&](const WaterCard& card) { return card.stage + 1 == stage.number; });
  if (any || (water && stage.number > 1) || stage.pores == PoreWater::flows) return;
  if (water) {
    b.note("S316", stage.where,
           "stage 1 adds water alone: no weight, load or displacement; is gravity missing?");
    return;
  }
  b.note("S316", stage.where,
         "stage " + std::to_string(stage.number) +
             " adds nothing (no load, displacement, gravity, birth or death): a null step, which only "
             "brings what is out of balance into equilibrium");
}

void check_reports(Builder& b, const Size& size) {
  for (const Report& report : b.model.reports) {
    if (report.kind != ReportKind::triaxial) continue;
    if (report.height > 10.0 * size.length || report.height < 0.01 * size.length)
      b.warning("S317", report.where,
                "the report's height, " + rounded_text(report.height) + ", does not fit the mesh, " +
                    rounded_text(size.length));
    if (report.area > 100.0 * size.length * std::max(size.length, 1.0))
      b.warning("S317", report.where,
                "the report's area, " + rounded_text(report.area) + ", does not fit the mesh, " +
                    rounded_text(size.length) + " long");
    if (report.cell_pressure < 0.0) b.note("S317", report.where, "the report's cell pressure is negative");
    if (size.stiffness > 0.0 && report.cell_pressure > size.stiffness)
      b.warning("S317", report.where,
                "the report's cell pressure exceeds the largest modulus, " + rounded_text(size.stiffness));
  }
}

}  // namespace

void check_plausible(Builder& b) {
  const Size size = size_of(b);
  check_slender(b);
  check_overlap(b);
  note_missing_numbers(b);
  check_poisson(b);
  check_angles(b);
  check_strengths_and_weights(b);
  for (const InitialStress& initial : b.model.initials) check_initial(b, initial);
  check_twice_initial(b, b.model.initials);
  Activity activity(b.model);
  for (const Stage& stage : b.model.stages) {
    check_fixities(b, stage, activity, size);
    activity.enter(stage);
    check_loads(b, stage, size);
    check_inner_edges(b, stage, activity);
    note_null_stage(b, stage);
    check_tolerance(b, stage);
    check_twice_initial(b, stage.initials);
    for (const InitialStress& initial : stage.initials) check_initial(b, initial);
  }
  check_gravity(b);
  check_plate_weights(b);
  check_reports(b, size);
}

}  // namespace sage::builder
