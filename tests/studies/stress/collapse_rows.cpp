// Collapse loads of footings under associated flow, on two meshes of each element.
#include <fmt/format.h>

#include <cmath>

#include "tests/studies/scenes/footing.hpp"
#include "tests/studies/stress/row.hpp"

namespace sage::stress {

namespace {

using namespace scenes;

struct CollapseKind {
  const char* name;
  Cell cell;
  int formulation;
  int coarse;  // cells under the half width; twice as many on the finer mesh
};
constexpr CollapseKind kFree[] = {{"quad4 enhanced", Cell::quad4, 5, 8}, {"quad8 reduced", Cell::quad8, 1, 5}};
constexpr CollapseKind kLocking[] = {{"quad4 full", Cell::quad4, 1, 8}, {"quad4 b-bar", Cell::quad4, 2, 8}};

// A footing and what it carries: the mean pressure at collapse.
struct CollapseScene {
  Footing footing;
  double settlement = 0.15, exact = 0.0;
};

Footing meshed(const CollapseScene& scene, const CollapseKind& kind, int inside) {
  Footing footing = scene.footing;
  const bool linear = kind.cell == Cell::quad4;
  footing.cell = kind.cell;
  footing.formulation = kind.formulation;
  footing.inside = inside;
  footing.outside = inside * 3 / 2;
  footing.down = inside * 5 / 4;
  if (linear) footing.power = 2.0;
  footing.build();
  footing.press(scene.settlement, 12);
  return footing;
}

// Relative to the exact load.
double excess(const CollapseScene& scene, const Footing& footing, const Ran& ran) {
  return ran.completed() ? footing.pressure(*ran.run) / scene.exact - 1.0 : kUnknown;
}

// 3 % on the finer mesh, 9 % on the coarser one.  An element that locks must fail on the finer one.
void collapse(Sweep& s, const CollapseScene& scene, bool locks) {
  constexpr double kAllowed = 0.03;
  for (const CollapseKind& kind : kFree)
    for (int fine : {1, 2}) {
      const Footing footing = meshed(scene, kind, kind.coarse * fine);
      const Ran ran = s.run(footing.deck.text());
      Trial& t = s.right(fmt::format("{}, {} under the half width", kind.name, footing.inside),
                         1.0 / (footing.block.order() * footing.inside), ran, excess(scene, footing, ran),
                         fine == 2 ? kAllowed : 3.0 * kAllowed);
      t.series = kind.name;
    }
  if (!locks) return;
  for (const CollapseKind& kind : kLocking) {
    const Footing footing = meshed(scene, kind, 2 * kind.coarse);
    const Ran ran = s.run(footing.deck.text());
    const double error = ran.run ? footing.pressure(*ran.run) / scene.exact - 1.0 : kUnknown;
    s.holds(fmt::format("{}, {} under the half width", kind.name, footing.inside), kUnknown, error > kAllowed,
            "fails: more than 3 % too much", fmt::format("{:.1f} % too much", 100.0 * error));
  }
}

void strip_on_clay(Sweep& s) {
  CollapseScene scene;
  scene.footing.rough = true;
  scene.exact = 2.0 + kPi;
  collapse(s, scene, false);
}

void circle_on_clay(Sweep& s) {
  CollapseScene scene;
  scene.footing.geometry = 2;
  scene.footing.width = 2.5;
  scene.footing.depth = 2.0;
  scene.exact = 5.689;
  collapse(s, scene, false);
}

void strip_on_sand(Sweep& s) {
  CollapseScene scene;
  scene.footing.rough = true;
  scene.footing.phi = scene.footing.psi = 30.0;
  scene.footing.c = 0.0;
  scene.footing.nu = 0.3;
  scene.footing.E = 3000.0;
  scene.footing.surcharge = 1.0;
  scene.footing.width = 10.0;
  scene.footing.depth = 6.0;
  scene.settlement = 0.12;
  scene.exact = prandtl_Nq(30.0);
  collapse(s, scene, true);
}

}  // namespace

std::vector<Row> collapse_rows() {
  const std::string family = "Collapse loads", axis = "distance of nodes over half width";
  const std::string allowed = " Allowed: 3 % on the finer of two meshes, 9 % on the coarser one";
  return {
      {"collapse-clay", family, "rough strip on Tresca clay", "Prandtl: (2 + pi) c." + allowed, axis, true,
       strip_on_clay},
      {"collapse-circle", family, "smooth circle on Tresca clay",
       "5.689 c (Cox, Eason & Hopkins 1961; Houlsby & Wroth 1983)." + allowed, axis, true, circle_on_clay},
      {"collapse-sand", family, "rough strip, phi = psi = 30, weightless with surcharge",
       "Prandtl: N_q = 18.40." + allowed + "; elements that lock must fail", axis, true, strip_on_sand},
  };
}

}  // namespace sage::stress
