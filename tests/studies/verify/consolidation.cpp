// Consolidation: a column, a sample between plates, a cylinder, a sphere, a strip on a layer, a closed specimen.
#include "tests/studies/scenes/consolidation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sage/model/dof_map.hpp"
#include "tests/studies/verify/cases.hpp"

namespace sage::verify {

namespace {

double excess_of(const WholeRun& run, int number) {
  return run.last().u[DofMap(*run.model).of(run.index(number), 1)];
}

WholeRun run_of(const Record& record, const ModelInput& input) {
  return record.run(build_model(input, record.bench().catalogue()));
}

// Loads that are applied at once: `steps` of backward Euler up to time / 256, then eight intervals that double, each of so
// many steps of Crank-Nicolson.  An interval has one matrix.
void march(ModelInput& input, double time, int steps) {
  constexpr int kDoublings = 8;
  double end = std::ldexp(time, -kDoublings);
  input.stages.push_back(consolidation(end, steps));
  for (int k = 0; k < kDoublings; ++k, end *= 2.0) input.stages.push_back(consolidation(end, steps, 1.0, 0.5));
}

// A pressure of 1 on the upper side, from x = 0 on, or on the right side; the water is shut in.
StageInput press_top(const LatticeMesh& mesh, std::size_t elements) {
  StageInput stage = shut_in();
  std::vector<int> under = mesh.upper_elements();
  under.resize(std::min(elements, under.size()));
  stage.pressures = {{.elements = under, .edge = mesh.upper_edge(), .normal1 = 1.0, .normal2 = 1.0}};
  return stage;
}
StageInput press_right(const LatticeMesh& mesh) {
  StageInput stage = shut_in();
  stage.pressures = {
      {.elements = mesh.right_elements(), .edge = mesh.right_edge(), .normal1 = 1.0, .normal2 = 1.0}};
  return stage;
}

// One number on meshes of halved cells: the order, the error of the finest, and that of the limit to which the last two
// extrapolate by the second order.
struct MeshErrors {
  std::vector<double> size, error, computed;
  double reference = kNone;

  void take(double h, double value, double exact) {
    size.push_back(h);
    error.push_back(std::abs(value - exact));
    computed.push_back(value);
    reference = exact;
  }
  void report(Record& record, Where where, const std::string& what, double gate) const {
    record.order(where, what, size, error, 2.0, 0.2);
    record.within(where, what + ", finest", computed.back(), reference, gate);
  }
  void report_limit(Record& record, Where where, const std::string& what, double gate) const {
    const double before = computed[computed.size() - 2];
    record.within(where, what + ", limit", (4.0 * computed.back() - before) / 3.0, reference, gate);
  }
};

// ---- Terzaghi ----

// Sum over M = pi (m + 1/2) of term(M).
template <class Term>
double terzaghi(const Term& term) {
  double sum = 0.0;
  for (int m = 0; m < 200; ++m) sum += term(std::numbers::pi * (m + 0.5));
  return sum;
}

// E' = 1, nu' = 0, k / gamma_w = 1: c = 1.  A layer of height `drains` that drains through its top, or through both ends.
void drained_column(Record& record, const char* element, int drains) {
  constexpr double kT = 0.1;
  const double exact_degree = 1.0 - terzaghi([](double M) { return 2.0 / (M * M) * std::exp(-M * M * kT); });
  const double exact_pressure =
      terzaghi([](double M) { return 2.0 / M * std::sin(0.5 * M) * std::exp(-M * M * kT); });
  MeshErrors degree, pressure;
  for (const int n : {32, 64, 128}) {
    const LatticeMesh mesh{.x = {0.0, 1.0}, .y = graded(0.0, drains, n * drains), .element = element};
    ModelInput input = pore_input(mesh, 1.0, 0.0, 1.0);
    const int top = 2 * mesh.rows();
    input.supports = {held(mesh.column(0), true, false), held(mesh.column(2), true, false),
                      held(mesh.row(0), true, true), drained(mesh.corner_row(top))};
    if (drains == 2) input.supports.push_back(drained(mesh.corner_row(0)));
    input.stages = {press_top(mesh, 1)};
    march(input, kT, n / 2);
    const WholeRun run = run_of(record, input);
    degree.take(1.0 / n, -run.u(mesh.node(0, top)).y() / drains, exact_degree);
    pressure.take(1.0 / n, excess_of(run, mesh.node(0, top - n)), exact_pressure);
  }
  degree.report(record, Where::plane_strain, "degree of consolidation, T = .1", 1e-5);
  pressure.report(record, Where::plane_strain, "excess pressure at half the way of drainage, T = .1", 1e-5);
}

void one_way(Record& record) {
  drained_column(record, "quad8p4", 1);
}
void two_ways(Record& record) {
  drained_column(record, "quad9p4", 2);
}

// ---- Mandel ----

// Half-width 1, G = 1, nu' = 0.2, half of the force 1.  The plates move as the closed form has it; pressure, width and force
// follow.
class Mandel {
 public:
  Mandel() {
    constexpr double kRatio = (1.0 - kNu) / (0.5 - kNu);
    for (int n = 0; n < 200; ++n) {
      double low = (n + 1e-12) * std::numbers::pi, high = (n + 0.5) * std::numbers::pi - 1e-13;
      for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        (std::tan(middle) < kRatio * middle ? low : high) = middle;
      }
      roots_.push_back(0.5 * (low + high));
    }
  }
  static constexpr double kNu = 0.2;
  double plate(double T) const {
    return -0.5 * (1.0 - kNu) + 0.5 * sum(T, [](double a) { return std::cos(a); });
  }
  double pressure(double x, double T) const {
    return sum(T, [&](double a) { return std::cos(a * x) - std::cos(a); });
  }
  double width(double T) const {
    return 0.5 * kNu - 0.5 * sum(T, [](double a) { return std::cos(a); }) +
           sum(T, [](double a) { return std::cos(a); });
  }

 private:
  template <class Factor>
  double sum(double T, const Factor& factor) const {
    double sum = 0.0;
    for (const double a : roots_)
      sum += std::sin(a) / (a - std::sin(a) * std::cos(a)) * std::exp(-a * a * T) * factor(a);
    return sum;
  }
  std::vector<double> roots_;
};

void mandel(Record& record) {
  constexpr double kT = 0.1, kC = 2.0 * (1.0 - Mandel::kNu) / (1.0 - 2.0 * Mandel::kNu);
  const Mandel exact;
  std::array<MeshErrors, 4> errors;
  for (const int n : {48, 96, 192}) {
    const LatticeMesh mesh{.x = graded(0.0, 1.0, n), .y = {0.0, 0.1}};
    ModelInput input = pore_input(mesh, 2.0 * (1.0 + Mandel::kNu), Mandel::kNu, 1.0);
    input.supports = {held(mesh.column(0), true, false), held(mesh.row(0), false, true),
                      drained(mesh.corner_column(2 * n))};
    double last = 0.0;
    const auto move = [&](StageInput stage, double to) {
      stage.supports = {{.nodes = mesh.row(2), .y = FixityCode::fixed, .y_value = 0.1 * (to - last)}};
      input.stages.push_back(stage);
      last = to;
    };
    move(shut_in(), -0.25);
    ModelInput times;
    march(times, kT, n / 4);
    double T = 0.0;
    for (const StageInput& stage : times.stages)
      for (int i = 0; i < stage.increments; ++i) {
        T += stage.duration / stage.increments;
        move(consolidation(stage.duration / stage.increments / kC, 1, 1.0, stage.theta), exact.plate(T));
      }
    const WholeRun run = run_of(record, input);
    const double h = 1.0 / n;
    errors[0].take(h, excess_of(run, mesh.node(0, 0)) / 0.5, exact.pressure(0.0, kT) / 0.5);
    errors[1].take(h, excess_of(run, mesh.node(n, 0)) / 0.5, exact.pressure(0.5, kT) / 0.5);
    errors[2].take(h, run.u(mesh.node(2 * n, 0)).x(), exact.width(kT));
    errors[3].take(h, -run.reaction(run.last(), mesh.row(2), 1), 1.0);
  }
  const char* const names[] = {"excess pressure in the middle, T = .1", "excess pressure at a/2, T = .1",
                               "half-width's change, T = .1", "force on the plates, T = .1"};
  for (std::size_t i = 0; i < 4; ++i) errors[i].report(record, Where::plane_strain, names[i], 1e-5);
}

// ---- de Leeuw and Cryer ----

// c of a skeleton of E' = 1.
double coefficient(double nu) {
  return (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
}

// A ring of the cylinder, 1 / n high.
double cylinder_axis(const Record& record, int n, double T) {
  constexpr double kNu = 0.3;
  const LatticeMesh mesh{.x = graded(0.0, 1.0, n), .y = {0.0, 1.0 / n}};
  ModelInput input = pore_input(mesh, 1.0, kNu, 1.0, Geometry::axisymmetric);
  input.supports = {held(mesh.column(0), true, false), held(mesh.row(0), false, true),
                    held(mesh.row(1), false, true), held(mesh.row(2), false, true),
                    drained(mesh.corner_column(2 * n))};
  input.stages = {press_right(mesh)};
  march(input, T / coefficient(kNu), n / 4);
  return excess_of(run_of(record, input), mesh.node(0, 0));
}

void de_leeuw(Record& record) {
  for (const auto& [T, exact] : {std::pair{0.01, 1.064715}, {0.5, .1797926}})
    record.within(Where::axisymmetric, fmt::format("excess pressure on the axis, T = {:g}", T),
                  cylinder_axis(record, 128, T), exact, 3e-5);
  MeshErrors errors;
  for (const int n : {64, 128, 256}) errors.take(1.0 / n, cylinder_axis(record, n, 0.1), 1.0355326);
  errors.report(record, Where::axisymmetric, "excess pressure on the axis, T = 0.1", 5e-5);
}

// A quarter of the section in polar lines, around a hole of 1/2000 of the radius.
double sphere_centre(const Record& record, int n, double T, int steps) {
  constexpr double kNu = 0.25;
  constexpr int kSides = 8;
  LatticeMesh mesh{.x = graded(0.0005, 1.0, n), .y = graded(0.0, 1.0, kSides)};
  mesh.place = [](double r, double t) {
    return Vector2(r * std::cos(0.5 * kPi * t), r * std::sin(0.5 * kPi * t));
  };
  ModelInput input = pore_input(mesh, 1.0, kNu, 1.0, Geometry::axisymmetric);
  input.supports = {held(mesh.column(0), true, true), held(mesh.row(0), false, true),
                    held(mesh.row(2 * kSides), true, false), drained(mesh.corner_column(2 * n))};
  input.stages = {press_right(mesh)};
  march(input, T / coefficient(kNu), steps);
  return excess_of(run_of(record, input), mesh.node(0, 0));
}

void cryer(Record& record) {
  MeshErrors errors;
  for (const int n : {128, 256, 512}) errors.take(1.0 / n, sphere_centre(record, n, 0.05, 32), 1.30750092745);
  errors.report(record, Where::axisymmetric, "excess pressure at the centre, T = 0.05", 1e-5);
  record.within(Where::axisymmetric, "excess pressure at the centre, T = 0.5",
                sphere_centre(record, 256, 0.5, 96), .0846806585775, 1e-5);
}

// ---- a strip on a layer ----

// Half-width 1 on a layer of width and depth 5: rollers at the sides, rough base, drained top, nu' = 0, T = 0.1.
// Settlement of centre and edge, pressure below the centre at depths 1 and 5.
constexpr std::array<double, 4> kStrip{1.219979448, 0.625805571, 0.584247062, 0.323439818};

// Elements below the strip, beside it, in the lower 4/5 of the layer and above; in each direction the last interval over the
// first.  They are smallest at the edge of the strip.
struct StripMesh {
  int below, beside, lower, upper, steps;
  double to_edge = 0.1, from_edge = 40.0, to_upper = 1.0 / 3.0, to_top = 0.1;

  std::vector<double> x() const {
    return joined(span(0.0, 1.0, below, to_edge), span(1.0, 5.0, beside, from_edge));
  }
  std::vector<double> y() const {
    return joined(span(0.0, 4.0, lower, to_upper), span(4.0, 5.0, upper, to_top));
  }

 private:
  static std::vector<double> span(double a, double b, int n, double last_over_first) {
    return graded(a, b, n, std::pow(last_over_first, 1.0 / n));
  }
  static std::vector<double> joined(std::vector<double> a, const std::vector<double>& b) {
    a.insert(a.end(), b.begin() + 1, b.end());
    return a;
  }
};

std::array<double, 4> strip_on_layer(const Record& record, const StripMesh& strip) {
  const LatticeMesh mesh{.x = strip.x(), .y = strip.y()};
  ModelInput input = pore_input(mesh, 1.0, 0.0, 1.0);
  const int right = 2 * mesh.columns(), up = 2 * mesh.rows();
  input.supports = {held(mesh.column(0), true, false), held(mesh.column(right), true, false),
                    held(mesh.row(0), true, true), drained(mesh.corner_row(up))};
  input.stages = {press_top(mesh, static_cast<std::size_t>(strip.below))};
  march(input, 0.1, strip.steps);
  const WholeRun run = run_of(record, input);
  return {-run.u(mesh.node(0, up)).y(), -run.u(mesh.node(2 * strip.below, up)).y(),
          excess_of(run, mesh.node(0, 2 * strip.lower)), excess_of(run, mesh.node(0, 0))};
}

constexpr std::array<const char*, 4> kStripNames{"settlement of the centre", "settlement of the edge",
                                                 "excess pressure at depth b", "excess pressure at the base"};

std::array<MeshErrors, 4> strip_errors(const Record& record, const std::vector<StripMesh>& meshes) {
  std::array<MeshErrors, 4> errors;
  for (const StripMesh& mesh : meshes) {
    const std::array<double, 4> values = strip_on_layer(record, mesh);
    for (std::size_t i = 0; i < 4; ++i) errors[i].take(1.0 / mesh.below, values[i], kStrip[i]);
  }
  return errors;
}

void strip_orders(Record& record) {
  constexpr std::array<double, 4> kFinest{1e-4, 4e-5, 4e-4, 6e-5};
  std::vector<StripMesh> meshes;
  for (const int n : {10, 20, 40}) meshes.push_back({n, n + n / 2, n, n, n / 2});
  const std::array<MeshErrors, 4> errors = strip_errors(record, meshes);
  for (std::size_t i = 0; i < 4; ++i) {
    errors[i].report(record, Where::plane_strain, kStripNames[i], kFinest[i]);
    errors[i].report_limit(record, Where::plane_strain, kStripNames[i], 1e-5);
  }
}

// The finest has 109 000 elements.  Divisions and gradings that give each of the four numbers its share of the error.
void fine_strip(Record& record) {
  std::vector<StripMesh> meshes;
  for (const int k : {1, 2, 4}) meshes.push_back({48 * k, 26 * k, 32 * k, 60 * k, 10 * k, 0.3, 40.0, 0.6, 0.6});
  const std::array<MeshErrors, 4> errors = strip_errors(record, meshes);
  for (std::size_t i = 0; i < 4; ++i) errors[i].report(record, Where::plane_strain, kStripNames[i], 1e-5);
}

// ---- a closed specimen ----

// Height and diameter 2 between rough platens, nu' = 0.2: force over that without friction, shut in, and when its water has
// one pressure.
void closed_specimen(Record& record) {
  for (const char* element : {"quad8p4", "quad9p4"}) {
    constexpr int n = 12;
    constexpr double kG = 1.0 / 2.4;
    const double shrink = std::pow(100.0, -1.0 / n);
    const LatticeMesh mesh{
        .x = graded(0.0, 1.0, n, shrink), .y = graded(0.0, 1.0, n, shrink), .element = element};
    ModelInput input = pore_input(mesh, 1.0, 0.2, 1.0, Geometry::axisymmetric);
    const std::vector<int> top = mesh.row(2 * n);
    input.supports = {held(mesh.column(0), true, false), held(mesh.row(0), false, true),
                      held(top, true, false)};
    StageInput down = shut_in();
    down.supports = {{.nodes = top, .y = FixityCode::fixed, .y_value = -0.01}};
    input.stages = {down, consolidation(1e6, 8, 10.0)};
    const WholeRun run = run_of(record, input);
    const auto ratio = [&](const Snapshot& at) { return -run.reaction(at, top, 1) / (kPi * 3.0 * kG * 0.01); };
    record.within(Where::axisymmetric, fmt::format("force, {}, water shut in", element),
                  ratio(run.increments.front()), 1.19627, 2e-4);
    record.within(Where::axisymmetric, fmt::format("force, {}, t to infinity", element), ratio(run.last()),
                  1.140501, 1e-4);
    record.within(Where::axisymmetric, fmt::format("excess pressure over G strain, {}, t to infinity", element),
                  excess_of(run, mesh.node(0, 0)) / (kG * 0.01), 1.421504, 2e-4);
  }
}

}  // namespace

Section consolidation_cases() {
  return {"Consolidation",
          {
              {"consolidation.one_way", "a column with a load that is applied at once, drained at its top",
               "Terzaghi (1925), series", Grade::exact, "order 2; finest mesh 1e-5", one_way},
              {"consolidation.two_ways", "the same of quad9p4, drained at both ends", "Terzaghi (1925), series",
               Grade::exact, "order 2; finest mesh 1e-5", two_ways},
              {"consolidation.mandel", "a sample between rigid smooth plates", "Mandel (1953), series",
               Grade::exact, "order 2; finest mesh 1e-5", mandel},
              {"consolidation.de_leeuw", "a cylinder under a pressure that is applied at once, drained outside",
               "de Leeuw (1965), series", Grade::exact, "order 2; finest mesh 5e-5", de_leeuw},
              {"consolidation.cryer", "a sphere under a pressure that is applied at once, drained outside",
               "Cryer (1963), series", Grade::exact, "order 2; finest mesh 1e-5", cryer},
              {"consolidation.strip", "a strip load on a layer, drained at its top",
               "Fourier series along the layer, Talbot's inverse in time", Grade::computed,
               "order 2; limit of the last two meshes 1e-5", strip_orders},
              {"consolidation.strip_fine", "the same on fine meshes",
               "Fourier series along the layer, Talbot's inverse in time", Grade::computed,
               "order 2; finest mesh 1e-5", fine_strip, true},
              {"consolidation.closed", "a closed specimen between rough platens",
               "spectral elements with the same equations", Grade::computed,
               "1e-4; 2e-4 where the rim of the platen is singular on this mesh", closed_specimen},
          }};
}

}  // namespace sage::verify
