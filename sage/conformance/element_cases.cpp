#include "sage/conformance/element_cases.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <stdexcept>
#include <variant>

#include "elements/shapes.hpp"

namespace sage::conformance {

namespace {

Eigen::Matrix2Xd columns(std::initializer_list<Vector2> points) {
  Eigen::Matrix2Xd x(2, static_cast<Eigen::Index>(points.size()));
  Eigen::Index i = 0;
  for (const Vector2& p : points) x.col(i++) = p;
  return x;
}

bool exists(const ElementEntry& entry, Geometry geometry, int formulation) {
  try {
    return entry.make(geometry, formulation) != nullptr;
  } catch (const ParameterError&) {
    return false;
  }
}

// Solids and elements of flow have an area; interfaces and structures are lines.
bool has_area(const ElementEntry& entry) {
  return entry.solid() || entry.flow();
}

}  // namespace

std::vector<ElementCase> element_cases(const Catalogue& catalogue, const std::vector<int>& codes) {
  std::vector<ElementCase> cases;
  for (const auto& [code, entry] : catalogue.elements.entries()) {
    if (!codes.empty() && std::ranges::find(codes, code) == codes.end()) continue;
    for (const Formulation& formulation : entry.formulations)
      for (const Geometry geometry : {Geometry::plane_strain, Geometry::axisymmetric}) {
        if (!exists(entry, geometry, formulation.code)) continue;
        cases.push_back({code, formulation.code, geometry, &entry,
                         entry.name + " " + formulation.name +
                             (geometry == Geometry::axisymmetric ? " axisymmetric" : " plane strain")});
      }
  }
  return cases;
}

std::vector<ElementCase> of_kind(ElementKind kind, const std::vector<ElementCase>& cases) {
  std::vector<ElementCase> found;
  for (const ElementCase& c : cases)
    if (c.entry->kind == kind) found.push_back(c);
  return found;
}

Eigen::Matrix2Xd parent_nodes(const ElementEntry& entry) {
  Eigen::Matrix2Xd nodes(2, static_cast<Eigen::Index>(entry.parent_nodes.size()));
  for (Eigen::Index i = 0; i < nodes.cols(); ++i) {
    const auto& [xi, eta] = entry.parent_nodes[i];
    nodes.col(i) << xi, (has_area(entry) ? eta : 0.0);
  }
  return nodes;
}

Eigen::Matrix2Xd straight_element(const ElementEntry& entry, const Eigen::Matrix2Xd& corners) {
  const Eigen::Matrix2Xd parent = parent_nodes(entry);
  Eigen::Matrix2Xd x(2, parent.cols());
  for (Eigen::Index i = 0; i < parent.cols(); ++i) {
    const ParentPoint q{parent(0, i), parent(1, i)};
    if (corners.cols() == 2) x.col(i) = corners * Line2::N(q[0]);
    if (corners.cols() == 3) x.col(i) = corners * Tri3::N(q);
    if (corners.cols() == 4) x.col(i) = corners * Quad4::N(q);
  }
  return x;
}

Eigen::Matrix2Xd sample_shape(const ElementEntry& entry) {
  if (!has_area(entry)) return straight_element(entry, columns({{1.0, 0.5}, {2.2, 1.1}}));
  if (entry.triangle()) return straight_element(entry, columns({{1.0, 0.2}, {2.3, 0.5}, {1.4, 1.7}}));
  return straight_element(entry, columns({{1.0, 0.1}, {2.4, 0.3}, {2.0, 1.6}, {1.2, 1.2}}));
}

Eigen::Matrix2Xd sample_shape_on_axis(const ElementEntry& entry) {
  if (!has_area(entry)) return straight_element(entry, columns({{0.0, 0.5}, {1.2, 1.1}}));
  if (entry.triangle()) return straight_element(entry, columns({{0.0, 0.2}, {1.3, 0.5}, {0.4, 1.7}}));
  return straight_element(entry, columns({{0.0, 0.1}, {1.4, 0.3}, {1.0, 1.6}, {0.0, 1.2}}));
}

Eigen::Matrix2Xd sample_shape_curved(const ElementEntry& entry) {
  Eigen::Matrix2Xd x = sample_shape(entry);
  if (entry.only_corners()) return x;
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const Vector2 p = x.col(i);
    x.col(i) += 0.06 * Vector2(std::sin(2.0 * p.y()), std::cos(2.0 * p.x()));
  }
  return x;
}

ElementRun::ElementRun(const Element& e, const Eigen::Matrix2Xd& nodes, LawRef l)
    : element(&e), law(l), x(nodes) {
  const ElementTraits& t = e.traits();
  const auto points = static_cast<std::size_t>(t.points), n = static_cast<std::size_t>(t.law_size);
  const PointHistory quantities = history_of(law, t);
  history = static_cast<int>(quantities.size());
  geometry.resize(t.geometry_size());
  e.geometry(x, geometry);
  sigma0.assign(points * n, 0.0);
  eps0 = sigma1 = eps1 = sigma0;
  for (std::size_t p = 0; p < points; ++p)
    for (std::size_t i = 0; i < quantities.size(); ++i) h0.push_back(quantities[i].initial);
  h1.assign(h0.size(), 0.0);
  status.assign(points, PointStatus::elastic);
  u0.setZero(t.dofs);
  K.setZero(t.dofs, t.dofs);
  f.setZero(t.dofs);
}

Outcome ElementRun::evaluate(const Eigen::VectorXd& du, bool want_stiffness) {
  ElementIn in{geometry.data(), du.data(), law, sigma0.data(), eps0.data(), h0.data(), contexts};
  in.u0 = u0.data();
  in.dt = dt;
  in.x = x.data();
  in.second_law = second_law;
  in.edges = edges;
  in.four_law = four_law;
  ElementOut out{
      want_stiffness ? K.data() : nullptr, f.data(), sigma1.data(), eps1.data(), h1.data(), status.data()};
  return element->evaluate(in, out);
}

double tangent_error(ElementRun& run, const Eigen::VectorXd& du, double step) {
  const auto force = [&](const Eigen::VectorXd& at, bool want_stiffness) {
    if (run.evaluate(at, want_stiffness) != Outcome::ok) throw std::runtime_error("the element refused a step");
    return run.f;
  };
  force(du, true);
  const Eigen::MatrixXd K = run.K;
  double largest = 0.0;
  for (Eigen::Index j = 0; j < du.size(); ++j) {
    const Eigen::VectorXd along = step * Eigen::VectorXd::Unit(du.size(), j);
    const Eigen::VectorXd difference = (force(du + along, false) - force(du - along, false)) / (2.0 * step);
    largest = std::max(largest, (difference - K.col(j)).norm());
  }
  return largest / K.norm();
}

double ElementRun::weight(int point) const {
  const ElementTraits& t = element->traits();
  return geometry[point * (1 + t.law_size * t.dofs)];
}

Eigen::MatrixXd ElementRun::B(int point) const {
  const ElementTraits& t = element->traits();
  const double* block = geometry.data() + point * (1 + t.law_size * t.dofs);
  return Eigen::Map<const Eigen::MatrixXd>(block + 1, t.dofs, t.law_size).transpose();
}

}  // namespace sage::conformance
