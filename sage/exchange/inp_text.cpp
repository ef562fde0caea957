// A model as Abaqus-style input for CalculiX.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "sage/exchange/convert.hpp"
#include "sage/model/foreign_element.hpp"

namespace sage {

namespace {

// CPE4, CAX8R, ...: of its corners where CalculiX has no element like a solid, empty for what is none.
std::string element_type(const Model& model, const Group& group) {
  const ElementEntry& entry = *group.entry;
  if (!entry.solid()) return {};
  const std::string family = model.geometry == Geometry::axisymmetric ? "CAX" : "CPE";
  if (entry.calculix.type.empty()) return family + (entry.triangle() ? "3" : "4");
  const bool reduced = group.element->traits().reduced && !entry.calculix_reduced.empty();
  return family + (reduced ? entry.calculix_reduced : entry.calculix.type);
}

std::string set_name(const Group& group, std::size_t index) {
  return "G" + std::to_string(index + 1) + "_" + std::to_string(group.number);
}

class InpWriter {
 public:
  InpWriter(const Model& model, Diagnostics& diagnostics) : model_(model), diagnostics_(diagnostics) {}

  std::string text() {
    heading();
    elements();
    materials();
    supports();
    for (const Stage& stage : model_.stages) step(stage);
    the_rest();
    return std::move(text_);
  }

 private:
  void warning(const std::string& message) {
    diagnostics_.add({Severity::warning, "S720", {model_.file, 0, 0, 0}, message, {}});
  }
  // What is no part of the problem there.
  void the_rest() {
    if (!model_.water.empty()) warning(std::to_string(model_.water.size()) + " water card(s) left out");
    if (model_.large_strain)
      warning(
          "large strain is left out: the steps are written without NLGEOM, whose elastic law is another one");
    if (model_.combines_dofs()) warning("inclined supports and ties are left out");
    if (!model_.reports.empty()) warning(std::to_string(model_.reports.size()) + " report(s) left out");
    if (!control_.empty())
      diagnostics_.add({Severity::note,
                        "S721",
                        {model_.file, 0, 0, 0},
                        "stage(s) " + control_ +
                            ": method, limit of iterations, tolerance and output interval are left to CalculiX",
                        {}});
    if (model_.solver != 0)
      diagnostics_.add(
          {Severity::note, "S721", {model_.file, 0, 0, 0}, "the choice of the solver is left to CalculiX", {}});
  }
  int number(int node) const { return model_.mesh.number[node]; }

  void heading() {
    text_ += "*HEADING\n" + model_.title + "\n";
    const UnitSystem& u = model_.units;
    if (u.length != "-" || u.force != "-" || u.stress != "-")
      text_ += "** units: " + u.length + ", " + u.force + ", " + u.stress + "\n";
    if (u.atmospheric_pressure != 0.0 || u.water_unit_weight != 0.0)
      text_ += fmt::format("** p_a {}, gamma_w {}\n", u.atmospheric_pressure, u.water_unit_weight);
    text_ += "*NODE, NSET=NALL\n";
    for (int i = 0; i < model_.mesh.nodes(); ++i)
      text_ += fmt::format("{}, {}, {}, 0.\n", number(i), model_.mesh.x(0, i), model_.mesh.x(1, i));
  }

  void elements() {
    for (std::size_t g = 0; g < model_.groups.size(); ++g) {
      const Group& group = model_.groups[g];
      const std::string type = element_type(model_, group);
      written_.push_back(!type.empty() && group.elements() > 0);
      if (type.empty() && group.elements() > 0)
        warning(std::to_string(group.elements()) + " " + group.element_name +
                " element(s) left out: CalculiX has none");
      if (!written_.back()) continue;
      if (group.entry->calculix.type.empty()) warn_of_corners(group, "CalculiX", diagnostics_);
      note_integration(group, type);
      const std::vector<int> order = foreign_nodes(*group.entry, group.entry->calculix);
      if (group.overlay) text_ += "** on the elements of other groups\n";
      if (!group.name.empty()) text_ += "** group " + std::to_string(group.number) + " " + group.name + "\n";
      text_ += fmt::format("*ELEMENT, TYPE={}, ELSET={}\n", type, set_name(group, g));
      for (int e = 0; e < group.elements(); ++e) {
        text_ += std::to_string(group.element_numbers[e]);
        for (int i : order) text_ += ", " + std::to_string(number(group.nodes_of(e)[i]));
        text_ += '\n';
      }
    }
  }

  // Formulations have no names there, but for the reduced integration.
  void note_integration(const Group& group, const std::string& type) {
    const bool reduced = type.ends_with('R');
    if (reduced || group.entry->formulations.size() < 2 || !integrations_.insert(group.element_name).second)
      return;
    diagnostics_.add(
        {Severity::note,
         "S721",
         group.where,
         group.element_name + " is written as " + type + ", which CalculiX integrates in its own way",
         {}});
  }

  static bool has_more_than_elasticity(const Material& material) {
    return std::ranges::any_of(material.entry->parameters, [](const Parameter& p) {
      return p.role != ParameterRole::youngs_modulus && p.role != ParameterRole::poissons_ratio;
    });
  }

  void materials() {
    for (std::size_t g = 0; g < model_.groups.size(); ++g) {
      if (!written_[g]) continue;
      const Material& material = model_.material_of(model_.groups[g]);
      const std::optional<double> E = material.parameter(ParameterRole::youngs_modulus),
                                  nu = material.parameter(ParameterRole::poissons_ratio);
      const bool elastic = E && nu && *E > 0.0;
      const std::string set = set_name(model_.groups[g], g);
      // Density 1 x gravity in this program's units: unit weight.
      text_ += "** material " + std::to_string(material.number) + " " + material.name + "\n";
      text_ += fmt::format("*MATERIAL, NAME=M_{}\n", set);
      if (elastic)
        text_ += fmt::format("*ELASTIC\n{}, {}\n", *E, *nu);
      else
        warning("material " + std::to_string(material.number) + " (" + material.law_name +
                ") has no Young's modulus and Poisson's ratio: its *ELASTIC must be added by hand");
      if (elastic && has_more_than_elasticity(material))
        warning("material " + std::to_string(material.number) + " (" + material.law_name +
                "): only its elastic constants are written");
      if (material.unit_weight > 0.0) text_ += fmt::format("*DENSITY\n{}\n", material.unit_weight);
      if (material.saturated_unit_weight > 0.0)
        warning("material " + std::to_string(material.number) +
                ": its saturated unit weight is left out, CalculiX has one density");
      if (material.unit_weight < 0.0)
        warning("material " + std::to_string(material.number) +
                ": its unit weight is left out, CalculiX has no density below zero");
      text_ += fmt::format("*SOLID SECTION, ELSET={}, MATERIAL=M_{}\n", set, set);
      if (model_.geometry == Geometry::plane_strain) text_ += "1.\n";
    }
  }

  // What the cards of one stage say of a dof: of several the last stands.
  struct Held {
    FixityCode code = FixityCode::unchanged;
    double value = 0.0;
    int line = 0;
  };
  static std::map<std::pair<int, std::size_t>, Held> last_of(const std::vector<Fixity>& fixities) {
    std::map<std::pair<int, std::size_t>, Held> last;
    for (const Fixity& f : fixities)
      for (std::size_t c = 0; c < 2; ++c)
        if (f.code[c] != FixityCode::unchanged) last[{f.node, c}] = {f.code[c], f.value[c], f.line};
    return last;
  }

  // One message a card, with the first of its nodes.
  void warn_nodes(const std::map<int, std::set<int>>& nodes_of_line, const std::string& before,
                  const std::string& after) {
    constexpr std::size_t kShown = 8;
    for (const auto& [line, nodes] : nodes_of_line) {
      const std::size_t shown = std::min(kShown, nodes.size());
      const auto end = std::next(nodes.begin(), static_cast<std::ptrdiff_t>(shown));
      const char* const more = end != nodes.end() ? ", ..." : "";
      diagnostics_.add(
          {Severity::warning,
           "S720",
           {model_.file, line, 0, 0},
           fmt::format("{}node(s) {}{}{}", before, fmt::join(nodes.begin(), end, ", "), more, after),
           {}});
    }
  }

  // Supports before the first step: the values are zero.
  void supports() {
    if (!model_.fixities.empty()) text_ += "*BOUNDARY\n";
    for (const auto& [dof, held] : last_of(model_.fixities)) {
      displacement_[dof] = 0.0;
      text_ += fmt::format("{}, {}, {}, 0\n", number(dof.first), dof.second + 1, dof.second + 1);
    }
  }

  // Decks count displacements from where a stage begins, CalculiX from the start.  The two agree for a dof that
  // is held from the start on; one that could move first can only be held where it is (FIXED).
  void boundary(const Stage& stage, bool first) {
    std::string totals, frozen;
    std::map<int, std::set<int>> unknown, released;
    for (const auto& [dof, held] : last_of(stage.fixities)) {
      const auto [node, c] = dof;
      if (held.code == FixityCode::released) {
        released[held.line].insert(number(node));
        displacement_.erase(dof);
        frozen_.erase(dof);
        continue;
      }
      if (first) displacement_.try_emplace(dof, 0.0);
      const auto total = displacement_.find(dof);
      if (total == displacement_.end() && held.value == 0.0) {
        if (frozen_.insert(dof).second) frozen += fmt::format("{}, {}, {}\n", number(node), c + 1, c + 1);
        continue;
      }
      if (total == displacement_.end()) unknown[held.line].insert(number(node));
      double& sum = displacement_[dof];
      sum += held.value;
      totals += fmt::format("{}, {}, {}, {}\n", number(node), c + 1, c + 1, sum);
    }
    if (!totals.empty()) text_ += "*BOUNDARY\n" + totals;
    if (!frozen.empty()) text_ += "*BOUNDARY, FIXED\n" + frozen;
    const std::string name = "stage " + std::to_string(stage.number) + ": ";
    warn_nodes(unknown, name,
               " could move before this stage displaces them: CalculiX counts the displacement from their "
               "original place, not from where the stage begins; add what they had moved");
    warn_nodes(released, name + "the release of ", " is left out: CalculiX holds them on");
  }

  // Loads here are added stage by stage, there the last value stands: totals are written.
  void step(const Stage& stage) {
    if (!stage.title.empty()) text_ += "** " + stage.title + "\n";
    text_ += fmt::format("*STEP, INC={}\n*STATIC\n{}, {}\n", 100 * stage.increments,
                         stage.duration / stage.increments,
                         stage.duration == 1.0 ? "1." : fmt::format("{}", stage.duration));
    const Stage usual;
    if (stage.method != usual.method || stage.max_iterations != usual.max_iterations ||
        stage.tolerance != usual.tolerance || stage.output_every != usual.output_every)
      control_ += (control_.empty() ? "" : ", ") + std::to_string(stage.number);
    if (stage.strength_factor != 0.0)
      warning("stage " + std::to_string(stage.number) + ": its strength factor is left out");
    if (stage.pores != usual.pores || stage.theta != usual.theta || stage.grading != usual.grading)
      warning("stage " + std::to_string(stage.number) +
              ": its pore water, theta and the grading of its increments are left out");
    if (stage.time_error != 0.0 || stage.may_end_early() || !stage.output_times.empty())
      warning("stage " + std::to_string(stage.number) +
              ": its steps in time, ends and times of output are left out");
    if (stage.is_controlled())
      warning("stage " + std::to_string(stage.number) +
              ": the displacement that controls its load is left out");
    if (stage.resets_displacements)
      warning("stage " + std::to_string(stage.number) + ": its reset of displacements is left out");
    if (!stage.births.empty() || !stage.deaths.empty())
      warning("stage " + std::to_string(stage.number) +
              ": groups that are activated or removed in it are left out");
    if (!stage.initials.empty())
      warning("stage " + std::to_string(stage.number) +
              ": initial stresses, histories and changes of laws are left out");
    if (stage.has_mechanical_histories())
      warning("stage " + std::to_string(stage.number) +
              ": tables of time are left out; loads and displacements have their whole value at the end");
    boundary(stage, &stage == &model_.stages.front());
    if (!stage.loads.empty()) text_ += "*CLOAD\n";
    for (const NodalLoad& load : stage.loads)
      for (int c = 0; c < 2; ++c) {
        if (load.force[c] == 0.0) continue;
        double& total = force_[{load.node, c}];
        total += load.force[c];
        text_ += fmt::format("{}, {}, {}\n", number(load.node), c + 1, total);
      }
    distributed(stage);
    text_ += "*NODE PRINT, NSET=NALL\nU\n*END STEP\n";
  }

  void distributed(const Stage& stage) {
    gravity_ += stage.gravity;
    const bool weight = stage.gravity.norm() > 0.0;
    if (weight || !stage.pressures.empty()) text_ += "*DLOAD\n";
    if (weight) {
      const Vector2 direction = gravity_ / std::max(gravity_.norm(), 1e-300);
      for (std::size_t g = 0; g < model_.groups.size(); ++g)
        if (written_[g] && model_.material_of(model_.groups[g]).unit_weight > 0.0)
          text_ += fmt::format("{}, GRAV, {}, {}, {}, 0.\n", set_name(model_.groups[g], g), gravity_.norm(),
                               direction.x(), direction.y());
    }
    int uneven = 0, shear = 0, missing = 0;
    for (const EdgeLoad& load : stage.pressures) {
      const Group& group = model_.groups[load.group];
      if (!written_[load.group]) {
        ++missing;
        continue;
      }
      if (load.normal[0] != load.normal[1]) ++uneven;
      if (load.shear.norm() > 0.0) ++shear;
      const int element = group.element_numbers[load.element];
      double& total = pressure_[{element, load.edge}];
      total += load.normal.mean();
      text_ += fmt::format("{}, P{}, {}\n", element, load.edge + 1, total);
    }
    if (uneven > 0)
      warning(std::to_string(uneven) + " pressure(s) that vary along an edge are written as their mean");
    if (shear > 0) warning(std::to_string(shear) + " edge shear load(s) left out");
    if (missing > 0) warning(std::to_string(missing) + " pressure(s) on elements that are left out");
  }

  const Model& model_;
  Diagnostics& diagnostics_;
  std::string text_;
  std::string control_;                 // stages with an iteration control of their own
  std::set<std::string> integrations_;  // noted
  std::vector<char> written_;
  std::map<std::pair<int, std::size_t>, double> displacement_;  // totals, of dofs whose place is known
  std::set<std::pair<int, std::size_t>> frozen_;                // held where they were
  std::map<std::pair<int, int>, double> force_, pressure_;
  Vector2 gravity_ = Vector2::Zero();
};

}  // namespace

std::string inp_text(const Model& model, Diagnostics& diagnostics) {
  warn_of_unknowns(model, "CalculiX", diagnostics);
  if (!model.initials.empty())
    diagnostics.add({Severity::warning,
                     "S720",
                     {model.file, 0, 0, 0},
                     "initial stresses, histories and changes of laws are left out",
                     {}});
  return InpWriter(model, diagnostics).text();
}

}  // namespace sage
