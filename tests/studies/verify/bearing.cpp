// Bearing capacity of strips and circles.
#include <fmt/format.h>

#include <cmath>

#include "sage/bounds/bounds.hpp"
#include "sage/bounds/model_domain.hpp"
#include "tests/studies/scenes/footing.hpp"
#include "tests/studies/verify/cases.hpp"
#include "tests/studies/verify/fields.hpp"

namespace sage::verify {

namespace {

void collapse(Record& record, Footing footing, const std::string& name, double settlement, double reference,
              double gate) {
  footing.build();
  footing.press(settlement, 12);
  const WholeRun run = record.run(footing.deck);
  const double q = footing.load(run, run.last());
  record.near(where_of(footing.geometry), name, q, reference, gate);
  record.small(where_of(footing.geometry), name + ": growth in the last increment",
               q / footing.load(run, run.increments[run.increments.size() - 2]) - 1.0, 2e-3);
}

// Drucker-Prager with phi = 0 and k = c_u, von Mises, has the same collapse load in plane strain.
void strip(Record& record) {
  Footing smooth, rough, von_mises;
  rough.rough = true;
  von_mises.law = 3;
  collapse(record, smooth, "N_c, smooth", 0.15, 2 + kPi, 0.015);
  collapse(record, rough, "N_c, rough", 0.15, 2 + kPi, 0.015);
  collapse(record, von_mises, "N_c, smooth, von Mises", 0.15, 2 + kPi, 0.015);
}

// Under a flexible load that grows past collapse: the run ends, says between which loads, and is not complete.
void load_control(Record& record) {
  Footing footing;
  footing.inside = 5;
  footing.outside = 7;
  footing.down = 7;
  footing.build();
  StageCards& stage = footing.deck.stage(12);
  for (int i = 0; i < footing.inside; ++i)
    stage.pressure(footing.block.element(i, footing.down - 1), 3, 6.0, 6.0);
  const WholeRun run = record.try_run(footing.deck);
  record.within(Where::plane_strain, "run completed", run.completed() ? 1.0 : 0.0, 0.0, 0.5);
  const auto [from, to] = printed_bracket(run);
  record.near(Where::plane_strain, "lower end of the printed bracket", 6 * from, 2 + kPi, 0.03);
  record.small(Where::plane_strain, "width of the bracket over the load", (to - from) / from, 0.01);
}

void circle(Record& record) {
  for (bool rough : {false, true}) {
    Footing footing;
    footing.geometry = 2;
    footing.rough = rough;
    footing.inside = 14;
    footing.outside = 12;
    footing.down = 16;
    footing.width = 2.5;
    footing.depth = 2.0;
    collapse(record, footing, rough ? "N_c of the circle, rough" : "N_c of the circle, smooth", 0.15,
             rough ? 6.048 : 5.689, 0.015);
  }
}

// Weightless ground with friction, associated flow: N_c = (N_q - 1) cot phi.
void friction(Record& record) {
  const double phi = 20.0;
  Footing footing;
  footing.rough = true;
  footing.phi = footing.psi = phi;
  footing.nu = 0.3;
  footing.E = 1000.0;
  footing.inside = 12;
  footing.outside = 18;
  footing.down = 16;
  footing.width = 7.0;
  footing.depth = 4.0;
  collapse(record, footing, "N_c, phi = psi = 20", 0.2,
           (scenes::prandtl_Nq(phi) - 1) / std::tan(phi * kRadiansPerDegree), 0.03);
}

// Rigorous bounds on the same strip: the exact load must lie between them.
void strip_bounds(Record& record) {
  Footing footing;
  footing.rough = true;
  footing.inside = 5;
  footing.outside = 7;
  footing.down = 7;
  footing.build();
  footing.press(0.15, 1);
  const Model model = record.bench().build(footing.deck.text());
  bounds::Options options;
  options.elements = 1500;
  const bounds::Bounds found = bounds::find_bounds(bounds::make_ground(model, 0, 0).domain, options);
  if (!found.lower.value || !found.upper.value)
    throw AnalysisError("S575", found.lower.reason + found.upper.reason);
  const double exact = 2.0 + kPi;
  record.within(Where::plane_strain, "lower bound over the exact load, at most 1", *found.lower.value / exact,
                0.99, 0.01);
  record.within(Where::plane_strain, "upper bound over the exact load, at least 1", *found.upper.value / exact,
                1.01, 0.01);
}

}  // namespace

Section bearing_cases() {
  return {
      "Bearing capacity",
      {
          {"bearing.strip", "strip on Tresca clay", "Prandtl: N_c = 2 + pi, smooth and rough", Grade::exact,
           "approached from above: 1.5 % with twelve quad8 under the half width; a plateau", strip},
          {"bearing.load_control", "the same under a growing load: bracket of the limit load",
           "Prandtl: N_c = 2 + pi", Grade::exact, "coarse mesh of 5 quad8 under the half width: 3 %",
           load_control},
          {"bearing.bounds", "strip on Tresca clay: bounds by limit analysis", "Prandtl: N_c = 2 + pi",
           Grade::exact, "the exact load between the bounds, 2 % from each, 1500 triangles", strip_bounds},
          {"bearing.circle", "circle on Tresca clay",
           "5.689 smooth, 6.048 rough: Cox, Eason & Hopkins 1961; Eason & Shield 1960; Houlsby & Wroth 1983",
           Grade::published, "approached from above: 1.5 %; a plateau", circle},
          {"bearing.friction", "strip on weightless ground with c = 1, phi = psi = 20",
           "Prandtl: N_c = (N_q - 1) cot phi = 14.835", Grade::exact,
           "3 %, as recommended for friction; a plateau", friction},
      }};
}

}  // namespace sage::verify
