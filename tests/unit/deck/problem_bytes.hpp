// What the analysis of a deck would compute, as bytes: tells whether two decks are the same problem.
#pragma once

#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include "sage/deck/deck.hpp"
#include "sage/model/model.hpp"

namespace sage::test {

// Everything but names, titles, numbers that only label (nodes,
// elements), what nothing uses (unit weights without gravity, p_a and gamma_w without a law that asks for
// them), and the control of iterations and output, which stands apart.
class ProblemBytes {
 public:
  explicit ProblemBytes(const Model& model) {
    add(model.geometry);
    bool gravity = false, atmosphere = false, water = false;
    for (const Stage& stage : model.stages) gravity = gravity || stage.gravity.norm() > 0.0;
    for (const Material& m : model.materials) {
      atmosphere = atmosphere || (m.code >= 5 && m.code != 21);  // hyperbolic soil and interface
      water = water || m.code == 22;
    }
    if (atmosphere) add(model.units.atmospheric_pressure);
    if (water) add(model.units.water_unit_weight);
    for (Eigen::Index i = 0; i < model.mesh.x.size(); ++i) add(model.mesh.x.data()[i]);
    for (const Material& m : model.materials) {
      add(m.code);
      if (gravity && std::holds_alternative<std::unique_ptr<SolidLaw>>(m.law)) add(m.unit_weight);
      add_list(m.parameters);
    }
    for (const Group& g : model.groups) {
      add(g.element_code);
      bytes_ += g.element_name;
      add(g.material);
      add_list(g.nodes);
    }
    add_fixities(model.fixities);
    add_initials(model.initials);
    for (const Stage& s : model.stages) add_stage(s);
    for (const Report& r : model.reports) {
      add(r.kind);
      add(r.group);
      add_list(r.nodes);
      for (const double v : {r.height, r.area, r.cell_pressure}) add(v);
      add(r.stage);
    }
    control_ = std::to_string(model.solver);
    for (const Stage& s : model.stages)
      control_ += " " + std::to_string(static_cast<int>(s.method)) + " " + std::to_string(s.max_iterations) +
                  " " + std::to_string(s.output_every) + " " + std::to_string(std::log10(s.tolerance));
  }
  const std::string& control() const { return control_; }
  const std::string& bytes() const { return bytes_; }

 private:
  template <class T>
  void add(const T& value) {
    const T plain = value == T{} ? T{} : value;  // -0 is 0
    bytes_.append(reinterpret_cast<const char*>(&plain), sizeof plain);
  }
  template <class T>
  void add_list(const std::vector<T>& values) {
    add(values.size());
    for (const T& v : values) add(v);
  }
  void add_fixities(const std::vector<Fixity>& fixities) {
    add(fixities.size());
    for (const Fixity& f : fixities) {
      add(f.node);
      for (std::size_t c = 0; c < 2; ++c) {
        add(f.code[c]);
        add(f.value[c]);
      }
    }
  }
  void add_initials(const std::vector<InitialStress>& initials) {
    add(initials.size());
    for (const InitialStress& i : initials) {
      add(i.group);
      add(i.kind);
      for (std::size_t v = 0; v < 4; ++v) add(i.value[v]);  // the others have no meaning
    }
  }
  void add_stage(const Stage& s) {
    add(s.increments);
    for (const double v : {s.gravity.x(), s.gravity.y()}) add(v);
    add_fixities(s.fixities);
    add(s.loads.size());
    for (const NodalLoad& l : s.loads) {
      add(l.node);
      add(l.force.x());
      add(l.force.y());
    }
    add(s.pressures.size());
    for (const EdgeLoad& l : s.pressures) {
      for (const int v : {l.group, l.element, l.edge}) add(v);
      for (const double v : {l.normal[0], l.normal[1], l.shear[0], l.shear[1]}) add(v);
    }
    add_list(s.births);
    add_list(s.deaths);
    add_initials(s.initials);
  }

  std::string bytes_, control_;
};

// The values of a deck that isn't built into a model.
inline std::string values_as_read(const Deck& deck) {
  std::string bytes;
  for (const Card& card : deck.cards) {
    const std::vector<FieldValue> values = deck.values(card);
    bytes += std::to_string(card.spec) + "," + std::to_string(values.size()) + ";";
    for (const FieldValue& value : values)
      if (value.kind != FieldKind::text)
        bytes.append(reinterpret_cast<const char*>(&value.number), sizeof value.number);
  }
  return bytes;
}

}  // namespace sage::test
