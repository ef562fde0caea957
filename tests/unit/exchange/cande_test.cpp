// CANDE's decks as models.  Expected values: the decks' own counts, closed forms (named beside each) and equilibrium.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>

#include "sage/app/commands.hpp"
#include "sage/app/run_deck.hpp"
#include "sage/core/point_driver.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/exchange/cande_soils.hpp"
#include "sage/record/values.hpp"
#include "solvers/choose_solver.hpp"
#include "tests/studies/scenes/whole_run.hpp"
#include "tests/support/foreign_decks.hpp"

namespace sage::app {
namespace {

using test::kInputs, test::mentions, test::partial_if, test::run_of;

TEST(Cande, PipeIsBeamsInASoilOfItsName) {
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
  EXPECT_EQ(model.materials[1].law_name, "duncan_selig");
  EXPECT_EQ(model.materials[1].parameters[0], 75.0);
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
// The numbers of soils by name are from no copy of the papers: such a deck takes --partial.
TEST(Cande, SoilsByNameTakePartial) {
  try {
    build_model(read_deck_text(cande_text(), "deck.cid", load_layout("cande_level3")), full_catalogue());
    FAIL() << "numbers without a source are computed with, and no message says so";
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().errors(), 1) << "no element is of material 3 (SW95)";
    EXPECT_TRUE(mentions(error.diagnostics(), Severity::error, "material 2 (CL90)"));
    EXPECT_TRUE(mentions(error.diagnostics(), Severity::error, "D-3 and D-4"));
  }
  EXPECT_EQ(
      completed_words(cande_model(cande_text()), 0.0),
      "completed, but PARTIAL: left out material 2 (CL90), computed as duncan_selig with numbers not compared "
      "with Selig (1988)");
}

TEST(Cande, WithASoilOfNoNameIsRefusedUnlessAPartWillDo) {
  std::string text = cande_text();
  const std::size_t name = text.find("115CL90");
  ASSERT_NE(name, std::string::npos);
  text.replace(name, 7, "115CX90");
  try {
    build_model(read_deck_text(text, "deck.cid", load_layout("cande_level3")), full_catalogue());
    FAIL() << "a soil is missing, and no message says so";
  } catch (const InputError& error) {
    ASSERT_EQ(error.diagnostics().errors(), 1);
    for (const Diagnostic& d : error.diagnostics().list()) {
      if (d.severity != Severity::error) continue;
      EXPECT_GT(d.where.line, 0);
      EXPECT_NE(d.message.find("--partial"), std::string::npos) << d.message;
    }
    EXPECT_TRUE(mentions(error.diagnostics(), Severity::error, "material 2 (CX90)"));
  }
  const Model model = cande_model(text);
  EXPECT_EQ(completed_words(model, 0.0),
            "completed, but PARTIAL: left out material 2 (CX90), computed as the elastic material 1 (In Situ)")
      << "no element is of material 3 (SW95)";
  EXPECT_TRUE(model.title.starts_with("PARTIAL: 19962-3 Weholite")) << model.title;
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
  const scenes::Workbench bench(full_catalogue(), choose_solver);
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
  // held: a support against spinning, which nothing in the deck asks for.
  std::string deck(int around, int layers, const std::string& interface = "", bool held = true) const {
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
    if (pipe > 0 && held)
      text += cande_line("C-5.L3", fmt::format(" {:>4}    0       0.0    1       0.0", pipe + 1));
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

TEST(Cande, RingInGroundTendsToTheClosedForm) {
  const RingInGround ring;
  const std::array<double, 2> coarse = ring_errors(ring, 48, 6), fine = ring_errors(ring, 96, 12);
  // Moments are near the 0.04 % that shear of the wall, which the closed form has not, can make here.  Thrust errs
  // by h^2: linear quadrilaterals, and a polygon for the circle.
  EXPECT_LT(fine[1], 1e-3) << "moment";
  EXPECT_LT(fine[0], 0.01) << "thrust";
  EXPECT_LT(fine[0], 0.35 * coarse[0]) << coarse[0] << " to " << fine[0];
}

TEST(Cande, RingWithInterfacesIsBondedOrSlips) {
  const std::array<double, 2> bonded = ring_errors(RingInGround(), 48, 6),
                              rough = ring_errors(RingInGround(), 48, 6, "     100.0       0.0       0.0"),
                              smooth = ring_errors(RingInGround(true), 48, 6, "       0.0       0.0       0.0");
  // A friction of 100 holds: interfaces 1e4 times as stiff as the soil add 1e-4.
  EXPECT_NEAR(rough[0], bonded[0], 2e-4);
  EXPECT_NEAR(rough[1], bonded[1], 2e-4);
  EXPECT_LT(bonded[0], 2.5e-3);
  // Elements of 7.5 degrees: (2 pi/48)^2 = 1.7 % times a third, and a quarter of it with half their size.
  EXPECT_LT(smooth[0], 3e-3) << "thrust";
  EXPECT_LT(smooth[1], 6e-3) << "moment";
  const std::array<double, 2> fine = ring_errors(RingInGround(true), 96, 12, "       0.0       0.0       0.0");
  EXPECT_LT(fine[1], 0.35 * smooth[1]);
  // Slip is another answer than bond: the moment differs by far more than these errors.
  EXPECT_GT(ring_errors(RingInGround(), 48, 6, "       0.0       0.0       0.0")[1], 0.05);
}

// Force and moment of all points of the pipe, of a ring with interfaces whose beams are the only group of so many points.
scenes::PointStresses pipe_of(const scenes::WholeRun& run, int around) {
  for (const auto& group : run.stress)
    if (group.cols() == 3 * around && group.rows() == 5) return group;
  return {};
}

// Nothing pushes a smooth pipe round, and what it carries does not depend on how it is turned: as with a support.
TEST(Cande, ASmoothPipeNeedsNoSupportAgainstSpinning) {
  const RingInGround ring(true);
  const std::string smooth = "       0.0       0.0       0.0";
  const scenes::WholeRun held = run_cande(ring.deck(24, 3, smooth)),
                         free = run_cande(ring.deck(24, 3, smooth, false));
  ASSERT_TRUE(held.completed() && free.completed()) << free.failure;
  const scenes::PointStresses a = pipe_of(held, 24), b = pipe_of(free, 24);
  ASSERT_EQ(a.size(), b.size());
  ASSERT_GT(a.row(0).cwiseAbs().maxCoeff(), 1.0);
  for (const int row : {0, 3})
    EXPECT_LT((a - b).row(row).cwiseAbs().maxCoeff(), 1e-6 * a.row(row).cwiseAbs().maxCoeff()) << row;
}

// The right half of a ring, cut at x = 0, is the whole one: its ends don't turn, though no card can say so.
TEST(Cande, HalfAMeshIsTheWholeOne) {
  const int around = 24, layers = 3;
  const RingInGround ring;
  const std::string text = ring.deck(around, layers);
  // Nodes j of a circle from -90 to 90 degrees, which have the numbers of the whole: 18 ... 23, 0 ... 6 of 24.
  const auto kept = [&](int number) {
    const int j = (number - 1) % around;
    return j >= 18 || j <= 6;
  };
  std::string half;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::string record = line.size() > 27 ? line.substr(27) : "";
    const bool boundary = line.find("C-5.L3!!") != std::string::npos;
    if (line.find("C-3.L3!!") != std::string::npos && !kept(std::stoi(record.substr(1, 4)))) continue;
    if (boundary && !kept(std::stoi(record.substr(1, 4)))) continue;
    if (line.find("C-4.L3!!") != std::string::npos) continue;
    if (line.find("A-2.L3!!") != std::string::npos) line = line.substr(0, 27) + "STEEL        12";
    if (line.find("C-3.L3!!") != std::string::npos) line[27] = ' ';
    if (boundary && line[27] == 'L') line[27] = ' ';
    const bool first_boundary = boundary && half.find("C-5.L3!!") == std::string::npos;
    if (first_boundary) {
      int number = 0;
      const auto element = [&](int a, int b, int c, int d) {
        half += cande_line("C-4.L3",
                           fmt::format("{}{:>4}{:>5}{:>5}{:>5}{:>5}    1    1",
                                       number + 1 == 12 * (layers + 1) ? "L" : " ", number + 1, a, b, c, d));
        ++number;
      };
      for (int k = 18; k < 30; ++k) element(k % around + 1, (k + 1) % around + 1, 0, 0);
      for (int i = 0; i < layers; ++i)
        for (int k = 18; k < 30; ++k) {
          const int n = i * around + k % around + 1, m = i * around + (k + 1) % around + 1;
          element(n, n + around, m + around, m);
        }
      for (int i = 0; i < layers; ++i)
        for (const int j : {6, 18})
          half += cande_line("C-5.L3", fmt::format(" {:>4}    1       0.0    0       0.0", i * around + j + 1));
    }
    half += line + "\n";
  }
  const scenes::WholeRun whole = run_cande(text), run = run_cande(half);
  ASSERT_TRUE(whole.completed() && run.completed()) << run.failure;
  const scenes::PointStresses a = pipe_of(whole, around), b = pipe_of(run, 12);
  ASSERT_EQ(b.cols(), 36);
  for (int e = 0; e < 12; ++e)  // beam 18 + e of the whole
    for (int p = 0; p < 3; ++p)
      for (const int row : {0, 3})
        EXPECT_NEAR(b(row, 3 * e + p), a(row, 3 * ((18 + e) % around) + p),
                    1e-6 * a.row(row).cwiseAbs().maxCoeff());
}

// An odd polygon is not its own mirror image: the decimals of its cards leave it a moment.
TEST(Cande, ASmoothPipeOfAnOddNumberOfBeamsRuns) {
  const scenes::WholeRun run =
      run_cande(RingInGround(true).deck(25, 3, "       0.0       0.0       0.0", false));
  EXPECT_TRUE(run.completed()) << run.failure;
}

// Ground that moves away from a pipe without weight, all around: the pipe stays where it is, and carries nothing.
TEST(Cande, APipeThatTouchesNothingFloats) {
  RingInGround away;
  away.alpha = 1e-3;
  away.A = away.beta = away.C = away.D = 0.0;
  const scenes::WholeRun run = run_cande(away.deck(24, 3, "       0.3       0.0       0.0", false));
  ASSERT_TRUE(run.completed()) << run.failure;
  const scenes::PointStresses pipe = pipe_of(run, 24);
  ASSERT_GT(pipe.size(), 0);
  EXPECT_LT(pipe.cwiseAbs().maxCoeff(), 1e-9) << "of 20 where it is pressed by as much";
}

// Two squares of 100, the second on the first, with nodes of their own where they meet: lower 1 2 3 4, upper 5 6 7 8
// (5, 6 on 4, 3), and joints with third nodes 9 and 10.  E = 2000, nu = 0.  The base is held, the top (7, 8) is moved
// by `top` cards.
std::string two_squares(const std::string& joints, const std::string& interface, const std::string& top) {
  std::string text = cande_line("A-1", "ANALYS   3 0  0two squares") + cande_line("C-1.L3", "PREP") +
                     cande_line("C-2.L3", "    2    3    1    3    1   10");
  const double x[] = {0, 100, 100, 0, 0, 100, 100, 0, 0, 100},
               y[] = {0, 0, 100, 100, 100, 100, 200, 200, 100, 100};
  for (int n = 1; n <= 10; ++n)
    text += cande_line(
        "C-3.L3", fmt::format("{}{:>4}  00{:>10.2f}{:>10.2f}", n == 10 ? "L" : " ", n, x[n - 1], y[n - 1]));
  text += cande_line("C-4.L3", "    1    1    2    3    4    1    1") +
          cande_line("C-4.L3", "    2    5    6    7    8    1    1") + joints +
          cande_line("C-5.L3", "    1    1       0.0    1       0.0") +
          cande_line("C-5.L3", "    2    1       0.0    1       0.0") + top +
          cande_line("D-1", "    1    1       0.0soil") + cande_line("D-2.Isotropic", "      2000       0.0") +
          cande_line("D-1", "L   1    6       0.0") + cande_line("D-2.Interface", interface) + "STOP\n";
  return text;
}

const std::string kTwoInterfaces = cande_line("C-4.L3", "    3    4    5    9    0    1    1    1") +
                                   cande_line("C-4.L3", "L   4    3    6   10    0    1    1    1");

// C-5 cards of both top nodes in a step.
std::string moved_top(double x, double y, int step, bool last) {
  return cande_line("C-5.L3", fmt::format("    7    1{:>10.4f}    1{:>10.4f}       0.0{:>5}", x, y, step)) +
         cande_line("C-5.L3", fmt::format("{}   8    1{:>10.4f}    1{:>10.4f}       0.0{:>5}", last ? "L" : " ",
                                          x, y, step));
}

// Force on the top at the end of a step.
double top_force(const scenes::WholeRun& run, std::size_t step, int direction) {
  return run.reaction(run.increments[step], {7, 8}, direction);
}

// Both squares together: E w d / (2 h) = 10 for each 0.01.  Interfaces 1e4 times as stiff: 1e-4.
TEST(Cande, InterfacesCloseTheirGapAndBreak) {
  const auto pressed = [](const std::string& interface, double y) {
    const scenes::WholeRun run = run_cande(two_squares(kTwoInterfaces, interface, moved_top(0, y, 1, true)));
    EXPECT_TRUE(run.completed()) << run.failure;
    return run.completed() ? top_force(run, 0, 1) : 0.0;
  };
  EXPECT_NEAR(pressed("      90.0       0.3       0.0       0.0", -0.02), -20.0, 20 * 2e-4);
  EXPECT_NEAR(pressed("      90.0       0.3       0.0     0.015", -0.02), -5.0, 5 * 1e-3) << "gap";
  EXPECT_NEAR(pressed("      90.0       0.3       0.0     0.025", -0.02), 0.0, 1e-9) << "wider gap";
  EXPECT_NEAR(pressed("      90.0       0.3       0.0       0.0", 0.02), 0.0, 1e-9) << "no tension";
  EXPECT_NEAR(pressed("      90.0       0.3      11.0       0.0", 0.02), 20.0, 20 * 2e-4) << "10 a node";
  EXPECT_NEAR(pressed("      90.0       0.3       9.0       0.0", 0.02), 0.0, 1e-9) << "broken";
}

// Coulomb, whatever the squares do: the sum of shear is the friction coefficient times the sum of normal forces.
TEST(Cande, InterfacesSlipByTheirCoefficient) {
  const scenes::WholeRun run = run_cande(two_squares(
      kTwoInterfaces, "      90.0       0.3", moved_top(0, -0.05, 1, false) + moved_top(1.0, 0, 2, true)));
  ASSERT_TRUE(run.completed()) << run.failure;
  EXPECT_LT(top_force(run, 1, 1), -10.0);
  EXPECT_NEAR(top_force(run, 1, 0), -0.3 * top_force(run, 1, 1), 1e-6);
}

// The angle of a card that is turned round, or whose nodes are swapped, is put right by where the soil is.
TEST(Cande, InterfacesTurnedRoundAreTurnedBack) {
  const std::string text = two_squares(kTwoInterfaces, "     -90.0       0.3", moved_top(0, -0.02, 1, true));
  const scenes::WholeRun run = run_cande(text);
  ASSERT_TRUE(run.completed()) << run.failure;
  EXPECT_NEAR(top_force(run, 0, 1), -20.0, 20 * 2e-4);
  EXPECT_TRUE(mentions(cande_model(text).diagnostics, Severity::warning, "the normal of 2 interface(s)"));
}

// Pinned links hold both ways until they die.
TEST(Cande, LinksHoldUntilTheyDie) {
  const std::string links =
      cande_line("C-4.L3", "    3    4    5    9    0    0    1    9    0    0    0    2") +
      cande_line("C-4.L3", "L   4    3    6   10    0    0    1    8    0    0    0    2");
  const scenes::WholeRun run = run_cande(two_squares(links, "", moved_top(0, 0.02, 1, true)));
  ASSERT_TRUE(run.completed()) << run.failure;
  EXPECT_NEAR(top_force(run, 0, 1), 20.0, 20 * 2e-4);
  EXPECT_NEAR(top_force(run, 1, 1), 0.0, 1e-9);
}

// A beam of two welded halves on two supports, with a force in its middle: P L^3/(48 EI); shear of the wall adds
// 12 EI/(GA L^2) = 1e-3 of it.
std::string two_beams(const std::string& link) {
  std::string text = cande_line("A-1", "ANALYS   3 0  1beams") + cande_line("A-2.L3", "BASIC         2") +
                     cande_line("B-1.Basic", "    1    2     1.0E6       0.0       1.0       0.1") +
                     cande_line("C-1.L3", "PREP") + cande_line("C-2.L3", "    1    3    1    3    1    5");
  const double x[] = {0, 50, 50, 100, 50};
  for (int n = 1; n <= 5; ++n)
    text += cande_line("C-3.L3",
                       fmt::format("{}{:>4}  00{:>10.2f}{:>10.2f}", n == 5 ? "L" : " ", n, x[n - 1], 0.0));
  return text + cande_line("C-4.L3", "    1    1    2    0    0    1    1") +
         cande_line("C-4.L3", "    2    3    4    0    0    1    1") + cande_line("C-4.L3", link) +
         cande_line("C-5.L3", "    1    1       0.0    1       0.0") +
         cande_line("C-5.L3", "    4    0       0.0    1       0.0") +
         cande_line("C-5.L3", "L   2    0       0.0    0      -2.0") +
         cande_line("D-1", "L   1    1       0.0soil") + cande_line("D-2.Isotropic", "      2000       0.3") +
         "STOP\n";
}

TEST(Cande, FixedLinkWeldsTwoBeams) {
  const scenes::WholeRun run = run_cande(two_beams("L   3    2    3    5    0    0    1    8"));
  ASSERT_TRUE(run.completed()) << run.failure;
  const double bent = 2.0 * 1e6 / (48 * 1e5);
  EXPECT_NEAR(-run.u(2).y(), bent, 2e-3 * bent);
}

// A normal along the surface is taken as it is, with a word to its card.
TEST(Cande, InterfacesWhoseNormalLiesAlongTheSurfaceAreNamed) {
  const Model model =
      cande_model(two_squares(kTwoInterfaces, "       2.0       0.3", moved_top(0, -0.02, 1, true)));
  EXPECT_TRUE(mentions(model.diagnostics, Severity::warning, "the normal of 2 interface(s) lies nearly along"));
  EXPECT_FALSE(mentions(model.diagnostics, Severity::warning, "is turned"));
}

// Every field of the cards that joints need, wrong: an error at its line and columns.
TEST(Cande, JointsThatMakeNoSenseAreErrorsOfTheirFields) {
  struct Case {
    std::string joints, interface, words;
  };
  const std::string good = "      90.0       0.3       0.0       0.0";
  const auto first = [](const std::string& card) {
    return cande_line("C-4.L3", card) + cande_line("C-4.L3", "L   4    3    6   10    0    1    1    1");
  };
  for (const Case& c :
       {Case{kTwoInterfaces, "      abcd       0.3", "angle"},
        Case{kTwoInterfaces, "      90.0      -0.3", "coefficient of friction"},
        Case{kTwoInterfaces, "      90.0       abc", "coefficient of friction"},
        Case{kTwoInterfaces, "     999.0       0.3", "from -360 to 360"},
        Case{kTwoInterfaces, "      90.0       0.3      -1.0", "tensile limit"},
        Case{kTwoInterfaces, "      90.0       0.3       x.0", "tensile limit"},
        Case{kTwoInterfaces, "      90.0       0.3       0.0      -1.0", "gap"},
        Case{kTwoInterfaces, "      90.0       0.3       0.0      gap!", "gap"},
        Case{first("    3    4    5    0    0    1    1    1"), good, "third node must be its own"},
        Case{first("    3    4    5   10    0    1    1    1"), good, "third node must be its own"},
        Case{first("    3    4    4    9    0    1    1    1"), good, "joins a node with itself"},
        Case{first("    3    4    6    9    0    1    1    1"), good, "only nodes at one place"},
        Case{first("    3    4   77    9    0    1    1    1"), good, "node 77 has no card C-3"},
        Case{first("    3    4    5    9    0    2    1    1"), good,
             "no card D-1 has the interface material 2"},
        Case{first("    3    4    5    9    0    0    1   10"), good, "1 link"}}) {
    SCOPED_TRACE(c.words);
    try {
      run_cande(two_squares(c.joints, c.interface, moved_top(0, -0.02, 1, true)));
      ADD_FAILURE() << "taken";
    } catch (const InputError& error) {
      bool placed = false;
      for (const Diagnostic& d : error.diagnostics().list())
        placed = placed || (d.severity == Severity::error && d.message.find(c.words) != std::string::npos &&
                            d.where.line > 0 && d.where.first_column > 0);
      EXPECT_TRUE(placed) << error.diagnostics().list().front().message;
    }
  }
  // A rotation can't be tied for a time.
  const auto link_error = [](const std::string& card) {
    try {
      run_cande(two_beams(card));
    } catch (const InputError& error) {
      for (const Diagnostic& d : error.diagnostics().list())
        if (d.severity == Severity::error) return d.message;
    }
    return std::string();
  };
  EXPECT_NE(
      link_error("L   3    2    3    5    0    0    1    8    0    0    0    1").find("for good or not at all"),
      std::string::npos);
}

TEST(Cande, LoadScalingIsRefusedAtItsCard) {
  std::string text = small_cande("");
  const std::size_t at = text.find("                   C-3.L3!!");
  text.insert(at, cande_line("C-2b.L3", "    2    3"));
  try {
    run_cande(text);
    FAIL() << "live loads were taken as they are";
  } catch (const InputError& error) {
    EXPECT_TRUE(mentions(error.diagnostics(), Severity::error, "continuous load scaling"));
    EXPECT_EQ(error.diagnostics().list().back().where.line, 4);
  }
}

// McGrath's (1998) secant moduli of one-dimensional compression, which are the design values of these soils for
// pipes (Moser, Buried Pipe Design, table 3.5; AASHTO LRFD 12.12.3.5), were made with this law and these numbers: at
// 69 and 275 kPa.  They are smoothed and rounded, and their start is not known: 18 %.
TEST(Cande, SoilsOfSeligHaveTheirConstrainedModuli) {
  struct Case {
    const char* name;
    double at_69, at_275;  // MPa
  };
  for (const Case& c : {Case{"SW95", 20.7, 29.3}, Case{"SW90", 11.2, 14.5}, Case{"SW85", 3.9, 5.7},
                        Case{"ML95", 12.2, 14.4}, Case{"ML90", 5.2, 6.2}, Case{"ML85", 2.8, 3.5},
                        Case{"CL95", 4.8, 5.6}, Case{"CL90", 2.4, 3.2}, Case{"CL85", 1.4, 2.0}}) {
    SCOPED_TRACE(c.name);
    const translate::NamedSoil* soil = translate::named_soil(true, std::string(c.name) + "  fill");
    ASSERT_NE(soil, nullptr);
    const UnitSystem units{"m", "kN", "kPa", 101.325, 9.81};
    const std::vector<double> values{soil->K,
                                     soil->n,
                                     soil->R_f,
                                     soil->K,
                                     soil->bulk,
                                     soil->bulk_other,
                                     soil->cohesion * 6.894757,
                                     soil->friction_angle,
                                     soil->friction_loss};
    const auto law =
        std::get<std::unique_ptr<SolidLaw>>(full_catalogue().materials.find(10)->make(values, units));
    PointDriver<4> point(*law, Vector4(-0.1, -0.1, -0.1, 0));
    double moduli[2] = {0, 0}, strain = 0;
    const double goals[2] = {69.0, 275.0};
    for (int k = 0; k < 2;) {
      strain += 2e-4;
      ASSERT_LT(strain, 0.5);
      point.advance({Control::strain, Control::strain, Control::strain, Control::strain}, {0, -2e-4, 0, 0});
      if (-point.sigma()[1] >= goals[k]) moduli[k++] = -point.sigma()[1] / strain / 1000;
    }
    EXPECT_NEAR(moduli[0], c.at_69, 0.18 * c.at_69);
    EXPECT_NEAR(moduli[1], c.at_275, 0.18 * c.at_275);
  }
}

TEST(Cande, PipesThatMakeNoSenseAreErrorsOfTheirCard) {
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
TEST(Cande, LoadFactorsMultiplyTheLoadsOfTheirSteps) {
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

// Lives of elements and weights that can't be, at their fields; the small deck has three load steps.
TEST(Cande, LivesAndWeightsThatMakeNoSenseAreErrorsOfTheirFields) {
  const std::string second = "L   2    3    4    6    5    1    2";
  struct Case {
    std::string from, to, words;
  };
  for (const Case& c :
       {Case{second, "L   2    3    4    6    5    1    4", "is born in load step 4, after the last of the 3"},
        Case{second, "L   2    3    4    6    5    199999", "is born in load step 99999"},
        Case{second, "L   2    3    4    6    5    1   -2", "birth is negative"},
        Case{second, second + "    0    0    0    0    2", "is taken away in load step 2, and is born in 2"},
        Case{"     120.0soil", "    -120.0soil", "can't be negative"}}) {
    SCOPED_TRACE(c.words);
    std::string text = small_cande("");
    ASSERT_NE(text.find(c.from), std::string::npos);
    text.replace(text.find(c.from), c.from.size(), c.to);
    try {
      run_cande(text);
      ADD_FAILURE() << "taken";
    } catch (const InputError& error) {
      const Diagnostic& d = error.diagnostics().list().back();
      EXPECT_NE(d.message.find(c.words), std::string::npos) << d.message;
      EXPECT_GT(d.where.first_column, 0);
    }
  }
  // Taken away after the last step: it stays.
  std::string text = small_cande("");
  text.replace(text.find(second), second.size(), second + "    0    0    0    0    9");
  EXPECT_TRUE(run_cande(text).completed());
}

TEST(Cande, LoadFactorsThatMakeNoSenseAreErrors) {
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
TEST(Cande, SoilOfDuncan) {
  const std::string model_card = "               D-2.Duncan!!    0       0.5    1";
  const std::string cards =
      "               D-3.Duncan!!       1.5      36.0       5.0     450.0      0.35      0.80\n"
      "               D-4.Duncan!!     300.0      0.10       0.0\n";
  std::string text = cande_text();
  const std::size_t at = text.find(model_card), end = text.find('\n', at) + 1;
  text.insert(end, cards);
  const Model selig = cande_model(text);
  EXPECT_EQ(selig.materials[1].law_name, "duncan_selig");
  EXPECT_EQ(selig.materials[1].parameters[4], 300.0) << "B_i/p_a";
  EXPECT_EQ(selig.materials[1].parameters[5], 0.10) << "eps_u";
  text[at + model_card.size() - 1] = '0';
  const Model duncan = cande_model(text);
  EXPECT_EQ(duncan.materials[1].law_name, "duncan_chang_eb");
  const std::vector<double> expected{450.0, 0.35, 0.80, 450.0, 300.0,
                                     0.10,  1.5,  36.0, 5.0};  // K n Rf Kur Kb m c phi dphi
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(duncan.materials[1].parameters[i], expected[i]) << "parameter " << i + 1;
  EXPECT_TRUE(mentions(duncan.diagnostics, Severity::warning, "no modulus for unloading"));
}

// D-3 and D-4 as they stand on a card: cohesion, angle, its loss, K, n, R_f; bulk number and exponent.
Diagnostic refused_soil(const std::string& strength, const std::string& bulk) {
  const std::string model_card = "               D-2.Duncan!!    0       0.5    1";
  std::string text = cande_text();
  text.insert(text.find('\n', text.find(model_card)) + 1,
              "               D-3.Duncan!!" + strength + "\n               D-4.Duncan!!" + bulk + "\n");
  try {
    cande_model(text);
  } catch (const InputError& error) {
    return error.diagnostics().list().front();
  }
  throw std::logic_error("taken: " + strength + "|" + bulk);
}

// A blank, or a card that ends early, is a zero to CANDE: where no soil comes of it the field is named.
// Beyond a card's end there are no columns to point at (0), but its line.
TEST(Cande, BlankNumbersOfDuncanAreErrorsOfTheirFields) {
  const std::string bulk = "     300.0      0.10";
  const auto expect = [](const Diagnostic& d, const std::string& what, int column) {
    EXPECT_NE(d.message.find(what), std::string::npos) << d.message;
    EXPECT_EQ(d.where.first_column, column) << d.message;
    EXPECT_GT(d.where.line, 0);
  };
  expect(refused_soil("       1.5      36.0       5.0                0.35      0.80", bulk), "modulus number",
         58);
  expect(refused_soil("       1.5      36.0       5.0     450.0      0.35", bulk), "failure ratio", 0);
  expect(refused_soil("       0.0                 5.0     450.0      0.35      0.80", bulk), "friction angle",
         38);
  expect(refused_soil("       1.5      36.0       5.0     450.0      0.35      0.80", "     300.0"),
         "bulk modulus exponent", 0);
}

TEST(Cande, GenerationIsRefusedWithItsField) {
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

}  // namespace
}  // namespace sage::app
