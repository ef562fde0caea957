// Decks of other programs as models.  Expected values: the decks' own counts and
// QUAD4M's own echo of its areas.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <set>

#include "sage/app/commands.hpp"
#include "sage/app/run_deck.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/record/values.hpp"
#include "sage/scenes/whole_run.hpp"
#include "solvers/choose_solver.hpp"
#include "tests/support/scratch_folder.hpp"

namespace sage::app {
namespace {

const std::string kInputs = SAGE_SOURCE_DIR "/legacy_inputs/";

BuildOptions partial_if(bool partial) {
  BuildOptions options;
  options.partial = partial;
  return options;
}

Model model_of(const std::string& deck, const std::string& layout = "", bool partial = false) {
  InputOptions input;
  input.layout = layout;
  return build_model(read_input(kInputs + deck, input), full_catalogue(), partial_if(partial));
}

std::string refusal(const std::string& deck, const std::string& layout) {
  try {
    model_of(deck, layout);
  } catch (const InputError& error) {
    return error.diagnostics().list().front().message;
  }
  return "";
}

bool mentions(const Diagnostics& diagnostics, Severity severity, const std::string& text) {
  for (const Diagnostic& d : diagnostics.list())
    if (d.severity == severity && d.message.find(text) != std::string::npos) return true;
  return false;
}

RunOutcome run_of(const std::string& deck, bool partial = false) {
  RunRequest request;
  request.input.build.partial = partial;
  request.deck = kInputs + deck;
  request.quiet = true;
  request.output.folder = test::scratch_folder("foreign");
  return run_deck(request, full_catalogue());
}

TEST(ForeignModel, Quad4mAreasAgreeWithItsOwnEcho) {
  const Model model = model_of("quad4m/MDL.Q4I");
  EXPECT_EQ(model.mesh.nodes(), 2289);
  std::map<int, double> area;
  for (const Group& group : model.groups) {
    std::vector<double> geometry(static_cast<std::size_t>(group.element->traits().geometry_size()));
    const ElementTraits& traits = group.element->traits();
    Eigen::Matrix2Xd x;
    for (int e = 0; e < group.elements(); ++e) {
      element_coordinates(model.mesh, group, e, x);
      group.element->geometry(x, geometry);
      double& sum = area[group.element_numbers[static_cast<std::size_t>(e)]];
      for (int p = 0; p < traits.points; ++p)
        sum += geometry[static_cast<std::size_t>(p * (1 + traits.law_size * traits.dofs))];
    }
  }
  std::ifstream in(SAGE_SOURCE_DIR "/tests/unit/exchange/data/quad4m_areas.csv");
  int compared = 0;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    int number = 0;
    double echoed = 0.0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%d,%lf", &number, &echoed), 2);
    // Printed with three decimals, computed there in single precision.
    EXPECT_NEAR(area.at(number), echoed, 0.0006 + 1e-5 * echoed) << "element " << number;
    ++compared;
  }
  EXPECT_EQ(compared, 2933);
}

TEST(ForeignModel, Quad4mCarriesItsWeight) {
  const RunOutcome outcome = run_of("quad4m/MDL.Q4I");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.record.result.reason;
  EXPECT_LT(outcome.record.out_of_balance, 1e-9);
  EXPECT_TRUE(mentions(outcome.model->diagnostics, Severity::note, "30 node(s) of a transmitting base"));
  // N/m^3 in the deck, kN/m^3 here; E = 2 G (1 + nu) of element 1.
  EXPECT_DOUBLE_EQ(outcome.model->materials.front().unit_weight, 22.0);
  EXPECT_NEAR(outcome.model->materials.front().parameters[0], 2 * 4855861.0 * 1.392, 1.0);
}

TEST(ForeignModel, CandePipeIsBeamsAndSaysWhatIsMissing) {
  const RunOutcome outcome = run_of("cande_level3/candejar_input_test1.cid", true);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.record.result.reason;
  EXPECT_LT(outcome.record.out_of_balance, 1e-9);
  const Model& model = *outcome.model;
  int elements = 0;
  for (const Group& group : model.groups) elements += group.elements();
  EXPECT_EQ(elements, 2047);
  EXPECT_EQ(model.mesh.nodes(), 1471);
  EXPECT_EQ(model.stages.size(), 28u);
  EXPECT_FALSE(mentions(model.diagnostics, Severity::warning, "left out: 36 beam element(s)"));
  EXPECT_TRUE(mentions(model.diagnostics, Severity::warning, "the pipe is computed elastic"));
  // Long-term modulus 28000 over 1 - 0.45^2 times A = 1.65 and I = 6.283; 0.0378793 lbf/in^3.
  const Material& wall = model.materials.back();
  EXPECT_NEAR(wall.parameters[0], 28000.0 / (1 - 0.45 * 0.45) * 1.65, 1e-6);
  EXPECT_NEAR(wall.parameters[1], 28000.0 / (1 - 0.45 * 0.45) * 6.283, 1e-6);
  EXPECT_NEAR(wall.unit_weight, 0.0378793 * 1.65, 1e-12);
  EXPECT_TRUE(mentions(model.diagnostics, Severity::warning, "material 2 (CL90)"));
  EXPECT_TRUE(mentions(model.diagnostics, Severity::note, "1 element(s) listed clockwise"));
  // 115 lbf/ft^3 in inches.
  EXPECT_NEAR(model.materials[1].unit_weight, 115.0 / 1728.0, 1e-15);
}

std::string cande_text() {
  std::ifstream file(kInputs + "cande_level3/candejar_input_test.cid");
  return {std::istreambuf_iterator<char>(file), {}};
}

Model cande_model(const std::string& text) {
  return build_model(read_deck_text(text, "deck.cid", load_layout("cande_level3")), full_catalogue(),
                     partial_if(true));
}

// Every part that is missing is an error of its own, at its card; with `partial` each stands in the status line
// and the title, which all files bear.
TEST(ForeignModel, CandeWithoutItsSoilIsRefusedUnlessAPartWillDo) {
  const std::string deck = "cande_level3/candejar_input_test1.cid";
  try {
    model_of(deck);
    FAIL() << "a soil is missing, and no message says so";
  } catch (const InputError& error) {
    ASSERT_EQ(error.diagnostics().errors(), 1);
    for (const Diagnostic& d : error.diagnostics().list()) {
      if (d.severity != Severity::error) continue;
      EXPECT_GT(d.where.line, 0);
      EXPECT_NE(d.message.find("--partial"), std::string::npos) << d.message;
    }
    EXPECT_TRUE(mentions(error.diagnostics(), Severity::error, "material 2 (CL90)"));
  }
  const Model model = model_of(deck, "", true);
  EXPECT_EQ(completed_words(model, 0.0),
            "completed, but PARTIAL: left out material 2 (CL90), computed as the elastic material 1 (In Situ)")
      << "no element is of material 3 (SW95)";
  EXPECT_TRUE(model.title.starts_with("PARTIAL: 19962-3 Weholite")) << model.title;
}

TEST(ForeignModel, Quad4mStatusSaysThatThereIsNoEarthquake) {
  EXPECT_EQ(completed_words(model_of("quad4m/MDL.Q4I"), 0.0),
            "completed, but PARTIAL: left out earthquake motion and damping");
}

std::string cande_line(const std::string& name, const std::string& record) {
  return std::string(25 - name.size(), ' ') + name + "!!" + record + "\n";
}

// Two squares of 10 x 10 in, the upper one born in step 2, and 2 x 5 lbf on its top in step 3; held below.
// All that the deck asks for exists here.
std::string small_cande(const std::string& factors, const std::string& method = " 1") {
  std::string text = cande_line("A-1", "ANALYS   3" + method + "  0two lifts") + cande_line("C-1.L3", "PREP") +
                     cande_line("C-2.L3", "    3    3    1    3    1    6    2    4    1");
  for (int n = 1; n <= 6; ++n)
    text += cande_line("C-3.L3", fmt::format("{}{:>4}  00{:>11.2f}{:>10.2f}", n == 6 ? "L" : " ", n,
                                             10.0 * ((n - 1) % 2), 10.0 * ((n - 1) / 2)));
  text += cande_line("C-4.L3", "    1    1    2    4    3    1    1") +
          cande_line("C-4.L3", "L   2    3    4    6    5    1    2") +
          cande_line("C-5.L3", "    1    1       0.0    1       0.0       0.0    0") +
          cande_line("C-5.L3", "    2    1       0.0    1       0.0       0.0    0") +
          cande_line("C-5.L3", "    5    0       0.0    0      -5.0       0.0    3") +
          cande_line("C-5.L3", "L   6    0       0.0    0      -5.0       0.0    3");
  return text + cande_line("D-1", "L   1    1     120.0soil") +
         cande_line("D-2.Isotropic", "      2000       0.3") + factors + "STOP\n";
}

// A column that is one field too wide would be seen here.
std::string e1(int first, int last, const std::string& factor) {
  return cande_line("E-1", fmt::format("{:>5}{:>5}{:>10}dead load", first, last, factor));
}

scenes::WholeRun run_cande(const std::string& text) {
  const scenes::Workbench bench(
      full_catalogue(), [](int equations, bool symmetric) { return choose_solver(equations, symmetric); });
  return bench.run(
      build_model(read_deck_text(text, "small.cid", load_layout("cande_level3")), full_catalogue()));
}

// A steel ring of radius 10 bonded to elastic ground out to radius 20, whose outer side is displaced as by a
// uniform pressure and a mode of cos 2 theta.  Closed form: Lame's field, Michell's terms r^2, r^-2 and r^0 (B of
// r^4 is zero) in plane strain; the ring strains by (w + v')/a and bends by (w'' - v')/a^2 (Timoshenko, Theory of
// Elasticity, general solution in polar coordinates; Burns and Richard use the same field for an outer radius
// that is infinite).
struct RingInGround {
  double a = 10.0, b = 20.0, E = 2000.0, nu = 0.3, area = 0.05, inertia = 0.0002, Es = 29e6, nus = 0.3;
  double G = E / (2 * (1 + nu)), EA = Es * area / (1 - nus * nus), EI = Es * inertia / (1 - nus * nus);
  double alpha = -1e-3, beta = 0.0, A = -1.0, C = 0.0, D = 0.0;  // A in psi
  Eigen::Vector2d ring = Eigen::Vector2d::Zero();                // w and v of the ring

  explicit RingInGround(bool slips = false) {
    // EA u / a^2 = sigma_r(a), u = alpha a + beta / a
    const double k = EA / (a * a);
    beta = (2 * G * alpha / (1 - 2 * nu) - k * alpha * a) / (k / a + 2 * G / (a * a));
    Eigen::Matrix2d left;
    Eigen::Vector2d right;
    const Eigen::Vector2d ofA = residual(A, 0, 0), ofC = residual(0, 1, 0), ofD = residual(0, 0, 1);
    left << ofC, ofD;
    right = left.inverse() * -ofA;
    C = right(0), D = right(1);
    ring = mode(a, A, C, D);
    if (slips) slip();
  }
  // C, D and the ring's v: no shear in the ground at the ring, and the ring in equilibrium both ways.
  void slip() {
    const double a2 = a * a, a4 = a2 * a2;
    const auto rows = [&](double A2, double C2, double D2, double v) {
      const Eigen::Vector2d u(mode(a, A2, C2, D2)(0), v);
      const double N = EA * strain(u), M = EI * curvature(u);
      return Eigen::Vector3d(N / a - 4 * M / a2 + (2 * A2 + 6 * C2 / a4 + 4 * D2 / a2), 2 * N / a - 2 * M / a2,
                             (2 * A2 - 6 * C2 / a4 - 2 * D2 / a2) * a);
    };
    Eigen::Matrix3d left;
    left << rows(0, 1, 0, 0), rows(0, 0, 1, 0), rows(0, 0, 0, 1);
    const Eigen::Vector3d x = left.fullPivLu().solve(-rows(A, 0, 0, 0));
    C = x(0), D = x(1);
    ring = {mode(a, A, C, D)(0), x(2)};
  }
  Eigen::Vector2d mode(double r, double A2, double C2, double D2) const {  // W of cos, V of sin
    return Eigen::Vector2d(-2 * A2 * r + 2 * C2 / (r * r * r) + 4 * (1 - nu) * D2 / r,
                           2 * A2 * r + 2 * C2 / (r * r * r) - 2 * (1 - 2 * nu) * D2 / r) /
           (2 * G);
  }
  double strain(const Eigen::Vector2d& u) const { return (2 * u(1) + u(0)) / a; }
  double curvature(const Eigen::Vector2d& u) const { return (-4 * u(0) - 2 * u(1)) / (a * a); }
  // Virtual work of the ring less that of the ground's tractions, for w and v.
  Eigen::Vector2d residual(double A2, double C2, double D2) const {
    const Eigen::Vector2d u = mode(a, A2, C2, D2);
    const double N = EA * strain(u), M = EI * curvature(u), a2 = a * a, a4 = a2 * a2;
    return {N / a - 4 * M / a2 + (2 * A2 + 6 * C2 / a4 + 4 * D2 / a2),
            2 * N / a - 2 * M / a2 - (2 * A2 - 6 * C2 / a4 - 2 * D2 / a2)};
  }
  // interface: of card D-2.Interface what follows the angle; empty: the pipe and the ground share nodes.
  std::string deck(int around, int layers, const std::string& interface = "") const {
    const int ground = (layers + 1) * around, pipe = interface.empty() ? 0 : ground;
    const int nodes = interface.empty() ? ground : ground + 2 * around;
    std::string text =
        cande_line("A-1", "ANALYS   3 0  1ring") +
        cande_line("A-2.L3", fmt::format("{:<10}{:>5}", "STEEL", around)) +
        cande_line("B-1.Steel", fmt::format("{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>5}{:>5}{:>5}", Es, nus,
                                            33000, 33000, 0, 0, 0, 1, 0)) +
        cande_line("B-2.Steel.A", fmt::format("{:>10}{:>10}", area, inertia)) + cande_line("C-1.L3", "PREP") +
        cande_line("C-2.L3", "    1    3    1    3    1");
    for (int i = 0; i <= layers; ++i)
      for (int j = 0; j < around; ++j) {
        const double r = a * std::pow(b / a, double(i) / layers), t = 2 * M_PI * j / around;
        const int n = i * around + j + 1;
        text += cande_line("C-3.L3", fmt::format("{}{:>4}  00{:>10.5f}{:>10.5f}", n == nodes ? "L" : " ", n,
                                                 r * std::cos(t), r * std::sin(t)));
      }
    for (int n = ground + 1; n <= nodes; ++n) {  // those of the pipe, then the third ones of interfaces
      const double t = 2 * M_PI * (n - 1) / around;
      text += cande_line("C-3.L3", fmt::format("{}{:>4}  00{:>10.5f}{:>10.5f}", n == nodes ? "L" : " ", n,
                                               a * std::cos(t), a * std::sin(t)));
    }
    int number = 0;
    for (int j = 0; j < around; ++j)
      text += cande_line("C-4.L3", fmt::format(" {:>4}{:>5}{:>5}    0    0    1    1", ++number, pipe + j + 1,
                                               pipe + (j + 1) % around + 1));
    for (int j = 0; j < around && pipe > 0; ++j)
      text += cande_line("C-4.L3", fmt::format(" {:>4}{:>5}{:>5}{:>5}    0{:>5}    1    1", ++number,
                                               pipe + j + 1, j + 1, pipe + around + j + 1, j + 1));
    for (int i = 0; i < layers; ++i)
      for (int j = 0; j < around; ++j) {
        const int n = i * around + j + 1, m = i * around + (j + 1) % around + 1;
        ++number;
        text += cande_line("C-4.L3", fmt::format("{}{:>4}{:>5}{:>5}{:>5}{:>5}    1    1",
                                                 i == layers - 1 && j == around - 1 ? "L" : " ", number, n,
                                                 n + around, m + around, m));
      }
    // A ring that slips could spin.
    if (pipe > 0) text += cande_line("C-5.L3", fmt::format(" {:>4}    0       0.0    1       0.0", pipe + 1));
    for (int j = 0; j < around; ++j) {
      const double t = 2 * M_PI * j / around;
      const Eigen::Vector2d two = mode(b, A, C, D);
      const double w = alpha * b + beta / b + two(0) * std::cos(2 * t), v = two(1) * std::sin(2 * t);
      text += cande_line(
          "C-5.L3", fmt::format("{}{:>4}    1{:>10.7f}    1{:>10.7f}{:>10}    1", j + 1 == around ? "L" : " ",
                                layers * around + j + 1, w * std::cos(t) - v * std::sin(t),
                                w * std::sin(t) + v * std::cos(t), 0));
    }
    text += cande_line("D-1", pipe > 0 ? "    1    1       0.0soil" : "L   1    1       0.0soil") +
            cande_line("D-2.Isotropic", fmt::format("{:>10}{:>10}", E, nu));
    for (int j = 0; j < around && pipe > 0; ++j)
      text += cande_line("D-1", fmt::format("{}{:>4}    6       0.0", j + 1 == around ? "L" : " ", j + 1)) +
              cande_line("D-2.Interface", fmt::format("{:>10.4f}{}", 360.0 * j / around, interface));
    return text + "STOP\n";
  }
};

// Largest error of thrust and of moment in the middle of the beams, over the largest of each.
std::array<double, 2> ring_errors(const RingInGround& ring, int around, int layers,
                                  const std::string& interface = "") {
  const scenes::WholeRun run = run_cande(ring.deck(around, layers, interface));
  EXPECT_TRUE(run.completed()) << run.failure;
  const auto* beams = run.stress.empty() ? nullptr : &run.stress.front();
  for (const auto& group : run.stress)
    if (group.cols() == 3 * around) beams = &group;
  if (beams == nullptr) return {1.0, 1.0};
  const Eigen::Vector2d& u = ring.ring;
  const double N0 = ring.EA * (ring.alpha + ring.beta / (ring.a * ring.a)), N2 = ring.EA * ring.strain(u),
               M2 = ring.EI * ring.curvature(u);
  std::array<double, 2> errors{0.0, 0.0};
  for (int e = 0; e < around; ++e) {
    const double c = std::cos(4 * M_PI * (e + 0.5) / around);
    // Going counter-clockwise outside is to the right: M > 0 pulls it, where curvature by w is negative.
    const double N = (*beams)(0, 3 * e + 1), M = (*beams)(3, 3 * e + 1);
    errors[0] = std::max(errors[0], std::abs(N - (N0 + N2 * c)) / (std::abs(N0) + std::abs(N2)));
    errors[1] = std::max(errors[1], std::abs(M + M2 * c) / std::abs(M2));
  }
  return errors;
}

TEST(ForeignModel, CandeRingInGroundTendsToTheClosedForm) {
  const RingInGround ring;
  const std::array<double, 2> coarse = ring_errors(ring, 48, 6), fine = ring_errors(ring, 96, 12);
  // Moments are near the 0.04 % that shear of the wall, which the closed form has not, can make here.  Thrust errs
  // by h^2: linear quadrilaterals, and a polygon for the circle.
  EXPECT_LT(fine[1], 1e-3) << "moment";
  EXPECT_LT(fine[0], 0.01) << "thrust";
  EXPECT_LT(fine[0], 0.35 * coarse[0]) << coarse[0] << " to " << fine[0];
}

TEST(ForeignModel, CandeRingWithInterfacesIsBondedOrSlips) {
  const std::array<double, 2> bonded = ring_errors(RingInGround(), 48, 6),
                              rough = ring_errors(RingInGround(), 48, 6, "     100.0       0.0       0.0"),
                              smooth = ring_errors(RingInGround(true), 48, 6, "       0.0       0.0       0.0");
  printf("%g %g  %g %g  %g %g\n", bonded[0], bonded[1], rough[0], rough[1], smooth[0], smooth[1]);
}

TEST(ForeignModel, CandePipesThatMakeNoSenseAreErrorsOfTheirCard) {
  const std::string good = RingInGround().deck(12, 1);
  struct Case {
    std::string from, to, words;
  };
  for (const Case& c :
       {Case{"STEEL        12", "STEEL        13", "13 beam elements by this card, 12 by cards C-4"},
        Case{"      0.05    0.0002", "      0.05       0.0", "moment of inertia"},
        Case{"STEEL        12", "CONCRETE     12", "pipe CONCRETE is not taken"}}) {
    std::string text = good;
    ASSERT_NE(text.find(c.from), std::string::npos) << c.from;
    text.replace(text.find(c.from), c.from.size(), c.to);
    try {
      run_cande(text);
      FAIL() << c.words;
    } catch (const InputError& error) {
      EXPECT_TRUE(mentions(error.diagnostics(), Severity::error, c.words))
          << error.diagnostics().list().front().message;
    }
  }
}

// Equilibrium: what the base carries is the weight of each square times the factor of the step that places it,
// and the forces times that of theirs.
TEST(ForeignModel, CandeLoadFactorsMultiplyTheLoadsOfTheirSteps) {
  const double weight = 100.0 * 120.0 / 1728.0;  // of one square, lbf per inch
  struct Case {
    std::string cards;
    std::array<double, 3> factor;
  };
  for (const Case& c : {Case{"", {1, 1, 1}}, Case{e1(1, 3, "1.30"), {1.3, 1.3, 1.3}},
                        Case{e1(3, 0, "1.75") + e1(1, 1, "1.25") + e1(2, 2, ""), {1.25, 1.0, 1.75}},
                        Case{e1(2, 40, "0.9"), {1.0, 0.9, 0.9}}}) {
    SCOPED_TRACE(c.cards);
    const scenes::WholeRun run = run_cande(small_cande(c.cards));
    ASSERT_TRUE(run.completed());
    double expected = 0.0;
    const std::array<double, 3> load{weight, weight, 10.0};
    for (std::size_t step = 0; step < 3; ++step) {
      expected += c.factor[step] * load[step];
      EXPECT_NEAR(run.reaction(run.increments[step], {1, 2}, 1), expected, 1e-9 * expected) << step + 1;
    }
  }
}

TEST(ForeignModel, CandeLoadFactorsThatMakeNoSenseAreErrors) {
  const auto message = [](const std::string& cards) {
    try {
      run_cande(small_cande(cards));
    } catch (const InputError& error) {
      return error.diagnostics().list().back().message;
    }
    return std::string();
  };
  EXPECT_NE(message(e1(0, 2, "1.3")).find("load factors count from load step 1"), std::string::npos);
  EXPECT_NE(message(e1(3, 2, "1.3")).find("from 3 to 2"), std::string::npos);
  EXPECT_NE(message(e1(1, 2, "0.0")).find("above zero"), std::string::npos);
  EXPECT_NE(message(e1(1, 2, "1.3") + e1(2, 3, "1.5")).find("load step 2 has a load factor already"),
            std::string::npos);
  const Model working =
      build_model(read_deck_text(small_cande(e1(1, 1, "1.3"), " 0"), "small.cid", load_layout("cande_level3")),
                  full_catalogue());
  EXPECT_TRUE(mentions(working.diagnostics, Severity::warning, "working stress (method 0)"));
}

// No deck at hand gives a soil of Duncan's with its numbers: the real one with those cards put in.
TEST(ForeignModel, CandeSoilOfDuncan) {
  const std::string model_card = "               D-2.Duncan!!    0       0.5    1";
  const std::string cards =
      "               D-3.Duncan!!       1.5      36.0       5.0     450.0      0.35      0.80\n"
      "               D-4.Duncan!!     300.0      0.10       0.0\n";
  std::string text = cande_text();
  const std::size_t at = text.find(model_card), end = text.find('\n', at) + 1;
  text.insert(end, cards);
  const Model selig = cande_model(text);
  EXPECT_EQ(selig.materials[1].law_name, "linear_elastic");
  EXPECT_TRUE(mentions(selig.diagnostics, Severity::warning, "bulk modulus is that of Selig (code 1)"));
  text[at + model_card.size() - 1] = '0';
  const Model duncan = cande_model(text);
  EXPECT_EQ(duncan.materials[1].law_name, "duncan_chang_eb");
  const std::vector<double> expected{450.0, 0.35, 0.80, 450.0, 300.0,
                                     0.10,  1.5,  36.0, 5.0};  // K n Rf Kur Kb m c phi dphi
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(duncan.materials[1].parameters[i], expected[i]) << "parameter " << i + 1;
  EXPECT_TRUE(mentions(duncan.diagnostics, Severity::warning, "no modulus for unloading"));
}

TEST(ForeignModel, CandeGenerationIsRefusedWithItsField) {
  std::string text = cande_text();
  const std::size_t tenth = text.find("C-4.L3!!   10"), line = text.rfind('\n', tenth) + 1;
  ASSERT_NE(tenth, std::string::npos);
  text.erase(line, text.find('\n', tenth) + 1 - line);
  try {
    cande_model(text);
    FAIL() << "a gap in the elements was taken as it is";
  } catch (const InputError& error) {
    const Diagnostic& d = error.diagnostics().list().front();
    EXPECT_NE(d.message.find("elements 10 to 10 are not given"), std::string::npos) << d.message;
    EXPECT_GT(d.where.first_column, 0);
  }
}

TEST(ForeignModel, AxisymmetricForcesAreForOneRadian) {
  const Model model = model_of("smith_griffiths/p51_5.dat");
  EXPECT_EQ(model.geometry, Geometry::axisymmetric);
  EXPECT_NEAR(model.stages[0].loads[2].force.y(), -24.0 * 2 * 3.14159265358979, 1e-10);
  EXPECT_EQ(model.groups[0].element_name, "quad4 full 3x3");
}

TEST(ForeignModel, FootingPrograms) {
  const Model model = model_of("smith_griffiths/p66.dat", "sg_p66");
  EXPECT_EQ(model.stages.size(), 10u);
  EXPECT_EQ(model.mesh.nodes(), 121);
  std::set<std::pair<int, std::size_t>> held;
  for (const Fixity& f : model.fixities)
    for (std::size_t c = 0; c < 2; ++c)
      if (f.code[c] == FixityCode::fixed) held.insert({f.node, c});
  EXPECT_EQ(static_cast<std::size_t>(DofMap(model).dofs()) - held.size(), 192u)
      << "equations, as p66.res counts them";
}

TEST(ForeignModel, EmbankmentInLifts) {
  const Model model = model_of("smith_griffiths/p69.dat", "sg_p69");
  EXPECT_EQ(model.stages.size(), 5u);
  std::vector<int> lifts;
  double area = 0.0;
  for (const Group& group : model.groups) {
    lifts.push_back(group.elements());
    for (int e = 0; e < group.elements(); ++e) {
      const std::size_t corners = group.node_count() == 8 ? 4 : 3;
      for (std::size_t i = 0; i < corners; ++i) {
        const Vector2 a = model.mesh.x.col(group.nodes_of(e)[i]);
        const Vector2 b = model.mesh.x.col(group.nodes_of(e)[(i + 1) % corners]);
        area += 0.5 * (a.x() * b.y() - b.x() * a.y());
      }
    }
  }
  EXPECT_EQ(lifts, (std::vector<int>{48, 7, 1, 6, 1, 5, 1, 4, 1})) << "74 elements";
  // 38 x 10 below; four lifts of 1 m whose toes stand at x = 20, 22, 24, 26, each slope 2 m long.
  EXPECT_NEAR(area, 380.0 + (18.0 - 1.0) + (16.0 - 1.0) + (14.0 - 1.0) + (12.0 - 1.0), 1e-10);
  EXPECT_EQ(model.mesh.nodes(), 263 - 8) << "two nodes of each slope element are left out";
  std::set<std::pair<int, std::size_t>> held;
  for (const Fixity& f : model.fixities)
    for (std::size_t c = 0; c < 2; ++c)
      if (f.code[c] == FixityCode::fixed) held.insert({f.node, c});
  EXPECT_EQ(static_cast<std::size_t>(DofMap(model).dofs()) - held.size(), 452u - 16u)
      << "p69.res: 452 freedoms";
}

// Program 6.11 with water of bulk modulus Kw = 60 K': p' = 100 + q / 3 / 61, and at yield q = 1.2 p' (phi = 30),
// from which both follow; no plastic change of volume after it (psi = 0).
TEST(ForeignModel, UndrainedTriaxialTest) {
  std::ifstream file(kInputs + "smith_griffiths/p611_1.dat");
  std::string deck{std::istreambuf_iterator<char>(file), {}};
  const std::string drained = "0.25  0.0  -100.0";
  const std::size_t at = deck.find(drained);
  ASSERT_NE(at, std::string::npos);
  deck.replace(at, drained.size(), "0.25  1.0e6  -100.0");
  Model model = build_model(read_deck_text(deck, "p611_2.dat", load_layout("sg_p611")), full_catalogue());
  for (const char* words : {"overlap", "inside the body"})
    EXPECT_FALSE(mentions(model.diagnostics, Severity::warning, words)) << words;
  const scenes::WholeRun run = make_workbench().run(std::move(model));
  ASSERT_TRUE(run.completed());
  const double q = 120.0 / (1.0 - 1.2 / 183.0), u = q / 3.0 * 60.0 / 61.0;
  const Eigen::Vector4d soil = run.stress[0].col(0), water = run.stress[1].col(0);
  EXPECT_NEAR(soil[0] - soil[1], q, 1e-3);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(-water[c], u, 1e-3) << c;
  EXPECT_NEAR(-(soil[0] + water[0]), 100.0, 1e-6) << "the cell pressure is borne by both";
}

TEST(ForeignModel, WhatCanNotBecomeAModelIsRefused) {
  EXPECT_NE(refusal("smith_griffiths/p52.dat", "sg_p52").find("three displacements a node"), std::string::npos);
  EXPECT_NE(refusal("cande_level3/candejar_cidmock_standard_lines.cid", "").find("no nodes"),
            std::string::npos);
}

// A layout of one's own whose card has the coordinates under another name.
TEST(ForeignModel, AMeshWithoutItsCoordinatesIsRefused) {
  std::ifstream file(kInputs + "layouts/sg_p61.toml");
  std::string layout{std::istreambuf_iterator<char>(file), {}};
  const std::string field = "{ name = \"y\", label";
  ASSERT_NE(layout.find(field), std::string::npos);
  layout.replace(layout.find(field), field.size(), "{ name = \"z\", label");
  const std::string path = test::scratch_folder("own_layout").string() + "/own.toml";
  std::ofstream(path) << layout;
  EXPECT_EQ(refusal("smith_griffiths/p61.dat", path),
            "field \"z\" of card \"rectangle_y\" is used by nothing; the nearest name is \"y\" (or mark it: "
            "ignored = "
            "true)");
}

}  // namespace
}  // namespace sage::app
