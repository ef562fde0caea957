#include "sage/draw/picture_field.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sage/draw/diagram.hpp"
#include "sage/draw/flow_net.hpp"

namespace sage {

namespace {

constexpr double kRoundOff = 1e-9;  // of the largest stress or displacement: not worth a colour
constexpr std::size_t kMost = 16;   // numbers of a field without memory of its own

// Of what a DisplacementField, StressField or StrainField carries; 0 of others, whose numbers may differ by much.
double largest_of(const FieldEntry& field, const Eigen::MatrixXd& at) {
  double largest = 0.0;
  const bool moved = std::holds_alternative<DisplacementField>(field.value);
  if (!moved && !std::holds_alternative<StressField>(field.value) &&
      !std::holds_alternative<StrainField>(field.value))
    return largest;
  for (Eigen::Index e = 0; e < at.cols(); ++e) {  // NaN at interfaces
    const double one = moved ? at.col(e).norm() : at.col(e).cwiseAbs().maxCoeff();
    if (one > largest) largest = one;
  }
  return largest;
}

}  // namespace

std::string unknown_field(const FieldTable& table, std::string_view name, bool pictures) {
  const bool heads = table.find("head") != nullptr;
  if (name == kFlowNet)
    return pictures ? "flow_net is of heads, and the model has none: it has no elements of flow"
                    : "flow_net is a picture; head is its field";
  return "unknown field " + std::string(name) + "; known: conf, dev, SL, " +
         (pictures && heads ? "flow_net, " : "") + table.known();
}

FieldChoice picture_field(const FieldTable& table, std::string_view name) {
  std::string_view field = name == kFlowNet ? "head" : name;
  if (is_envelope(name)) field = kEndQuantities[static_cast<std::size_t>(diagram_of(name))];
  const std::optional<FieldChoice> choice = table.choose(field);
  const FieldPlace place = choice ? choice->entry->place() : FieldPlace::increment;
  if (place == FieldPlace::node || place == FieldPlace::point) return *choice;
  throw std::invalid_argument(unknown_field(table, name, true));
}

void unfold_angles(const FieldEntry& field, std::vector<double*> values) {
  if (field.dimension != Dimension::angle || !field.of_mean) return;
  const auto steep = std::ranges::count_if(values, [](const double* v) { return std::abs(*v) > 45.0; });
  const auto flat = std::ranges::count_if(values, [](const double* v) { return std::abs(*v) <= 45.0; });
  if (steep <= flat) return;
  for (double* value : values)
    if (*value < 0.0) *value += 180.0;
}

FieldParts field_parts(const Model& model, const Solution& s, const NodalLayout& layout,
                       const FieldEntry& field, NodalRule rule) {
  FieldParts parts;
  const auto entries = static_cast<Eigen::Index>(layout.node.size());
  parts.components = static_cast<int>(carried_size(field));
  if (field.place() == FieldPlace::node) {
    parts.at.resize(parts.components, entries);
    const NodeViews nodes(model, s);
    for (Eigen::Index e = 0; e < entries; ++e)
      carry(field, nodes.at(layout.node[static_cast<std::size_t>(e)]), parts.at.col(e).data());
  } else {
    const std::vector<double> values = nodal_average(model, s, layout, {&field}, rule);
    parts.at = Eigen::Map<const Eigen::MatrixXd>(values.data(), parts.components, entries);
  }
  parts.largest = largest_of(field, parts.at);
  return parts;
}

double field_number(const FieldChoice& field, const FieldParts& parts, const double* at) {
  std::array<double, kMost> room;
  std::vector<double> more(field.entry->size() > kMost ? field.entry->size() : 0);
  double* values = more.empty() ? room.data() : more.data();
  value_of_carried(*field.entry, at, values);
  const double value = chosen(field, values);
  return std::abs(value) < kRoundOff * parts.largest ? 0.0 : value;
}

}  // namespace sage
