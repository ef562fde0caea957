#include "tests/studies/verify/fields.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "elements/lobatto.hpp"
#include "elements/shapes.hpp"
#include "sage/record/end_forces.hpp"

namespace sage::verify {

namespace {

// Calls act with the shape of a solid element; codes are the catalogue's.
template <class Act>
void with_shape(int element_code, const Act& act) {
  switch (element_code) {
    case 1:
      return act(Quad4{});
    case 2:
      return act(Quad8{});
    case 3:
      return act(Tri3{});
    case 4:
      return act(Tri6{});
    case 5:
      return act(Quad9{});
    case 6:
      return act(Tri15{});
    case 7:
      return act(LobattoQuad<4>{});
    case 8:
      return act(LobattoQuad<6>{});
    case 9:
      return act(LobattoQuad<8>{});
    default:
      throw std::logic_error("no shape for element code " + std::to_string(element_code));
  }
}

// A point of the load rule: shape functions, place, and weight with the measure.
struct LoadPoint {
  Eigen::VectorXd N;
  Vector2 x;
  double w;
};

void each_load_point(const Model& model, const Group& group,
                     const std::function<void(int element, const LoadPoint&)>& act) {
  Eigen::Matrix2Xd x;
  with_shape(group.element_code, [&](auto shape) {
    using Shape = decltype(shape);
    for (int e = 0; e < group.elements(); ++e) {
      element_coordinates(model.mesh, group, e, x);
      for (const RulePoint& p : Shape::LoadRule::table) {
        const ParentPoint q{p.xi, p.eta};
        const Matrix2 J = x * Shape::dN(q);
        LoadPoint point{Shape::N(q), Vector2::Zero(), p.w * J.determinant()};
        point.x = x * point.N;
        if (model.geometry == Geometry::axisymmetric) point.w *= 2.0 * kPi * point.x.x();
        act(e, point);
      }
    }
  });
}

bool is_solid(const Group& group) {
  return group.solid();
}

}  // namespace

std::vector<char> boundary_nodes(const Model& model) {
  std::map<std::pair<int, int>, int> uses;
  const auto each_edge = [&](const auto& act) {
    for (const Group& group : model.groups) {
      if (!is_solid(group)) continue;
      for (int e = 0; e < group.elements(); ++e)
        for (const std::vector<int>& edge : group.element->edges()) {
          const int *nodes = group.nodes_of(e), a = nodes[edge[0]], z = nodes[edge[1]];
          act(std::pair<int, int>(std::min(a, z), std::max(a, z)), nodes, edge);
        }
    }
  };
  each_edge([&](const auto& ends, const int*, const std::vector<int>&) { ++uses[ends]; });
  std::vector<char> flags(static_cast<std::size_t>(model.mesh.nodes()), 0);
  each_edge([&](const auto& ends, const int* nodes, const std::vector<int>& edge) {
    if (uses[ends] == 1)
      for (int local : edge) flags[nodes[local]] = 1;
  });
  return flags;
}

void hold(Model& model, int node, bool x, bool y, const Vector2& u) {
  Fixity fixity;
  fixity.node = node;
  fixity.code = {x ? FixityCode::fixed : FixityCode::unchanged, y ? FixityCode::fixed : FixityCode::unchanged};
  fixity.value = {x ? u.x() : 0.0, y ? u.y() : 0.0};
  model.stages.front().fixities.push_back(fixity);
}

void hold(Model& model, const std::vector<char>& nodes, const VectorField& u) {
  for (int i = 0; i < model.mesh.nodes(); ++i)
    if (nodes[i]) hold(model, i, true, true, u(model.mesh.x.col(i)));
}

void add_body_force(Model& model, const VectorField& b) {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(DofMap(model).dofs());
  for (const Group& group : model.groups) {
    if (!is_solid(group)) continue;
    each_load_point(model, group, [&](int e, const LoadPoint& point) {
      const Vector2 load = point.w * b(point.x);
      for (Eigen::Index i = 0; i < point.N.size(); ++i)
        force.segment<2>(DofMap::displacement(group.nodes_of(e)[i])) += point.N[i] * load;
    });
  }
  for (int node = 0; node < model.mesh.nodes(); ++node)
    model.stages.front().loads.push_back({node, force.segment<2>(DofMap::displacement(node)), 0});
}

Vector4 stress_of(const Material& material, const Vector4& strain) {
  const SolidLaw& law = *std::get<std::unique_ptr<SolidLaw>>(material.law);
  PointOut<4> out;
  const std::vector<double> h0 = initial_values(law.traits().history);
  std::vector<double> h1 = h0;
  out.h1 = h1;
  law.update({Vector4::Zero(), Vector4::Zero(), strain, h0}, out);
  return out.sigma;
}

Vector2 point_position(const Model& model, std::size_t group, Eigen::Index point) {
  const Group& g = model.groups[group];
  const int points = g.element->traits().points, p = static_cast<int>(point);
  Eigen::Matrix2Xd x;
  element_coordinates(model.mesh, g, p / points, x);
  return g.element->position(x, p % points);
}

FieldErrors field_errors(const WholeRun& run, const VectorField& u, const TensorField& sigma) {
  const Model& model = *run.model;
  double du = 0.0, size_u = 0.0, ds = 0.0, size_s = 0.0;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (!is_solid(group)) continue;
    each_load_point(model, group, [&](int e, const LoadPoint& point) {
      Vector2 computed = Vector2::Zero();
      for (Eigen::Index i = 0; i < point.N.size(); ++i)
        computed += point.N[i] * run.last().u.segment<2>(DofMap::displacement(group.nodes_of(e)[i]));
      const Vector2 exact = u(point.x);
      du += point.w * (computed - exact).squaredNorm();
      size_u += point.w * exact.squaredNorm();
    });
    const ElementTraits& traits = group.element->traits();
    std::vector<double> geometry(static_cast<std::size_t>(traits.geometry_size()));
    Eigen::Matrix2Xd x;
    for (int e = 0; e < group.elements(); ++e) {
      element_coordinates(model.mesh, group, e, x);
      group.element->geometry(x, geometry);
      for (int p = 0; p < traits.points; ++p) {
        const double w = geometry[p * (1 + 4 * traits.dofs)];
        const Vector4 exact = sigma(group.element->position(x, p));
        ds += w * (run.stress[g].col(e * traits.points + p) - exact).squaredNorm();
        size_s += w * exact.squaredNorm();
      }
    }
  }
  return {std::sqrt(du / size_u), std::sqrt(ds / size_s)};
}

double largest_stress_error(const WholeRun& run, std::size_t group, const TensorField& sigma) {
  double error = 0.0, size = 0.0;
  for (Eigen::Index p = 0; p < run.stress[group].cols(); ++p) {
    const Vector4 exact = sigma(point_position(*run.model, group, p));
    error = std::max(error, (run.stress[group].col(p) - exact).norm());
    size = std::max(size, exact.norm());
  }
  return error / size;
}

void EndReader::on_increment(const Model& model, const StepReport&, const Solution& now) {
  ends_.clear();
  for (const ElementEnd& end : element_ends(model, now, group_))
    ends_.push_back({-end.value[sage::kAxialForce] * end.along +
                         end.value[sage::kShearForce] * Vector2(-end.along.y(), end.along.x()),
                     end.place, end.value[kBendingMoment]});
}

Vector4 stress_at_node(const WholeRun& run, std::size_t group, int number) {
  const Group& g = run.model->groups[group];
  const int node = run.index(number), points = g.element->traits().points;
  Vector4 sum = Vector4::Zero();
  int count = 0;
  Eigen::Matrix2Xd x;
  for (int e = 0; e < g.elements(); ++e)
    for (std::size_t i = 0; i < g.node_count(); ++i) {
      if (g.nodes_of(e)[i] != node) continue;
      element_coordinates(run.model->mesh, g, e, x);
      const std::span<const double> to_node = g.element->point_to_node(x);
      for (int p = 0; p < points; ++p)
        sum += to_node[i * static_cast<std::size_t>(points) + static_cast<std::size_t>(p)] *
               run.stress[group].col(e * points + p);
      ++count;
    }
  if (count == 0) throw std::logic_error("no element at node " + std::to_string(number));
  return sum / count;
}

}  // namespace sage::verify
