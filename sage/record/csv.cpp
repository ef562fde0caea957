#include "sage/record/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sage/record/values.hpp"

namespace sage {

namespace {

constexpr const char* kPointColumns = "group,element,point";

// A table's cells, one behind the other.
struct Cells {
  std::string& text;
  int digits = kCsvDigits;

  void result(double value) const { append_result_cell(text, value, digits); }
  void optional(double value) const { append_optional_cell(text, value, digits); }
  void integer(long value) const {
    text += ',';
    append_integer(text, value, 0);
  }
  void word(std::string_view value) const {
    text += ',';
    text += value;
  }
  void blank() const { text += ','; }
  // The first two columns.
  void begin(const StepReport& report) const {
    append_integer(text, report.stage + 1, 0);
    integer(report.increment);
  }
  void end() const { text += '\n'; }
};

std::string head(const Model& model) {
  return "# " + model.title + "\n" + sign_convention(model, "# ");
}

// "stress_xx[psi]"; whole numbers and words have no unit.
std::string columns_of(const FieldList& fields, const UnitSystem& units) {
  std::string text;
  for (const FieldEntry* field : fields)
    for (std::size_t c = 0; c < field->size(); ++c) {
      text += "," + field->column(c);
      if (field->form == FieldForm::number) text += "[" + unit_text(field->dimension, units) + "]";
    }
  return text + "\n";
}

std::string places_header(const Model& model, const char* columns) {
  const bool ring = model.geometry == Geometry::axisymmetric && columns == kPointColumns;
  return head(model) + (ring ? "# x = r, y = z, zz = hoop\n" : "") +
         fmt::format("stage,increment,{0},x[{1}],y[{1}]", columns, model.units.length);
}

void field_cells(const Cells& cells, const FieldEntry& field, const double* values) {
  for (std::size_t c = 0; c < field.size(); ++c) {
    if (field.form == FieldForm::word)
      cells.word(word_of(field, values[c]));
    else if (field.form == FieldForm::integer && std::isnan(values[c]))
      cells.blank();
    else if (field.form == FieldForm::integer)
      cells.integer(std::lround(values[c]));
    else if (field.optional)
      cells.optional(values[c]);  // infinite where no strength is left
    else
      cells.result(values[c]);
  }
}

std::size_t most_values(const FieldList& fields) {
  std::size_t most = 1;
  for (const FieldEntry* field : fields) most = std::max(most, field->size());
  return most;
}

void node_rows(const Cells& cells, const Model& model, const StepReport& report, const Solution& s,
               const FieldList& fields) {
  const std::vector<char> active = active_nodes(model, *s.activity);
  std::vector<double> values(most_values(fields));
  const NodeViews views(model, s);
  for (int node = 0; node < model.mesh.nodes(); ++node) {
    if (!active[node]) continue;
    const NodeView view = views.at(node);
    cells.begin(report);
    cells.integer(view.number);
    for (int c = 0; c < 2; ++c) cells.result(view.place[c]);
    for (const FieldEntry* field : fields) {
      read_field(*field, view, values.data());
      field_cells(cells, *field, values.data());
    }
    cells.end();
  }
}

void point_rows(const Cells& cells, const Model& model, const StepReport& report, const GroupData& data,
                const FieldList& fields) {
  const Group& group = *data.group;
  const int count = group.element->traits().points;
  std::vector<double> values(most_values(fields));
  std::vector<char> has;
  for (const FieldEntry* field : fields) has.push_back(applies(*field, data) ? 1 : 0);
  Eigen::Matrix2Xd x;
  for (int e = 0; e < group.elements(); ++e) {
    element_coordinates(model.mesh, group, e, x);
    for (int p = 0; p < count; ++p) {
      const PointState point(model.mesh, data, static_cast<std::size_t>(e * count + p));
      const Vector2 at = group.element->position(x, p);
      cells.begin(report);
      cells.integer(group.number);
      cells.integer(group.element_numbers[e]);
      cells.integer(p + 1);
      cells.result(at.x());
      cells.result(at.y());
      for (std::size_t i = 0; i < fields.size(); ++i) {
        if (has[i]) {
          read_field(*fields[i], point, values.data());
          field_cells(cells, *fields[i], values.data());
        } else {
          for (std::size_t c = 0; c < fields[i]->size(); ++c) cells.blank();
        }
      }
      cells.end();
    }
  }
}

// A result that is no number throws: the rows of its state are then taken back.
template <class AddRows>
void add_whole(OutFile& file, const AddRows& add_rows) {
  if (!file.open()) return;
  const std::size_t before = file.text().size();
  try {
    add_rows(file.text());
  } catch (...) {
    file.text().resize(before);
    throw;
  }
}

}  // namespace

Csv::Csv(const std::filesystem::path& folder, const std::string& stem, CsvOptions options)
    : folder_(folder),
      stem_(stem),
      digits_(options.digits),
      asked_(std::move(options.fields)),
      wants_points_(options.points) {
  if (options.increments) increments_.file = OutFile(folder / (stem + ".increments.csv"));
  if (options.nodes) nodes_.file = OutFile(folder / (stem + ".nodes.csv"));
  if (options.points) points_.file = OutFile(folder / (stem + ".points.csv"));
}

Csv::Table& Csv::of(ElementKind kind) {
  switch (kind) {
    case ElementKind::interface:
      return interfaces_;
    case ElementKind::structure:
      return structures_;
    case ElementKind::flow:
      return flows_;
    case ElementKind::solid:
      break;
  }
  return points_;
}

// The usual columns, the history of the laws, then what was asked for.  Structures show every field of theirs:
// of the program's own first.
void Csv::choose_fields(const Model& model) {
  const auto program = FieldTable().rows();
  for (const FieldEntry& row : program)
    if (row.place() == FieldPlace::increment) increments_.fields.push_back(&row);
  nodes_.fields = fields_named({}, {"displacement", "external_force", "reaction"});
  points_.fields = fields_named({}, {"stress", "strain", "stress_level", "status"});
  interfaces_.fields = fields_named({}, {"traction", "relative_displacement", "stress_level", "status"});
  flows_.fields = fields_named({}, {"velocity", "hydraulic_gradient"});
  unknowns_ = unknown_fields(model);
  for (const FieldEntry& row : unknowns_) nodes_.fields.push_back(&row);
  fields_ = fields_of(model);
  const auto applies_here = [&](const FieldEntry& row) {
    return std::ranges::any_of(model.groups, [&](const Group& group) {
      return applies(row, group, model.material_of(group).law_ref());
    });
  };
  for (const FieldEntry& row : fields_.rows())
    if (row.kind == ElementKind::structure && applies_here(row)) structures_.fields.push_back(&row);
  for (const char* name : {"stress_level", "status"}) structures_.fields.push_back(fields_.find(name));
  for (const ElementKind kind : kElementKinds) {
    std::vector<FieldEntry>& history = history_[static_cast<std::size_t>(kind)];
    history = history_fields(model, kind);
    for (const FieldEntry& row : history) of(kind).fields.push_back(&row);
  }
  const auto add = [](Table& table, const FieldEntry* row) {
    if (std::ranges::none_of(table.fields, [&](const FieldEntry* one) { return one->name == row->name; }))
      table.fields.push_back(row);
  };
  for (const std::string& name : asked_) {
    const FieldEntry* row = fields_.find(name);
    if (row == nullptr) continue;
    if (row->place() == FieldPlace::node) add(nodes_, row);
    if (row->place() == FieldPlace::increment) add(increments_, row);
    for (const ElementKind kind : kElementKinds)
      if (applies(*row, kind)) add(of(kind), row);
  }
}

void Csv::open(Table& table, const std::string& header, const Model& model) {
  if (table.file.open()) table.file.text() = header + columns_of(table.fields, model.units);
}

void Csv::on_start(const Model& model, const Scene&, std::string_view, int) {
  choose_fields(model);
  open(increments_, head(model) + "stage,increment", model);
  open(nodes_, places_header(model, "node"), model);
  open(points_, places_header(model, kPointColumns), model);
  const std::pair<ElementKind, const char*> kOthers[] = {{ElementKind::interface, ".interfaces.csv"},
                                                         {ElementKind::structure, ".structures.csv"},
                                                         {ElementKind::flow, ".flow.csv"}};
  for (const auto& [kind, name] : kOthers) {
    const auto has = [kind = kind](const Group& group) { return group.entry->kind == kind; };
    if (wants_points_ && std::ranges::any_of(model.groups, has))
      of(kind).file = OutFile(folder_ / (stem_ + name));
    open(of(kind), places_header(model, kPointColumns), model);
  }
  open_ends(model);
}

void Csv::open_ends(const Model& model) {
  quantities_ = end_quantities(model);
  if (!wants_points_ || quantities_.empty()) return;
  const std::string ends = fmt::format("group,element,end,node,x[{0}],y[{0}]", model.units.length);
  const auto unit = [&](std::size_t q) { return unit_text(end_field(q).dimension, model.units); };
  const std::string along =
      "# ends of elements, in equilibrium with the forces of their nodes; 1 = at the element's first node\n";
  ends_.file = OutFile(folder_ / (stem_ + ".ends.csv"));
  ends_.file.text() = head(model) + along + "stage,increment," + ends;
  envelope_table_.file = OutFile(folder_ / (stem_ + ".envelope.csv"));
  envelope_table_.file.text() =
      head(model) + along + "# least and largest at the ends of all stages, each with its stage\n" + ends;
  for (const std::size_t q : quantities_) {
    const std::string name(kEndQuantities[q]);
    ends_.file.text() += fmt::format(",{}[{}]", name, unit(q));
    envelope_table_.file.text() +=
        fmt::format(",{0}_least[{1}],{0}_least_stage,{0}_largest[{1}],{0}_largest_stage", name, unit(q));
  }
  ends_.file.text() += '\n';
  envelope_table_.file.text() += '\n';
}

void Csv::add_ends(const Model& model, const StepReport& report, const Solution& solution) {
  add_whole(ends_.file, [&](std::string& text) {
    const Cells cells{text, digits_};
    for (std::size_t g = 0; g < model.groups.size(); ++g)
      for (const ElementEnd& end : element_ends(model, solution, g)) {
        const Group& group = model.groups[g];
        cells.begin(report);
        cells.integer(group.number);
        cells.integer(group.element_numbers[end.element]);
        cells.integer(end.end);
        cells.integer(model.mesh.number[end.node]);
        for (int c = 0; c < 2; ++c) cells.result(end.place[c]);
        for (const std::size_t q : quantities_) cells.optional(end.value[q]);
        cells.end();
      }
  });
}

void Csv::add_envelope(const Model& model) {
  if (!envelope_table_.file.open()) return;
  std::string& text = envelope_table_.file.text();
  const Cells cells{text, digits_};
  for (const EnvelopeEnd& row : envelope_.rows()) {
    const Group& group = model.groups[row.group];
    append_integer(text, group.number, 0);
    cells.integer(group.element_numbers[row.element]);
    cells.integer(row.end);
    cells.integer(model.mesh.number[row.node]);
    for (int c = 0; c < 2; ++c) cells.result(model.mesh.x(c, row.node));
    for (const std::size_t q : quantities_)
      for (const auto& [value, stage] :
           {std::pair{row.low[q], row.low_stage[q]}, {row.high[q], row.high_stage[q]}}) {
        cells.optional(value);
        if (std::isnan(value))
          cells.blank();
        else
          cells.integer(static_cast<long>(stage) + 1);
      }
    cells.end();
  }
}

void Csv::on_stage_end(const Model& model, int stage, const EquilibriumAudit&, const Solution& solution) {
  if (envelope_table_.file.open()) envelope_.add(model, stage, solution);
}

void Csv::add_increment(const Model& model, const StepReport& report) {
  add_whole(increments_.file, [&](std::string& text) {
    const Cells cells{text, digits_};
    const IncrementView view = increment_view(model, report);
    std::vector<double> values(most_values(increments_.fields));
    cells.begin(report);
    for (const FieldEntry* field : increments_.fields) {
      read_field(*field, view, values.data());
      field_cells(cells, *field, values.data());
    }
    cells.end();
  });
}

void Csv::add_states(const Model& model, const StepReport& report, const Solution& solution) {
  add_whole(nodes_.file, [&](std::string& text) {
    node_rows({text, digits_}, model, report, solution, nodes_.fields);
  });
  for (const ElementKind kind : kElementKinds)
    add_whole(of(kind).file, [&](std::string& text) {
      for (const GroupData& data : solution.groups())
        if (data.active && data.group->entry->kind == kind)
          point_rows({text, digits_}, model, report, data, of(kind).fields);
    });
  add_ends(model, report, solution);
  for (Table* table : all()) table->file.checkpoint();
}

void Csv::on_increment(const Model& model, const StepReport& report, const Solution& solution) {
  add_increment(model, report);
  increments_.file.checkpoint();
  if (is_output_increment(stage_of(model, report.stage), report)) add_states(model, report, solution);
}

void Csv::exchange(Archive& archive) {
  for (Table* table : all()) table->file.exchange(archive);
  envelope_.exchange(archive);
}

void Csv::comment(const std::string& line) {
  for (Table* table : all())
    if (table->file.open()) table->file.text() += "# " + line + "\n";
}

void Csv::on_failure(const Model& model, const StepReport& report, const std::string&,
                     const Solution& solution) {
  add_increment(model, report);
  add_states(model, report, solution);
  add_envelope(model);
  envelope_ = {};
  comment(fmt::format(
      "NOT CONVERGED in stage {}, increment {}; the last state in equilibrium is at load factor {:.6g}",
      report.stage + 1, report.increment, report.load_factor));
}

void Csv::finish() {
  for (Table* table : all()) {
    if (!table->file.open()) continue;
    table->file.finish();
    files_.push_back(table->file.path());
  }
}

void Csv::on_finish(const Model& model, const RunResult&) {
  add_envelope(model);
  finish();
}

void Csv::stop(const std::string& reason) {
  comment("RUN STOPPED, NOT COMPLETE: " + one_line(reason));
  finish();
}

}  // namespace sage
