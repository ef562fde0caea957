#include "sage/analysis/error_estimate.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "sage/analysis/patch_fit.hpp"
#include "sage/core/dense.hpp"
#include "sage/model/coarse_shape.hpp"

namespace sage {

namespace {

using Stress4 = Eigen::Matrix<double, Eigen::Dynamic, 4>;

// What is known of one element: places and stress of its samples, and of the points where the error is
// measured, with their weights.
struct ElementStress {
  Eigen::Matrix2Xd sample_at, point_at;
  Stress4 samples, points;
  Eigen::VectorXd w;
  int degree = 1, corners = 4;
};

// The stress of a patch of elements as a polynomial for each component.
class Fit {
 public:
  explicit Fit(const std::vector<const ElementStress*>& patch) : polynomial_(places(patch), degree(patch)) {
    const Eigen::MatrixXd& V = polynomial_.matrix();
    Stress4 values(V.rows(), 4);
    Eigen::Index row = 0;
    for (const ElementStress* e : patch)
      for (Eigen::Index i = 0; i < e->samples.rows(); ++i) values.row(row++) = e->samples.row(i);
    coefficients_ = dense_matrix::least_squares(V, values);
  }

  Eigen::RowVector4d at(const Vector2& x) const { return polynomial_.terms(x) * coefficients_; }

 private:
  static std::vector<const Eigen::Matrix2Xd*> places(const std::vector<const ElementStress*>& patch) {
    std::vector<const Eigen::Matrix2Xd*> all;
    all.reserve(patch.size());
    for (const ElementStress* e : patch) all.push_back(&e->sample_at);
    return all;
  }
  static int degree(const std::vector<const ElementStress*>& patch) {
    int lowest = patch.front()->degree;
    for (const ElementStress* e : patch) lowest = std::min(lowest, e->degree);
    return lowest;
  }

  PatchPolynomial polynomial_;
  Eigen::MatrixXd coefficients_;
};

// What a field at n x n Gauss points (xi fastest) has above degree n - 3 in xi or eta: the identity less the
// projection onto products of the lower Legendre polynomials.  Points and weights by Golub & Welsch (1969).
Eigen::MatrixXd highest_degrees(int n) {
  Eigen::MatrixXd jacobi = Eigen::MatrixXd::Zero(n, n);
  for (int k = 1; k < n; ++k) jacobi(k, k - 1) = jacobi(k - 1, k) = k / std::sqrt(4.0 * k * k - 1.0);
  // Row i of the eigenvectors: +-sqrt(w) times the orthonormal Legendre polynomial of degree i at each point;
  // the sign is that of row 0.
  const Eigen::MatrixXd Q = dense_matrix::symmetric_eigensystem(jacobi).vectors;
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
  if (entry.square()) {
    const double at[3] = {-std::sqrt(0.6), 0.0, std::sqrt(0.6)}, w[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
    rule.shares.resize(9, 4);
    rule.w.resize(9);
    for (int i = 0; i < 9; ++i) {
      const double x = at[i % 3], y = at[i / 3];
      rule.at.push_back({x, y});
      rule.shares.row(i) << (1 - x) * (1 - y) / 4, (1 + x) * (1 - y) / 4, (1 + x) * (1 + y) / 4,
          (1 - x) * (1 + y) / 4;
      rule.w(i) = w[i % 3] * w[i / 3];
    }
    return rule;
  }
  rule.shares.resize(6, 3);
  rule.w.resize(6);
  const double b[2] = {0.44594849091596488632, 0.09157621350977074346},
               w[2] = {0.2233815896780114657, 0.10995174365532186764};
  for (int i = 0; i < 6; ++i) {
    rule.shares.row(i).setConstant(b[i / 3]);
    rule.shares(i, i % 3) = 1.0 - 2.0 * b[i / 3];
    rule.at.push_back({rule.shares(i, 1), rule.shares(i, 2)});
    rule.w(i) = w[i / 3];
  }
  return rule;
}

// At the points of a reduced rule the error of a smooth solution vanishes: it is measured at others, where the
// stress is the linear or bilinear one through those points.
void measure_between_points(const Group& group, const Eigen::Matrix2Xd& x, ElementStress& s) {
  const Element& element = *group.element;
  const Eigen::Index points = s.points.rows(), corners = s.corners;
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> to_nodes(
      element.point_to_node().data(), element.traits().nodes, points);
  const CornerRule rule = corner_rule(*group.entry);
  const Eigen::MatrixXd map = rule.shares * to_nodes.topRows(corners);
  const double volume = s.w.sum();
  const Eigen::VectorXd density = map * s.w;
  s.w = (rule.w.array() * density.array()).matrix();
  s.w *= volume / s.w.sum();
  s.points = map * s.points;
  CoarseShape shape;
  shape.corners = s.corners;
  for (std::size_t k = 0; k < static_cast<std::size_t>(s.corners); ++k) {
    shape.corner[k] = x.col(static_cast<Eigen::Index>(k));
    const std::vector<int>& edge = element.edges()[k];
    if (edge.size() > 2) shape.middle[k] = x.col(edge[2]);
  }
  s.point_at.resize(2, rule.w.size());
  for (std::size_t i = 0; i < rule.at.size(); ++i)
    s.point_at.col(static_cast<Eigen::Index>(i)) = shape.at(rule.at[i]);
}

ElementStress element_stress(const Model& model, const GroupData& data, int e,
                             const std::vector<double>* start) {
  const Group& group = *data.group;
  const Element& element = *group.element;
  const ElementTraits& traits = element.traits();
  Eigen::Matrix2Xd x;
  element_coordinates(model.mesh, group, e, x);
  ElementStress s;
  s.degree = element.degree();
  s.corners = static_cast<int>(element.edges().size());
  const Eigen::Index points = traits.points;
  s.points.resize(points, 4);
  s.point_at.resize(2, points);
  s.w.resize(points);
  std::vector<double> made;
  const auto stride = static_cast<std::size_t>(1 + traits.law_size * traits.dofs);
  const double* geometry = nullptr;
  if (data.geometry.empty()) {
    made.resize(static_cast<std::size_t>(traits.geometry_size()));
    element.geometry(x, made);
    geometry = made.data();
  } else {
    geometry =
        data.geometry.data() + static_cast<std::size_t>(e) * static_cast<std::size_t>(traits.geometry_size());
  }
  for (Eigen::Index p = 0; p < points; ++p) {
    const auto at =
        4 * (static_cast<std::size_t>(e) * static_cast<std::size_t>(points) + static_cast<std::size_t>(p));
    for (Eigen::Index c = 0; c < 4; ++c) {
      const std::size_t i = at + static_cast<std::size_t>(c);
      s.points(p, c) = data.state.committed.sigma[i] - (start != nullptr ? (*start)[i] : 0.0);
    }
    s.point_at.col(p) = element.position(x, static_cast<int>(p));
    s.w(p) = geometry[static_cast<std::size_t>(p) * stride];
  }
  const Eigen::MatrixXd to_samples = sample_map(element);
  s.samples = to_samples.size() > 0 ? Stress4(to_samples * s.points) : s.points;
  s.sample_at = to_samples.size() > 0 ? Eigen::Matrix2Xd(s.point_at * to_samples.transpose()) : s.point_at;
  const bool own_places = element.point_to_sample().empty();
  if (own_places && s.degree <= 2 && (group.entry->square() || points < 3 * s.degree))
    measure_between_points(group, x, s);
  return s;
}

// D^-1 of a linear law; the unit matrix for the others.
Matrix4 compliance(const SolidLaw& law) {
  if (!has_constant_stiffness(law)) return Matrix4::Identity();
  PointIn<4> in{Vector4::Zero(), Vector4::Zero(), Vector4::Zero(), {}};
  PointOut<4> out;
  law.update(in, out);
  return out.D.inverse();
}

const SolidLaw* solid_law(const GroupData& data) {
  const auto* law = std::get_if<const SolidLaw*>(&data.law);
  return data.active && law != nullptr ? *law : nullptr;
}

// The polynomials of all patches, each made when it is first asked for.
class PatchFits {
 public:
  PatchFits(const Model& model, const std::vector<ElementRef>& elements,
            const std::vector<ElementStress>& stress)
      : model_(model), elements_(elements), stress_(stress) {}

  // Those around an element's corners inside its material; where it has none, one of all of its neighbours.
  // Valid until the next call.
  std::vector<const Fit*> of(const Group& group, std::size_t k) {
    const Patches& patches = of_material(group.material);
    const int* nodes = group.nodes_of(elements_[k].element);
    std::vector<const Fit*> use;
    for (int c = 0; c < stress_[k].corners; ++c) {
      if (!patches.inside(nodes[c])) continue;
      auto it = fits_.find({group.material, nodes[c]});
      if (it == fits_.end())
        it = fits_.emplace(std::pair{group.material, nodes[c]}, fit(patches.around(nodes[c]))).first;
      use.push_back(&it->second);
    }
    if (!use.empty()) return use;
    own_.emplace(fit(patches.neighbours(*group.element, nodes)));
    return {&*own_};
  }

 private:
  const Patches& of_material(int material) {
    auto known = patches_.find(material);
    if (known == patches_.end()) {
      std::vector<char> same;
      for (const Group& other : model_.groups) same.push_back(other.material == material);
      known = patches_.try_emplace(material, model_, same, elements_).first;
    }
    return known->second;
  }
  Fit fit(const std::vector<std::size_t>& patch) const {
    std::vector<const ElementStress*> members;
    members.reserve(patch.size());
    for (std::size_t k : patch) members.push_back(&stress_[k]);
    return Fit(members);
  }

  const Model& model_;
  const std::vector<ElementRef>& elements_;
  const std::vector<ElementStress>& stress_;
  std::map<int, Patches> patches_;           // by material
  std::map<std::pair<int, int>, Fit> fits_;  // by material and vertex
  std::optional<Fit> own_;
};

// |sigma* - sigma|^2 over an element, sigma* the mean of the fits; |sigma|^2 is added to `size`.
double fitted_error(const ElementStress& s, const std::vector<const Fit*>& fits, const Matrix4& C,
                    double& size) {
  double error = 0.0;
  for (Eigen::Index p = 0; p < s.points.rows(); ++p) {
    Eigen::RowVector4d smooth = Eigen::RowVector4d::Zero();
    for (const Fit* fit : fits) smooth += fit->at(s.point_at.col(p)) / static_cast<double>(fits.size());
    const Vector4 own_stress = s.points.row(p), difference = smooth.transpose() - own_stress;
    error += s.w(p) * difference.dot(C * difference);
    size += s.w(p) * own_stress.dot(C * own_stress);
  }
  return error;
}

// Elements of high degree show their error themselves by their highest degrees; the polynomials of patches are
// far too coarse for them where sizes jump from layer to layer.
bool shows_its_own_error(const ElementStress& s) {
  return s.degree >= 4 && s.points.rows() == (s.degree + 1) * (s.degree + 1);
}

// above: highest_degrees() of the element's points.
double own_error(const ElementStress& s, const Eigen::MatrixXd& above, const Matrix4& C) {
  const Stress4 top = above * s.points;
  double error = 0.0;
  for (Eigen::Index p = 0; p < s.points.rows(); ++p)
    error += s.w(p) * top.row(p).dot((C * top.row(p).transpose()).transpose());
  return error;
}

void add_element(ErrorEstimate& estimate, const ElementRef& element, double error) {
  estimate.error += error;
  estimate.element[element.group].push_back(error);
  const bool worst =
      estimate.worst_group < 0 || error > estimate.element[static_cast<std::size_t>(estimate.worst_group)]
                                                          [static_cast<std::size_t>(estimate.worst_element)];
  if (error > 0.0 && worst) {
    estimate.worst_group = static_cast<int>(element.group);
    estimate.worst_element = element.element;
  }
}

}  // namespace

double ErrorEstimate::relative() const {
  return size + error > 0.0 ? std::sqrt(error / (size + error)) : 0.0;
}

StressState stress_state(const Assembly& assembly) {
  StressState state;
  for (const GroupData& data : assembly.groups()) state.push_back(data.state.committed.sigma);
  return state;
}

ErrorEstimate estimate_error(const Model& model, const Solution& solution, const StressState* start) {
  ErrorEstimate result;
  const std::vector<GroupData>& groups = solution.assembly->groups();
  result.element.resize(groups.size());
  std::vector<ElementRef> elements;
  std::vector<ElementStress> stress;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const SolidLaw* law = solid_law(groups[g]);
    if (law == nullptr) continue;
    result.energy = result.energy && law->linear();
    for (int e = 0; e < groups[g].group->elements(); ++e) {
      elements.push_back({g, e});
      stress.push_back(element_stress(model, groups[g], e, start != nullptr ? &(*start)[g] : nullptr));
    }
  }

  PatchFits fits(model, elements, stress);
  std::map<int, Eigen::MatrixXd> highest;  // by points a line
  for (std::size_t k = 0; k < elements.size(); ++k) {
    const GroupData& data = groups[elements[k].group];
    const Matrix4 C = result.energy ? compliance(*solid_law(data)) : Matrix4::Identity();
    double error = fitted_error(stress[k], fits.of(*data.group, k), C, result.size);
    if (shows_its_own_error(stress[k])) {
      const int line = stress[k].degree + 1;
      auto& above = highest[line];
      if (above.size() == 0) above = highest_degrees(line);
      error = std::min(error, own_error(stress[k], above, C));
    }
    add_element(result, elements[k], error);
  }
  return result;
}

}  // namespace sage
