#include "sage/draw/picture_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "sage/draw/diagram.hpp"
#include "sage/draw/flow_net.hpp"
#include "sage/math/rounding.hpp"
#include "sage/messages/near_names.hpp"
#include "sage/model/coarse_shape.hpp"

namespace sage {

namespace {

constexpr double kRoundOff = rounding::kText;  // of the largest stress or displacement: not worth a colour
constexpr std::size_t kMost = 16;              // numbers of a field without memory of its own

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

// The range of what the points of areas have of a field that is carried as it is.
void set_range(FieldParts& parts, const Model& model, const Solution& s, const NodalLayout& layout,
               const FieldEntry& field) {
  if (!std::holds_alternative<PointField>(field.value)) return;
  const double infinite = std::numeric_limits<double>::infinity();
  std::vector<double> value(field.size()), least(field.size(), infinite), most(field.size(), -infinite);
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const GroupData& data = s.groups()[g];
    const Group& group = model.groups[g];
    if (layout.of_group[g].empty() || drawn_as(group) != ElementKind::solid || !applies(field, data)) continue;
    const auto points = static_cast<std::size_t>(group.elements() * group.element->traits().points);
    for (std::size_t p = 0; p < points; ++p) {
      read_applying(field, PointState(model.mesh, data, p), value.data());
      for (std::size_t c = 0; c < value.size(); ++c) {
        if (value[c] < least[c]) least[c] = value[c];
        if (value[c] > most[c]) most[c] = value[c];
      }
    }
  }
  for (std::size_t c = 0; c < value.size(); ++c)
    if (!(least[c] <= most[c])) least[c] = -infinite, most[c] = infinite;  // no number anywhere
  parts.least = std::move(least);
  parts.most = std::move(most);
}

// The excess pressure of pore water is linear between the corners, which alone have it.
void fill_between_corners(const Model& model, const NodalLayout& layout, Eigen::MatrixXd& at) {
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    const std::vector<int>& entries = layout.of_group[g];
    if (entries.empty() || group.entry == nullptr || !group.entry->has_pores()) continue;
    const std::size_t nodes = group.node_count();
    const auto corners = static_cast<std::size_t>(group.entry->corners);
    for (std::size_t first = 0; first < entries.size(); first += nodes)
      for (std::size_t i = corners; i < nodes; ++i) {
        auto value = at.col(entries[first + i]);
        if (!value.array().isNaN().all()) continue;
        value.setZero();
        const std::array<double, 4> shares = corner_shares(group.entry->corners, group.entry->parent_nodes[i]);
        for (std::size_t c = 0; c < corners; ++c) value += shares[c] * at.col(entries[first + c]);
      }
  }
}

}  // namespace

std::string unknown_field(const FieldTable& table, std::string_view name, bool pictures) {
  const bool heads = table.find("head") != nullptr;
  if (name == kFlowNet)
    return pictures ? "flow_net is of heads, and the model has none: it has no elements of flow"
                    : "flow_net is a picture; head is its field";
  std::vector<std::string> names{"conf", "dev", "SL"};
  for (const FieldEntry& row : table.rows()) names.push_back(row.name);
  return "unknown field " + std::string(name) + "; known: conf, dev, SL, " +
         (pictures && heads ? "flow_net, " : "") + table.known() + did_you_mean(name, names);
}

FieldChoice picture_field(const FieldTable& table, std::string_view name) {
  std::string_view field = name == kFlowNet ? "head" : name;
  if (is_envelope(name)) field = kEndQuantities[diagram_of(name)];
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
    for (Eigen::Index e = 0; e < entries; ++e) carry(field, nodes.at(layout.node[e]), parts.at.col(e).data());
    fill_between_corners(model, layout, parts.at);
  } else {
    const std::vector<double> values = nodal_average(model, s, layout, {&field}, rule);
    parts.at = Eigen::Map<const Eigen::MatrixXd>(values.data(), parts.components, entries);
    set_range(parts, model, s, layout, field);
  }
  parts.largest = largest_of(field, parts.at);
  return parts;
}

double field_number(const FieldChoice& field, const FieldParts& parts, const double* at) {
  std::array<double, kMost> room;
  std::vector<double> more(field.entry->size() > kMost ? field.entry->size() : 0);
  double* values = more.empty() ? room.data() : more.data();
  value_of_carried(*field.entry, at, values);
  for (std::size_t c = 0; c < parts.least.size(); ++c)
    values[c] = std::clamp(values[c], parts.least[c], parts.most[c]);
  const double value = chosen(field, values);
  return std::abs(value) < kRoundOff * parts.largest ? 0.0 : value;
}

std::string rule_text(const FieldEntry& entry, NodalRule rule) {
  if (entry.place() != FieldPlace::point) return "";
  if (entry.of_mean) return "values: a colour an element, of its mean stress or strain";
  return rule == NodalRule::element_means ? "values: means of elements, averaged at nodes"
                                          : "values: extrapolated from points to nodes, averaged there";
}

PictureValues::PictureValues(const Model& model, const Solution& solution, const FieldChoice& field,
                             NodalRule rule)
    : model_(model),
      field_(field),
      layout_(nodal_layout(model, *solution.activity)),
      parts_(field_parts(model, solution, layout_, *field.entry, rule)),
      solids_(model),
      flow_(model, ElementKind::flow) {
  if (!field.entry->of_mean) return;
  for (std::size_t g = 0; g < model.groups.size(); ++g)
    of_elements_.push_back(layout_.of_group[g].empty()
                               ? std::vector<double>()
                               : element_average(model.mesh, solution.groups()[g], {field.entry}));
}

double PictureValues::at(const Vector2& place) const {
  for (const Locator* locator : {&solids_, &flow_})
    for (const Location& location : locator->at(place))
      if (const double value = at(location); std::isfinite(value)) return value;
  return std::numeric_limits<double>::quiet_NaN();
}

double PictureValues::at(const Location& location) const {
  const std::vector<int>& entries = layout_.of_group[location.group];
  if (entries.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto e = static_cast<std::size_t>(location.element);
  if (field_.entry->of_mean)
    return chosen(field_, of_elements_[location.group].data() + e * field_.entry->size());
  Eigen::VectorXd at = Eigen::VectorXd::Zero(parts_.components);
  for (std::size_t i = 0; i < location.N.size(); ++i)
    at += location.N[i] * parts_.at.col(entries[e * location.N.size() + i]);
  return field_number(field_, parts_, at.data());
}

}  // namespace sage
