#include "sage/analysis/probe.hpp"

#include <algorithm>
#include <array>

#include "sage/math/dense.hpp"
#include "sage/model/coarse_shape.hpp"

namespace sage {

namespace {

constexpr int kOwnDegree = 4;  // from here on patches are coarser than an element's own polynomial

}  // namespace

ProbeValue read_probe(const Probe& probe, const Solution& solution) {
  ProbeValue value;
  for (const Probe::Node& n : probe.nodes)
    value.u += n.weight * solution.u->segment<2>(DofMap::displacement(n.node));
  for (const Probe::Point& p : probe.points) {
    const PointStates& state = solution.groups()[p.group].state.committed;
    value.stress += p.weight * Eigen::Map<const Vector4>(state.sigma.data() + 4 * p.point);
    value.strain += p.weight * Eigen::Map<const Vector4>(state.eps.data() + 4 * p.point);
  }
  return value;
}

ProbeMaker::ProbeMaker(const Model& model, const std::vector<char>& active, ElementKind kind)
    : model_(&model), active_(active), zone_(zones_of(model)), locator_(model, kind) {
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    if (!active[g] || model.groups[g].entry->kind != kind) continue;
    for (int e = 0; e < model.groups[g].elements(); ++e) elements_.push_back({g, e});
  }
}

const Patches& ProbeMaker::patches(int zone) const {
  const auto known = patches_.find(zone);
  if (known != patches_.end()) return known->second;
  std::vector<char> same;
  for (int other : zone_) same.push_back(other == zone ? 1 : 0);
  return patches_.try_emplace(zone, *model_, same, elements_).first->second;
}

bool ProbeMaker::uses_own_stress(const Group& group) {
  return group.element->traits().degree >= kOwnDegree && group.entry->square();
}

// Without stress.
Probe ProbeMaker::blank_at(const Vector2& place, int group, std::vector<Location>& found) const {
  Probe probe;
  found = one_body(*model_, locator_.at(place), active_, group);
  if (found.empty()) return probe;
  const Location& first = found.front();
  probe.group = static_cast<int>(first.group);
  probe.element = first.element;
  const int* nodes = model_->groups[first.group].nodes_of(first.element);
  for (std::size_t i = 0; i < first.N.size(); ++i) probe.nodes.push_back({nodes[i], first.N[i]});
  return probe;
}

Probe ProbeMaker::at(const Vector2& place, int group) const {
  std::vector<Location> found;
  Probe probe = blank_at(place, group, found);
  for (const Location& location : found) add_stress(probe, location, 1.0 / static_cast<double>(found.size()));
  return probe;
}

Probe ProbeMaker::own_at(const Vector2& place, int group) const {
  std::vector<Location> found;
  Probe probe = blank_at(place, group, found);
  for (const Location& location : found) add_sampled(probe, location, 1.0 / static_cast<double>(found.size()));
  return probe;
}

bool ProbeMaker::is_surrounded(const Probe& probe) const {
  const auto g = static_cast<std::size_t>(probe.group);
  const Group& group = model_->groups[g];
  const int* nodes = group.nodes_of(probe.element);
  const Patches& of_zone = patches(zone_[g]);
  for (std::size_t c = 0; c < group.element->edges().size(); ++c)
    if (of_zone.inside(nodes[c])) return true;
  return false;
}

void ProbeMaker::add_stress(Probe& probe, const Location& location, double part) const {
  const Group& group = model_->groups[location.group];
  const Element& element = *group.element;
  const std::size_t corners = element.edges().size();
  if (uses_own_stress(group)) return add_own(probe, location, part);
  const int* nodes = group.nodes_of(location.element);
  const Patches& of_zone = patches(zone_[location.group]);
  Eigen::Matrix2Xd x;
  element_coordinates(model_->mesh, group, location.element, x);
  const Vector2 place = x * Eigen::Map<const Eigen::VectorXd>(location.N.data(), x.cols());
  std::array<double, 4> shares =
      corner_shares(group.entry->corners, {location.parent.x(), location.parent.y()});
  double sum = 0.0;
  std::size_t inside = 0;
  for (std::size_t c = 0; c < corners; ++c) {
    const bool usable = of_zone.inside(nodes[c]);
    shares[c] = usable ? std::max(shares[c], 0.0) : -1.0;
    sum += usable ? shares[c] : 0.0;
    inside += usable ? 1 : 0;
  }
  // An element without a vertex inside the zone: all of its neighbours.
  if (inside == 0) return add_patch(probe, of_zone.neighbours(element, nodes), place, part);
  constexpr double kNear = 1e-6;
  for (std::size_t c = 0; c < corners; ++c) {
    if (shares[c] < 0.0) continue;
    const double share = sum > kNear ? shares[c] / sum : 1.0 / static_cast<double>(inside);
    if (share > 0.0) add_patch(probe, of_zone.around(nodes[c]), place, part * share);
  }
}

// What is extrapolated to the nodes has the degree that the best places determine, and
// the shape functions hold it.
void ProbeMaker::add_own(Probe& probe, const Location& location, double part) const {
  const Group& group = model_->groups[location.group];
  Eigen::Matrix2Xd x;
  element_coordinates(model_->mesh, group, location.element, x);
  const std::span<const double> to_nodes = group.element->point_to_node(x);
  const auto points = static_cast<std::size_t>(group.element->traits().points);
  for (std::size_t p = 0; p < points; ++p) {
    double weight = 0.0;
    for (std::size_t i = 0; i < location.N.size(); ++i) weight += location.N[i] * to_nodes[i * points + p];
    probe.points.push_back(
        {location.group, static_cast<std::size_t>(location.element) * points + p, part * weight});
  }
}

// The polynomial of the parent shape through the best places, where these are others than the points: 1, x, y and xy of four.
void ProbeMaker::add_sampled(Probe& probe, const Location& location, double part) const {
  const Group& group = model_->groups[location.group];
  const Element& element = *group.element;
  const Eigen::MatrixXd map = sample_map(element);
  const Eigen::Index samples = map.rows(), points = element.traits().points;
  if (samples != 1 && samples != 3 && samples != 4) return add_own(probe, location, part);
  Eigen::Matrix2Xd x, at(2, points);
  element_coordinates(model_->mesh, group, location.element, x);
  for (int p = 0; p < points; ++p) at.col(p) = element.position(x, p);
  const Eigen::Matrix2Xd places = at * map.transpose();
  const auto terms = [samples](const Vector2& parent) -> Eigen::VectorXd {
    return Eigen::Vector4d(1.0, parent.x(), parent.y(), parent.x() * parent.y()).head(samples);
  };
  Eigen::MatrixXd V(samples, samples);
  for (Eigen::Index i = 0; i < samples; ++i) {
    Vector2 parent;
    std::vector<double> N;
    if (!find_parent(group, x, places.col(i), parent, N)) return add_own(probe, location, part);
    V.col(i) = terms(parent);
  }
  const Eigen::VectorXd of_samples = dense_matrix::smallest_solution(V, terms(location.parent), 1e-12);
  const Eigen::VectorXd of_points = part * (map.transpose() * of_samples);
  const auto first = static_cast<std::size_t>(location.element) * static_cast<std::size_t>(points);
  for (Eigen::Index p = 0; p < points; ++p)
    probe.points.push_back({location.group, first + static_cast<std::size_t>(p), of_points(p)});
}

// The value at a place of the polynomial that fits the samples best: linear in them, so a weight a point.
void ProbeMaker::add_patch(Probe& probe, std::span<const std::size_t> patch, const Vector2& place,
                           double part) const {
  Eigen::Matrix2Xd places, at;
  int degree = model_->groups[elements_[patch.front()].group].element->traits().degree;
  Eigen::Matrix2Xd x;
  for (std::size_t k = 0; k < patch.size(); ++k) {
    const ElementRef& ref = elements_[patch[k]];
    const Group& group = model_->groups[ref.group];
    const Element& element = *group.element;
    element_coordinates(model_->mesh, group, ref.element, x);
    at.resize(2, element.traits().points);
    for (int p = 0; p < element.traits().points; ++p) at.col(p) = element.position(x, p);
    const Eigen::MatrixXd map = sample_map(element);
    if (map.size() > 0) at = Eigen::Matrix2Xd(at * map.transpose());
    const Eigen::Index before = places.cols();
    places.conservativeResize(2, before + at.cols());
    places.rightCols(at.cols()) = at;
    degree = std::min(degree, element.traits().degree);
  }
  PatchFitter fitter;
  fitter.set_places(places, degree);
  Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(places.cols(), places.cols()), fit;
  fitter.fit(unit, fit);
  Eigen::VectorXd terms(fitter.terms().count());
  fitter.terms().at(place, [&](Eigen::Index k, double term) { terms(k) = term; });
  const Eigen::RowVectorXd weights = part * (fit * terms).transpose();
  Eigen::Index row = 0;
  for (std::size_t k : patch) {
    const ElementRef& ref = elements_[k];
    const Element& element = *model_->groups[ref.group].element;
    const Eigen::Index points = element.traits().points;
    const Eigen::MatrixXd map = sample_map(element);
    const Eigen::Index samples = map.size() > 0 ? map.rows() : points;
    Eigen::RowVectorXd of_points = weights.segment(row, samples);
    if (map.size() > 0) of_points = Eigen::RowVectorXd(of_points * map);
    row += samples;
    for (Eigen::Index p = 0; p < points; ++p)
      probe.points.push_back({ref.group,
                              static_cast<std::size_t>(ref.element) * static_cast<std::size_t>(points) +
                                  static_cast<std::size_t>(p),
                              of_points(p)});
  }
}

}  // namespace sage
