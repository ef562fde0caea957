#include "sage/analysis/error_estimate.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "sage/analysis/patch_fit.hpp"
#include "sage/analysis/spectrum.hpp"
#include "sage/math/quadrature.hpp"
#include "sage/model/coarse_shape.hpp"
#include "sage/model/locking.hpp"
#include "sage/platform/thread_pool.hpp"

namespace sage {

namespace {

constexpr int kWorthPatchThreads = 2000;  // elements from which on threads gain

// Calls work(first, last, thread) for pieces of 0 ... count.  Each makes what belongs to its own elements alone:
// the estimate does not depend on the number of threads.
template <class Work>
void in_units(ThreadPool& pool, int count, const Work& work) {
  constexpr int kUnit = 64;  // elements or patches that a thread takes at a time
  pool.run((count + kUnit - 1) / kUnit,
           [&](int unit, int thread) { work(unit * kUnit, std::min((unit + 1) * kUnit, count), thread); });
}

// The elements of a group, one after the other: places and stress of their samples, and of the points where the
// error is measured, with their weights.
struct GroupStress {
  int degree = 1, corners = 4;           // of an element
  Eigen::Index samples = 0, points = 0;  // of an element
  Eigen::Matrix2Xd sample_at, point_at;
  Eigen::Matrix4Xd sample, point;  // stress
  Eigen::VectorXd w;
  Matrix4 C = Matrix4::Identity();  // D^-1 of a linear law

  auto samples_of(int e) const { return sample.middleCols(e * samples, samples); }
  auto sample_places_of(int e) const { return sample_at.middleCols(e * samples, samples); }
  auto points_of(int e) const { return point.middleCols(e * points, points); }
};

// The stress of a patch of elements as a polynomial for each component.
struct Fit {
  PolynomialTerms terms;
  Eigen::Matrix4Xd coefficients;

  Vector4 at(const Vector2& x) const {
    Vector4 sum = Vector4::Zero();
    terms.at(x, [&](Eigen::Index k, double term) { sum += term * coefficients.col(k); });
    return sum;
  }
};

// What a field at n x n Gauss points (xi fastest) has above degree n - 3 in xi or eta: the identity less the
// projection onto products of the lower Legendre polynomials.
Eigen::MatrixXd highest_degrees(int n) {
  const Eigen::MatrixXd Q = legendre_at_gauss(n);
  const Eigen::VectorXd first = Q.row(0).transpose();
  const Eigen::MatrixXd lower = Q.topRows(n - 2);
  const Eigen::MatrixXd line =
      first.cwiseInverse().asDiagonal() * (lower.transpose() * lower) * first.asDiagonal();
  Eigen::MatrixXd square = Eigen::MatrixXd::Identity(n * n, n * n);
  for (int b = 0; b < n; ++b)
    for (int d = 0; d < n; ++d) square.block(b * n, d * n, n, n) -= line(b, d) * line;
  return square;
}

// A rule given by the share of each corner in its points: linear on triangles, bilinear on quadrilaterals.
struct CornerRule {
  std::vector<Place> at;
  Eigen::MatrixXd shares;  // points x corners
  Eigen::VectorXd w;       // sum 1
};

// 3 x 3 Gauss, or Dunavant's rule of degree 4.
CornerRule corner_rule(const ElementEntry& entry) {
  CornerRule rule;
  const std::span<const RulePoint> points =
      entry.square() ? std::span<const RulePoint>(GaussSquare<3>::table) : Triangle6::table;
  rule.shares.resize(points.size(), entry.corners);
  rule.w.resize(rule.shares.rows());
  const double size = entry.square() ? 4.0 : 0.5;
  for (Eigen::Index i = 0; i < rule.w.size(); ++i) {
    const RulePoint& point = points[i];
    rule.at.push_back({point.xi, point.eta});
    const std::array<double, 4> shares = corner_shares(entry.corners, rule.at.back());
    for (Eigen::Index k = 0; k < rule.shares.cols(); ++k)
      rule.shares(i, k) = shares[static_cast<std::size_t>(k)];
    rule.w(i) = point.w / size;
  }
  return rule;
}

// Of a linear law; nothing for the others.
std::optional<Matrix4> stiffness(const SolidLaw& law) {
  if (!has_constant_stiffness(law)) return {};
  PointIn<4> in{Vector4::Zero(), Vector4::Zero(), Vector4::Zero(), {}};
  PointOut<4> out;
  law.update(in, out);
  return out.D;
}

// A group that is activated in a later stage strains from the displacements of then, and none from those that count from
// a later stage.
bool starts_later(const Model& model, std::size_t group) {
  if (std::ranges::any_of(model.stages, &Stage::resets_displacements)) return true;
  for (std::size_t s = 1; s < model.stages.size(); ++s)
    if (std::ranges::find(model.stages[s].births, static_cast<int>(group)) != model.stages[s].births.end())
      return true;
  return false;
}

// Stress (4 x points), places and weights at an element's own points.
class ElementPoints {
 public:
  // start: of the group `index`; null = from nothing.
  ElementPoints(const Model& model, const Solution& solution, std::size_t index, const StressState* start)
      : model_(model),
        data_(solution.groups()[index]),
        u_(*solution.u),
        start_(start),
        index_(index),
        traits_(data_.group->element->traits()) {
    const GroupData& data = data_;
    stress.resize(4, traits_.points);
    strain.resize(4, traits_.points);
    u.resize(2, traits_.nodes);
    at.resize(2, traits_.points);
    w.resize(traits_.points);
    if (data.geometry.empty()) made_.resize(traits_.geometry_size());
    if (data.keeps_matrices() && data.geometry.empty()) take_shapes();
  }

  void take(int e) {
    const Element& element = *data_.group->element;
    element_coordinates(model_.mesh, *data_.group, e, x);
    if (of_shape_.size() > 0)
      w = of_shape_.col(data_.matrix[e]);
    else
      make_weights(e);
    const auto first = 4 * static_cast<std::size_t>(e) * static_cast<std::size_t>(traits_.points);
    const auto values = [&](const std::vector<double>& of_points) {
      return Eigen::Map<const Eigen::Matrix4Xd>(of_points.data() + first, 4, traits_.points);
    };
    stress = values(data_.state.committed.sigma);
    strain = values(data_.state.committed.eps);
    const int* nodes = data_.group->nodes_of(e);
    for (int i = 0; i < traits_.nodes; ++i) u.col(i) = u_.segment<2>(DofMap::displacement(nodes[i]));
    if (start_ != nullptr) {
      stress -= values(start_->sigma[index_]);
      strain -= values(start_->eps[index_]);
      for (int i = 0; i < traits_.nodes; ++i)
        u.col(i) -= Eigen::Map<const Vector2>(start_->u.data() + DofMap::displacement(nodes[i]));
    }
    for (int p = 0; p < traits_.points; ++p) at.col(p) = element.position(x, p);
  }

  Eigen::Matrix2Xd x, at;  // of its nodes, of its points
  Eigen::Matrix4Xd stress, strain;
  Eigen::Matrix2Xd u;  // of its nodes
  Eigen::VectorXd w;

 private:
  // Where few shapes make up the group, the weights of each are made once, of the first element that has it.
  void take_shapes() {
    constexpr std::size_t kFewer = 4;
    const std::size_t shapes = data_.K.size() / data_.matrix_size();
    if (!data_.constant || data_.matrix.size() < kFewer * shapes) return;
    of_shape_.resize(traits_.points, static_cast<Eigen::Index>(shapes));
    for (int e = 0, made = 0; e < data_.group->elements(); ++e) {
      if (data_.matrix[e] != made) continue;
      element_coordinates(model_.mesh, *data_.group, e, x);
      make_weights(e);
      of_shape_.col(made++) = w;
    }
  }

  void make_weights(int e) {
    const auto size = static_cast<std::size_t>(traits_.geometry_size());
    const auto stride = static_cast<std::size_t>(1 + traits_.law_size * traits_.dofs);
    if (data_.geometry.empty()) data_.group->element->geometry(x, made_);
    const double* geometry =
        data_.geometry.empty() ? made_.data() : data_.geometry.data() + static_cast<std::size_t>(e) * size;
    for (int p = 0; p < traits_.points; ++p) w(p) = geometry[static_cast<std::size_t>(p) * stride];
  }

  const Model& model_;
  const GroupData& data_;
  const Eigen::VectorXd& u_;
  const StressState* start_;
  std::size_t index_;
  const ElementTraits& traits_;
  std::vector<double> made_;
  Eigen::MatrixXd of_shape_;  // weights, a shape a column; empty = every element has its own
};

// What displacements (two a node) make of an element at places of its parent shape.
class StrainBetween {
 public:
  StrainBetween(const Element& element, const std::vector<Place>& places, Geometry geometry)
      : nodes_(element.traits().nodes), ring_(geometry == Geometry::axisymmetric) {
    for (const Place& place : places) {
      std::vector<double> N(static_cast<std::size_t>(nodes_)), dN(2 * static_cast<std::size_t>(nodes_));
      known_ = known_ && element.shape_functions({place[0], place[1]}, N, dN);
      N_.push_back(Eigen::Map<const Eigen::VectorXd>(N.data(), nodes_));
      dN_.push_back(Eigen::Map<const Eigen::MatrixX2d>(dN.data(), nodes_, 2));
    }
  }
  bool known() const { return known_; }
  // At place i; u: 2 x nodes.
  Vector4 at(std::size_t i, const Eigen::Matrix2Xd& x, const Eigen::Matrix2Xd& u) const {
    const Matrix2 slope = u * dN_[i] * (x * dN_[i]).inverse();
    const double hoop = ring_ ? u.row(0).dot(N_[i]) / x.row(0).dot(N_[i]) : 0.0;
    return {slope(0, 0), slope(1, 1), hoop, slope(0, 1) + slope(1, 0)};
  }

 private:
  Eigen::Index nodes_;
  bool ring_, known_ = true;
  std::vector<Eigen::VectorXd> N_;
  std::vector<Eigen::MatrixX2d> dN_;
};

// At the points of a reduced rule the error of a smooth solution vanishes: it is measured at others.  The stress there
// is that of the displacements, where the law is linear; else the linear or bilinear one through those points.
class PointsBetween {
 public:
  // D: of the law; nothing where it is not linear, or displacements do not begin with the strain.
  PointsBetween(const Group& group, Geometry geometry, const std::optional<Matrix4>& D)
      : element_(*group.element),
        rule_(corner_rule(*group.entry)),
        strain_(element_, rule_.at, geometry),
        D_(D) {
    if (!strain_.known()) D_.reset();
    const Eigen::Index points = element_.traits().points;
    const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> to_nodes(
        element_.point_to_node(Eigen::Matrix2Xd::Zero(2, element_.traits().nodes)).data(),
        element_.traits().nodes,
        points);  // of a solid the map is the same everywhere
    map_ = rule_.shares * to_nodes.topRows(static_cast<Eigen::Index>(element_.edges().size()));
  }

  static bool suit(const Group& group) {
    const Element& element = *group.element;
    const bool own_places = element.point_to_sample().empty();
    return own_places && element.traits().degree <= 2 &&
           (group.entry->square() || element.traits().points < 3 * element.traits().degree);
  }

  Eigen::Index count() const { return rule_.w.size(); }

  // Element e of `s` from what is at its own points.
  void put(const ElementPoints& own, int e, GroupStress& s) const {
    const Eigen::Matrix2Xd& x = own.x;
    const Eigen::VectorXd density = map_ * own.w;
    auto weights = s.w.segment(e * s.points, s.points);
    weights = (rule_.w.array() * density.array()).matrix();
    weights *= own.w.sum() / weights.sum();
    auto between = s.point.middleCols(e * s.points, s.points);
    between.noalias() = own.stress * map_.transpose();
    if (D_) {
      const Eigen::Matrix4Xd strain = own.strain * map_.transpose();
      for (Eigen::Index i = 0; i < s.points; ++i)
        between.col(i) += *D_ * (strain_.at(i, x, own.u) - strain.col(i));
    }
    CoarseShape shape;
    shape.corners = s.corners;
    for (std::size_t k = 0; k < static_cast<std::size_t>(s.corners); ++k) {
      shape.corner[k] = x.col(static_cast<Eigen::Index>(k));
      const std::vector<int>& edge = element_.edges()[k];
      if (edge.size() > 2) shape.middle[k] = x.col(edge[2]);
    }
    for (std::size_t i = 0; i < rule_.at.size(); ++i)
      s.point_at.col(e * s.points + static_cast<Eigen::Index>(i)) = shape.at(rule_.at[i]);
  }

 private:
  const Element& element_;
  CornerRule rule_;
  StrainBetween strain_;
  std::optional<Matrix4> D_;
  Eigen::MatrixXd map_;  // from an element's points to these
};

// to_samples: sample_map of the element.
void put_samples(const ElementPoints& own, const Eigen::MatrixXd& to_samples, int e, GroupStress& s) {
  auto places = s.sample_at.middleCols(e * s.samples, s.samples);
  auto values = s.sample.middleCols(e * s.samples, s.samples);
  if (to_samples.size() > 0) {
    places.noalias() = own.at * to_samples.transpose();
    values.noalias() = own.stress * to_samples.transpose();
  } else {
    places = own.at;
    values = own.stress;
  }
}

// D: of a linear law.
GroupStress group_stress(const Model& model, const Solution& solution, std::size_t index,
                         const StressState* start, std::optional<Matrix4> D, ThreadPool& pool) {
  const Group& group = *solution.groups()[index].group;
  if (starts_later(model, index)) D.reset();
  const Element& element = *group.element;
  const Eigen::MatrixXd to_samples = sample_map(element);
  std::optional<PointsBetween> between;
  if (PointsBetween::suit(group)) between.emplace(group, model.geometry, D);
  GroupStress s;
  s.degree = element.traits().degree;
  s.corners = static_cast<int>(element.edges().size());
  s.samples = to_samples.size() > 0 ? to_samples.rows() : element.traits().points;
  s.points = between ? between->count() : element.traits().points;
  const Eigen::Index elements = group.elements();
  s.sample_at.resize(2, elements * s.samples);
  s.sample.resize(4, elements * s.samples);
  s.point_at.resize(2, elements * s.points);
  s.point.resize(4, elements * s.points);
  s.w.resize(elements * s.points);
  std::vector<ElementPoints> points(static_cast<std::size_t>(pool.threads()),
                                    ElementPoints(model, solution, index, start));
  in_units(pool, group.elements(), [&](int first, int last, int thread) {
    ElementPoints& own = points[thread];
    for (int e = first; e < last; ++e) {
      own.take(e);
      put_samples(own, to_samples, e, s);
      if (between) {
        between->put(own, e, s);
      } else {
        s.point_at.middleCols(e * s.points, s.points) = own.at;
        s.point.middleCols(e * s.points, s.points) = own.stress;
        s.w.segment(e * s.points, s.points) = own.w;
      }
    }
  });
  return s;
}

const SolidLaw* solid_law(const GroupData& data) {
  const auto* law = std::get_if<const SolidLaw*>(&data.law);
  return data.active && law != nullptr ? *law : nullptr;
}

// The polynomials of all patches of one material.
class PatchFits {
 public:
  // What one thread needs to fit and to ask.
  struct Room {
    PatchFitter fitter;
    Eigen::Matrix2Xd places;
    Eigen::Matrix4Xd values;
    Fit own;
    std::vector<const Fit*> use;
  };

  PatchFits(const Model& model, const std::vector<ElementRef>& elements, const std::vector<GroupStress>& stress,
            int material)
      : elements_(elements),
        stress_(stress),
        nodes_(model.mesh.nodes()),
        patches_(model, of_material(model, material), elements) {}

  // Fits around all vertices inside the material; rooms: one for each thread.
  void make(const std::vector<GroupData>& groups, int material, ThreadPool& pool, std::vector<Room>& rooms) {
    std::vector<int> vertices;
    fit_of_.assign(nodes_, -1);
    for (const ElementRef& element : elements_) {
      const Group& group = *groups[element.group].group;
      if (group.material != material) continue;
      const int* nodes = group.nodes_of(element.element);
      for (int c = 0; c < stress_[element.group].corners; ++c) {
        int& known = fit_of_[nodes[c]];
        if (known >= 0 || !patches_.inside(nodes[c])) continue;
        known = static_cast<int>(vertices.size());
        vertices.push_back(nodes[c]);
      }
    }
    fits_.resize(vertices.size());
    in_units(pool, static_cast<int>(vertices.size()), [&](int first, int last, int thread) {
      for (auto v = static_cast<std::size_t>(first); v < static_cast<std::size_t>(last); ++v)
        fits_[v] = fit(patches_.around(vertices[v]), rooms[thread]);
    });
  }

  // Those around an element's corners inside its material; where it has none, one of all of its neighbours.
  // Valid until the next call with this room.
  const std::vector<const Fit*>& of(const Group& group, const ElementRef& element, Room& room) const {
    const int* nodes = group.nodes_of(element.element);
    room.use.clear();
    for (int c = 0; c < stress_[element.group].corners; ++c)
      if (const int known = fit_of_[nodes[c]]; known >= 0)
        room.use.push_back(&fits_[static_cast<std::size_t>(known)]);
    if (room.use.empty()) {
      room.own = fit(patches_.neighbours(*group.element, nodes), room);
      room.use.push_back(&room.own);
    }
    return room.use;
  }

 private:
  static std::vector<char> of_material(const Model& model, int material) {
    std::vector<char> same;
    for (const Group& group : model.groups) same.push_back(group.material == material);
    return same;
  }

  Fit fit(std::span<const std::size_t> patch, Room& room) const {
    Eigen::Index count = 0;
    int degree = PolynomialTerms::kMostDegree;
    for (const std::size_t k : patch) {
      count += stress_[elements_[k].group].samples;
      degree = std::min(degree, stress_[elements_[k].group].degree);
    }
    room.places.resize(2, count);
    room.values.resize(4, count);
    Eigen::Index row = 0;
    for (const std::size_t k : patch) {
      const auto& [group, element] = elements_[k];
      const GroupStress& s = stress_[group];
      room.places.middleCols(row, s.samples) = s.sample_places_of(element);
      room.values.middleCols(row, s.samples) = s.samples_of(element);
      row += s.samples;
    }
    // A polynomial in x and y is a poor one around a curve, and the error of high degrees is smaller than that.
    constexpr int kHighDegree = 4;
    room.fitter.set_places(room.places, degree, degree >= kHighDegree ? 2 : 1);
    Fit fit{room.fitter.terms(), {}};
    room.fitter.fit(room.values, fit.coefficients);
    return fit;
  }

  const std::vector<ElementRef>& elements_;
  const std::vector<GroupStress>& stress_;
  int nodes_;
  Patches patches_;
  std::vector<int> fit_of_;  // by node: in fits_, -1 = none
  std::vector<Fit> fits_;
};

// Squares over one element: of the error and of the stress itself.
struct ElementSquares {
  double error = 0.0, size = 0.0;
};

// The mean of some fits.  Linear ones are added up first: as their value at a place and their slopes.
class MeanFit {
 public:
  MeanFit(const std::vector<const Fit*>& fits, const Vector2& place) : fits_(fits), place_(place) {
    linear_ = std::ranges::all_of(fits, [](const Fit* fit) { return fit->terms.degree == 1; });
    if (!linear_) return;
    for (const Fit* fit : fits) {
      value_ += fit->at(place);
      slope_.col(0) += fit->coefficients.col(1) / fit->terms.scale.x();
      slope_.col(1) += fit->coefficients.col(2) / fit->terms.scale.y();
    }
  }

  Vector4 at(const Vector2& x) const {
    Vector4 sum = value_ + slope_ * (x - place_);
    if (!linear_)
      for (const Fit* fit : fits_) sum += fit->at(x);
    return sum / static_cast<double>(fits_.size());
  }

 private:
  const std::vector<const Fit*>& fits_;
  Vector2 place_;
  bool linear_ = false;
  Vector4 value_ = Vector4::Zero();
  Eigen::Matrix<double, 4, 2> slope_ = Eigen::Matrix<double, 4, 2>::Zero();
};

// |sigma* - sigma|^2 and |sigma|^2 over an element, sigma* the mean of the fits.
ElementSquares fitted_error(const GroupStress& s, int e, const std::vector<const Fit*>& fits) {
  ElementSquares sum;
  const MeanFit mean(fits, s.point_at.col(e * s.points));
  for (Eigen::Index p = e * s.points; p < (e + 1) * s.points; ++p) {
    const Vector4 smooth = mean.at(s.point_at.col(p));
    const Vector4 own_stress = s.point.col(p), difference = smooth - own_stress;
    sum.error += s.w(p) * difference.dot(s.C * difference);
    sum.size += s.w(p) * own_stress.dot(s.C * own_stress);
  }
  return sum;
}

// Elements of high degree show their error themselves by their highest degrees; the polynomials of patches are
// far too coarse for them where sizes jump from layer to layer.
bool shows_its_own_error(const GroupStress& s) {
  return s.degree >= 4 && s.points == (s.degree + 1) * (s.degree + 1);
}

// above: highest_degrees() of the element's points.
double own_error(const GroupStress& s, int e, const Eigen::MatrixXd& above) {
  const Eigen::Matrix4Xd top = s.points_of(e) * above.transpose();
  double error = 0.0;
  for (Eigen::Index p = 0; p < s.points; ++p) error += s.w(e * s.points + p) * top.col(p).dot(s.C * top.col(p));
  return error;
}

void add_element(ErrorEstimate& estimate, const ElementRef& element, double error) {
  estimate.error += error;
  estimate.element[element.group].push_back(error);
  const bool worst =
      estimate.worst_group < 0 || error > estimate.element[estimate.worst_group][estimate.worst_element];
  if (error > 0.0 && worst) {
    estimate.worst_group = static_cast<int>(element.group);
    estimate.worst_element = element.element;
  }
}

int solid_elements(const std::vector<GroupData>& groups) {
  int count = 0;
  for (const GroupData& data : groups)
    if (solid_law(data) != nullptr) count += data.group->elements();
  return count;
}

// One estimate: stress of all active solids, the fits of each material, then each element's distance from them.
class Estimation {
 public:
  Estimation(const Model& model, const Solution& solution)
      : model_(model),
        solution_(solution),
        groups_(solution.assembly->groups()),
        count_(solid_elements(groups_)),
        pool_(count_ >= kWorthPatchThreads ? solution.assembly->threads() : 1),
        stress_(groups_.size()),
        rooms_(static_cast<std::size_t>(pool_.threads())) {}

  ErrorEstimate compute(const StressState* start) {
    ErrorEstimate result;
    result.element.resize(groups_.size());
    for (const GroupData& data : groups_)
      if (const SolidLaw* law = solid_law(data))
        result.energy = result.energy && law->traits().linear && !model_.large_strain;
    take_stress(start, result.energy);
    make_fits();
    measure();
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      result.size += squares_[i].size;
      add_element(result, elements_[i], squares_[i].error);
    }
    return result;
  }

 private:
  void take_stress(const StressState* start, bool energy) {
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const SolidLaw* law = solid_law(groups_[g]);
      if (law == nullptr) continue;
      const std::optional<Matrix4> D = energy ? stiffness(*law) : std::nullopt;
      stress_[g] = group_stress(model_, solution_, g, start, D, pool_);
      if (D) stress_[g].C = D->inverse();
      for (int e = 0; e < groups_[g].group->elements(); ++e) elements_.push_back({g, e});
      const int line = stress_[g].degree + 1;
      if (shows_its_own_error(stress_[g])) highest_.try_emplace(line, highest_degrees(line));
    }
  }

  void make_fits() {
    for (const GroupData& data : groups_) {
      if (solid_law(data) == nullptr) continue;
      const int material = data.group->material;
      if (const auto [made, is_new] = fits_.try_emplace(material, model_, elements_, stress_, material); is_new)
        made->second.make(groups_, material, pool_, rooms_);
    }
  }

  void measure() {
    squares_.resize(elements_.size());
    in_units(pool_, count_, [&](int first, int last, int thread) {
      for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(last); ++i)
        squares_[i] = squares_of(elements_[i], rooms_[thread]);
    });
  }

  ElementSquares squares_of(const ElementRef& element, PatchFits::Room& room) const {
    const GroupStress& s = stress_[element.group];
    const Group& group = *groups_[element.group].group;
    ElementSquares squares =
        fitted_error(s, element.element, fits_.at(group.material).of(group, element, room));
    if (shows_its_own_error(s))
      squares.error = std::min(squares.error, own_error(s, element.element, highest_.at(s.degree + 1)));
    return squares;
  }

  const Model& model_;
  const Solution& solution_;
  const std::vector<GroupData>& groups_;
  int count_;  // of elements
  ThreadPool pool_;
  std::vector<ElementRef> elements_;
  std::vector<GroupStress> stress_;         // by group
  std::map<int, Eigen::MatrixXd> highest_;  // by points a line
  std::vector<PatchFits::Room> rooms_;      // by thread
  std::map<int, PatchFits> fits_;           // by material
  std::vector<ElementSquares> squares_;     // by element
};

}  // namespace

double ErrorEstimate::relative() const {
  return size + error > 0.0 ? std::sqrt(error / (size + error)) : 0.0;
}

std::vector<int> locking_groups(const Model& model) {
  std::vector<int> found;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (group.solid() && group.elements() > 0 && group.element->traits().locks &&
        nearly_incompressible(model, group))
      found.push_back(static_cast<int>(g));
  }
  return found;
}

StressState stress_state(const Solution& solution) {
  StressState state;
  for (const GroupData& data : solution.groups()) {
    state.sigma.push_back(data.state.committed.sigma);
    state.eps.push_back(data.state.committed.eps);
  }
  state.u.assign(solution.u->begin(), solution.u->end());
  return state;
}

ErrorEstimate estimate_error(const Model& model, const Solution& solution, const StressState* start) {
  return Estimation(model, solution).compute(start);
}

}  // namespace sage
