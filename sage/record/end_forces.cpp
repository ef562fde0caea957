#include "sage/record/end_forces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sage/model/spread_loads.hpp"

namespace sage {

namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
constexpr double kOnAxis = 1e-9;  // of the largest radius of an element

// Loads spread along the elements of a group, at a state: a force a dof, element after element; empty: there are none.
std::vector<double> spread_at(const Model& model, const Solution& solution, std::size_t group) {
  if (solution.stage < 0) return {};
  std::vector<double> end = spread_loads(model, solution.stage, group);
  const double part = solution.load_factor;
  if (part == 1.0) return end;
  const std::vector<double> start = spread_loads(model, solution.stage - 1, group);
  end.resize(std::max(end.size(), start.size()), 0.0);
  for (std::size_t i = 0; i < end.size(); ++i)
    end[i] = part * end[i] + (start.empty() ? 0.0 : (1.0 - part) * start[i]);
  return end;
}

// Unit vector along the line at an end, from node 1 to node 2; the line through three nodes is a parabola.
Vector2 along_at(const Eigen::Matrix2Xd& x, int end) {
  if (x.cols() < 2) return Vector2::UnitX();
  if (x.cols() < 3) return (x.col(1) - x.col(0)).normalized();
  const Vector2 to_middle = x.col(2) - 0.5 * (x.col(0) + x.col(1));
  return (0.5 * (x.col(1) - x.col(0)) + (end == 1 ? 2.0 : -2.0) * to_middle).normalized();
}

// Place of a node's rotation among the dofs of an element; -1 = it has none.
int rotation_of(const ElementEntry& entry, int node) {
  int at = 0;
  for (const ElementUnknown& unknown : entry.unknowns) {
    const int count = unknown.nodes.empty() ? entry.nodes : static_cast<int>(unknown.nodes.size());
    for (int i = 0; i < count; ++i)
      if (unknown.field.turns && (unknown.nodes.empty() ? i : unknown.nodes[i]) == node) return at + i;
    at += count * unknown.field.components();
  }
  return -1;
}

// Section forces as laws count them (tension positive): the same places as in kEndQuantities.
using Section = std::array<double, 5>;

// Of the stress of a law of bars or beams.
Section section_of(std::span<const double> sigma) {
  Section section;
  section.fill(kNoValue);
  section[kAxialForce] = sigma[0];
  if (sigma.size() == 3) section[kShearForce] = sigma[1], section[kBendingMoment] = sigma[2];
  if (sigma.size() == 5) {
    section[kShearForce] = sigma[2];
    section[kBendingMoment] = sigma[3];
    section[kHoopForce] = sigma[1];
    section[kHoopMoment] = sigma[4];
  }
  return section;
}

// One element after the other.
class EndReader {
 public:
  EndReader(const Model& model, const Solution& solution, std::size_t group)
      : model_(model),
        data_(solution.groups()[group]),
        group_(*data_.group),
        traits_(group_.element->traits()),
        loads_(spread_at(model, solution, group)),
        geometry_(static_cast<std::size_t>(traits_.geometry_size())),
        force_(static_cast<std::size_t>(traits_.dofs)),
        sigma_(static_cast<std::size_t>(traits_.law_size)),
        spacing_(spacing_of(data_.law)) {
    const auto points = static_cast<std::size_t>(traits_.points);
    stress_.resize(2 * points * sigma_.size());
    history_.resize(points * static_cast<std::size_t>(data_.state.history_size()));
    status_.resize(points);
  }

  void read(int element, std::vector<ElementEnd>& ends) {
    element_coordinates(model_.mesh, group_, element, x_);
    const bool ring = x_.cols() < 2;
    if (!ring) node_forces(element);
    for (int end = 1; end <= (ring ? 1 : 2); ++end) {
      ElementEnd one;
      one.element = element;
      one.end = end;
      one.node = group_.nodes_of(element)[end - 1];
      one.place = x_.col(end - 1);
      one.along = along_at(x_, end);
      const Section section = section_at(element, end, ring);
      one.value.fill(kNoValue);
      for (const std::size_t q : {kAxialForce, kHoopForce}) one.value[q] = 0.0 - section[q];
      for (const std::size_t q : {kShearForce, kBendingMoment, kHoopMoment}) one.value[q] = 0.0 + section[q];
      if (spacing_ != 1.0) one.value[kForceEach] = spacing_ * one.value[kAxialForce];
      ends.push_back(one);
    }
  }

 private:
  const double* sigma_at(int element, int point) const {
    return data_.state.committed.sigma.data() +
           static_cast<std::size_t>(element * traits_.points + point) * sigma_.size();
  }

  // Of sections that may yield: what the element itself makes of its state and the loads along it.
  bool evaluate(int element) {
    if (!sees_spread_loads(group_, data_.law) || wants_context(data_.law)) return false;
    const auto e = static_cast<std::size_t>(element);
    const StateStore& state = data_.state;
    ElementIn in;
    in.geometry = geometry_.data();
    const std::vector<double> none(force_.size(), 0.0);
    in.du = none.data();
    in.law = data_.law;
    in.sigma0 = sigma_at(element, 0);
    in.eps0 = state.committed.eps.data() + e * stress_.size() / 2;
    in.h0 = state.committed.h.data() + e * history_.size();
    in.spread = in.spread0 = loads_.empty() ? none.data() : loads_.data() + e * force_.size();
    ElementOut out;
    out.f = force_.data();
    out.sigma1 = stress_.data();
    out.eps1 = stress_.data() + stress_.size() / 2;
    out.h1 = history_.data();
    out.status = status_.data();
    return group_.element->evaluate(in, out) == Outcome::ok;
  }

  // sum w B^T sigma.
  void sum_points(int element) {
    std::ranges::fill(force_, 0.0);
    const std::size_t n = force_.size(), size = sigma_.size();
    const double* block = geometry_.data();
    for (int p = 0; p < traits_.points; ++p, block += 1 + size * n) {
      const double* sigma = sigma_at(element, p);
      for (std::size_t c = 0; c < size; ++c)
        for (std::size_t i = 0; i < n; ++i) force_[i] += *block * sigma[c] * block[1 + c * n + i];
    }
  }

  // Internal forces less the loads along the element.
  void node_forces(int element) {
    group_.element->geometry(x_, geometry_);
    if (!evaluate(element)) sum_points(element);
    if (loads_.empty()) return;
    for (std::size_t i = 0; i < force_.size(); ++i)
      force_[i] -= loads_[static_cast<std::size_t>(element) * force_.size() + i];
  }

  // What the points say of a node.
  Section extrapolated(int element, int node) {
    const std::span<const double> map = group_.element->point_to_node(x_);
    const auto points = static_cast<std::size_t>(traits_.points);
    std::ranges::fill(sigma_, 0.0);
    for (std::size_t p = 0; p < points; ++p)
      for (std::size_t c = 0; c < sigma_.size(); ++c)
        sigma_[c] +=
            map[static_cast<std::size_t>(node) * points + p] * sigma_at(element, static_cast<int>(p))[c];
    return section_of(sigma_);
  }

  Section section_at(int element, int end, bool ring) {
    const int node = end - 1;
    Section section = extrapolated(element, node);
    if (ring) return section;
    double width = 1.0;
    if (traits_.geometry == Geometry::axisymmetric) {
      const double r = x_(0, node);
      if (!(r > kOnAxis * x_.row(0).maxCoeff())) return section;
      width = 2.0 * static_cast<double>(EIGEN_PI) * r;
    }
    const double towards = (end == 1 ? -1.0 : 1.0) / width;
    const Vector2 t = along_at(x_, end), force = Vector2::Map(force_.data() + 2 * node);
    section[kAxialForce] = towards * force.dot(t);
    if (const int turn = rotation_of(*group_.entry, node); turn >= 0) {
      section[kShearForce] = towards * force.dot(Vector2(-t.y(), t.x()));
      section[kBendingMoment] = towards * force_[turn];
    }
    return section;
  }

  const Model& model_;
  const GroupData& data_;
  const Group& group_;
  const ElementTraits& traits_;
  std::vector<double> loads_, geometry_, force_, sigma_;
  double spacing_;
  std::vector<double> stress_, history_;  // room for what an element makes of its state
  std::vector<PointStatus> status_;
  Eigen::Matrix2Xd x_;
};

void widen(EnvelopeEnd& row, const ElementEnd& end, int stage) {
  for (std::size_t q = 0; q < end.value.size(); ++q) {
    const double value = end.value[q];
    if (!(row.low[q] <= value)) row.low[q] = value, row.low_stage[q] = stage;
    if (!(row.high[q] >= value)) row.high[q] = value, row.high_stage[q] = stage;
  }
}

}  // namespace

int end_quantity(std::string_view field) {
  const auto* at = std::ranges::find(kEndQuantities, field);
  return at == kEndQuantities.end() ? -1 : static_cast<int>(at - kEndQuantities.begin());
}

const FieldEntry& end_field(std::size_t quantity) {
  static const FieldTable program;
  return *program.find(kEndQuantities[quantity]);
}

bool has_quantity(const Model& model, const Group& group, std::size_t quantity) {
  return group.structure() && group.elements() > 0 &&
         applies(end_field(quantity), group, model.material_of(group).law_ref());
}

std::vector<std::size_t> end_quantities(const Model& model) {
  std::vector<std::size_t> list;
  for (std::size_t q = 0; q < kEndQuantities.size(); ++q)
    if (std::ranges::any_of(model.groups, [&](const Group& group) { return has_quantity(model, group, q); }))
      list.push_back(q);
  return list;
}

std::vector<ElementEnd> element_ends(const Model& model, const Solution& solution, std::size_t group) {
  std::vector<ElementEnd> ends;
  if (group >= solution.groups().size()) return ends;  // points were not kept
  const GroupData& data = solution.groups()[group];
  if (!data.active || !data.group->structure() || data.state.committed.sigma.empty()) return ends;
  EndReader reader(model, solution, group);
  for (int e = 0; e < data.group->elements(); ++e) reader.read(e, ends);
  return ends;
}

void Envelope::add(const Model& model, int stage, const Solution& solution) {
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    if (!model.groups[g].structure()) continue;
    const std::vector<ElementEnd> ends = element_ends(model, solution, g);
    if (ends.empty()) continue;
    auto row = std::ranges::find(rows_, static_cast<std::int64_t>(g), &EnvelopeEnd::group);
    if (row == rows_.end()) {
      const std::size_t first = rows_.size();
      for (const ElementEnd& end : ends) {
        EnvelopeEnd& made = rows_.emplace_back();
        made.group = static_cast<std::int64_t>(g);
        made.element = end.element;
        made.end = end.end;
        made.node = end.node;
        made.low.fill(kNoValue);
        made.high.fill(kNoValue);
      }
      row = rows_.begin() + static_cast<std::ptrdiff_t>(first);
    }
    for (const ElementEnd& end : ends) widen(*row++, end, stage);
  }
}

std::vector<EnvelopeEnd> Envelope::rows() const {
  std::vector<EnvelopeEnd> sorted = rows_;
  std::ranges::stable_sort(sorted, {}, &EnvelopeEnd::group);
  return sorted;
}

}  // namespace sage
