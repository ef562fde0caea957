#include "sage/app/run_model.hpp"

#include <algorithm>

#include "sage/app/commands.hpp"
#include "sage/app/screen.hpp"
#include "sage/app/state_choice.hpp"
#include "sage/deck/text.hpp"
#include "sage/draw/diagram.hpp"
#include "sage/draw/picture.hpp"
#include "sage/exchange/convert.hpp"
#include "sage/record/vtu.hpp"

namespace sage::app {

namespace {

// A warning about the fields that were asked for in vain.
void warn_of_fields(const OutputOptions& o, Model& model) {
  const bool tables = o.listing && o.tables != Tables::none, all = o.vtu || o.msh || o.result;
  const bool reports =
      std::ranges::any_of(model.reports, [](const Report& r) { return r.kind == ReportKind::point; });
  const auto has_column = [&](const FieldEntry& row) {
    const bool in_reports = reports && row.form == FieldForm::number;
    switch (row.place()) {
      case FieldPlace::node:
        return o.nodes || tables || in_reports || all;
      case FieldPlace::point:
        return o.points || tables || in_reports || all;
      case FieldPlace::increment:
        return o.increments || o.result;
      case FieldPlace::element:
        return all;
    }
    return true;
  };
  const std::string text = fields_without_column(
      o.fields, fields_of(model), has_column,
      "ask for --nodes (fields of nodes), --points (of integration points) or --result (all)");
  if (!text.empty()) model.diagnostics.add({Severity::warning, "S610", {model.file, 0, 0, 0}, text, {}});
}

// Pictures of integration points that no element has that is drawn would be empty, but for structures, which are drawn in
// every picture.
void expect_drawn(const std::vector<std::string>& pictures, const Model& model) {
  const bool structures =
      std::ranges::any_of(model.groups, [](const Group& group) { return group.structure(); });
  const bool moves = std::ranges::any_of(
      model.groups, [](const Group& group) { return group.entry->moves() && group.elements() > 0; });
  const FieldTable table = fields_of(model);
  const auto of_motion = [](const FieldEntry& field) {
    return field.name == "displacement" || field.name == "external_force" || field.name == "reaction";
  };
  const auto is_drawn = [&](const FieldEntry& field, bool diagram) {
    if (field.place() == FieldPlace::node) return moves || !of_motion(field);
    return std::ranges::any_of(model.groups, [&](const Group& group) {
      const ElementKind kind = diagram ? ElementKind::structure : ElementKind::solid;
      return drawn_as(group) == kind && group.elements() > 0 &&
             applies(field, group, model.material_of(group).law_ref());
    });
  };
  for (const std::string& name : pictures) {
    const FieldChoice field = picture_field(table, name);
    const bool diagram = diagram_of(name) >= 0;
    if (is_drawn(*field.entry, diagram) || (structures && !diagram)) continue;
    std::string there;
    for (const FieldEntry& row : table.rows()) {
      const bool shown = row.place() == FieldPlace::node || row.place() == FieldPlace::point;
      if (shown && row.form == FieldForm::number && is_drawn(row, false))
        there += (there.empty() ? "" : ", ") + row.name;
    }
    throw UsageError("S644", "--picture " + name + ": no " +
                                 (diagram ? "structure" : "element that fills an area") +
                                 " of this deck has it, the picture would be empty; there are: " + there);
  }
}

}  // namespace

std::unique_ptr<Model> read_model(RunRequest& request, const Catalogue& catalogue, ResultOwner& owner,
                                  RunSource& source, Profile& profile) {
  const Deck deck = [&] {
    const Profile::Scope scope(profile, phase::kReading);
    return read_input(request.deck, request.input);
  }();
  const Profile::Scope scope(profile, phase::kModel);
  BuildOptions build = request.input.build;
  if (!request.solver.empty()) build.solver = solver_code(catalogue, request.solver);
  std::string heads;
  if (request.output.result && build.heads) build.heads = keeping_heads(build.heads, heads);
  auto model = std::make_unique<Model>(build_model(deck, catalogue, build));
  owner.deck_sum = checksum(*deck.source.text());
  if (request.output.result) source = source_of(*deck.source.text(), deck.layout, request.input.layout, build);
  source.heads = std::move(heads);
  if (request.output.vtu || request.output.result) warn_of_vtu(*model, model->diagnostics);
  if (request.output.msh) msh_mesh(*model, MshForm::binary, model->diagnostics);
  request.output.fields = require_fields(request.output.pictures, request.output.fields, {fields_of(*model)});
  expect_drawn(request.output.pictures, *model);
  warn_of_fields(request.output, *model);
  for (Report& report : model->reports) report.fields = request.output.fields;
  try {
    for (const std::string& note : ask_for_states(*model, request.output.states))
      if (!request.quiet) say_note(request.deck, note, "S643");
  } catch (const std::invalid_argument& error) {
    throw UsageError("S643", std::string("--states: ") + error.what());
  }
  return model;
}

}  // namespace sage::app
