#include "sage/conformance/patch.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

namespace sage::conformance {

namespace {

// Index of the node at p, added if there is none.
int node_at(std::vector<Vector2>& nodes, const Vector2& p, double tolerance) {
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if ((nodes[i] - p).norm() < tolerance) return static_cast<int>(i);
  nodes.push_back(p);
  return static_cast<int>(nodes.size()) - 1;
}

void scatter(const std::vector<int>& nodes, const ElementRun& run, DenseSystem& system) {
  for (std::size_t i = 0; i < 2 * nodes.size(); ++i) {
    const int row = 2 * nodes[i / 2] + static_cast<int>(i % 2);
    const auto a = static_cast<Eigen::Index>(i);
    system.f(row) += run.f(a);
    for (std::size_t j = 0; j < 2 * nodes.size(); ++j)
      system.K(row, 2 * nodes[j / 2] + static_cast<int>(j % 2)) += run.K(a, static_cast<Eigen::Index>(j));
  }
}

}  // namespace

CornerMesh macneal_harder() {
  CornerMesh mesh;
  mesh.x.resize(2, 8);
  mesh.x << 0, .24, .24, 0, .04, .18, .16, .08,  //
      0, 0, .12, .12, .02, .03, .08, .08;
  mesh.quads = {{4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {0, 4, 7, 3}};
  return mesh;
}

CornerMesh perturbed_grid(int nx, int ny, double x0, double x1, double y0, double y1, double shift) {
  CornerMesh mesh;
  mesh.x.resize(2, (nx + 1) * (ny + 1));
  const double dx = (x1 - x0) / nx, dy = (y1 - y0) / ny;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) {
      Vector2 p(x0 + i * dx, y0 + j * dy);
      if (i > 0 && i < nx) p.x() += shift * dx * std::sin(3.0 * i + 5.0 * j);
      if (j > 0 && j < ny) p.y() += shift * dy * std::cos(4.0 * i - 2.0 * j);
      mesh.x.col(j * (nx + 1) + i) = p;
    }
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int a = j * (nx + 1) + i;
      mesh.quads.push_back({a, a + 1, a + nx + 2, a + nx + 1});
    }
  return mesh;
}

PatchMesh make_mesh(const ElementEntry& entry, const CornerMesh& corners) {
  std::vector<std::vector<int>> cells = corners.quads;
  if (entry.triangle()) {
    cells.clear();
    for (const auto& q : corners.quads) {
      cells.push_back({q[0], q[1], q[2]});
      cells.push_back({q[0], q[2], q[3]});
    }
  }
  const double size = (corners.x.rowwise().maxCoeff() - corners.x.rowwise().minCoeff()).norm();
  PatchMesh mesh;
  std::vector<Vector2> nodes;
  for (const auto& cell : cells) {
    const Eigen::Matrix2Xd x = straight_element(entry, element_nodes(corners.x, cell));
    std::vector<int>& element = mesh.elements.emplace_back();
    for (Eigen::Index i = 0; i < x.cols(); ++i) element.push_back(node_at(nodes, x.col(i), 1e-9 * size));
  }
  mesh.x.resize(2, static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) mesh.x.col(static_cast<Eigen::Index>(i)) = nodes[i];
  return mesh;
}

Eigen::Matrix2Xd element_nodes(const Eigen::Matrix2Xd& x, const std::vector<int>& nodes) {
  Eigen::Matrix2Xd part(2, static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) part.col(static_cast<Eigen::Index>(i)) = x.col(nodes[i]);
  return part;
}

DenseSystem assemble(const Eigen::Matrix2Xd& x, const std::vector<Group>& groups, const Eigen::Matrix2Xd& u) {
  DenseSystem system;
  const Eigen::Index dofs = 2 * x.cols();
  system.K.setZero(dofs, dofs);
  system.f.setZero(dofs);
  for (const Group& group : groups) {
    auto& runs = system.runs.emplace_back();
    for (const auto& nodes : group.elements) {
      ElementRun& run = runs.emplace_back(*group.element, element_nodes(x, nodes), group.law);
      const Eigen::Matrix2Xd du = element_nodes(u, nodes);
      run.evaluate(du.reshaped());
      scatter(nodes, run, system);
    }
  }
  return system;
}

Eigen::Matrix2Xd solve(const Eigen::Matrix2Xd& x, const std::vector<Group>& groups,
                       const std::vector<char>& fixed, const Eigen::Matrix2Xd& prescribed,
                       const Eigen::VectorXd& load) {
  Eigen::Matrix2Xd u = prescribed;
  std::vector<Eigen::Index> free;
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (!fixed[i]) {
      free.push_back(static_cast<Eigen::Index>(i));
      u(static_cast<Eigen::Index>(i % 2), static_cast<Eigen::Index>(i / 2)) = 0.0;
    }
  const DenseSystem system = assemble(x, groups, u);
  const Eigen::MatrixXd K = system.K(free, free);
  const Eigen::VectorXd residual = load - system.f;
  // One step of refinement makes partial pivoting as exact as full pivoting, in a fraction of its time.
  const Eigen::PartialPivLU<Eigen::MatrixXd> factors(K);
  const Eigen::VectorXd right = residual(free);
  Eigen::VectorXd du = factors.solve(right);
  du += factors.solve(right - K * du);
  for (std::size_t i = 0; i < free.size(); ++i) u(free[i] % 2, free[i] / 2) = du(static_cast<Eigen::Index>(i));
  return u;
}

std::vector<int> own_edges(const PatchMesh& mesh, const Element& element, const std::vector<int>& nodes) {
  const auto ends = [&](const std::vector<int>& of, const std::vector<int>& edge) {
    return std::minmax({of[edge[0]], of[edge[1]]});
  };
  std::vector<int> own;
  for (std::size_t local = 0; local < element.edges().size(); ++local) {
    int uses = 0;
    for (const auto& other : mesh.elements)
      for (const auto& edge : element.edges())
        uses += ends(other, edge) == ends(nodes, element.edges()[local]) ? 1 : 0;
    if (uses == 1) own.push_back(static_cast<int>(local));
  }
  return own;
}

std::vector<char> boundary_nodes(const PatchMesh& mesh, const Element& element) {
  std::vector<char> on_boundary(static_cast<std::size_t>(mesh.x.cols()), 0);
  for (const auto& nodes : mesh.elements)
    for (const int edge : own_edges(mesh, element, nodes))
      for (const int local : element.edges()[edge]) on_boundary[nodes[local]] = 1;
  return on_boundary;
}

}  // namespace sage::conformance
