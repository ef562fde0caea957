// Solids under large strain, one element: stresses against the closed forms of Hencky's law, rotations, tangents by
// differences, and small strain as the limit.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "tests/support/elements.hpp"
#include "tests/support/laws.hpp"

namespace sage::test {
namespace {

constexpr double kYoung = 1000.0, kPoisson = 0.3, kShear = kYoung / 2.6;

// Those of the tree that have a form for large strain.
std::vector<ElementCase> large_cases() {
  std::vector<ElementCase> cases = solid_cases();
  std::erase_if(cases, [](const ElementCase& c) {
    return !c.entry->make_large || c.entry->make_large(c.geometry, c.formulation) == nullptr;
  });
  return cases;
}

std::unique_ptr<Element> make_large(const ElementCase& c) {
  return c.entry->make_large(c.geometry, c.formulation);
}

// An element that goes on from step to step.
struct Moving {
  Moving(const ElementCase& c, const Eigen::Matrix2Xd& x, const SolidLaw& law)
      : element(make_large(c)), run(*element, x, &law) {}

  void commit(const Eigen::VectorXd& du) {
    ASSERT_EQ(run.evaluate(du), Outcome::ok);
    run.sigma0 = run.sigma1;
    run.eps0 = run.eps1;
    run.h0 = run.h1;
    run.u0 += du;
  }
  // To these places of the nodes, a function of those of the mesh.
  template <class Place>
  void move_to(const Place& place) {
    Eigen::VectorXd du(run.u0.size());
    for (Eigen::Index i = 0; i < run.x.cols(); ++i) {
      const Vector2 x = run.x.col(i);
      du.segment<2>(2 * i) = place(x) - x - run.u0.segment<2>(2 * i);
    }
    commit(du);
  }
  Vector4 stress(int point) const { return Vector4::Map(run.sigma0.data() + 4 * point); }
  Vector4 strain(int point) const { return Vector4::Map(run.eps0.data() + 4 * point); }
  int points() const { return element->traits().points; }

  std::unique_ptr<Element> element;
  ElementRun run;
};

std::unique_ptr<SolidLaw> hencky(double nu = kPoisson) {
  return solid(1, {kYoung, nu});
}

Eigen::Matrix2d turned_by(double angle) {
  return (Eigen::Matrix2d() << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle)).finished();
}

// Closed form: b = F F^T of F = [1 g; 0 1] has the eigenvalues exp(+-2 asinh(g/2)), and ln(b)/2 the components
// xy = asinh(g/2) / sqrt(1 + g^2/4), xx = -yy = xy g/2; the volume stays.
TEST(LargeStrain, SimpleShearHasTheStressOfHenckysLaw) {
  const auto law = hencky();
  for (const ElementCase& c : large_cases()) {
    if (c.axisymmetric()) continue;
    Moving body(c, sample_shape(*c.entry), *law);
    for (const double g : {0.5, 1.0, 2.0, 4.0}) {
      body.move_to([g](const Vector2& x) { return Vector2(x.x() + g * x.y(), x.y()); });
      const double xy = std::asinh(0.5 * g) / std::sqrt(1.0 + 0.25 * g * g), xx = 0.5 * g * xy;
      const Vector4 expected = 2.0 * kShear * Vector4(xx, -xx, 0.0, xy);
      for (int p = 0; p < body.points(); ++p) {
        EXPECT_LT((body.stress(p) - expected).norm(), 1e-10 * expected.norm()) << c.name << " " << g;
        EXPECT_LT((body.strain(p) - Vector4(xx, -xx, 0.0, 2.0 * xy)).norm(), 1e-10) << c.name << " " << g;
      }
    }
  }
}

// Cauchy stress of tau = K tr(e) + 2 G dev(e), e = (ln a, ln b, ln c): tau over a b c.  In one step and in three.
TEST(LargeStrain, StretchHasTheCauchyStressOfHenckysLaw) {
  const auto law = hencky();
  const double K = kYoung / (3.0 * (1.0 - 2.0 * kPoisson));
  for (const ElementCase& c : large_cases())
    for (const int steps : {1, 3}) {
      Moving body(c, sample_shape(*c.entry), *law);
      const double a = 1.4, b = 0.6;
      for (int s = 1; s <= steps; ++s)
        body.move_to([&](const Vector2& x) {
          const double t = static_cast<double>(s) / steps;
          return Vector2(x.x() * (1.0 + t * (a - 1.0)), x.y() * (1.0 + t * (b - 1.0)));
        });
      const double zz = c.axisymmetric() ? a : 1.0;
      const Vector4 e(std::log(a), std::log(b), std::log(zz), 0.0);
      const double volume = e.head<3>().sum();
      Vector4 expected = 2.0 * kShear * e;
      expected.head<3>().array() += (K - 2.0 / 3.0 * kShear) * volume;
      expected /= a * b * zz;
      for (int p = 0; p < body.points(); ++p) {
        EXPECT_LT((body.stress(p) - expected).norm(), 1e-11 * expected.norm()) << c.name << " " << steps;
        EXPECT_LT((body.strain(p) - e).norm(), 1e-12) << c.name << " " << steps;
      }
    }
}

// In nine steps of ten degrees and in one.
TEST(LargeStrain, ARotationBy90DegreesLeavesNoStressAndTurnsWhatThereIs) {
  const auto law = hencky();
  const Vector4 start(-120.0, -200.0, -80.0, 30.0);
  for (const ElementCase& c : large_cases())
    for (const int steps : {1, 9}) {
      if (c.axisymmetric()) continue;
      Moving free(c, sample_shape(*c.entry), *law), loaded(c, sample_shape(*c.entry), *law);
      for (int p = 0; p < loaded.points(); ++p) Vector4::Map(loaded.run.sigma0.data() + 4 * p) = start;
      for (int s = 1; s <= steps; ++s)
        for (Moving* body : {&free, &loaded})
          body->move_to([&](const Vector2& x) -> Vector2 { return turned_by(0.5 * kPi * s / steps) * x; });
      const Vector4 expected(start[1], start[0], start[2], -start[3]);
      for (int p = 0; p < free.points(); ++p) {
        EXPECT_LT(free.stress(p).norm(), 1e-12 * kYoung) << c.name;
        EXPECT_LT((loaded.stress(p) - expected).norm(), 1e-12 * kYoung) << c.name;
      }
    }
}

struct SampleLaw {
  const char* name;
  std::unique_ptr<SolidLaw> law;
  Vector4 stress;
  double step;          // size of the displacements
  double width = 1e-5;  // of differences
};

std::vector<SampleLaw> sample_laws() {
  std::vector<SampleLaw> laws;
  laws.push_back({"elastic", hencky(0.45), Vector4(-50.0, -90.0, -60.0, 20.0), 0.1});
  laws.push_back(
      {"Drucker-Prager", solid(3, {kYoung, 0.3, 20.0, 30.0, 10.0}), Vector4(-50.0, -90.0, -60.0, 20.0), 0.05});
  laws.push_back(
      {"Mohr-Coulomb", solid(4, {kYoung, 0.3, 20.0, 30.0, 30.0}), Vector4(-50.0, -90.0, -60.0, 20.0), 0.05});
  laws.push_back({"Cam clay", solid(11, {1.0, 0.2, 0.04, 2.0, 0.3, 1.5}), Vector4(-100.0, -130.0, -110.0, 10.0),
                  0.03, 1e-6});
  return laws;
}

// A smooth motion that strains every point differently.
Eigen::VectorXd uneven(const Eigen::Matrix2Xd& x, double size, double shift) {
  Eigen::VectorXd u(2 * x.cols());
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const double a = x(0, i) + shift, b = x(1, i) - 0.5 * shift;
    u[2 * i] = size * (0.4 * a - 0.7 * b + 0.3 * std::sin(1.3 * a + b));
    u[2 * i + 1] = size * (0.5 * a - 0.8 * b + 0.3 * std::cos(a - 0.9 * b));
  }
  return u;
}

Moving after_a_step(const ElementCase& c, const SampleLaw& sample) {
  Moving body(c, sample_shape_curved(*c.entry), *sample.law);
  const auto of_law = sample.law->traits().history.size();
  const auto stride = static_cast<std::size_t>(body.run.history_size());
  for (int p = 0; p < body.points(); ++p) {
    Vector4::Map(body.run.sigma0.data() + 4 * p) = sample.stress;
    sample.law->initialise(sample.stress, {body.run.h0.data() + static_cast<std::size_t>(p) * stride, of_law});
  }
  body.commit(uneven(body.run.x, sample.step, 0.0));
  return body;
}

// Central differences: error of order width^2 beside curvature of order 1, and rounding over width.
TEST(LargeStrain, TheTangentIsTheDerivativeOfTheForces) {
  for (const SampleLaw& sample : sample_laws())
    for (const ElementCase& c : large_cases()) {
      Moving body = after_a_step(c, sample);
      body.run.edges = {{1, Vector2(30.0, 50.0), Vector2(-10.0, 5.0)},
                        {2, Vector2(-20.0, 40.0), Vector2(7.0, 0.0)}};
      const double error = tangent_error(body.run, uneven(body.run.x, sample.step, 0.4), sample.width);
      EXPECT_LT(error, 1e-7) << c.name << ", " << sample.name;
    }
}

TEST(LargeStrain, TheTangentOfAnElasticLawIsSymmetric) {
  const std::vector<SampleLaw> laws = sample_laws();
  for (const ElementCase& c : large_cases()) {
    Moving body = after_a_step(c, laws.front());
    ASSERT_EQ(body.run.evaluate(uneven(body.run.x, 0.1, 0.4)), Outcome::ok);
    EXPECT_LT((body.run.K - body.run.K.transpose()).norm(), 1e-13 * body.run.K.norm()) << c.name;
  }
}

// But for rounding.
TEST(LargeStrain, NoMotionChangesNothing) {
  for (const SampleLaw& sample : sample_laws())
    for (const ElementCase& c : large_cases()) {
      Moving body = after_a_step(c, sample);
      ASSERT_EQ(body.run.evaluate(Eigen::VectorXd::Zero(body.run.u0.size())), Outcome::ok);
      for (std::size_t i = 0; i < body.run.sigma0.size(); ++i)
        EXPECT_NEAR(body.run.sigma1[i], body.run.sigma0[i], 1e-13 * kYoung) << c.name << ", " << sample.name;
    }
}

// What differs from small strain falls in proportion to the strain: forces of an elastic element by theory, 1 +- .02.
TEST(LargeStrain, TheDifferenceFromSmallStrainIsOfFirstOrder) {
  const auto law = hencky();
  for (const ElementCase& c : large_cases()) {
    const Eigen::Matrix2Xd x = sample_shape(*c.entry);
    const std::unique_ptr<Element> small = c.make(), large = make_large(c);
    ElementRun plain(*small, x, law.get()), moved(*large, x, law.get());
    double difference[2];
    int at = 0;
    for (const double size : {1e-3, 1e-6}) {
      const Eigen::VectorXd du = uneven(x, size, 0.0);
      ASSERT_EQ(plain.evaluate(du), Outcome::ok);
      ASSERT_EQ(moved.evaluate(du), Outcome::ok);
      difference[at++] = (moved.f - plain.f).norm() / plain.f.norm();
    }
    EXPECT_LT(difference[1], 1e-5) << c.name;
    EXPECT_NEAR(std::log10(difference[0] / difference[1]) / 3.0, 1.0, 0.02) << c.name;
  }
}

// f = int tau . grad N of a homogeneous state is in balance with the Cauchy stress on the moved edges, where the pressure
// on them is that stress.
TEST(LargeStrain, AFollowingPressureBalancesAnEvenStress) {
  const auto law = hencky();
  for (const ElementCase& c : large_cases()) {
    if (c.axisymmetric() && make_large(c)->traits().reduced) continue;  // its rule is not exact for the forces
    Moving body(c, sample_shape(*c.entry), *law);
    body.move_to([&](const Vector2& x) -> Vector2 {
      return c.axisymmetric() ? Vector2(0.8 * x) : Vector2(turned_by(0.7) * (0.8 * x));
    });
    // Plane strain: the stress in the plane is even.  Rings: all of it.
    const double pressure = -body.stress(0)[0];
    ASSERT_GT(pressure, 0.0);
    for (std::size_t e = 0; e < body.element->edges().size(); ++e)
      body.run.edges.push_back({static_cast<int>(e), Vector2(pressure, pressure), Vector2::Zero()});
    ASSERT_EQ(body.run.evaluate(Eigen::VectorXd::Zero(body.run.u0.size())), Outcome::ok);
    Eigen::VectorXd dead = Eigen::VectorXd::Zero(body.run.u0.size());
    for (const EdgeTraction& load : body.run.edges)
      body.element->edge_load(body.run.x, load.edge, load.normal, load.shear,
                              {dead.data(), static_cast<std::size_t>(dead.size())});
    EXPECT_LT((body.run.f - dead).cwiseAbs().maxCoeff(), 1e-11 * dead.cwiseAbs().maxCoeff()) << c.name;
  }
}

TEST(LargeStrain, AnElementThatTurnsInsideOutCutsTheStep) {
  const auto law = hencky();
  for (const ElementCase& c : large_cases()) {
    Moving body(c, sample_shape(*c.entry), *law);
    Eigen::VectorXd du(body.run.u0.size());
    for (Eigen::Index i = 0; i < body.run.x.cols(); ++i) du.segment<2>(2 * i) << 0.0, -2.0 * body.run.x(1, i);
    EXPECT_EQ(body.run.evaluate(du), Outcome::cut_step) << c.name;
  }
}

}  // namespace
}  // namespace sage::test
