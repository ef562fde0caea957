#include "sage/model/fingerprint.hpp"

#include "sage/core/archive.hpp"

namespace sage {

namespace {

template <class... T>
void add(Archive& archive, T... values) {
  (archive(values), ...);
}

void add_fixities(Archive& archive, const std::vector<Fixity>& fixities) {
  for (const Fixity& f : fixities) add(archive, f.node, f.code, f.value);
}

void add_turned_fixities(Archive& archive, const std::vector<TurnedFixity>& fixities) {
  for (const TurnedFixity& f : fixities) add(archive, f.node, f.code, f.value, f.angle);
}

void add_field_fixities(Archive& archive, const std::vector<FieldFixity>& fixities) {
  for (const FieldFixity& f : fixities) add(archive, f.field, f.node, f.code, f.value);
}

void add_initials(Archive& archive, const std::vector<InitialStress>& initials) {
  for (const InitialStress& initial : initials) add(archive, initial.group, initial.kind, initial.value);
}

void add_stage(Archive& archive, const Stage& s) {
  if (s.pores != PoreWater::kept || s.theta != 1.0 || s.grading != 1.0)
    add(archive, s.pores, s.theta, s.grading);
  if (s.time_error != 0.0 || s.may_end_early() || !s.output_times.empty())
    add(archive, s.time_error, s.end_degree, s.end_pressure, s.output_times);
  if (s.is_controlled()) add(archive, s.control.node, s.control.other, s.control.component, s.control.growth);
  add(archive, s.title, s.increments, s.duration, s.method, s.max_iterations, s.output_every, s.tolerance,
      s.gravity.x(), s.gravity.y());
  add_fixities(archive, s.fixities);
  add_turned_fixities(archive, s.turned_fixities);
  for (const NodalLoad& load : s.loads) add(archive, load.node, load.force.x(), load.force.y());
  add_field_fixities(archive, s.field_fixities);
  for (const Exit& exit : s.exits) {
    add(archive, exit.node, exit.pressure_head);
    if (exit.field >= 0) add(archive, exit.field);
  }
  const auto add_history = [&](const auto& card) {
    for (const auto& [time, share] : card.history) add(archive, time, share);
  };
  for (const Fixity& f : s.fixities) add_history(f);
  for (const NodalLoad& load : s.loads) add_history(load);
  for (const EdgeLoad& load : s.pressures) add_history(load);
  for (const FieldFixity& f : s.field_fixities) add_history(f);
  for (const FieldLoad& load : s.field_loads) add_history(load);
  for (const FieldLoad& load : s.field_loads) add(archive, load.field, load.node, load.value);
  for (const EdgeLoad& load : s.pressures)
    add(archive, load.group, load.element, load.edge, load.normal.x(), load.normal.y(), load.shear.x(),
        load.shear.y());
  add(archive, s.births, s.deaths);
  add_initials(archive, s.initials);
  if (s.strength_factor != 0.0) add(archive, s.strength_factor);
  if (s.resets_displacements) add(archive, s.resets_displacements);
}

}  // namespace

std::uint64_t fingerprint(const Model& model) {
  Archive archive = Archive::for_sum();
  const UnitSystem& u = model.units;
  add(archive, model.title, u.length, u.force, u.stress, u.atmospheric_pressure, u.water_unit_weight);
  add(archive, model.geometry, model.solver);
  if (model.large_strain) add(archive, model.large_strain);
  for (Eigen::Index i = 0; i < model.mesh.x.cols(); ++i) add(archive, model.mesh.x(0, i), model.mesh.x(1, i));
  add(archive, model.mesh.number);
  for (const Material& m : model.materials) add(archive, m.number, m.name, m.code, m.parameters, m.unit_weight);
  for (const Material& m : model.materials)
    if (m.saturated_unit_weight != 0.0) add(archive, m.number, m.saturated_unit_weight);
  for (const Group& g : model.groups)
    add(archive, g.number, g.name, g.element_code, g.element_name, g.material, g.element_numbers, g.nodes);
  for (const Material& m : model.materials)
    for (const LawVariant& variant : m.variants) add(archive, variant.parameters);
  for (const Group& g : model.groups)
    for (const LawChoice& choice : g.choices) add(archive, choice.stage, choice.of_point);
  for (const Group& g : model.groups)
    if (g.overlay) add(archive, g.number, g.overlay);
  for (const Group& g : model.groups)
    if (g.second_material >= 0) add(archive, g.number, g.second_material);
  add_fixities(archive, model.fixities);
  add_turned_fixities(archive, model.turned_fixities);
  for (const Tie& tie : model.ties) add(archive, tie.node, tie.to, tie.component);
  add_field_fixities(archive, model.field_fixities);
  add_initials(archive, model.initials);
  for (const Stage& stage : model.stages) add_stage(archive, stage);
  for (const WaterCard& card : model.water) {
    add(archive, card.stage, card.group, card.kind, card.action, card.value);
    for (const Vector2& point : card.line) add(archive, point.x(), point.y());
    for (const auto& [node, pressure] : card.nodes) add(archive, node, pressure);
  }
  for (const Report& r : model.reports) {
    add(archive, r.kind, r.group, r.nodes, r.height, r.area, r.cell_pressure, r.place.x(), r.place.y(), r.name,
        r.stage);
    if (r.kind == ReportKind::section) add(archive, r.end.x(), r.end.y());
  }
  return archive.sum();
}

}  // namespace sage
