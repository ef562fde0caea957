#include "sage/app/answer_run.hpp"

#include <nlohmann/json.hpp>

#include "sage/record/profile_text.hpp"
#include "sage/record/values.hpp"

namespace sage::app {

namespace {

const char* kind_word(ReportKind kind) {
  switch (kind) {
    case ReportKind::triaxial:
      return "triaxial";
    case ReportKind::nodes:
      return "nodes";
    case ReportKind::point:
      return "point";
    case ReportKind::discharge:
      return "discharge";
    case ReportKind::uplift:
      return "uplift";
    case ReportKind::section:
      return "section";
  }
  return "";
}

Json report_json(const Model& model, const Reports& reports, std::size_t index) {
  const Report& report = model.reports[index];
  Json columns = Json::array(), rows = Json::array();
  for (const ReportColumn& column : report_columns(model, report))
    columns.push_back({{"name", json_text(column.name)}, {"unit", json_text(column.unit)}});
  for (std::size_t row = 0; row < reports.rows(index); ++row) {
    const auto [stage, increment] = reports.step(index, row);
    rows.push_back({{"stage", stage}, {"increment", increment}, {"values", reports.values(index, row)}});
  }
  return {{"title", json_text(report_title(model, index))},
          {"kind", kind_word(report.kind)},
          {"columns", std::move(columns)},
          {"rows", std::move(rows)},
          {"messages", json_list(reports.messages(index))}};
}

Json stages_json(const Model& model, const RunRecord& record) {
  Json stages = Json::array();
  for (std::size_t s = 0; s < record.stages.size(); ++s) {
    const RunRecord::StageCount& count = record.stages[s];
    stages.push_back({{"title", json_text(model.stages[s].title)},
                      {"increments_asked", model.stages[s].increments},
                      {"increments", count.increments},
                      {"iterations", count.iterations},
                      {"cuts", count.cuts}});
  }
  return stages;
}

Json points_json(const std::array<long, kStatuses>& points) {
  Json counts = Json::object();
  for (int s = 0; s < kStatuses; ++s) counts[std::string(status_name(static_cast<PointStatus>(s)))] = points[s];
  return counts;
}

Json strength_json(const std::vector<StrengthRow>& rows) {
  Json list = Json::array();
  for (const StrengthRow& row : rows)
    list.push_back({{"factor", row.factor},
                    {"load_factor", row.load_factor},
                    {"largest_displacement", row.largest},
                    {"iterations", row.iterations},
                    {"equilibrium", row.equilibrium != 0}});
  return list;
}

Json work_json(const WorkCounters& w) {
  return {{"assemblies", w.assemblies},         {"force_passes", w.residuals},
          {"factorisations", w.factorisations}, {"solves", w.solves},
          {"condensed_equations", w.condensed}, {"linear_products", w.linear_products},
          {"kept_factors", w.kept_factors},     {"repeated_increments", w.repeats},
          {"twin_equations", w.twin_equations}, {"border_steps", w.border_steps}};
}

// Extremes of each stage and of all, and the envelope at the ends of elements; compression positive.
Json extremes_json(const Model& model, const std::vector<ExtremeRow>& rows) {
  Json list = Json::array();
  const FieldList fields = structure_forces(model);
  for (const ExtremeRow& row : rows) {
    const FieldEntry& field = *fields[row.field];
    list.push_back(
        {{"stage", row.stage + 1},
         {"group", model.groups[row.group].number},
         {"quantity", field.name},
         {"unit", json_text(unit_text(field.dimension, model.units))},
         {"least", {{"value", row.low}, {"element", row.low_at}, {"stage", row.low_stage + 1}}},
         {"largest", {{"value", row.high}, {"element", row.high_at}, {"stage", row.high_stage + 1}}}});
  }
  return list;
}

Json end_json(const Model& model, const EnvelopeEnd& row) {
  const Group& group = model.groups[row.group];
  Json json = {{"group", group.number},
               {"element", group.element_numbers[row.element]},
               {"end", row.end},
               {"node", model.mesh.number[row.node]},
               {"x", model.mesh.x(0, row.node)},
               {"y", model.mesh.x(1, row.node)}};
  for (std::size_t q = 0; q < kEndQuantities.size(); ++q)
    if (has_quantity(model, group, q))
      json[std::string(kEndQuantities[q])] = {{"least", row.low[q]},
                                              {"least_stage", row.low_stage[q] + 1},
                                              {"largest", row.high[q]},
                                              {"largest_stage", row.high_stage[q] + 1}};
  return json;
}

Json structures_json(const Model& model, const RunRecord& record) {
  Json along = Json::array();
  for (const EnvelopeEnd& row : record.envelope.rows()) along.push_back(end_json(model, row));
  Json all = extremes_json(model, envelope(record.structures));
  for (Json& row : all) row.erase("stage");
  return {{"stages", extremes_json(model, record.structures)},
          {"envelope", std::move(all)},
          {"ends", std::move(along)}};
}

Json failure_json(const StepReport& failed) {
  return {{"stage", failed.stage + 1},
          {"increment", failed.increment},
          {"increments", failed.increments},
          {"load_factor", failed.load_factor},
          {"cuts", failed.cuts}};
}

Json error_json(const Model& model, const DiscretisationError& error) {
  Json json = Json::object();
  if (const std::string why = DiscretisationError::why_none(model); !why.empty()) json["none"] = json_text(why);
  if (error.estimate()) json["relative"] = error.estimate()->relative();
  if (error.estimate()) json["norm"] = error.estimate()->energy ? "energy" : "stress";
  if (error.ratio_error()) json["ratio"] = *error.ratio_error();
  return json;
}

}  // namespace

const char* status_word(RunStatus status) {
  switch (status) {
    case RunStatus::completed:
      return "completed";
    case RunStatus::not_converged:
      return "not_converged";
    case RunStatus::singular:
      return "singular";
    case RunStatus::stopped:
      return "stopped";
    case RunStatus::failed:
      return "failed";
  }
  return "failed";
}

Json model_json(const Model& model, const Scene& scene) {
  const UnitSystem& units = model.units;
  const bool ring = model.geometry == Geometry::axisymmetric;
  Json json = {{"title", json_text(model.title)},
               {"geometry", ring ? "axisymmetric" : "plane strain"},
               {"forces", ring ? "for the full circle" : "per unit thickness"},
               {"units",
                {{"length", json_text(units.length)},
                 {"force", json_text(units.force)},
                 {"stress", json_text(units.stress)}}},
               {"nodes", model.mesh.nodes()},
               {"elements", scene.elements},
               {"points", scene.points},
               {"groups", model.groups.size()},
               {"stages_asked", model.stages.size()},
               {"linear", scene.linear},
               {"symmetric", scene.symmetric}};
  if (!model.left_out.empty()) json["partial"] = json_text(left_out_words(model));
  return json;
}

Json reports_json(const Model& model, const Reports& reports) {
  Json list = Json::array();
  for (std::size_t i = 0; i < reports.count(); ++i) list.push_back(report_json(model, reports, i));
  return list;
}

Json files_json(const std::vector<std::filesystem::path>& files) {
  Json list = Json::array();
  for (const std::filesystem::path& file : files) list.push_back(json_text(file.string()));
  return list;
}

Json outcome_json(const RunOutcome& outcome) {
  const RunRecord& record = outcome.record;
  const RunResult& result = record.result;
  const Model& model = *outcome.model;
  Json json = {{"status", status_word(result.status)}, {"reason", json_text(result.reason)}};
  json["model"] = model_json(model, record.scene);
  json["equations"] = record.equations;
  json["solver"] = record.solver;
  json["kernels"] = result.kernels.empty() ? Json(nullptr) : Json(result.kernels);
  json["stages_done"] = result.stages_done;
  json["increments_done"] = result.increments_done;
  json["stages"] = stages_json(model, record);
  if (result.status != RunStatus::completed && result.status != RunStatus::stopped)
    json["failed_at"] = failure_json(record.failed);
  json["integration_points"] = points_json(record.points);
  if (!record.strength.rows().empty()) json["strength"] = strength_json(record.strength.rows());
  if (!record.structures.empty()) json["structures"] = structures_json(model, record);
  json["reports"] = outcome.reports ? reports_json(model, *outcome.reports) : Json::array();
  if (outcome.error) json["mesh_error"] = error_json(*outcome.model, *outcome.error);
  json["out_of_balance"] = record.audited > 0 ? Json(record.out_of_balance) : Json(nullptr);
  json["warnings"] = record.warnings;
  json["work"] = work_json(result.work);
  json["seconds"] = record.seconds;
  json["phases"] = Json::parse(profile_json(record.profile, "", 0, ""))["run"];
  json["files"] = files_json(outcome.files);
  return json;
}

}  // namespace sage::app
