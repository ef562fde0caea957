#include "sage/model/fingerprint.hpp"

#include "sage/core/archive.hpp"

namespace sage {

namespace {

template <class T>
void add(Archive& archive, T value) {
  archive(value);
}

void add_vector(Archive& archive, const Vector2& v) {
  add(archive, v.x());
  add(archive, v.y());
}

void add_material(Archive& archive, const Material& material) {
  add(archive, material.code);
  add(archive, material.parameters);
  add(archive, material.unit_weight);
}

void add_group(Archive& archive, const Group& group) {
  add(archive, group.element_code);
  add(archive, group.element_name);
  add(archive, group.material);
  add(archive, group.nodes);
}

void add_fixities(Archive& archive, const std::vector<Fixity>& fixities) {
  for (const Fixity& f : fixities) {
    add(archive, f.node);
    add(archive, f.code);
    add(archive, f.value);
  }
}

void add_initials(Archive& archive, const std::vector<InitialStress>& initials) {
  for (const InitialStress& initial : initials) {
    add(archive, initial.group);
    add(archive, initial.kind);
    add(archive, initial.value);
  }
}

void add_stage(Archive& archive, const Stage& stage) {
  add(archive, stage.increments);
  add(archive, stage.method);
  add(archive, stage.max_iterations);
  add(archive, stage.output_every);
  add(archive, stage.tolerance);
  add_vector(archive, stage.gravity);
  add_fixities(archive, stage.fixities);
  for (const NodalLoad& load : stage.loads) {
    add(archive, load.node);
    add_vector(archive, load.force);
  }
  for (const EdgeLoad& load : stage.pressures) {
    add(archive, load.group);
    add(archive, load.element);
    add(archive, load.edge);
    add_vector(archive, load.normal);
    add_vector(archive, load.shear);
  }
  add(archive, stage.births);
  add(archive, stage.deaths);
  add_initials(archive, stage.initials);
}

void add_report(Archive& archive, const Report& report) {
  add(archive, report.kind);
  add(archive, report.group);
  add(archive, report.nodes);
  add(archive, report.height);
  add(archive, report.area);
  add(archive, report.cell_pressure);
  add(archive, report.stage);
}

}  // namespace

std::uint64_t fingerprint(const Model& model) {
  Archive archive;
  add(archive, model.geometry);
  add(archive, model.units.atmospheric_pressure);
  add(archive, model.units.water_unit_weight);
  add(archive, model.solver);
  for (Eigen::Index i = 0; i < model.mesh.x.cols(); ++i) add_vector(archive, model.mesh.x.col(i));
  add(archive, model.mesh.number);
  for (const Material& material : model.materials) add_material(archive, material);
  for (const Group& group : model.groups) add_group(archive, group);
  add_fixities(archive, model.fixities);
  add_initials(archive, model.initials);
  for (const Stage& stage : model.stages) add_stage(archive, stage);
  for (const Report& report : model.reports) add_report(archive, report);
  return checksum(archive.bytes());
}

}  // namespace sage
