// What every element must satisfy, whatever its shape, rule or geometry: sage/conformance/suites.hpp.
#include "sage/conformance/suites.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <ostream>
#include <set>
#include <utility>

#include "materials/linear_elastic.hpp"
#include "sage/conformance/element_cases.hpp"
#include "sage/conformance/law_driver.hpp"
#include "sage/conformance/patch.hpp"
#include "sage/conformance/sample_laws.hpp"
#include "sage/core/four_at_a_time.hpp"

namespace sage::conformance {

void PrintTo(const ElementSubject& subject, std::ostream* out) {
  *out << subject.what;
}
std::string name_of_elements(const testing::TestParamInfo<ElementSubject>& info) {
  return info.param.what;
}

Geometry Elements::geometry_of(const ElementEntry& entry) {
  for (const ElementCase& c : all_cases())
    if (c.entry->name == entry.name) return c.geometry;
  return Geometry::plane_strain;
}

std::vector<ElementCase> Elements::cases() {
  std::vector<ElementCase> found = all_cases();
  std::erase_if(found, [](const ElementCase& c) { return !c.entry->unknowns.empty() || moves(c); });
  return found;
}

std::vector<ElementCase> Elements::moving_cases() {
  std::vector<ElementCase> found = all_cases();
  std::erase_if(found, [](const ElementCase& c) { return !c.entry->unknowns.empty() || !moves(c); });
  return found;
}

std::vector<ElementCase> Elements::turning_cases() {
  std::vector<ElementCase> found = of_kind(ElementKind::structure, all_cases());
  std::erase_if(found, [](const ElementCase& c) {
    return c.entry->unknowns.empty() || std::ranges::any_of(c.entry->unknowns, [](const ElementUnknown& u) {
             return !u.field.displacement() && !u.field.turns;
           });
  });
  return found;
}

std::vector<ElementEntry> Elements::entries() {
  std::vector<ElementEntry> found;
  for (const ElementCase& c : all_cases())
    if (found.empty() || found.back().name != c.entry->name) found.push_back(*c.entry);
  return found;
}

namespace {

// A displacement without any symmetry.
Eigen::VectorXd wavy(int dofs, double size) {
  Eigen::VectorXd u(dofs);
  for (int i = 0; i < dofs; ++i) u(i) = size * std::sin(1.3 * i * i + 0.7 * i + 0.4);
  return u;
}

// One law of each size, for elements of every kind.
template <class Solid, class Interface, template <int> class Structure>
struct LawsOfAllSizes {
  Solid solid;
  Interface interface;
  Structure<1> one;
  Structure<3> three;
  Structure<5> five;
  LawRef of(const ElementCase& c) const {
    switch (c.entry->law_size) {
      case 1:
        return static_cast<const Law<1>*>(&one);
      case 2:
        return static_cast<const InterfaceLaw*>(&interface);
      case 3:
        return static_cast<const Law<3>*>(&three);
      case 5:
        return static_cast<const Law<5>*>(&five);
      default:
        return static_cast<const SolidLaw*>(&solid);
    }
  }
};

template <int N>
LinearLaw<N> section_law() {
  Matrix<N> D = Matrix<N>::Zero();
  for (int i = 0; i < N; ++i) D(i, i) = 1000.0 / (i + 1);
  return LinearLaw<N>(D);
}

struct ElasticLaws : LawsOfAllSizes<LinearElastic, LinearLaw<2>, LinearLaw> {
  ElasticLaws()
      : LawsOfAllSizes{LinearElastic(moduli_from_young(1000.0, 0.3)), interface_law(300.0, 2000.0),
                       section_law<1>(), section_law<3>(), section_law<5>()} {}
};

// Refuse an increment with a component beyond `limit`.
struct SmoothLaws : LawsOfAllSizes<SmoothLaw<4>, SmoothLaw<2>, SmoothLaw> {
  explicit SmoothLaws(double limit = 1e9)
      : LawsOfAllSizes{SmoothLaw<4>(limit), SmoothLaw<2>(limit), SmoothLaw<1>(limit), SmoothLaw<3>(limit),
                       SmoothLaw<5>(limit)} {}
};

// Of the unknowns that the entry lists.
int dofs_of(const ElementEntry& entry) {
  if (entry.unknowns.empty()) return 2 * entry.nodes;
  int dofs = 0;
  for (const ElementUnknown& unknown : entry.unknowns) {
    const int nodes = unknown.nodes.empty() ? entry.nodes : static_cast<int>(unknown.nodes.size());
    dofs += nodes * unknown.field.components();
  }
  return dofs;
}

TEST_P(Elements, DefaultIsTheFirstFormulation) {
  for (const ElementEntry& entry : entries()) {
    const Geometry geometry = geometry_of(entry);
    const auto by_zero = entry.make(geometry, 0);
    const auto by_code = entry.make(geometry, entry.formulations.front().code);
    EXPECT_EQ(by_zero->traits().name, by_code->traits().name);
    EXPECT_FALSE(entry.summary.empty());
  }
}

// What the entry says in place of the element: corners first, N_i = 1 at node i and 0 at the others.
TEST_P(Elements, ParentNodesAreThoseOfTheShapeFunctions) {
  for (const ElementCase& c : solid_cases()) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    const auto n = static_cast<std::size_t>(c.entry->nodes);
    ASSERT_EQ(c.entry->parent_nodes.size(), n);
    EXPECT_EQ(c.entry->corners, c.entry->triangle() ? 3 : 4);
    EXPECT_EQ(element->edges().size(), static_cast<std::size_t>(c.entry->corners));
    const std::vector<std::array<double, 2>> corners =
        c.entry->triangle() ? std::vector<std::array<double, 2>>{{0, 0}, {1, 0}, {0, 1}}
                            : std::vector<std::array<double, 2>>{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    for (std::size_t i = 0; i < corners.size(); ++i) EXPECT_EQ(c.entry->parent_nodes[i], corners[i]);
    std::vector<double> N(n), dN(2 * n);
    for (std::size_t i = 0; i < n; ++i) {
      const auto& [xi, eta] = c.entry->parent_nodes[i];
      ASSERT_TRUE(element->shape_functions({xi, eta}, N, dN));
      for (std::size_t j = 0; j < n; ++j) EXPECT_NEAR(N[j], i == j ? 1.0 : 0.0, 1e-12);
    }
  }
}

// Place of node i of VTK's cell types in the parent shape, from VTK's file formats: corners, sides, inner
// nodes. Its Lagrange quadrilateral (70) runs the third side from corner 3 to 2 and the fourth from corner 0 to
// 3, and counts equal steps where our nodes of high degree stand at Gauss-Lobatto points.
std::vector<std::array<double, 2>> vtk_places(const ElementEntry& entry) {
  if (entry.vtk.type == 1) return {{0.0, 0.0}};  // a vertex
  if (entry.shape == ParentShape::line) {        // ends, then the inner nodes from the first to the second
    std::vector<std::array<double, 2>> at{{-1.0, 0.0}, {1.0, 0.0}};
    for (int i = 1; i < entry.nodes - 1; ++i) at.push_back({-1.0 + 2.0 * i / (entry.nodes - 1), 0.0});
    return at;
  }
  const bool triangle = entry.triangle();
  std::vector<std::array<double, 2>> at(entry.parent_nodes.begin(), entry.parent_nodes.begin() + entry.corners);
  const auto corner = at;
  const int nodes = entry.nodes, corners = entry.corners;
  int p = 1;
  while ((triangle ? (p + 1) * (p + 2) / 2 : (p + 1) * (p + 1)) < nodes) ++p;
  const auto add = [&](std::size_t a, std::size_t z, double t) {
    at.push_back(
        {corner[a][0] + t * (corner[z][0] - corner[a][0]), corner[a][1] + t * (corner[z][1] - corner[a][1])});
  };
  for (int side = 0; side < corners; ++side) {
    auto a = static_cast<std::size_t>(side), z = static_cast<std::size_t>((side + 1) % corners);
    if (!triangle && side >= 2) std::swap(a, z);
    for (int i = 1; i < p; ++i) add(a, z, static_cast<double>(i) / p);
  }
  for (int j = 1; j < p; ++j)
    for (int i = 1; i < p - (triangle ? j : 0); ++i) {
      const double x = static_cast<double>(i) / p, y = static_cast<double>(j) / p;
      at.push_back(triangle ? std::array{x, y} : std::array{2 * x - 1, 2 * y - 1});
    }
  at.resize(nodes);  // the serendipity quadrilateral has none inside
  return at;
}

// Up to degree 8 Gauss-Lobatto points lie within 0.18 of equal steps, which two exchanged ones do not.
TEST_P(Elements, VtkCountsTheirNodesAsTheEntrySays) {
  const std::set<int> known{0, 1, 3, 5, 9, 21, 22, 23, 28, 68, 69, 70};
  for (const ElementEntry& entry : entries()) {
    SCOPED_TRACE(entry.name);
    ASSERT_EQ(known.count(entry.vtk.type), 1u) << "add VTK's order of type " << entry.vtk.type;
    if (entry.interface() || entry.vtk.type == 0) continue;
    const double near = entry.makes_nodes() ? 0.18 : 1e-12;
    const std::vector<std::array<double, 2>> wanted = vtk_places(entry);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const std::size_t local = entry.vtk.nodes.empty() ? i : static_cast<std::size_t>(entry.vtk.nodes[i]);
      const auto& at = entry.parent_nodes[local];
      EXPECT_NEAR(at[0], wanted[i][0], near) << i;
      EXPECT_NEAR(at[1], wanted[i][1], near) << i;
    }
  }
}

TEST_P(Elements, WhatTheEntryNamesExists) {
  const Registry<ElementEntry>& elements = catalogue().elements;
  for (const ElementEntry& entry : entries()) {
    SCOPED_TRACE(entry.name);
    for (const auto* order : {&entry.vtk.nodes, &entry.gmsh.nodes, &entry.calculix.nodes}) {
      const std::set<int> distinct(order->begin(), order->end());
      EXPECT_EQ(distinct.size(), order->size());
      EXPECT_TRUE(order->empty() || *distinct.rbegin() < entry.nodes);
    }
    EXPECT_GE(entry.card_nodes, entry.corners);
    EXPECT_LE(entry.card_nodes, entry.nodes);
    for (const Formulation& f : entry.formulations)
      EXPECT_EQ(f.points, entry.make(geometry_of(entry), f.code)->traits().points) << f.name;
    EXPECT_TRUE(entry.folded.empty() || elements.code_of(entry.folded) != 0);
    if (entry.side_interface.empty()) continue;
    const ElementEntry* beside = elements.find(elements.code_of(entry.side_interface));
    ASSERT_NE(beside, nullptr);
    EXPECT_TRUE(beside->interface());
    EXPECT_EQ(beside->make(Geometry::plane_strain, 0)->edges().front().size(),
              entry.make(Geometry::plane_strain, 0)->edges().front().size());
  }
}

TEST_P(Elements, TraitsAgreeWithTheEntry) {
  std::set<std::pair<std::string_view, Geometry>> names;
  for (const ElementCase& c : all_cases()) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    const ElementTraits& t = element->traits();
    EXPECT_EQ(t.nodes, c.entry->nodes);
    EXPECT_EQ(t.dofs, dofs_of(*c.entry));
    EXPECT_EQ(t.law_size, c.entry->law_size);
    EXPECT_EQ(t.geometry, c.geometry);
    names.emplace(t.name, t.geometry);
  }
  EXPECT_EQ(names.size(), all_cases().size());
}

// An element that solves for a strain of its own keeps behind its points what it needs for that.
bool has_own_strain(const Element& element) {
  return element.traits().own_doubles > 0;
}

// K = df/du by central differences with a nonlinear unsymmetric law, from a state with stress, strain and
// history. f is quadratic in u, so the differences are exact but for rounding: 1e-16 |f| / 1e-4 = 1e-12 |K|.
// Of an element with a strain of its own f is no polynomial: smaller differences, 1e-7.
TEST_P(Elements, StiffnessIsTheDerivativeOfTheForce) {
  const SmoothLaws laws;
  for (const ElementCase& c : cases()) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    ElementRun run(*element, sample_shape_curved(*c.entry), laws.of(c));
    for (std::size_t i = 0; i < run.sigma0.size(); ++i) run.sigma0[i] = 5.0 * std::cos(static_cast<double>(i));
    const bool own = has_own_strain(*element);
    const Eigen::VectorXd u = wavy(element->traits().dofs, own ? 0.05 : 0.5);
    ASSERT_EQ(run.evaluate(u), Outcome::ok);
    const Eigen::MatrixXd K = run.K;
    if (c.entry->law_size > 1) {
      EXPECT_GT((K - K.transpose()).norm(), 1e-3 * K.norm()) << "the law is unsymmetric and so must be K";
    }
    EXPECT_LT(own ? tangent_error(run, u, 1e-5) : tangent_error(run, u), own ? 1e-7 : 1e-10);
  }
}

// Trial stress, strain and history of each point come from that point's committed values.  A strain of the element's own
// is part of the trial strain, and does no work on the stress that the increment adds: the strains B du do all of it.
TEST_P(Elements, EachPointGetsItsOwnState) {
  const SmoothLaws laws;
  for (const ElementCase& c : cases()) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    const ElementTraits& t = element->traits();
    ElementRun run(*element, sample_shape(*c.entry), laws.of(c));
    for (std::size_t i = 0; i < run.sigma0.size(); ++i) {
      run.sigma0[i] = 10.0 + static_cast<double>(i);
      run.eps0[i] = -0.01 * static_cast<double>(i);
    }
    for (std::size_t i = 0; i < run.h0.size(); ++i) run.h0[i] = 100.0 * static_cast<double>(i);
    const Eigen::VectorXd u = wavy(t.dofs, 0.1);
    ASSERT_EQ(run.evaluate(u), Outcome::ok);
    Eigen::VectorXd f = Eigen::VectorXd::Zero(t.dofs);
    double own_work = 0.0, size = 0.0;
    for (int p = 0; p < t.points; ++p) {
      const auto first = static_cast<std::size_t>(p * t.law_size);
      const auto of_point = [&](const std::vector<double>& v) {
        return Eigen::Map<const Eigen::VectorXd>(v.data() + first, t.law_size);
      };
      const Eigen::VectorXd deps = of_point(run.eps1) - of_point(run.eps0);
      const Eigen::VectorXd own = deps - run.B(p) * u, added = of_point(run.sigma1) - of_point(run.sigma0);
      if (!has_own_strain(*element)) {
        EXPECT_LT(own.cwiseAbs().maxCoeff(), 1e-13);
      }
      own_work += run.weight(p) * own.dot(added);
      size += run.weight(p) * own.norm() * added.norm();
      const auto h = static_cast<std::size_t>(run.history_size() * p);
      EXPECT_NEAR(run.h1[h], run.h0[h] + deps.sum(), 1e-12 * (1.0 + run.h0[h]));
      EXPECT_EQ(run.h1[h + 1], run.h0[h + 1] + 1.0);
      EXPECT_EQ(run.status[p], PointStatus::yielded);
      f += run.weight(p) * run.B(p).transpose() *
           Eigen::Map<const Eigen::VectorXd>(run.sigma1.data() + first, t.law_size);
    }
    EXPECT_LT((f - run.f).norm(), 1e-12 * f.norm());
    if (!has_own_strain(*element)) continue;
    EXPECT_GT(size, 1e-6 * f.norm() * u.norm()) << "it has a strain of its own";
    EXPECT_LE(std::abs(own_work), 1e-11 * size);
  }
}

// Four elements and their arrays side by side.
struct FourRuns {
  std::vector<ElementRun> runs;
  std::vector<double> geometry, du;
  FourElementsIn in;
  FourElementsOut out;

  // The last place is the third element again, as at the end of a group.
  FourRuns(const FourElements& element, const FourPointLaw<4>& law, std::vector<ElementRun> three,
           const std::vector<Eigen::VectorXd>& u)
      : runs(std::move(three)) {
    const std::size_t dofs = static_cast<std::size_t>(u[0].size());
    geometry.resize(kAbreast * static_cast<std::size_t>(element.four_geometry_size()));
    du.resize(kAbreast * dofs);
    for (std::size_t l = 0; l < kAbreast; ++l) {
      const std::size_t place = std::min(l, std::size_t{2});
      ElementRun& run = runs[place];
      run.K.setZero(u[0].size(), u[0].size());
      run.f.setZero(u[0].size());
      element.place_among_four(run.geometry, geometry.data() + l);
      for (std::size_t i = 0; i < dofs; ++i) du[i * kAbreast + l] = u[place](static_cast<int>(i));
      in.sigma0[l] = run.sigma0.data();
      in.eps0[l] = run.eps0.data();
      in.h0[l] = run.h0.data();
      out.K[l] = run.K.data();
      out.f[l] = run.f.data();
      out.sigma1[l] = run.sigma1.data();
      out.eps1[l] = run.eps1.data();
      out.h1[l] = run.h1.data();
      out.status[l] = run.status.data();
    }
    in.geometry = geometry.data();
    in.du = du.data();
    in.law = &law;
    in.history = history_of(runs[0].law).size();
  }
};

// Three elements of a case under the increments u that are made for them.
template <class Law>
FourRuns four_runs(const ElementCase& c, const Element& element, const FourElements& fours, const Law& law,
                   std::vector<Eigen::VectorXd>& u) {
  std::vector<ElementRun> three;
  for (int l = 0; l < 3; ++l) {
    ElementRun& run = three.emplace_back(element, (1.0 + 0.3 * l) * sample_shape(*c.entry),
                                         static_cast<const SolidLaw*>(&law));
    for (std::size_t i = 0; i < run.sigma0.size(); ++i) {
      run.sigma0[i] = 10.0 * l + std::sin(static_cast<double>(i));
      run.eps0[i] = 0.01 * (l - std::cos(static_cast<double>(i)));
    }
    for (std::size_t i = 0; i < run.h0.size(); ++i) run.h0[i] = 100.0 * l + static_cast<double>(i);
    u.push_back((1.0 - 0.2 * l) * wavy(element.traits().dofs, 0.1));
  }
  return {fours, law, std::move(three), u};
}

// check(fours, four, u) for every case whose element is FourElements.  The law is a FourPointLaw too.
template <class Law, class Check>
void check_fours(const std::vector<ElementCase>& cases, const Law& law, const Check& check) {
  for (const ElementCase& c : cases) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    const auto* const fours = dynamic_cast<const FourElements*>(element.get());
    if (fours == nullptr) continue;
    std::vector<Eigen::VectorXd> u;
    FourRuns four = four_runs(c, *element, *fours, law, u);
    check(*fours, four, u);
  }
}

// Callers and laws have room for so many dofs and points.
TEST_P(Elements, FourAtOnceOnlyWhereThereIsRoom) {
  for (const ElementCase& c : all_cases()) {
    const auto element = c.make();
    if (dynamic_cast<const FourElements*>(element.get()) != nullptr) {
      EXPECT_TRUE(four_may_go_together(element->traits())) << c.name;
    }
  }
}

// A law that leaves its status out must not hand on that of the point before.
TEST_P(Elements, NoPointHasTheStatusOfAnother) {
  for (const ElementCase& c : cases()) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    const int points = element->traits().points;
    std::vector<PointContext> contexts(static_cast<std::size_t>(points));
    for (int p = 0; p < points; ++p) contexts[p].point = p;
    std::visit(
        [&]<int N>(const Law<N>*) {
          const SilentLaw<N> law;
          ElementRun run(*element, sample_shape(*c.entry), static_cast<const Law<N>*>(&law));
          run.contexts = contexts.data();
          ASSERT_EQ(run.evaluate(Eigen::VectorXd::Zero(element->traits().dofs)), Outcome::ok);
          for (int p = 0; p < points; ++p)
            EXPECT_EQ(run.status[p], p == 0 ? PointStatus::yielded : PointStatus::elastic);
        },
        ElasticLaws().of(c));
  }
}

// Against one by one.  Compilers round sums of products once or twice as they like: fewer than a hundred terms,
// 1e-13.
TEST_P(Elements, FourAtOnceAreAsOneByOne) {
  const InFours<SmoothLaw<4>> law;
  check_fours(cases(), law,
              [](const FourElements& element, FourRuns& four, const std::vector<Eigen::VectorXd>& u) {
                ASSERT_EQ(element.evaluate_four(four.in, four.out), Outcome::ok);
                for (std::size_t l = 0; l < 3; ++l) {
                  const ElementRun& run = four.runs[l];
                  ElementRun one = run;
                  ASSERT_EQ(one.evaluate(u[l]), Outcome::ok);
                  EXPECT_LE((run.K - one.K).norm(), 1e-13 * one.K.norm());
                  EXPECT_LE((run.f - one.f).norm(), 1e-13 * one.f.norm());
                  EXPECT_EQ(run.status, one.status);
                  for (std::size_t i = 0; i < one.sigma1.size(); ++i) {
                    EXPECT_NEAR(run.sigma1[i], one.sigma1[i], 1e-13 * (100.0 + std::abs(one.sigma1[i])));
                    EXPECT_NEAR(run.eps1[i], one.eps1[i], 1e-13);
                  }
                  for (std::size_t i = 0; i < one.h1.size(); ++i)
                    EXPECT_NEAR(run.h1[i], one.h1[i], 1e-13 * (1.0 + std::abs(one.h1[i])));
                }
              });
}

// Whether a matrix changed is seen to the bit, in every term; matrices that nobody wants are left alone.
TEST_P(Elements, FourAtOnceSeeWhatChanged) {
  const InFours<SmoothLaw<4>> law, fussy(1e-9);
  check_fours(cases(), law, [&](const FourElements& element, FourRuns& four, const auto& /*u*/) {
    element.evaluate_four(four.in, four.out);
    EXPECT_TRUE(four.out.changed);
    four.out.changed = false;
    element.evaluate_four(four.in, four.out);
    EXPECT_FALSE(four.out.changed) << "the same again";
    const Eigen::MatrixXd K = four.runs[1].K;
    for (int i = 0; i < K.size(); ++i) {
      double& term = four.runs[1].K(i);
      term = std::nextafter(term, 1e300);
      element.evaluate_four(four.in, four.out);
      EXPECT_TRUE(four.out.changed) << "term " << i;
      four.out.changed = false;
      EXPECT_EQ(term, K(i));
    }
    four.runs[1].K.setZero();
    four.out.K.fill(nullptr);
    EXPECT_EQ(element.evaluate_four(four.in, four.out), Outcome::ok);
    EXPECT_FALSE(four.out.changed);
    EXPECT_TRUE(four.runs[1].K.isZero(0.0));
    four.in.law = &fussy;
    EXPECT_EQ(element.evaluate_four(four.in, four.out), Outcome::cut_step);
  });
}

// Where a law says that its D is the constant one, and what stands there was made of it, nothing is written; in all
// other cases everything is.
TEST_P(Elements, FourAtOnceLeaveMatricesOfAConstantDAlone) {
  const InFours<SmoothLaw<4>> changing(1e9, false), constant(1e9, true);
  check_fours(cases(), changing, [&](const FourElements& element, FourRuns& four, const auto& /*u*/) {
    const auto K_after = [&](const FourPointLaw<4>& law, bool stands) {
      four.in.law = &law;
      four.out.constant = stands;
      for (ElementRun& run : four.runs) run.K.setConstant(7.0);
      EXPECT_EQ(element.evaluate_four(four.in, four.out), Outcome::ok);
      EXPECT_EQ(four.out.constant, &law == &constant);
      return four.runs[1].K;
    };
    const Eigen::MatrixXd K = K_after(changing, false);
    EXPECT_GT((K.array() - 7.0).abs().maxCoeff(), 0.0);
    EXPECT_EQ(K_after(changing, true), K);
    EXPECT_EQ(K_after(constant, false), K);
    EXPECT_TRUE((K_after(constant, true).array() == 7.0).all());
  });
}

TEST_P(Elements, NoIncrementGivesBackTheCommittedStress) {
  const ElasticLaws laws;
  for (const ElementCase& c : cases()) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    ElementRun run(*element, sample_shape(*c.entry), laws.of(c));
    for (std::size_t i = 0; i < run.sigma0.size(); ++i) run.sigma0[i] = 3.0 + static_cast<double>(i);
    run.evaluate(Eigen::VectorXd::Zero(element->traits().dofs));
    EXPECT_EQ(run.sigma1, run.sigma0);
  }
}

TEST_P(Elements, ALawThatRefusesCutsTheStep) {
  const SmoothLaws laws(1e-6);
  for (const ElementCase& c : cases()) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    ElementRun run(*element, sample_shape(*c.entry), laws.of(c));
    EXPECT_EQ(run.evaluate(wavy(element->traits().dofs, 1.0)), Outcome::cut_step);
    EXPECT_EQ(run.evaluate(Eigen::VectorXd::Zero(element->traits().dofs)), Outcome::ok);
  }
}

TEST_P(Elements, SymmetricLawGivesSymmetricStiffness) {
  const ElasticLaws laws;
  for (const ElementCase& c : cases()) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    ElementRun run(*element, sample_shape_curved(*c.entry), laws.of(c));
    run.evaluate(wavy(element->traits().dofs, 0.01));
    EXPECT_LT((run.K - run.K.transpose()).norm(), 1e-14 * run.K.norm());
  }
}

// Columns: translations in x and y and a rotation about the origin; axisymmetric:
// translation along the axis only.
Eigen::MatrixXd rigid_motions(const ElementCase& c, const Eigen::Matrix2Xd& x) {
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(2 * x.cols(), c.axisymmetric() ? 1 : 3);
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    if (c.axisymmetric()) {
      u(2 * i + 1, 0) = 1.0;
    } else {
      u.block<2, 3>(2 * i, 0) << 1.0, 0.0, -x(1, i), 0.0, 1.0, x(0, i);
    }
  }
  return u;
}

// Patch P6.  A common motion of both faces is rigid for an interface too, also when axisymmetric.
TEST_P(Elements, RigidMotionsGiveNoForce) {
  const ElasticLaws laws;
  for (const ElementCase& c : cases()) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    for (const auto& x :
         {sample_shape(*c.entry), sample_shape_curved(*c.entry), sample_shape_on_axis(*c.entry)}) {
      ElementRun run(*element, x, laws.of(c));
      const Eigen::MatrixXd rigid = rigid_motions(c, x);
      run.evaluate(rigid.col(0));
      EXPECT_LT((run.K * rigid).norm(), 1e-13 * run.K.norm() * rigid.norm());
      EXPECT_LT(run.f.norm(), 1e-13 * run.K.norm() * rigid.norm());
    }
  }
}

// Rigid motions of an element that turns, in the order of its dofs.
Eigen::MatrixXd rigid_motions_with_turning(const ElementCase& c, const Eigen::Matrix2Xd& x) {
  const Eigen::MatrixXd moved = rigid_motions(c, x);
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(dofs_of(*c.entry), moved.cols());
  Eigen::Index dof = 0;
  for (const ElementUnknown& unknown : c.entry->unknowns) {
    const Eigen::Index nodes =
        unknown.nodes.empty() ? c.entry->nodes : static_cast<Eigen::Index>(unknown.nodes.size());
    for (Eigen::Index i = 0; i < nodes; ++i) {
      const Eigen::Index node = unknown.nodes.empty() ? i : unknown.nodes[i];
      if (unknown.field.displacement()) {
        u.middleRows<2>(dof) = moved.middleRows<2>(2 * node);
        dof += 2;
      } else {
        if (!c.axisymmetric()) u(dof, 2) = 1.0;  // counter-clockwise
        ++dof;
      }
    }
  }
  return u;
}

// Beams and shells: rigid motions are free, every other motion is resisted, and what is resisted is symmetric where
// the law is.  A structure of one node resists the difference of its two rotations alone.
TEST_P(Elements, TurningStructuresResistAllButRigidMotions) {
  const ElasticLaws laws;
  for (const ElementCase& c : turning_cases()) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    for (const auto& x : {sample_shape(*c.entry), sample_shape_curved(*c.entry)}) {
      ElementRun run(*element, x, laws.of(c));
      const Eigen::MatrixXd rigid = rigid_motions_with_turning(c, x);
      run.evaluate(rigid.col(0));
      EXPECT_LT((run.K * rigid).norm(), 1e-13 * run.K.norm() * rigid.norm());
      EXPECT_LT(run.f.norm(), 1e-13 * run.K.norm() * rigid.norm());
      EXPECT_LT((run.K - run.K.transpose()).norm(), 1e-14 * run.K.norm());
      const Eigen::VectorXd stiffness = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(run.K).eigenvalues();
      const Eigen::Index resisted = (stiffness.array() > 1e-9 * stiffness.maxCoeff()).count();
      EXPECT_EQ(resisted, c.entry->nodes < 2 ? 1 : element->traits().dofs - rigid.cols());
    }
  }
}

// From a state with stress, strain and history, under a nonlinear unsymmetric law.  1e-7: an element that solves for
// unknowns of its own has a force that is no polynomial of the second degree.
TEST_P(Elements, TurningStructuresHaveTheDerivativeOfTheirForce) {
  const SmoothLaws laws;
  for (const ElementCase& c : turning_cases()) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    ElementRun run(*element, sample_shape_curved(*c.entry), laws.of(c));
    const Eigen::VectorXd u = wavy(element->traits().dofs, 0.01);
    ASSERT_EQ(run.evaluate(u), Outcome::ok);
    EXPECT_LT(tangent_error(run, u, 1e-5), 1e-7);
  }
}

// The same of elements that recompute their geometry, from a state that has moved.  1e-7: their force is no polynomial.
TEST_P(Elements, MovingElementsHaveTheDerivativeOfTheirForce) {
  const SmoothLaws laws;
  for (const ElementCase& c : moving_cases()) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    ElementRun run(*element, sample_shape(*c.entry), laws.of(c));
    run.u0 = wavy(element->traits().dofs, 0.2);
    const Eigen::VectorXd u = wavy(element->traits().dofs, -0.1);
    ASSERT_EQ(run.evaluate(u), Outcome::ok);
    EXPECT_LT(tangent_error(run, u, 1e-5), 1e-7);
  }
}

// The displacement of uniform strain, turned by nothing: t . E t along, u_r / r around.
TEST_P(Elements, TurningStructuresHaveTheStrainOfAUniformField) {
  const ElasticLaws laws;
  for (const ElementCase& c : turning_cases()) {
    if (c.entry->law_size != 5 || c.entry->nodes < 2) continue;
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    const Eigen::Matrix2Xd x = sample_shape(*c.entry);
    ElementRun run(*element, x, laws.of(c));
    Eigen::VectorXd u = Eigen::VectorXd::Zero(element->traits().dofs);
    for (Eigen::Index i = 0; i < x.cols(); ++i) u(2 * i) = 1e-3 * x(0, i);  // e_xx, or e_rr and hoop
    const Vector2 t = (x.col(1) - x.col(0)).normalized();
    // Turned so that the line stays normal to its section: theta = t_x e (-t_y).
    for (Eigen::Index dof = 2 * x.cols(); dof < u.size(); ++dof) u(dof) = -1e-3 * t.x() * t.y();
    run.evaluate(u);
    for (int p = 0; p < element->traits().points; ++p) {
      const double* eps = run.eps1.data() + 5 * p;
      EXPECT_NEAR(eps[0], 1e-3 * t.x() * t.x(), 1e-15);
      EXPECT_NEAR(eps[1], c.axisymmetric() ? 1e-3 : 0.0, 1e-5);  // beam2 bends a little between its nodes
      EXPECT_NEAR(eps[2], 0.0, 1e-4);
    }
  }
}

// Patch P6: number of deformation modes that the element resists, against dofs - rigid motions.  An element
// that resists fewer must say so (traits().reduced), and only such a one may.
TEST_P(Elements, SolidRankIsFullUnlessReduced) {
  const ElasticLaws laws;
  for (const ElementCase& c : solid_cases()) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    const ElementTraits& t = element->traits();
    ElementRun run(*element, sample_shape(*c.entry), laws.of(c));
    run.evaluate(Eigen::VectorXd::Zero(t.dofs));
    const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(run.K).eigenvalues();
    EXPECT_GT(eigenvalues(0), -1e-12 * eigenvalues(t.dofs - 1)) << "K is positive semi-definite";
    const auto positive = (eigenvalues.array() > 1e-9 * eigenvalues(t.dofs - 1)).count();
    const int full = t.dofs - (c.axisymmetric() ? 1 : 3);
    if (t.reduced)
      EXPECT_EQ(positive, full - 1);
    else
      EXPECT_EQ(positive, full);
  }
}

// Relative motions of the pairs: each is resisted, except where the element warns of it (Newton-Cotes at r = 0).
TEST_P(Elements, InterfaceEveryPairIsHeldUnlessTheElementWarns) {
  const ElasticLaws laws;
  for (const ElementCase& c : interface_cases()) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    for (const auto& x : {sample_shape(*c.entry), sample_shape_on_axis(*c.entry)}) {
      ElementRun run(*element, x, laws.of(c));
      run.evaluate(Eigen::VectorXd::Zero(element->traits().dofs));
      const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(run.K).eigenvalues();
      const auto positive = (eigenvalues.array() > 1e-9 * eigenvalues.maxCoeff()).count();
      const bool warns = !element->caution(x).empty();
      EXPECT_EQ(positive, element->traits().nodes - (warns ? 2 : 0));
    }
  }
}

// Sum of w = area (shoelace), or volume of the ring = 2 pi times the first moment of the polygon (Pappus).
TEST_P(Elements, SolidWeightsSumToAreaOrVolume) {
  for (const ElementCase& c : solid_cases()) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    const SmoothLaw<4> law;
    for (const auto& x : {sample_shape(*c.entry), sample_shape_on_axis(*c.entry)}) {
      double area = 0.0, moment = 0.0;
      for (int i = 0; i < c.entry->corners; ++i) {
        const int j = (i + 1) % c.entry->corners;
        const double cross = x(0, i) * x(1, j) - x(0, j) * x(1, i);
        area += cross / 2.0;
        moment += cross * (x(0, i) + x(0, j)) / 6.0;
      }
      ElementRun run(*element, x, static_cast<const SolidLaw*>(&law));
      double sum = 0.0;
      for (int p = 0; p < element->traits().points; ++p) {
        EXPECT_GT(run.weight(p), 0.0);
        sum += run.weight(p);
      }
      const double expected = c.axisymmetric() ? 2.0 * kPi * moment : area;
      EXPECT_NEAR(sum, expected, 1e-13 * expected);
    }
  }
}

// Sum of w = length, or 2 pi times length times mean radius (frustum), for every rule.
TEST_P(Elements, InterfaceWeightsSumToLengthOrArea) {
  const LinearLaw<2> law = interface_law(1.0, 1.0);
  for (const ElementCase& c : interface_cases()) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    for (const auto& x : {sample_shape(*c.entry), sample_shape_on_axis(*c.entry)}) {
      ElementRun run(*element, x, static_cast<const InterfaceLaw*>(&law));
      double sum = 0.0;
      for (int p = 0; p < element->traits().points; ++p) sum += run.weight(p);
      const double length = (x.col(1) - x.col(0)).norm();
      const double expected = length * (c.axisymmetric() ? kPi * (x(0, 0) + x(0, 1)) : 1.0);
      EXPECT_NEAR(sum, expected, 1e-13 * expected);
    }
  }
}

// Strain of a linear field is exact at every point: xx = a, yy = d, xy = b + c, and zz = u_r / r
// when axisymmetric. Elements that average the dilatation keep its mean instead, so here the
// field has a constant one.
TEST_P(Elements, SolidLinearFieldsGiveExactStrain) {
  const SmoothLaw<4> law;
  for (const ElementCase& c : solid_cases()) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    const double b = c.axisymmetric() ? 0.0 : 0.3;
    for (const auto& x :
         {sample_shape(*c.entry), sample_shape_on_axis(*c.entry), sample_shape_curved(*c.entry)}) {
      Eigen::VectorXd u(2 * x.cols());
      for (Eigen::Index i = 0; i < x.cols(); ++i)
        u.segment<2>(2 * i) << 0.2 * x(0, i) + b * x(1, i), 0.5 * x(0, i) - 0.7 * x(1, i);
      ElementRun run(*element, x, static_cast<const SolidLaw*>(&law));
      for (int p = 0; p < element->traits().points; ++p) {
        const Vector4 expected(0.2, -0.7, c.axisymmetric() ? 0.2 : 0.0, b + 0.5);
        EXPECT_LT((run.B(p) * u - expected).norm(), 1e-13) << "point " << p;
      }
    }
  }
}

// The first component of a structure's strain is axial: t . E t of a uniform strain E along the tangent t.  A
// straight one has it at every point.
TEST_P(Elements, StructureUniformStrainIsAxial) {
  const SmoothLaws laws;
  const Matrix2 E = (Matrix2() << 2e-3, 3e-3, 3e-3, -7e-3).finished();
  for (const ElementCase& c : structure_cases()) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    const Eigen::Matrix2Xd x = sample_shape(*c.entry);
    if (element->traits().nodes < 2 || c.entry->extends) continue;
    ElementRun run(*element, x, laws.of(c));
    const Vector2 t = (x.col(1) - x.col(0)).normalized();
    const Eigen::Matrix2Xd u = E * x;
    for (int p = 0; p < element->traits().points; ++p)
      EXPECT_NEAR((run.B(p) * u.reshaped())(0), t.dot(E * t), 1e-15) << "point " << p;
  }
}

// Whatever the elements hand on to the law, the context of a point is its own.
TEST_P(Elements, EachPointGetsItsOwnContext) {
  for (const ElementCase& c : cases()) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    const int points = element->traits().points;
    std::vector<PointContext> contexts(static_cast<std::size_t>(points));
    for (int p = 0; p < points; ++p) contexts[p].point = p + 7;
    std::visit(
        [&]<int N>(const Law<N>*) {
          const ContextLaw<N> law;
          ElementRun run(*element, sample_shape(*c.entry), static_cast<const Law<N>*>(&law));
          run.contexts = contexts.data();
          ASSERT_EQ(run.evaluate(Eigen::VectorXd::Zero(element->traits().dofs)), Outcome::ok);
          for (int p = 0; p < points; ++p) EXPECT_EQ(run.h1[p], p + 7.0);
          run.contexts = nullptr;
          run.evaluate(Eigen::VectorXd::Zero(element->traits().dofs));
          for (int p = 0; p < points; ++p) EXPECT_EQ(run.h1[p], -1.0) << "none";
        },
        ElasticLaws().of(c));
  }
}

// position() and point_to_node(): values of a + b x + c y at the points give those at the nodes back, exactly
// on straight-sided elements.  With one point the node gets the point's value.
TEST_P(Elements, PointToNodeReproducesLinearFields) {
  const auto field = [](const Vector2& p) { return 2.0 + 3.0 * p.x() - 5.0 * p.y(); };
  for (const ElementCase& c : cases()) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    const ElementTraits& t = element->traits();
    for (const auto& x : {sample_shape(*c.entry), sample_shape_on_axis(*c.entry)}) {
      const std::span<const double> E = element->point_to_node(x);
      ASSERT_EQ(static_cast<int>(E.size()), t.nodes * t.points);
      for (int i = 0; i < t.nodes; ++i) {
        double value = 0.0, ones = 0.0;
        for (int p = 0; p < t.points; ++p) {
          value += E[i * t.points + p] * field(element->position(x, p));
          ones += E[i * t.points + p];
        }
        EXPECT_NEAR(ones, 1.0, 1e-13);
        EXPECT_NEAR(value, t.points == 1 ? field(element->position(x, 0)) : field(x.col(i)), 1e-12);
      }
    }
  }
}

// Sum of the forces of a body load = b times area or volume, whatever the number of points of the stiffness.
TEST_P(Elements, SolidBodyLoadCarriesTheWholeWeight) {
  const SmoothLaw<4> law;
  for (const ElementCase& c : solid_cases()) {
    SCOPED_TRACE(c.name);
    const auto element = c.make();
    const auto x = sample_shape_on_axis(*c.entry);
    ElementRun run(*element, x, static_cast<const SolidLaw*>(&law));
    double volume = 0.0;
    for (int p = 0; p < element->traits().points; ++p) volume += run.weight(p);
    std::vector<double> f(static_cast<std::size_t>(element->traits().dofs), 1.0);  // loads are added
    element->body_load(x, {2.0, -3.0}, f);
    const auto forces = Eigen::Map<const Eigen::Matrix2Xd>(f.data(), 2, c.entry->nodes);
    const Vector2 total = forces.rowwise().sum() - Vector2::Constant(c.entry->nodes);
    EXPECT_NEAR(total.x(), 2.0 * volume, 1e-12 * volume);
    EXPECT_NEAR(total.y(), -3.0 * volume, 1e-12 * volume);
  }
}

TEST_P(Elements, SolidQualityIsOneForParallelograms) {
  for (const ElementCase& c : solid_cases()) {
    SCOPED_TRACE(c.name);
    Eigen::Matrix2Xd corners(2, c.entry->corners);
    if (c.entry->square())
      corners << 1, 3, 4, 2, 0, 1, 3, 2;
    else
      corners << 1, 3, 2, 0, 1, 2;
    EXPECT_NEAR(c.make()->shape_quality(straight_element(*c.entry, corners)), 1.0, 1e-13);
    if (c.entry->square()) {
      const double quality = c.make()->shape_quality(sample_shape(*c.entry));
      EXPECT_GT(quality, 0.2);
      EXPECT_LT(quality, 0.9);
    }
  }
}

// The patch of MacNeal & Harder (1985) with u = 1e-3 (x + y / 2), v = 1e-3 (y + x / 2) on its boundary: the same
// field inside, but for rounding.
TEST_P(Elements, SolidPatchKeepsUniformStrain) {
  const LinearElastic law(moduli_from_young(1e6, 0.25));
  for (const ElementCase& c : solid_cases()) {
    if (c.axisymmetric()) continue;
    SCOPED_TRACE(c.name);
    const PatchMesh mesh = make_mesh(*c.entry, macneal_harder());
    const auto element = c.make();
    const std::vector<Group> groups{{element.get(), static_cast<const SolidLaw*>(&law), mesh.elements}};
    std::vector<char> fixed;
    for (const char on : boundary_nodes(mesh, *element)) fixed.insert(fixed.end(), 2, on);
    const Eigen::Matrix2Xd exact = 1e-3 * (Matrix2() << 1.0, 0.5, 0.5, 1.0).finished() * mesh.x;
    const Eigen::Matrix2Xd u = solve(mesh.x, groups, fixed, exact, Eigen::VectorXd::Zero(mesh.dofs()));
    EXPECT_LT((u - exact).cwiseAbs().maxCoeff(), 1e-12 * exact.cwiseAbs().maxCoeff());
  }
}

// Consistent forces of the tractions that the uniform stress sigma puts on the edges that one element has alone.
Eigen::VectorXd traction_loads(const PatchMesh& mesh, const Element& element, const Vector4& sigma) {
  const Matrix2 stress = (Matrix2() << sigma(0), sigma(3), sigma(3), sigma(1)).finished();
  Eigen::VectorXd load = Eigen::VectorXd::Zero(mesh.dofs());
  for (const auto& nodes : mesh.elements)
    for (const int local : own_edges(mesh, element, nodes)) {
      const Eigen::Matrix2Xd x = element_nodes(mesh.x, nodes);
      const std::vector<int>& edge = element.edges()[local];
      const Vector2 along = (x.col(edge[1]) - x.col(edge[0])).normalized(), out(along.y(), -along.x());
      const Vector2 traction = stress * out;
      std::vector<double> f(2 * nodes.size(), 0.0);
      element.edge_load(x, local, Vector2::Constant(-traction.dot(out)), Vector2::Constant(traction.dot(along)),
                        f);
      for (std::size_t i = 0; i < f.size(); ++i)
        load(2 * nodes[i / 2] + static_cast<Eigen::Index>(i % 2)) += f[i];
    }
  return load;
}

// The same patch on its fewest supports, with the tractions of a uniform stress on its edges: only an element whose
// forces are in equilibrium with the loads on its edges gives that stress back.  A ring on the axis and one away
// from it, where the stress is uniform if sigma_rr = sigma_tt.  1e-10: the free patch is about 50 times as
// ill-conditioned as the held one; beyond degree 6 five times that.
TEST_P(Elements, SolidPatchCarriesLoadedEdges) {
  const LinearElastic law(moduli_from_young(1e6, 0.25));
  for (const ElementCase& c : solid_cases()) {
    for (const double inner : {0.0, 0.3}) {
      if (!c.axisymmetric() && inner > 0.0) continue;
      SCOPED_TRACE(c.name + (inner > 0.0 ? ", away from the axis" : ""));
      CornerMesh corners = macneal_harder();
      corners.x.row(0).array() += inner;
      const PatchMesh mesh = make_mesh(*c.entry, corners);
      const auto element = c.make();
      const std::vector<Group> groups{{element.get(), static_cast<const SolidLaw*>(&law), mesh.elements}};
      const Matrix2 gradient = c.axisymmetric() ? (Matrix2() << 1e-3, 0.0, 0.0, -2.5e-3).finished()
                                                : (Matrix2() << 1e-3, 0.5e-3, 0.5e-3, 1e-3).finished();
      const Vector4 strain(gradient(0, 0), gradient(1, 1), c.axisymmetric() ? gradient(0, 0) : 0.0,
                           gradient(0, 1) + gradient(1, 0));
      const Vector4 sigma = update<4>(law, Vector4::Zero(), strain, {}).sigma;
      const Eigen::Matrix2Xd exact = gradient * mesh.x;
      std::vector<char> fixed(static_cast<std::size_t>(mesh.dofs()), 0);
      const auto hold = [&](const Vector2& at, bool x, bool y) {
        Eigen::Index node = 0;
        (mesh.x.colwise() - at).colwise().norm().minCoeff(&node);
        fixed[2 * node] = x ? 1 : 0;
        fixed[2 * node + 1] = y ? 1 : 0;
      };
      hold(corners.x.col(0), !c.axisymmetric(), true);
      if (!c.axisymmetric()) hold(corners.x.col(1), false, true);
      const Eigen::Matrix2Xd u = solve(mesh.x, groups, fixed, exact, traction_loads(mesh, *element, sigma));
      const double rounding = element->traits().degree > 6 ? 5e-10 : 1e-10;
      EXPECT_LT((u - exact).cwiseAbs().maxCoeff(), rounding * exact.cwiseAbs().maxCoeff());
      const DenseSystem solved = assemble(mesh.x, groups, u);
      double worst = 0.0;
      for (const ElementRun& run : solved.runs.front())
        for (int p = 0; p < element->traits().points; ++p)
          worst = std::max(worst, (Eigen::Map<const Vector4>(run.sigma1.data() + 4 * p) - sigma).norm());
      EXPECT_LT(worst, rounding * sigma.norm());
    }
  }
}

}  // namespace

}  // namespace sage::conformance
