// Beams and shells: cantilevers, a beam on springs, plates, the wall of a tank.
#include <fmt/format.h>

#include <cmath>

#include "sage/verify/cases.hpp"

namespace sage::verify {

namespace {

// Codes of the catalogue.
constexpr int kInterface4 = 11, kBeam2 = 35, kBeam3 = 36, kGoodman = 21, kPlate = 35, kSection = 36;

std::string rotation_held(int node) {
  return fmt::format("{:5}{:5}{:5}{:5}{:5}{:20}rotation", node, 0, 0, 1, 0, "");
}

// A row of beams from a to z: their nodes are the deck's first, group and material are number 1.
struct BeamRow {
  int elements, order;
  DeckWriter deck;

  BeamRow(int geometry, int code, int n, const Vector2& a, const Vector2& z, int law,
          const std::vector<double>& parameters)
      : elements(n), order(code == kBeam3 ? 2 : 1), deck(geometry) {
    const int last = order * n;
    for (int i = 0; i <= last; ++i) {
      const Vector2 at = a + (z - a) * i / last;
      deck.node(i + 1, at.x(), at.y());
    }
    deck.material(1, law, parameters);
    deck.group(1, code, 0, 1);
    for (int e = 0; e < n; ++e) {
      std::vector<int> nodes{order * e + 1, order * (e + 1) + 1};
      if (order == 2) nodes.push_back(2 * e + 2);
      deck.element(e + 1, 1, nodes);
    }
  }
  int node(int i) const { return order * i + 1; }  // at the end of i elements
  int last() const { return node(elements); }
  void clamp(int n) {
    deck.fix(n, 1, 1);
    deck.fixities.push_back(rotation_held(n));
  }
};

// B1 of the numbers: L = 10, a unit square, E = 1e4, nu = .25, unit force at the tip.
void cantilever(Record& record) {
  for (const auto& [across, exact] : {std::pair{0.0, 0.403}, {1.0, 0.378}})
    for (const int n : {1, 8}) {
      BeamRow row(1, kBeam2, n, {0.0, 0.0}, {10.0, 0.0}, kPlate, {1e4, 0.25, 1.0, across});
      row.clamp(1);
      row.deck.stage().load(row.last(), 0.0, 1.0);
      const WholeRun run = record.run(row.deck);
      record.near(Where::plane_strain,
                  fmt::format("deflection, {}, {} element(s)", across == 0.0 ? "E" : "E/(1-nu^2)", n),
                  run.u(row.last()).y(), exact, 1e-11);
      record.near(Where::plane_strain, "moment at the clamp", run.stress[0](3, 0), 10.0, 1e-10);
    }
}

void slender(Record& record) {
  const double h = 1e-3, exact = 1000.0 / (3.0 * 1e4 * h * h * h / 12.0);
  for (const auto& [code, name] : {std::pair{kBeam2, "beam2"}, {kBeam3, "beam3"}}) {
    BeamRow row(1, code, 4, {0.0, 0.0}, {10.0, 0.0}, kPlate, {1e4, 0.0, h, 0.0});
    row.clamp(1);
    row.deck.stage().load(row.last(), 0.0, 1e-9);
    record.near(Where::plane_strain, fmt::format("deflection, L/h = 1e4, {}", name),
                1e9 * record.run(row.deck).u(row.last()).y(), exact, code == kBeam2 ? 1e-5 : 1e-2);
  }
}

// Hetenyi's beam: EI = 1000, length 10 with free ends, on springs of 100 for each unit of length and width.
BeamRow beam_on_springs(int n) {
  BeamRow row(1, kBeam2, n, {0.0, 0.0}, {10.0, 0.0}, kSection, {1e9, 1000.0, 1e9});
  DeckWriter& deck = row.deck;
  const int ground = row.last();
  for (int i = 0; i <= n; ++i) {
    deck.node(ground + i + 1, 10.0 * i / n, 0.0);
    deck.fix(ground + i + 1, 1, 1);
  }
  deck.material(2, kGoodman, {1.0, 100.0, 1.0});
  deck.group(2, kInterface4, 2, 2);
  for (int i = 0; i < n; ++i)
    deck.element(1000 + i, 2, {ground + i + 1, ground + i + 2, row.node(i + 1), row.node(i)});
  deck.fix(1, 1, 0);
  deck.stage().load(row.node(n / 2), 0.0, -1.0);
  return row;
}

void hetenyi(Record& record) {
  const double middle = 0.0021484346093, end = -0.00046278522147, moment = 0.66344563524;
  std::vector<double> size, error, end_error, moment_error;
  for (const int n : {16, 32, 64, 128}) {
    const BeamRow row = beam_on_springs(n);
    const WholeRun run = record.run(row.deck);
    size.push_back(10.0 / n);
    error.push_back(std::abs(-run.u(row.node(n / 2)).y() / middle - 1.0));
    end_error.push_back(std::abs(-run.u(1).y() / end - 1.0));
    moment_error.push_back(std::abs(run.stress[0](3, 3 * (n / 2)) / moment - 1.0));
  }
  record.order(Where::plane_strain, "deflection in the middle", size, error, 2.0);
  record.order(Where::plane_strain, "deflection of the ends", size, end_error, 2.0);
  record.order(Where::plane_strain, "moment in the middle", size, moment_error, 2.0);
  record.small(Where::plane_strain, "deflection in the middle, 128 elements, relative", error.back(), 2e-4);
}

double plate_deflection(const Record& record, int code, int n, bool clamped) {
  BeamRow row(2, code, n, {0.0, 0.0}, {1.0, 0.0}, kPlate, {1000.0, 0.3, 0.1});
  row.deck.fix(row.last(), 1, 1);
  if (clamped) row.deck.fixities.push_back(rotation_held(row.last()));
  StageCards& stage = row.deck.stage();
  for (int e = 1; e <= n; ++e) stage.pressure(e, 1, -1.0, -1.0);
  return -record.run(row.deck).u(1).y();
}

void plates(Record& record) {
  for (const auto& [code, name, theory] : {std::tuple{kBeam2, "beam2", 2.0}, {kBeam3, "beam3", 4.0}})
    for (const auto& [clamped, exact] : {std::pair{true, 0.178425}, {false, 0.703425}}) {
      std::vector<double> size, error;
      for (const int n : {8, 16, 32}) {
        size.push_back(1.0 / n);
        error.push_back(std::abs(plate_deflection(record, code, n, clamped) / exact - 1.0));
      }
      record.order(Where::axisymmetric, fmt::format("{}, {}", clamped ? "clamped" : "simply supported", name),
                   size, error, theory, 0.25);
    }
}

// a = 5, H = 6, t = .25, E = 2e7, nu = .2, weight of the water 10; base clamped, top free.  The numbers are those of
// a wall that does not shear.
void tank(Record& record) {
  const double H = 6.0;
  for (const auto& [code, name, gate] : {std::tuple{kBeam2, "beam2", 1e-5}, {kBeam3, "beam3", 3e-6}}) {
    const int n = 96;
    BeamRow row(2, code, n, {5.0, 0.0}, {5.0, H}, kPlate, {2e7, 0.2, 0.25, 1.0, 1e6});
    row.clamp(1);
    StageCards& stage = row.deck.stage();
    for (int e = 0; e < n; ++e)
      stage.pressure(e + 1, 1, -10.0 * (H - H * e / n), -10.0 * (H - H * (e + 1) / n));
    const WholeRun run = record.run(row.deck);
    for (const auto& [y, exact] :
         {std::pair{1, 1.39410377647e-4}, {2, 2.01960761189e-4}, {3, 1.61248811436e-4}})
      record.near(Where::axisymmetric, fmt::format("radial displacement at {}, {}", y, name),
                  run.u(row.node(n * y / 6)).x(), exact, gate);
    if (code != kBeam2) continue;  // its points are the ends
    record.near(Where::axisymmetric, "moment at the base", -run.stress[0](3, 0), 18.9362636344, 2e-3);
    record.near(Where::axisymmetric, "hoop force at 2", run.stress[0](1, 3 * (n / 3)), 201.96076118891, 1e-4);
  }
}

}  // namespace

Section structure_cases() {
  const std::string by_hand = "Timoshenko 1921", order = "order of convergence";
  return {"Beams and shells",
          {{"structures.cantilever", "cantilever of plates and of strips, one element as eight", by_hand,
            Grade::exact, "rounding times the condition number", cantilever},
           {"structures.slender", "cantilever of L/h = 1e4: no locking", by_hand, Grade::exact,
            "rounding times the condition number, 1e10; of beam3 its discretisation", slender},
           {"structures.hetenyi", "beam with free ends on springs (interface elements)", "Hetenyi 1946",
            Grade::exact, order, hetenyi},
           {"structures.plates", "circular plates under pressure, from the axis on, with shear",
            "Timoshenko and Woinowsky-Krieger 1959", Grade::exact, order, plates},
           {"structures.tank", "wall of a cylindrical tank, base clamped, top free",
            "Timoshenko and Woinowsky-Krieger 1959, in 30 digits", Grade::exact, "discretisation, 96 elements",
            tank}}};
}

}  // namespace sage::verify
