// Pore water that flows: permeabilities, steps, Poisson's ratios and layers far apart.
#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>

#include "sage/model/dof_map.hpp"
#include "tests/studies/scenes/consolidation.hpp"
#include "tests/studies/stress/row.hpp"

namespace sage::stress {

namespace {

using namespace scenes;

// A column of eight elements under a load of 1 that is applied at once; one step of backward Euler.
struct OneStep {
  static constexpr int kElements = 8;
  double E = 1.0, nu = 0.2, bulk = 0.0, dt = 1e-2;
  double k_below = 1.0, k_above = 1.0;  // of the lower and the upper half, over a unit weight of water of 1
  const char* element = "quad8p4";

  double modulus() const { return E * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)); }

  ModelInput input() const {
    const LatticeMesh mesh{.x = {0.0, 0.125}, .y = graded(0.0, 1.0, kElements), .element = element};
    ModelInput input = pore_input(mesh, E, nu, k_below);
    if (bulk > 0.0) input.materials[1].parameters["water_bulk"] = bulk;
    if (k_above != k_below) {
      input.materials.push_back(input.materials[1]);
      input.materials[2].parameters["permeability"] = k_above;
      GroupInput& below = input.groups[0];
      GroupInput above = below;
      above.second_material = 3;
      const auto half = static_cast<std::ptrdiff_t>(below.elements.size() / 2);
      above.elements.erase(above.elements.begin(), above.elements.begin() + half);
      below.elements.erase(below.elements.begin() + half, below.elements.end());
      input.groups.push_back(above);
    }
    const int top = 2 * kElements;
    input.supports = {held(mesh.column(0), true, false), held(mesh.column(2), true, false),
                      held(mesh.row(0), true, true), drained(mesh.corner_row(top))};
    StageInput press = shut_in();
    press.pressures = {
        {.elements = mesh.upper_elements(), .edge = mesh.upper_edge(), .normal1 = 1.0, .normal2 = 1.0}};
    input.stages = {press, consolidation(dt, 1)};
    return input;
  }

  // Elements of quadratic displacements and linear pressures condense to a consistent mass of linear pressures:
  // (1/M + S) p + dt k p' ... = 1/M at the corners, upwards from the base; 0 at the top.
  Eigen::VectorXd exact() const {
    constexpr int n = kElements;
    const double h = 1.0 / n, soft = 1.0 / modulus(), storage = bulk > 0.0 ? 1.0 / bulk : 0.0;
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n + 1, n + 1);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(n + 1);
    for (int e = 0; e < n; ++e)
      for (int i = 0; i < 2; ++i) {
        b[e + i] += 0.5 * h * soft;
        for (int j = 0; j < 2; ++j)
          A(e + i, e + j) += (soft + storage) * h * (i == j ? 2.0 : 1.0) / 6.0 +
                             dt * (e < n / 2 ? k_below : k_above) / h * (i == j ? 1.0 : -1.0);
      }
    A.row(n).setZero();
    A(n, n) = 1.0;
    b[n] = 0.0;
    return A.fullPivLu().solve(b);
  }

  // Largest error of the pressures at the corners of the left side, over the largest pressure.
  double error(const Ran& ran) const {
    if (!ran.completed()) return kUnknown;
    const LatticeMesh mesh{.x = {0.0, 0.125}, .y = graded(0.0, 1.0, kElements), .element = element};
    const Eigen::VectorXd p = exact();
    const DofMap map(*ran.run->model);
    double worst = 0.0;
    for (int i = 0; i <= kElements; ++i) {
      const double found = ran.run->last().u[map.of(ran.run->index(mesh.node(0, 2 * i)), 1)];
      worst = std::max(worst, std::abs(found - p[i]));
    }
    return worst / p.cwiseAbs().maxCoeff();
  }
};

void judge(Sweep& s, const std::string& label, double parameter, const OneStep& one) {
  const Ran ran = s.run(one.input());
  s.right(fmt::format("{}, {}", label, one.element), parameter, ran, one.error(ran), 1e-9).series = one.element;
}

constexpr const char* kElementsOfPores[] = {"quad8p4", "quad9p4"};

void permeabilities(Sweep& s) {
  for (const char* element : kElementsOfPores)
    for (int i = -12; i <= 0; i += 2)
      judge(s, fmt::format("k = 1e{}", i), std::pow(10.0, i),
            {.k_below = std::pow(10.0, i), .k_above = std::pow(10.0, i), .element = element});
}
void step_sizes(Sweep& s) {
  for (const char* element : kElementsOfPores)
    for (int i = -8; i <= 2; ++i)
      judge(s, fmt::format("dt = 1e{}", i), std::pow(10.0, i), {.dt = std::pow(10.0, i), .element = element});
}
void skeletons(Sweep& s) {
  for (const char* element : kElementsOfPores)
    for (const double left : {0.5, 0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6})
      judge(s, fmt::format("1/2 - nu = {:g}", left), left, {.nu = 0.5 - left, .element = element});
}
void water_bulks(Sweep& s) {
  for (const char* element : kElementsOfPores)
    for (const double bulk : {1e-2, 1.0, 1e2, 1e4, 1e8, 1e12, 0.0})
      judge(s, fmt::format("bulk over modulus {:g}{}", bulk, bulk == 0.0 ? " (incompressible)" : ""),
            bulk > 0.0 ? bulk : kUnknown, {.nu = 0.0, .bulk = bulk, .element = element});
}
void layers(Sweep& s) {
  for (const char* element : kElementsOfPores)
    for (const double contrast : {1e-8, 1e-6, 1e-4, 1e-2, 1e2, 1e4, 1e6, 1e8})
      judge(s, fmt::format("k above / k below = {:g}", contrast), contrast,
            {.k_above = contrast, .element = element});
}

}  // namespace

std::vector<Row> pore_rows() {
  const std::string family = "Consolidation",
                    exact = "one step of the discrete equations, solved densely; 1e-9";
  return {
      {"pore-permeability", family, "permeability over twelve decades", exact, "k", true, permeabilities},
      {"pore-steps", family, "time steps over ten decades", exact, "step, h^2/c = 1/58", true, step_sizes},
      {"pore-poisson", family, "Poisson's ratio of the skeleton up to 1/2", exact, "1/2 - nu", true, skeletons},
      {"pore-bulk", family, "water from soft to incompressible", exact, "bulk of the water over E", true,
       water_bulks},
      {"pore-layers", family, "layers of permeabilities far apart", exact, "k above / k below", true, layers}};
}

}  // namespace sage::stress
