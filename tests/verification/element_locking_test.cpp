// Thick cylinder, a = 1, b = 2, internal pressure p = E = 1, u_z = 0:  u(a) = (1 + nu)(5 - 2 nu) / 3  (Lame).
// Proves traits().locks, and that the default elements give the same accuracy at nu = .4999999 as at .3.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "materials/linear_elastic.hpp"
#include "sage/conformance/patch.hpp"
#include "tests/support/elements.hpp"

namespace sage::test {
namespace {

// A mesh over s, t in (0, 1): r = 1 + s; t is z / 1 in a ring of unit height, or the angle / 90 degrees in
// plane strain.
struct Cylinder {
  PatchMesh mesh;
  Eigen::Matrix2Xd st;
};

Cylinder make_cylinder(const ElementCase& c, int n) {
  Cylinder cylinder;
  cylinder.mesh = make_mesh(*c.entry, perturbed_grid(n, n, 0.0, 1.0, 0.0, 1.0, 0.1));
  cylinder.st = cylinder.mesh.x;
  for (Eigen::Index i = 0; i < cylinder.st.cols(); ++i) {
    const double r = 1.0 + cylinder.st(0, i), t = cylinder.st(1, i);
    cylinder.mesh.x.col(i) =
        c.axisymmetric() ? Vector2(r, t) : Vector2(r * std::cos(kPi / 2.0 * t), r * std::sin(kPi / 2.0 * t));
  }
  return cylinder;
}

Eigen::VectorXd pressure_load(const Cylinder& cylinder, const Element& element) {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(cylinder.mesh.dofs());
  for (const auto& nodes : cylinder.mesh.elements)
    for (std::size_t e = 0; e < element.edges().size(); ++e) {
      const auto inside = [&](int local) { return cylinder.st(0, nodes[local]) < 1e-9; };
      if (!std::all_of(element.edges()[e].begin(), element.edges()[e].end(), inside)) continue;
      std::vector<double> f(2 * nodes.size(), 0.0);
      element.edge_load(element_nodes(cylinder.mesh.x, nodes), static_cast<int>(e), {1.0, 1.0}, {0.0, 0.0}, f);
      for (std::size_t i = 0; i < f.size(); ++i) load(2 * nodes[i / 2] + static_cast<int>(i % 2)) += f[i];
    }
  return load;
}

// Relative error of u(a), root mean square over the inner nodes.
double lame_error(const ElementCase& c, int n, double nu) {
  const auto element = c.make();
  const LinearElastic law(moduli_from_young(1.0, nu));
  const Cylinder cylinder = make_cylinder(c, n);
  std::vector<char> fixed(static_cast<std::size_t>(cylinder.mesh.dofs()), 0);
  for (Eigen::Index i = 0; i < cylinder.st.cols(); ++i) {
    const double t = cylinder.st(1, i);
    const bool low = t<1e-9, high = t> 1.0 - 1e-9;
    const auto dof = static_cast<std::size_t>(2 * i);
    if (low || (high && c.axisymmetric())) fixed[dof + 1] = 1;
    if (high && !c.axisymmetric()) fixed[dof] = 1;
  }
  const Eigen::Matrix2Xd u =
      solve(cylinder.mesh.x, {{element.get(), static_cast<const SolidLaw*>(&law), cylinder.mesh.elements}},
            fixed, Eigen::Matrix2Xd::Zero(2, cylinder.st.cols()), pressure_load(cylinder, *element));
  double sum = 0.0;
  int count = 0;
  for (Eigen::Index i = 0; i < cylinder.st.cols(); ++i) {
    if (cylinder.st(0, i) > 1e-9) continue;
    const Vector2 x = cylinder.mesh.x.col(i);
    const double u_r = c.axisymmetric() ? u(0, i) : u.col(i).dot(x.normalized());
    sum += std::pow(u_r / ((1.0 + nu) * (5.0 - 2.0 * nu) / 3.0) - 1.0, 2);
    ++count;
  }
  return std::sqrt(sum / count);
}

// On 4 x 4 cells: an element that says it locks has more than 5 % error at nu = .4999999 and more than three
// times that at .3; one that doesn't has less than 5 %.
TEST(ThickCylinder, LocksIffItSaysSo) {
  for (const ElementCase& c : solid_cases()) {
    SCOPED_TRACE(c.name);
    const double easy = lame_error(c, 4, 0.3), hard = lame_error(c, 4, 0.4999999);
    EXPECT_LT(easy, 0.08);
    if (c.make()->traits().locks) {
      EXPECT_GT(hard, 0.05);
      EXPECT_GT(hard, 3.0 * easy);
    } else {
      EXPECT_LT(hard, 0.05);
    }
  }
}

TEST(ThickCylinder, BBarIsAsAccurateNearlyIncompressible) {
  for (const Geometry geometry : {Geometry::plane_strain, Geometry::axisymmetric}) {
    const ElementCase c = element_case(1, 2, geometry);
    EXPECT_LT(lame_error(c, 4, 0.4999999), 2.0 * lame_error(c, 4, 0.3));
  }
}

// Halving the cells divides the displacement error of four-node elements by four (2 to 4 cells measured: 2.8
// to 3.6, the cells are coarse and distorted) and that of quadratic ones by more.
TEST(ThickCylinder, Converges) {
  for (const ElementCase& c : solid_cases()) {
    if (c.entry->triangle() && c.make()->traits().degree > 2) continue;
    SCOPED_TRACE(c.name);
    EXPECT_LT(lame_error(c, 4, 0.3), lame_error(c, 2, 0.3) / (c.entry->only_corners() ? 2.5 : 4.0));
  }
}

}  // namespace
}  // namespace sage::test
