#include "sage/model/model.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

#include "sage/core/contact.hpp"

namespace sage {

std::string history_text(const TimeTable& table) {
  std::string text;
  const auto add = [&](double number) {
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    text += (text.empty() ? "" : " ") + std::string(digits.data(), end);
  };
  for (const auto& [time, share] : table) add(time), add(share);
  return text;
}

double share_at(const TimeTable& table, double time) {
  std::pair<double, double> before{0.0, 0.0};
  for (const auto& next : table) {
    if (time <= next.first) {
      if (next.first == before.first) return next.second;
      const double part = (time - before.first) / (next.first - before.first);
      return before.second + part * (next.second - before.second);
    }
    before = next;
  }
  return before.second;
}

LawRef Material::law_ref() const {
  return reference(law);
}

void set_element(Group& group, const Catalogue& catalogue, int code, int formulation, Geometry geometry) {
  std::shared_ptr<const ElementEntry> entry = catalogue.elements.share(code);
  if (entry == nullptr) throw std::logic_error("the catalogue has no element " + std::to_string(code));
  group.element = entry->make(geometry, formulation);
  group.element_code = code;
  group.entry = std::move(entry);
  const auto& known = group.entry->formulations;
  const auto found =
      std::find_if(known.begin(), known.end(), [&](const Formulation& f) { return f.code == formulation; });
  const Formulation& made = found == known.end() ? known.front() : *found;
  group.formulation = made.code;
  group.element_name = group.entry->name + " " + made.name;
}

const Formulation& Group::formulation_entry() const {
  const auto& known = entry->formulations;
  const auto found = std::ranges::find(known, formulation, &Formulation::code);
  return found == known.end() ? known.front() : *found;
}

std::optional<double> Material::parameter(ParameterRole role) const {
  const int i = entry == nullptr ? -1 : entry->find(role);
  if (i < 0 || static_cast<std::size_t>(i) >= parameters.size()) return std::nullopt;
  return parameters[i];
}

namespace {

// Without those of lines of contact, which may be longer than what stands on them: where no other is left, the specimen's.
std::vector<int> nodes_of_area(const Model& model, const Report& report) {
  // Decks with mistakes have groups of unknown elements.
  const auto is_of_contact = [](const Group& group) {
    return group.entry != nullptr && is_contact(*group.entry);
  };
  if (std::ranges::none_of(model.groups, is_of_contact)) return report.nodes;
  std::set<int> of_bodies;
  for (const Group& group : model.groups)
    if (!is_of_contact(group)) of_bodies.insert(group.nodes.begin(), group.nodes.end());
  std::vector<int> nodes = report.nodes;
  std::erase_if(nodes, [&](int node) { return !of_bodies.contains(node); });
  if (nodes.empty() && report.group >= 0) nodes = model.groups[report.group].nodes;
  std::erase_if(nodes, [&](int node) { return node < 0 || node >= model.mesh.nodes(); });  // not made yet
  return nodes;
}

}  // namespace

Vector2 turned_axis(double angle, std::size_t component) {
  const double along = angle * kRadiansPerDegree, c = std::cos(along), s = std::sin(along);
  return component == 0 ? Vector2(c, s) : Vector2(-s, c);
}

double report_area(const Model& model, const Report& report) {
  if (report.area > 0.0) return report.area;
  const std::vector<int> nodes = nodes_of_area(model, report);
  if (nodes.empty()) return std::numeric_limits<double>::quiet_NaN();
  double low = model.mesh.x(0, nodes.front()), high = low;
  for (const int node : nodes) {
    low = std::min(low, model.mesh.x(0, node));
    high = std::max(high, model.mesh.x(0, node));
  }
  return model.geometry == Geometry::axisymmetric ? kPi * high * high : high - low;
}

std::size_t node_of_card(const Group& group, std::size_t i, std::size_t given) {
  const ElementEntry& entry = *group.entry;
  const auto corners = static_cast<std::size_t>(entry.corners);
  if (i < corners || entry.interface() || (!entry.makes_nodes() && given > 2 * corners)) return i;
  const int middle = middle_of(group.element->edges()[i - corners]);
  return middle < 0 ? i : static_cast<std::size_t>(middle);
}

void element_coordinates(const Mesh& mesh, const Group& group, int element, Eigen::Matrix2Xd& x) {
  const auto n = static_cast<Eigen::Index>(group.node_count());
  if (x.cols() != n) x.resize(2, n);
  const int* nodes = group.nodes_of(element);
  for (Eigen::Index i = 0; i < n; ++i) x.col(i) = mesh.x.col(nodes[i]);
}

}  // namespace sage
