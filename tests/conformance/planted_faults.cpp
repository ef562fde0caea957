// Pieces with one fault each, over the suites: CTest expects each to fail in the test that is there for it.
#include <Eigen/LU>

#include "materials/linear_elastic.hpp"
#include "sage/conformance/sample_laws.hpp"
#include "sage/conformance/suites.hpp"
#include "tests/install/consumer/sparse_lu.hpp"
#include "tests/install/consumer/tri10.hpp"
#include "tests/support/offers_four.hpp"

namespace sage::conformance {
namespace {

// The shear term of the tangent has the wrong sign.
class WrongTangent final : public SolidLaw {
 public:
  LawTraits traits() const override { return {.symmetric = true}; }
  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override {
    const Outcome outcome = elastic_.update(in, out);
    out.D(3, 3) = -out.D(3, 3);
    return outcome;
  }

 private:
  LinearElastic elastic_{moduli_from_young(1e4, 0.3)};
};

enum class Forgotten { status, stress, none };

// Elastic; one field of the answer is left as it was.
template <Forgotten field>
class Forgetful : public SolidLaw {
 public:
  explicit Forgetful(double young = 1e4) : elastic_(moduli_from_young(young, 0.3)) {}
  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override {
    const PointOut<4> before = out;
    const Outcome outcome = elastic_.update(in, out);
    if (field == Forgotten::status) out.status = before.status;
    if (field == Forgotten::stress) out.sigma[2] = before.sigma[2];
    return outcome;
  }

 private:
  LinearElastic elastic_;
};

// Elastic, and at the apex everywhere.
class ApexEverywhere final : public SolidLaw {
 public:
  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override {
    const Outcome outcome = elastic_.update(in, out);
    out.status = PointStatus::apex;
    return outcome;
  }

 private:
  LinearElastic elastic_{moduli_from_young(1e4, 0.3)};
};

using OneByOne = Forgetful<Forgotten::none>;

// Answers the first four alone.
class FirstFourAlone final : public InFours<OneByOne> {
 public:
  Outcome update_four(std::span<const FourPointsIn<4>> in, std::span<FourPointsOut<4>> out) const override {
    return InFours<OneByOne>::update_four(in.first(1), out.first(1));
  }
};

// Answers up to eight fours.
class EightFoursAtMost final : public InFours<OneByOne> {
 public:
  Outcome update_four(std::span<const FourPointsIn<4>> in, std::span<FourPointsOut<4>> out) const override {
    const std::size_t fours = std::min(in.size(), std::size_t{8});
    return InFours<OneByOne>::update_four(in.first(fours), out.first(fours));
  }
};

// The fourth point always yields.
class WrongStatusInFours final : public InFours<OneByOne> {
 public:
  Outcome update_four(std::span<const FourPointsIn<4>> in, std::span<FourPointsOut<4>> out) const override {
    const Outcome outcome = InFours<OneByOne>::update_four(in, out);
    for (FourPointsOut<4>& four : out) four.status[3] = PointStatus::yielded;
    return outcome;
  }
};

ElementEntry too_large_for_four() {
  ElementEntry entry = own::tri10();
  entry.name = "too_large_for_four";
  entry.make = [make = entry.make](Geometry geometry, int formulation) -> std::unique_ptr<Element> {
    return std::make_unique<test::OffersFour>(make(geometry, formulation));
  };
  return entry;
}

// The derivative of the bubble in the middle is a tenth too large.
struct WrongDerivative : own::Tri10 {
  static Eigen::Matrix<double, 10, 2> dN(const ParentPoint& q) {
    Eigen::Matrix<double, 10, 2> dN = own::Tri10::dN(q);
    dN.row(9) *= 1.1;
    return dN;
  }
};

// Two shape functions have changed places.
struct WrongShape : own::Tri10 {
  static Vector<10> N(const ParentPoint& q) {
    Vector<10> N = own::Tri10::N(q);
    std::swap(N(3), N(4));
    return N;
  }
};

template <class Shape>
ElementEntry triangle(const std::string& name) {
  return element_entry(with_shape<Shape>({.name = name, .summary = name}),
                       {solid<Shape, Triangle12>({1, "twelve points", ""}, "planted")});
}

ElementEntry wrong_vtk_order() {
  ElementEntry entry = own::tri10();
  entry.name = "wrong_vtk_order";
  entry.vtk.nodes = {0, 1, 2, 4, 3, 5, 6, 7, 8, 9};
  return entry;
}

class Garbage final : public LinearSolver {
 public:
  const SolverTraits& traits() const override { return traits_; }
  void analyse(int, ElementEquations) override {}
  void clear() override {}
  void add(int, const double*) override {}
  void factorise() override {}
  SolveStatus solve(std::span<const double> b, std::span<double> x) const override {
    std::copy(b.begin(), b.end(), x.begin());
    return SolveStatus::ok;
  }

 private:
  SolverTraits traits_{.name = "garbage", .symmetric = false};
};

template <class PlantedLaw>
MaterialEntry planted_law(const std::string& name) {
  return {name, "planted", 4, {}, [](std::span<const double>, const UnitSystem&) {
            return LawPtr(std::make_unique<PlantedLaw>());
          }};
}

const Catalogue& planted() {
  static const Catalogue catalogue = [] {
    Catalogue c;
    c.materials.add(1, planted_law<WrongTangent>("wrong_tangent"));
    c.materials.add(2, planted_law<Forgetful<Forgotten::status>>("forgets_status"));
    c.materials.add(3, planted_law<Forgetful<Forgotten::stress>>("forgets_stress"));
    c.materials.add(4, planted_law<ApexEverywhere>("apex_everywhere"));
    c.materials.add(5, planted_law<FirstFourAlone>("first_four_alone"));
    c.materials.add(6, planted_law<EightFoursAtMost>("eight_fours_at_most"));
    c.materials.add(7, planted_law<WrongStatusInFours>("wrong_status_in_fours"));
    c.elements.add(1, triangle<WrongDerivative>("wrong_derivative"));
    c.elements.add(2, triangle<WrongShape>("wrong_shape"));
    c.elements.add(3, wrong_vtk_order());
    c.elements.add(4, too_large_for_four());
    c.solvers.add(1, {"garbage", "planted", false, [] { return std::make_unique<Garbage>(); }});
    return c;
  }();
  return catalogue;
}

INSTANTIATE_TEST_SUITE_P(Planted, Laws,
                         testing::ValuesIn(law_subjects(planted(), {{"wrong_tangent", 1},
                                                                    {"forgets_status", 2},
                                                                    {"forgets_stress", 3},
                                                                    {"apex_everywhere", 4},
                                                                    {"first_four_alone", 5},
                                                                    {"eight_fours_at_most", 6},
                                                                    {"wrong_status_in_fours", 7}})),
                         name_of_law);
INSTANTIATE_TEST_SUITE_P(Planted, Elements,
                         testing::Values(ElementSubject{"wrong_derivative", &planted(), {1}},
                                         ElementSubject{"wrong_shape", &planted(), {2}},
                                         ElementSubject{"wrong_vtk_order", &planted(), {3}},
                                         ElementSubject{"too_large_for_four", &planted(), {4}}),
                         name_of_elements);
INSTANTIATE_TEST_SUITE_P(Planted, Solvers, testing::ValuesIn(solver_subjects(planted())), name_of_solver);

}  // namespace
}  // namespace sage::conformance
