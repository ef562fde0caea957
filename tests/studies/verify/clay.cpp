// Modified Cam clay: points, one element, a cavity and the undrained strength.  References by integration of the law's
// equations (order 8, errors below 1e-9), or closed.
#include <fmt/format.h>

#include <cmath>

#include "sage/core/point_driver.hpp"
#include "tests/studies/verify/cases.hpp"

namespace sage::verify {

namespace {

constexpr int kCamClay = 11;
constexpr double kClayM = 1.2, kClayLambda = 0.2, kClayKappa = 0.04, kClayStart = 100.0;
constexpr double kStiffWater = 1e9;  // K_w/n, 1e5 times the bulk modulus of the clay

std::vector<double> clay_parameters(double ocr, double shape = 0.0) {
  return {kClayM, kClayLambda, kClayKappa, 2.0, 0.3, ocr, 0.0, 0.0, shape};
}
std::unique_ptr<SolidLaw> clay_law(const Record& record, const std::vector<double>& parameters) {
  LawPtr made =
      record.bench().catalogue().materials.find(kCamClay)->make(parameters, {"m", "kN", "kPa", 101.325, 9.81});
  return std::move(std::get<std::unique_ptr<SolidLaw>>(made));
}

enum class ClayPath { drained, undrained, oedometer };

PointDriver<4> clay_driven(const SolidLaw& law, ClayPath path, double strain, int steps) {
  constexpr Control e = Control::strain, s = Control::stress;
  PointDriver<4> point(law, {-kClayStart, -kClayStart, -kClayStart, 0.0});
  const double d = -strain / steps, side = path == ClayPath::undrained ? -0.5 * d : 0.0;
  for (int i = 0; i < steps; ++i)
    if (path == ClayPath::drained)
      point.advance({s, e, s, e}, {-kClayStart, d, -kClayStart, 0.0});
    else
      point.advance({e, e, e, e}, {side, d, side, 0.0});
  return point;
}

void clay_paths(Record& record) {
  struct Reference {
    const char* name;
    ClayPath path;
    double ocr, strain, axial, p_c;
  };
  const Reference references[] = {
      {"drained compression, OCR 1", ClayPath::drained, 1, .2, 265.852404834, 278.297972517},
      {"drained compression, OCR 8", ClayPath::drained, 8, .4, 306.674241964, 344.523008025},
      {"drained extension, OCR 1", ClayPath::drained, 1, -.02, 38.856009192, 112.227119557},
      {"undrained compression, OCR 1", ClayPath::undrained, 1, .05, 104.229224252, 114.340744303},
      {"undrained compression, OCR 8", ClayPath::undrained, 8, .1, 535.218906558, 612.817667123},
      {"oedometer, OCR 8", ClayPath::oedometer, 8, .05, 1021.185598359, 901.196128455}};
  for (const Reference& r : references) {
    const auto soil = clay_law(record, clay_parameters(r.ocr));
    const PointDriver<4> point = clay_driven(*soil, r.path, r.strain, 100);
    record.near(Where::point, fmt::format("{}: axial stress at {:g} %", r.name, 100.0 * r.strain),
                -point.sigma()[1], r.axial, 1e-3);
    record.near(Where::point, fmt::format("{}: p_c", r.name), point.history()[0], r.p_c, 1e-3);
    std::vector<double> size, error;
    for (const int steps : {100, 800}) {
      size.push_back(1.0 / steps);
      error.push_back(std::abs(clay_driven(*soil, r.path, r.strain, steps).sigma()[1] / -r.axial - 1.0));
    }
    record.order(Where::point, fmt::format("{}: axial stress, 100 and 800 steps", r.name), size, error, 2.0,
                 1.05);
  }
}

// One element under the controls of a point, with smooth ends and the same steps.
void clay_element(Record& record) {
  for (const Cell cell : {Cell::quad4, Cell::quad8})
    for (const ClayPath path : {ClayPath::drained, ClayPath::undrained, ClayPath::oedometer})
      for (const double ocr : {1.0, 8.0}) {
        constexpr int kSteps = 100;
        constexpr double kStrain = 0.05;
        Block block;
        block.cell = cell;
        block.place = rectangle(0.0, 1.0, 0.0, 1.0);
        DeckWriter deck(2);
        block.write_nodes(deck);
        deck.material(1, kCamClay, clay_parameters(ocr));
        deck.group(1, static_cast<int>(cell), 0, 1);
        block.write_elements(deck, 1);
        for (const int node : block.bottom()) deck.fix(node, 0, 1);
        for (const int node : block.left()) deck.fix(node, 1, 0);
        deck.initial(1, 0, kClayStart, kClayStart, kClayStart, 0.0);
        StageCards& stage = deck.stage(kSteps);
        stage.tolerance = 1e-11;
        for (const int node : block.top()) stage.fix(node, 0, 1, 0.0, -kStrain);
        if (path == ClayPath::drained)
          stage.pressure(block.element(0, 0), 2, kClayStart, kClayStart);
        else
          for (const int node : block.right())
            stage.fix(node, 1, 0, path == ClayPath::undrained ? 0.5 * kStrain : 0.0);
        const WholeRun run = record.run(deck);
        const PointDriver<4> point =
            clay_driven(*clay_law(record, clay_parameters(ocr)), path, kStrain, kSteps);
        double worst = 0.0;
        for (Eigen::Index p = 0; p < run.stress[0].cols(); ++p)
          worst = std::max(worst, (run.stress[0].col(p) - point.sigma()).cwiseAbs().maxCoeff() / kClayStart);
        const char* names[] = {"drained", "undrained", "oedometer"};
        record.small(Where::axisymmetric,
                     fmt::format("{}, {}, OCR {:g}: difference of stresses over the cell pressure",
                                 cell == Cell::quad4 ? "quad4" : "quad8", names[static_cast<int>(path)], ocr),
                     worst, 1e-9);
      }
}

// A strip of rings of quad8 from r = 1 to 10, sizes in geometric progression, water shut in, sigma_r(10) = 100 held.
double cavity_pressure(const Record& record, double ocr, double push, int rings) {
  Block block;
  block.cell = Cell::quad8;
  block.columns = rings;
  block.place = [](double x, double y) { return Vector2(std::pow(10.0, x), 0.1 * y); };
  block.straight = true;
  DeckWriter deck(2);
  block.write_nodes(deck);
  deck.material(1, kCamClay, clay_parameters(ocr));
  deck.group(1, static_cast<int>(Cell::quad8), 1, 1);
  block.write_elements(deck, 1);
  for (int j = 0; j < block.up(); ++j)
    for (int i = 0; i < block.across(); ++i)
      if (block.exists(i, j)) deck.fix(block.node(i, j), 0, 1);
  deck.initial(1, 0, kClayStart, kClayStart, kClayStart, 0.0);
  StageCards& stage = deck.stage(rings);
  for (const int node : block.left()) stage.fix(node, 1, 0, push, 0.0);
  stage.pressure(block.element(rings - 1, 0), 2, kClayStart, kClayStart);
  deck.water(5, 0, 1, 0, {}, kStiffWater);
  const WholeRun run = record.run(deck);
  return run.reaction(run.last(), block.left(), 0) / (2.0 * kPi * 0.1) - kClayStart;
}

// Increments and rings are doubled together.  With OCR 2 a plastic front moves through the rings.
void clay_cavity(Record& record) {
  struct Reference {
    double ocr, push, pressure;
  };
  for (const Reference& r : {Reference{1, .01, 39.53466010}, Reference{1, .05, 97.63924207},
                             Reference{1, .15, 136.74818962}, Reference{2, .05, 150.33674067}}) {
    const int rings = r.ocr > 1.0 ? 40 : 20;
    const double coarse = cavity_pressure(record, r.ocr, r.push, rings),
                 fine = cavity_pressure(record, r.ocr, r.push, 2 * rings);
    const std::string what = fmt::format("OCR {:g}, u_a/a = {:g}: growth of the pressure", r.ocr, r.push);
    record.near(Where::axisymmetric, fmt::format("{}, {} rings", what, rings), coarse, r.pressure, 1e-3);
    record.near(Where::axisymmetric, fmt::format("{}, {} and {} rings extrapolated", what, rings, 2 * rings),
                (4.0 * fine - coarse) / 3.0, r.pressure, 1e-4);
  }
}

// s_u = M(0) p_f/sqrt 3, p_f = p_0^(kappa/lambda) (p_c0/2)^(1 - kappa/lambda); with Matsuoka and Nakai's shape the middle
// stress is not p at the end, and the value is integrated.
void clay_strength(Record& record) {
  struct Reference {
    const char* name;
    double ocr, shape, s_u;
  };
  const auto closed = [](double ocr) {
    return kClayM / std::sqrt(3.0) * kClayStart * std::pow(0.5 * ocr, 1.0 - kClayKappa / kClayLambda);
  };
  for (const Reference& r :
       {Reference{"circle, OCR 1", 1, 0, closed(1)}, Reference{"circle, OCR 8", 8, 0, closed(8)},
        Reference{"Matsuoka-Nakai, OCR 1", 1, 1, 31.859154651}}) {
    Block block;
    block.cell = Cell::quad4;
    block.place = rectangle(0.0, 1.0, 0.0, 1.0);
    DeckWriter deck(1);
    block.write_nodes(deck);
    deck.material(1, kCamClay, clay_parameters(r.ocr, r.shape));
    deck.group(1, static_cast<int>(Cell::quad4), 1, 1);
    block.write_elements(deck, 1);
    for (const int node : block.bottom()) deck.fix(node, 0, 1);
    for (const int node : block.left()) deck.fix(node, 1, 0);
    deck.initial(1, 0, kClayStart, kClayStart, kClayStart, 0.0);
    StageCards& stage = deck.stage(200);
    for (const int node : block.top()) stage.fix(node, 0, 1, 0.0, r.ocr > 1.0 ? -0.5 : -0.2);
    stage.pressure(block.element(0, 0), 2, kClayStart, kClayStart);
    deck.water(5, 0, 1, 0, {}, kStiffWater);
    const WholeRun run = record.run(deck);
    const Vector4 stress = run.stress[0].col(0);
    record.near(Where::plane_strain, std::string(r.name) + ": s_u", 0.5 * (stress[0] - stress[1]), r.s_u, 1e-4);
  }
}

// Drained compression of a dry clay under a load that grows: the run ends at the peak, q = 3 (p - 100) on the surface.
void clay_peak(Record& record) {
  constexpr double kOcr = 8.0, kLoad = 500.0;
  Block block;
  block.place = rectangle(0.0, 1.0, 0.0, 1.0);
  DeckWriter deck(2);
  block.write_nodes(deck);
  deck.material(1, kCamClay, clay_parameters(kOcr));
  deck.group(1, static_cast<int>(Cell::quad4), 0, 1);
  block.write_elements(deck, 1);
  for (const int node : block.bottom()) deck.fix(node, 0, 1);
  for (const int node : block.left()) deck.fix(node, 1, 0);
  deck.initial(1, 0, kClayStart, kClayStart, kClayStart, 0.0);
  StageCards& cell = deck.stage();
  for (const int edge : {2, 3}) cell.pressure(block.element(0, 0), edge, kClayStart, kClayStart);
  deck.stage(20).pressure(block.element(0, 0), 3, kLoad, kLoad);
  const WholeRun run = record.try_run(deck);
  record.small(Where::axisymmetric, "runs that go on beyond the peak", run.completed() ? 1.0 : 0.0, 0.5);
  record.near(Where::axisymmetric, "OCR 8: largest deviator with equilibrium", kLoad * run.last().load_factor,
              443.9922379395, 1e-4);
}

}  // namespace

Section clay_cases() {
  return {"Modified Cam clay",
          {
              {"clay.paths", "a point on laboratory paths in 100 steps",
               "the law's equations by a Runge-Kutta method of order 8", Grade::computed,
               "1e-3; the error falls at least in proportion to the step", clay_paths},
              {"clay.one_element", "one element under the controls of a point",
               "the same law driven without a mesh", Grade::twofold, "tolerance of equilibrium 1e-11: 1e-9",
               clay_element},
              {"clay.cavity", "undrained cylindrical cavity, b/a = 10, pressure at b held",
               "isochoric kinematics and quadrature of the law's equations", Grade::computed,
               "1e-3; extrapolated 1e-4", clay_cavity},
              {"clay.undrained_strength", "undrained strength in plane strain",
               "s_u = M p_0^(kappa/lambda) (p_c0/2)^(1 - kappa/lambda)/sqrt 3", Grade::exact,
               "approach to the critical state and stiff water: 1e-4", clay_strength},
              {"clay.peak", "peak of an overconsolidated clay under a growing load",
               "q = 3 (p - sigma_3) on the yield surface, closed form", Grade::exact,
               "12 halvings of a twentieth of the load: 1e-4", clay_peak},
          }};
}

}  // namespace sage::verify
