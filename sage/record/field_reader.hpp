// Values of the table's fields (sage/core/field.hpp) in a state of a model.
#pragma once

#include "sage/analysis/observer.hpp"
#include "sage/analysis/probe.hpp"

namespace sage {

using FieldList = std::vector<const FieldEntry*>;

// A row for each history variable of a law and an element; and of all groups of a kind of element (or of all kinds), each
// name once.
std::vector<FieldEntry> history_fields(const LawRef& law, const ElementTraits& element);
std::vector<FieldEntry> history_fields(const Model& model, std::optional<ElementKind> kind = {});
// Rows for the unknowns besides displacement: of one named "c" whose load is "flux", "c", "c_flux" and
// "c_reaction".
std::vector<FieldEntry> unknown_fields(const Model& model);
// Rows of what is found from heads: the stream function.  Empty where no water flows.
std::vector<FieldEntry> flow_fields(const Model& model);
// The model's table, and behind it the rows of unknowns, of flow and of histories that clash with none of it.
FieldTable fields_of(const Model& model);

// Rows of a table by name.  Throws std::logic_error for a name that it lacks.
FieldList fields_named(const FieldTable& table, std::initializer_list<std::string_view> names);
// The same, and behind them those of the fields asked for that are numbers at nodes or points.
FieldList fields_at_places(const FieldTable& table, std::initializer_list<std::string_view> usual,
                           const std::vector<std::string>& asked);

// An integration point as its fields see it.
struct PointState {
  PointView view;
  const Group* group;
  ElementKind kind = ElementKind::solid;
  bool solid = false;
  Vector4 stress = Vector4::Zero(), strain = Vector4::Zero();  // of solids, compression positive

  PointState(const Mesh& mesh, const GroupData& data, std::size_t point);
};

// Whether a row that lives at points has values in elements of a kind, and in a group with a law.
bool applies(const FieldEntry& entry, ElementKind kind);
bool applies(const FieldEntry& entry, const Group& group, const LawRef& law);
bool applies(const FieldEntry& entry, const GroupData& data);

// entry.size() numbers.  At a point where the row does not apply: NaN.
void read_field(const FieldEntry& entry, const PointState& point, double* value);
// The same of a field that applies.
void read_applying(const FieldEntry& entry, const PointState& point, double* value);
void read_field(const FieldEntry& entry, const NodeView& node, double* value);
void read_field(const FieldEntry& entry, const ElementView& element, double* value);
void read_field(const FieldEntry& entry, const IncrementView& increment, double* value);

// Nodes as their fields see them.  Model and solution must outlive it, and it the views.
class NodeViews {
 public:
  NodeViews(const Model& model, const Solution& solution);
  NodeViews(const NodeViews&) = delete;
  NodeViews& operator=(const NodeViews&) = delete;
  NodeView at(int node) const;

 private:
  const Model& model_;
  const Solution& solution_;
  const std::function<double(int)> stream_function_;
};
// x: coordinates of the element's nodes; they and the group must outlive the view.
ElementView element_view(const Model& model, const Group& group, int element, const Eigen::Matrix2Xd& x);
// `worst_node` and the like are NaN where the step has none.
IncrementView increment_view(const Model& model, const StepReport& report);

// What shape functions, means and extrapolation carry of a field from points or nodes to other places: the
// stress of a StressField, not its value.
std::size_t carried_size(const FieldEntry& entry);
void carry(const FieldEntry& entry, const PointState& point, double* parts);
void carry(const FieldEntry& entry, const NodeView& node, double* parts);
// The value from what arrived.
void value_of_carried(const FieldEntry& entry, const double* parts, double* value);

// The number that a choice means, of a field's value.
double chosen(const FieldChoice& choice, const double* value);

// A field at any place (docs/theory/accuracy.md); NaN where the probe holds none, or the field is of elements or
// increments.
std::vector<double> field_at(const FieldEntry& entry, const Model& model, const Probe& probe,
                             const Solution& solution);

// "sig-z [psi], compression positive", "length of displacement [in]".
std::string describe(const FieldChoice& choice, const Model& model);

// The word of a value of FieldForm::word; empty for NaN.
std::string_view word_of(const FieldEntry& entry, double value);

}  // namespace sage
