// What every law, element and solver must satisfy, as suites of GoogleTest for pieces in and out of the tree.  They are
// compiled in the library sagefe::suites; a test program runs them over its pieces (materials/, elements/ and
// solvers/README.md):
//   using sage::conformance::Laws;
//   INSTANTIATE_TEST_SUITE_P(Mine, Laws, testing::ValuesIn(sage::conformance::law_subjects(catalogue, samples)),
//                            sage::conformance::name_of_law);
//   using sage::conformance::Elements;
//   INSTANTIATE_TEST_SUITE_P(Mine, Elements,
//                            testing::Values(sage::conformance::ElementSubject{"tri10", &catalogue, {40}}),
//                            sage::conformance::name_of_elements);
//   using sage::conformance::Solvers;
//   INSTANTIATE_TEST_SUITE_P(Mine, Solvers, testing::ValuesIn(sage::conformance::solver_subjects(catalogue, {90})),
//                            sage::conformance::name_of_solver);
#pragma once

#include <gtest/gtest.h>

#include <iosfwd>
#include <string>
#include <variant>
#include <vector>

#include "sage/conformance/element_cases.hpp"
#include "sage/conformance/law_driver.hpp"
#include "sage/conformance/law_sample.hpp"
#include "sage/core/catalogue.hpp"
#include "sage/messages/error.hpp"

namespace sage::conformance {

struct System;

// The catalogue must outlive the tests.
struct LawSubject {
  const Catalogue* catalogue;
  LawSample sample;
};

// Of the library: a program that runs a suite links its cases with these.
void PrintTo(const LawSubject& subject, std::ostream* out);
std::string name_of_law(const testing::TestParamInfo<LawSubject>& info);
std::vector<LawSubject> law_subjects(const Catalogue& catalogue, const std::vector<LawSample>& samples);

class Laws : public testing::TestWithParam<LawSubject> {
 protected:
  static const LawSample& sample() { return GetParam().sample; }
  static const MaterialEntry& entry() { return *GetParam().catalogue->materials.find(sample().code); }

  // Runs `check` with the law of this sample, whatever its size.
  template <class Check>
  static void with_law(const Check& check, const std::vector<double>& values, const UnitSystem& units) {
    const LawPtr law = entry().make(values, units);
    std::visit([&](const auto& p) { check(*p); }, law);
  }
  template <class Check>
  static void with_law(const Check& check) {
    with_law(check, sample().values, kpa_units());
  }
};

// Elements of a catalogue, which must outlive the tests.
struct ElementSubject {
  std::string what;  // letters, digits and _
  const Catalogue* catalogue;
  std::vector<int> codes = {};  // empty: all
};

void PrintTo(const ElementSubject& subject, std::ostream* out);
std::string name_of_elements(const testing::TestParamInfo<ElementSubject>& info);

class Elements : public testing::TestWithParam<ElementSubject> {
 protected:
  static const Catalogue& catalogue() { return *GetParam().catalogue; }
  static std::vector<ElementCase> all_cases() { return element_cases(catalogue(), GetParam().codes); }
  static bool moves(const ElementCase& c) { return c.make()->traits().sees_coordinates; }
  // Those that solve for displacements alone, with strains linear in them: the tests know what such a one has to answer.
  static std::vector<ElementCase> cases();
  // Those that recompute their geometry as they move.
  static std::vector<ElementCase> moving_cases();
  static std::vector<ElementCase> solid_cases() { return of_kind(ElementKind::solid, cases()); }
  static std::vector<ElementCase> interface_cases() { return of_kind(ElementKind::interface, cases()); }
  static std::vector<ElementCase> structure_cases() { return of_kind(ElementKind::structure, cases()); }
  // Structures whose only unknowns are displacements and rotations (UnknownField::turns).
  static std::vector<ElementCase> turning_cases();
  static std::vector<ElementEntry> entries();
  // One that an element can be in.
  static Geometry geometry_of(const ElementEntry& entry);
};

// A solver of a catalogue, which must outlive the tests.
struct SolverSubject {
  const Catalogue* catalogue;
  int code;
  const SolverEntry& entry() const { return *catalogue->solvers.find(code); }
};

void PrintTo(const SolverSubject& subject, std::ostream* out);
std::string name_of_solver(const testing::TestParamInfo<SolverSubject>& info);
// Those with these codes or, where there are none, all.
std::vector<SolverSubject> solver_subjects(const Catalogue& catalogue, const std::vector<int>& codes = {});

class Solvers : public testing::TestWithParam<SolverSubject> {
 protected:
  static const SolverEntry& entry() { return GetParam().entry(); }
  static std::unique_ptr<LinearSolver> make() { return entry().make(); }
  static bool symmetric() { return entry().symmetric; }
  static Eigen::VectorXd solve(const LinearSolver& solver, Eigen::VectorXd b);
  static void expect_solved(const Eigen::MatrixXd& K, const Eigen::VectorXd& x, const Eigen::VectorXd& b);
  static void expect_answer(const System& system);
  static SingularMatrix singular(const System& system);
};

}  // namespace sage::conformance
