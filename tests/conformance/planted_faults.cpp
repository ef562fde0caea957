// Pieces with one fault each, over the suites: CTest expects each to fail in the test that is there for it.
#include <Eigen/LU>

#include "materials/linear_elastic.hpp"
#include "sage/conformance/element_suite.hpp"
#include "sage/conformance/law_suite.hpp"
#include "sage/conformance/solver_suite.hpp"
#include "tests/install/consumer/sparse_lu.hpp"
#include "tests/install/consumer/tri10.hpp"

namespace sage::conformance {
namespace {

// The shear term of the tangent has the wrong sign.
class WrongTangent final : public SolidLaw {
 public:
  bool symmetric() const override { return true; }
  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override {
    const Outcome outcome = elastic_.update(in, out);
    out.D(3, 3) = -out.D(3, 3);
    return outcome;
  }

 private:
  LinearElastic elastic_{moduli_from_young(1e4, 0.3)};
};

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
  void solve(std::span<const double> b, std::span<double> x) const override {
    std::copy(b.begin(), b.end(), x.begin());
  }

 private:
  SolverTraits traits_{.name = "garbage", .symmetric = false};
};

const Catalogue& planted() {
  static const Catalogue catalogue = [] {
    Catalogue c;
    c.materials.add(1, {"wrong_tangent", "planted", 4, {}, [](std::span<const double>, const UnitSystem&) {
                          return LawPtr(std::make_unique<WrongTangent>());
                        }});
    c.elements.add(1, triangle<WrongDerivative>("wrong_derivative"));
    c.elements.add(2, triangle<WrongShape>("wrong_shape"));
    c.elements.add(3, wrong_vtk_order());
    c.solvers.add(1, {"garbage", "planted", false, [] { return std::make_unique<Garbage>(); }});
    return c;
  }();
  return catalogue;
}

INSTANTIATE_TEST_SUITE_P(Planted, Laws, testing::ValuesIn(law_subjects(planted(), {{"wrong_tangent", 1}})),
                         name_of_law);
INSTANTIATE_TEST_SUITE_P(Planted, Elements,
                         testing::Values(ElementSubject{"wrong_derivative", &planted(), {1}},
                                         ElementSubject{"wrong_shape", &planted(), {2}},
                                         ElementSubject{"wrong_vtk_order", &planted(), {3}}),
                         name_of_elements);
INSTANTIATE_TEST_SUITE_P(Planted, Solvers, testing::ValuesIn(solver_subjects(planted())), name_of_solver);

}  // namespace
}  // namespace sage::conformance
