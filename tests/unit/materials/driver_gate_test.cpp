// The point driver against answers that owe nothing to it: closed forms of triaxial and plane strain tests, and a
// bisection on the one strain that such a test leaves open, with the law alone.  1300 cases drawn at random over all
// laws of solids and joints, nu up to .4999999.  Wrong by more than 1e-6 without a message: none; at most 1 % without
// an answer.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <map>
#include <optional>
#include <random>

#include "materials/register_materials.hpp"
#include "sage/core/point_driver.hpp"
#include "sage/messages/error.hpp"

namespace sage {
namespace {

constexpr double kRight = 1e-6;
const UnitSystem kUnits{"m", "kN", "kPa", 101.325, 9.81};

// One open strain: deps = given + x * direction, until the stress of `component` is `held`.
template <int N>
struct OpenStrain {
  std::array<Control, N> control;
  Vector<N> direction;
  int component;
};
constexpr Control kStrain = Control::strain, kStress = Control::stress;

enum class Path { compression, extension, biaxial, shear, isotropic };

OpenStrain<4> open_strain(Path test) {
  switch (test) {
    case Path::biaxial:
      return {{kStress, kStrain, kStrain, kStrain}, {1, 0, 0, 0}, 0};
    case Path::shear:
      return {{kStrain, kStress, kStrain, kStrain}, {0, 1, 0, 0}, 1};
    case Path::isotropic:
      return {{kStress, kStress, kStress, kStrain}, {1, 1, 1, 0}, 0};
    default:
      return {{kStress, kStrain, kStress, kStrain}, {1, 0, 1, 0}, 0};
  }
}

// A law's state, moved by bisection.
template <int N>
class Bisected {
 public:
  Bisected(const Law<N>& law, const Vector<N>& sigma)
      : law_(law), sigma_(sigma), eps_(Vector<N>::Zero()), h_(initial_values(law.traits().history)) {
    h1_ = h_;
    if (!law.initialise(sigma_, h_)) throw AnalysisError("S503", "start");
  }
  const Vector<N>& sigma() const { return sigma_; }

  // False where no bracket is found, or the law refuses.
  bool advance(const OpenStrain<N>& open, const Vector<N>& given, double held, double width) {
    const auto lack = [&](double x) { return stress(given + x * open.direction)[open.component] - held; };
    double low = -width, high = width, at_low = lack(low), at_high = lack(high);
    // The answer nearest to the start: where strength falls there may be others.
    for (int i = 0; i < 90 && at_low > 0.0; ++i) at_low = lack(low *= 1.6);
    for (int i = 0; i < 90 && at_high < 0.0; ++i) at_high = lack(high *= 1.6);
    if (!(at_low <= 0.0 && at_high >= 0.0)) return false;
    for (int i = 0; i < 200 && high - low > 1e-16 * (std::abs(low) + std::abs(high)); ++i) {
      // Every third point is the middle, the others are of the secant: safe and quick.
      double x = i % 3 == 2 || at_high <= at_low ? 0.5 * (low + high)
                                                 : low - at_low * (high - low) / (at_high - at_low);
      if (!(x > low && x < high)) x = 0.5 * (low + high);
      if (x == low || x == high) break;
      const double f = lack(x);
      if (f == 0.0) {
        low = high = x;
        break;
      }
      (f < 0.0 ? low : high) = x;
      (f < 0.0 ? at_low : at_high) = f;
    }
    const double x = -at_low < at_high ? low : high;
    const Vector<N> deps = given + x * open.direction;
    sigma_ = stress(deps);
    if (refused_) return false;
    eps_ += deps;
    h_ = h1_;
    return sigma_.allFinite() && std::abs(sigma_[open.component] - held) <= 1e-7 * sigma_.cwiseAbs().maxCoeff();
  }

 private:
  Vector<N> stress(const Vector<N>& deps) {
    PointOut<N> out;
    out.h1 = h1_;
    refused_ = law_.update({sigma_, eps_, deps, h_, nullptr}, out) != Outcome::ok;
    return out.sigma;
  }
  const Law<N>& law_;
  Vector<N> sigma_, eps_;
  std::vector<double> h_, h1_;
  bool refused_ = false;
};

struct Tally {
  int cases = 0, blank = 0, wrong = 0, bisected = 0, closed = 0;
  double worst = 0.0;
};

class Random {
 public:
  double between(double low, double high) {
    return low + (high - low) * std::ldexp(double(engine_() >> 11), -53);
  }
  double scaled(double low, double high) { return low * std::pow(high / low, between(0, 1)); }
  int of(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }
  double poisson() {
    constexpr std::array<double, 9> near{0.0, 0.3, 0.45, 0.49, 0.499, 0.4999, 0.49999, 0.499999, 0.4999999};
    return of(3) == 0 ? between(0.0, 0.49) : near[of(9)];
  }
  double dilation(double phi) { return std::array<double, 3>{0.0, phi, between(0.0, phi)}[of(3)]; }

 private:
  std::mt19937_64 engine_{20261126};
};

struct Case {
  int code;
  std::vector<double> values;
  double pressure;
  Path test = Path::compression;
  double to = 0.0;  // strain (isotropic: stress), compression positive
  int steps = 1;
  // Axial stress (compression positive) at an axial strain, where there is a closed form.
  std::function<double(double)> axial{};
};

LawPtr law_of(const Case& c) {
  static const Catalogue catalogue = [] {
    Catalogue all;
    register_materials(all);
    return all;
  }();
  return catalogue.materials.find(c.code)->law_for(c.values, kUnits, "case");
}

std::string words(const Case& c) {
  return fmt::format("law {} ({}), test {}, pressure {}, to {} in {} steps", c.code, fmt::join(c.values, ", "),
                     static_cast<int>(c.test), c.pressure, c.to, c.steps);
}

template <int N>
double apart(const Vector<N>& a, const Vector<N>& b) {
  return (a - b).cwiseAbs().maxCoeff() / std::max(b.cwiseAbs().maxCoeff(), 1e-300);
}

const SolidLaw& solid(const LawPtr& law) {
  return *std::get<std::unique_ptr<SolidLaw>>(law);
}

// The largest stress that is not as held, of the largest stress.
double off_target(const std::array<Control, 4>& control, const Vector4& goal, const Vector4& sigma) {
  double off = 0.0;
  for (int i = 0; i < 4; ++i)
    if (control[i] == kStress) off = std::max(off, std::abs(sigma[i] - goal[i]));
  return off / std::max(sigma.cwiseAbs().maxCoeff(), 1e-300);
}

// A test with one open strain, its driver and its reference.
class Comparison {
 public:
  Comparison(const Case& c, const SolidLaw& law, const Vector4& start, Tally& tally)
      : c_(c), open_(open_strain(c.test)), driver_(law, start), reference_(law, start), tally_(tally) {
    const int driven = c.test == Path::shear ? 3 : 1;
    if (c.test != Path::isotropic) given_[driven] = (c.test == Path::extension ? 1.0 : -1.0) * c.to / c.steps;
  }
  // False where the rest has nothing to compare with.
  bool step(int number) {
    const double share = static_cast<double>(number) / c_.steps, p = -c_.pressure;
    const double target = c_.test == Path::isotropic ? p + share * (-c_.to - p) : p;
    Vector4 goal = given_;
    for (int i = 0; i < 4; ++i)
      if (open_.control[i] == kStress) goal[i] = target;
    const int parts = driver_.steps();
    bool blank = false;
    try {
      driver_.advance(open_.control, goal);
    } catch (const AnalysisError&) {
      blank = true;
    }
    if (!blank && !expect(off_target(open_.control, goal, driver_.sigma()), number)) return false;
    if (!blank && c_.axial) {
      const double right = c_.axial(share * c_.to), scale = std::max(std::abs(right), c_.pressure);
      ++tally_.closed;
      if (!expect(std::abs(-driver_.sigma()[1] - right) / scale, number, -right)) return false;
    }
    const bool answered = reference_.advance(open_, given_, target, 0.02 * std::max(given_.norm(), 1e-7));
    tally_.blank += answered && blank;
    if (!answered || blank) return false;            // no equilibrium along this path
    if (driver_.steps() != parts + 1) return false;  // divided: another path
    ++tally_.bisected;
    return expect(apart<4>(driver_.sigma(), reference_.sigma()), number, reference_.sigma()[1]);
  }

 private:
  bool expect(double off, int number, double axial = std::nan("")) {
    tally_.worst = std::max(tally_.worst, off);
    if (off <= kRight) return true;
    ++tally_.wrong;
    ADD_FAILURE() << fmt::format("stress {:.9g}, axial {:.9g}; off by {:.2e} of it in step {}: ",
                                 fmt::join(driver_.sigma(), " "), axial, off, number)
                  << words(c_);
    return false;
  }
  const Case& c_;
  OpenStrain<4> open_;
  Vector4 given_ = Vector4::Zero();
  PointDriver<4> driver_;
  Bisected<4> reference_;
  Tally& tally_;
};

// False where the law can't carry the start.
bool drive(const Case& c, Tally& tally) {
  const LawPtr law = law_of(c);
  const double p = -c.pressure;
  try {
    Comparison comparison(c, solid(law), {p, p, p, 0.0}, tally);
    ++tally.cases;
    for (int step = 1; step <= c.steps; ++step)
      if (!comparison.step(step)) break;
  } catch (const AnalysisError&) {
    return false;
  }
  return true;
}

// Any components held at their first stress, the others strained at random: what is held stays, or there is a message.
void drive_any(Random& random, const Case& c, Tally& tally) {
  const LawPtr law = law_of(c);
  const double p = -c.pressure;
  std::array<Control, 4> control{};
  for (Control& one : control) one = random.of(2) == 0 ? kStrain : kStress;
  Vector4 goal(p, p, p, 0.0);
  for (int i = 0; i < 4; ++i)
    if (control[i] == kStrain) goal[i] = random.between(-1.0, 1.0) * c.to / c.steps;
  try {
    PointDriver<4> driver(solid(law), {p, p, p, 0.0});
    ++tally.cases;
    for (int step = 0; step < c.steps; ++step) {
      driver.advance(control, goal);
      tally.worst = std::max(tally.worst, off_target(control, goal, driver.sigma()));
    }
  } catch (const AnalysisError& error) {
    tally.blank += error.code() == Code("S501");
  }
  if (tally.worst <= 1e-8) return;
  ++tally.wrong;
  ADD_FAILURE() << fmt::format("a held stress is off by {:.2e}: ", tally.worst) << words(c);
}

double slope(double degrees) {
  const double sine = std::sin(degrees * kRadiansPerDegree);
  return (1.0 + sine) / (1.0 - sine);
}

Path any_test(Random& random) {
  return static_cast<Path>(random.of(5));
}

// Strain of the whole test from that which reaches a strength, mostly beyond it.
void set_length(Random& random, Case& c, double strength, double E) {
  c.to = random.scaled(0.1, 300.0) * std::max(strength, 1e-3 * c.pressure) / E;
  c.steps = std::array<int, 4>{1, 3, 10, 25}[random.of(4)];
  if (c.test == Path::isotropic) c.to = c.pressure * random.scaled(0.5, 50.0);
}

Case elastic_case(Random& random) {
  Case c{1, {random.scaled(1e2, 1e8), random.poisson()}, random.scaled(1.0, 1e3), any_test(random)};
  set_length(random, c, c.pressure, c.values[0]);
  const double E = c.values[0], nu = c.values[1], p = c.pressure;
  if (c.test == Path::compression) c.axial = [=](double e) { return p + E * e; };
  if (c.test == Path::extension) c.axial = [=](double e) { return p - E * e; };
  if (c.test == Path::biaxial) c.axial = [=](double e) { return p + E / (1.0 - nu * nu) * e; };
  return c;
}

// Plastic flow starts where the elastic line meets the strength: exact for any dilation, as the zz stress lies between.
Case mohr_coulomb_case(Random& random) {
  const double E = random.scaled(1e2, 1e8), nu = random.poisson(),
               phi = random.of(4) == 0 ? 0.0 : random.between(1.0, 60.0);
  const double p = random.scaled(1.0, 1e3), c = phi > 0.0 && random.of(3) == 0 ? 0.0 : random.scaled(0.1, 1e3);
  const double N = slope(phi), Y = 2.0 * c * std::sqrt(N),
               T = random.of(5) == 0 ? random.between(0.0, c) : -1.0;
  Case one{4, {E, nu, c, phi, random.dilation(phi), T}, p, any_test(random)};
  set_length(random, one, (N - 1.0) * p + Y, E);
  const double stiff = one.test == Path::biaxial ? E / (1.0 - nu * nu) : E;
  if (one.test == Path::compression || one.test == Path::biaxial)
    one.axial = [=](double e) { return std::min(p + stiff * e, N * p + Y); };
  const double tension = T < 0.0 ? 1e300 : T;
  if (one.test == Path::extension)
    one.axial = [=](double e) { return std::max({p - E * e, (p - Y) / N, -tension}); };
  return one;
}

// q = A + B p on a compressive meridian of the cone 1: sqrt(J2) = k + alpha I1', from Mohr-Coulomb in compression.
Case drucker_prager_case(Random& random) {
  const double E = random.scaled(1e2, 1e8), nu = random.poisson(), phi = random.between(0.0, 50.0);
  const double p = random.scaled(1.0, 1e3), c = phi > 0.0 && random.of(3) == 0 ? 0.0 : random.scaled(0.1, 1e3);
  const double N = slope(phi), Y = 2.0 * c * std::sqrt(N), cone = 1 + random.of(5);
  const double flow = random.of(2);
  Case one{3, {E, nu, c, phi, random.dilation(phi), cone, flow}, p, any_test(random)};
  set_length(random, one, (N - 1.0) * p + Y, E);
  if (one.test == Path::compression && cone == 1.0)
    one.axial = [=](double e) { return std::min(p + E * e, N * p + Y); };
  if (one.test == Path::extension && cone == 2.0)
    one.axial = [=](double e) { return std::max(p - E * e, (p - Y) / N); };
  return one;
}

Case hoek_brown_case(Random& random) {
  const double E = random.scaled(1e3, 1e8), nu = random.poisson(), ci = random.scaled(10.0, 1e4),
               m = random.scaled(0.1, 20.0);
  const double s = random.of(3) == 0 ? 0.0 : random.scaled(1e-4, 1.0), a = random.between(0.5, 0.65);
  const double p = random.scaled(1.0, 1e3), T = random.of(4) == 0 ? 0.5 * s * ci / m : -1.0;
  Case one{9, {E, nu, ci, m, s, a, random.of(3) / 2.0, T}, p, any_test(random)};
  const double q = ci * std::pow(m * p / ci + s, a);
  set_length(random, one, q, E);
  if (one.test == Path::compression) one.axial = [=](double e) { return p + std::min(E * e, q); };
  return one;
}

// kappa = 2/sqrt(3) (1 + M/2) (e - q/E) in compression; q(kappa) straight between the values.  psi stays.
Case softening_case(Random& random) {
  const double nu = random.poisson(), p = random.scaled(1.0, 1e3), strain_1 = random.scaled(0.02, 0.2);
  const double phi = random.between(5.0, 45.0), phi_1 = random.between(5.0, 45.0);
  const double psi = random.of(2) * random.between(0.0, 5.0);
  const double c = random.scaled(0.1, 100.0), c_1 = random.scaled(0.1, 100.0);
  const double q = (slope(phi) - 1.0) * p + 2.0 * c * std::sqrt(slope(phi));
  // A strength that falls more steeply than the stiffness has several answers at one strain.
  const double E = random.scaled(1.0, 100.0) * 10.0 * q / strain_1;
  Case one{8, {E, nu, c, phi, psi, strain_1, c_1, phi_1, psi}, p, any_test(random)};
  set_length(random, one, q, E);
  one.steps = std::max(one.steps, 10);
  if (one.test != Path::compression) return one;
  const double flow = 2.0 / std::sqrt(3.0) * (1.0 + 0.5 * slope(psi));
  one.axial = [=](double e) {
    const auto strength = [=](double kappa) {
      const double share = std::min(kappa / strain_1, 1.0), N = slope(phi + share * (phi_1 - phi));
      return (N - 1.0) * p + 2.0 * (c + share * (c_1 - c)) * std::sqrt(N);
    };
    if (E * e <= strength(0.0)) return p + E * e;
    double low = 0.0, high = flow * e;
    for (int i = 0; i < 100; ++i) {
      const double kappa = 0.5 * (low + high);
      (kappa < flow * (e - strength(kappa) / E) ? low : high) = kappa;
    }
    return p + strength(low);
  };
  return one;
}

Case hyperbolic_case(Random& random) {
  const std::array<int, 4> codes{5, 6, 7, 10};
  const int code = codes[random.of(4)];
  const double K = random.scaled(50.0, 1000.0), phi = random.between(15.0, 45.0),
               c = random.of(2) * random.between(0.0, 20.0);
  std::vector<double> v{K, random.between(0.2, 0.8), random.between(0.6, 0.95), 1.5 * K};
  if (code == 5)
    v.insert(v.end(), {random.between(0.2, 0.4), random.between(0.0, 0.1), random.between(0.0, 5.0)});
  if (code == 10) v.insert(v.end(), {random.scaled(10.0, 200.0), random.between(0.02, 0.1)});
  if (code == 6 || code == 7) v.insert(v.end(), {random.scaled(0.5, 2.0) * K, random.between(0.0, 0.5)});
  v.insert(v.end(), {c, phi, random.of(2) * random.between(0.0, 5.0)});
  if (code == 7) v.push_back(random.of(2) * random.between(0.0, 10.0));
  Case one{code, v, random.scaled(10.0, 500.0), any_test(random)};
  if (one.test == Path::isotropic)
    one.to = one.pressure * random.scaled(1.0, 5.0);
  else
    one.to = random.scaled(1e-3, 0.1);
  one.steps = 40;
  return one;
}

// Joints: direct shear at constant normal stress, and Coulomb's strength in closed form where nothing is left of it.
void drive_joint(Random& random, Tally& tally) {
  const int code = 21 + random.of(3);
  const double p = random.scaled(1.0, 1e3), phi = random.between(0.0, 45.0),
               c = random.of(2) * random.scaled(0.1, 100.0);
  const double k_s = random.scaled(1e2, 1e6), k_n = random.scaled(1e3, 1e8);
  std::vector<double> v{k_s, k_n};
  if (code == 22)
    v = {c,   phi, 0.0, random.between(0.0, 0.95),        k_s / 10.0, random.between(0.0, 1.0),
         k_n, k_n, 0.0, static_cast<double>(random.of(3))};
  if (code == 23) v = {k_s, k_n, c, phi, random.dilation(phi)};
  const Case named{code, v, p, Path::shear};
  const LawPtr held = law_of(named);
  const InterfaceLaw& law = *std::get<std::unique_ptr<InterfaceLaw>>(held);
  const OpenStrain<2> open{{kStrain, kStress}, {0, 1}, 1};
  PointDriver<2> driver(law, {0.0, -p});
  Bisected<2> reference(law, {0.0, -p});
  ++tally.cases;
  const double strength = c + p * std::tan(phi * kRadiansPerDegree);
  const double step = random.scaled(0.1, 50.0) * std::max(strength, 1.0) / k_s / 10.0;
  double slip = 0.0;
  for (int i = 0; i < 20; ++i) {
    const double sense = i < 12 ? 1.0 : -1.0;
    slip += sense * step;
    try {
      driver.advance(open.control, {sense * step, -p});
    } catch (const AnalysisError&) {
      ++tally.blank;
      return;
    }
    if (!reference.advance(open, {sense * step, 0.0}, -p, 4.0 * step)) {
      return;
    }
    ++tally.bisected;
    double off = apart<2>(driver.sigma(), reference.sigma());
    if (code == 21) off = std::max(off, std::abs(driver.sigma()[0] - k_s * slip) / p);
    if (code == 23 && i < 12)
      off = std::max(off, std::abs(driver.sigma()[0] - std::min(k_s * slip, strength)) / std::max(p, strength));
    tally.worst = std::max(tally.worst, off);
    if (off > kRight) {
      ++tally.wrong;
      ADD_FAILURE() << "step " << i << ": " << driver.sigma().transpose() << " for "
                    << reference.sigma().transpose() << ": " << words(named);
      return;
    }
  }
}

TEST(PointDriverGate, RandomCasesAreRightOrSaySo) {
  Random random;
  std::map<std::string, Tally> tallies;
  const auto run = [&](const std::string& name, Case (*make)(Random&), int count) {
    for (int done = 0; done < count;) done += drive(make(random), tallies[name]);
  };
  run("elastic", elastic_case, 150);
  run("mohr_coulomb", mohr_coulomb_case, 300);
  run("drucker_prager", drucker_prager_case, 300);
  run("hoek_brown", hoek_brown_case, 150);
  run("softening", softening_case, 150);
  run("hyperbolic", hyperbolic_case, 100);
  for (int i = 0; i < 150; ++i) drive_joint(random, tallies["joints"]);
  Tally all;
  for (const auto& [name, tally] : tallies) {
    std::cout << fmt::format(
        "{:16} {} cases, {} states by bisection, {} in closed form: {} blank, {} wrong, worst {:.1e}\n", name,
        tally.cases, tally.bisected, tally.closed, tally.blank, tally.wrong, tally.worst);
    all.cases += tally.cases;
    all.blank += tally.blank;
    all.wrong += tally.wrong;
  }
  EXPECT_EQ(all.cases, 1300);
  EXPECT_EQ(all.wrong, 0);
  EXPECT_LE(all.blank, 13);
}

TEST(PointDriverGate, HoldsAnyStressesThatItIsGiven) {
  Random random;
  Tally tally;
  for (const auto make :
       {elastic_case, mohr_coulomb_case, drucker_prager_case, hoek_brown_case, softening_case, hyperbolic_case})
    for (int i = 0; i < 50; ++i) {
      const Case c = make(random);
      if (c.test != Path::isotropic) drive_any(random, c, tally);  // there `to` is a stress
    }
  EXPECT_GT(tally.cases, 200);
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_LE(tally.blank, tally.cases / 100);
}

}  // namespace
}  // namespace sage
