// Why the printed results of the textbook decks differ from this program's: the book's own iterations, run on
// the same mesh, stresses and operators.  With the deck's tolerance they give the printed digits; with a tighter
// one they go to this program's answer.  Algorithms: Smith and Griffiths, Programming the Finite Element Method,
// 5th ed., programs 6.2 and 6.4 (visco-plastic strains), 6.5 (initial stress).
#include <gtest/gtest.h>

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>

#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "sage/app/commands.hpp"
#include "sage/app/run_deck.hpp"
#include "sage/record/strength.hpp"
#include "tests/studies/workbench.hpp"
#include "tests/support/scratch_folder.hpp"

namespace sage::app {
namespace {

using Vec = Eigen::VectorXd;

constexpr double kRoot3 = std::numbers::sqrt3;

// Mean stress, sqrt(3 J2), Lode angle as that book has them; tension positive.
struct Invariants {
  double mean, dsbar, lode;
  Vector4 s;  // deviator xx yy zz xy
  explicit Invariants(const Vector4& stress) {
    mean = (stress[0] + stress[1] + stress[2]) / 3.0;
    s = stress - mean * Vector4(1, 1, 1, 0);
    const double J2 = 0.5 * (s[0] * s[0] + s[1] * s[1] + s[2] * s[2]) + s[3] * s[3];
    dsbar = std::sqrt(3.0 * J2);
    const double J3 = s[2] * (s[0] * s[1] - s[3] * s[3]);
    lode = dsbar < 1e-10 ? 0.0 : std::asin(std::clamp(-13.5 * J3 / (dsbar * dsbar * dsbar), -1.0, 1.0)) / 3.0;
  }
  // d/d sigma of the mean, J2 and J3; shear as a tensor component counted twice.
  Vector4 d_mean() const { return Vector4(1, 1, 1, 0) / 3.0; }
  Vector4 d_J2() const { return {s[0], s[1], s[2], 2.0 * s[3]}; }
  Vector4 d_J3() const {
    const double third = 2.0 / 9.0 * dsbar * dsbar, xy = s[3] * s[3];
    return {s[0] * s[0] + xy - third, s[1] * s[1] + xy - third, s[2] * s[2] - third,
            2.0 * s[3] * (s[0] + s[1])};
  }
};

struct Strength {
  bool von_mises = false;
  double c = 0.0, phi = 0.0, psi = 0.0;  // radians

  double yield(const Invariants& i) const {
    if (von_mises) return i.dsbar - kRoot3 * c;
    return std::sin(phi) * i.mean +
           i.dsbar * (std::cos(i.lode) / kRoot3 - std::sin(i.lode) * std::sin(phi) / 3.0) - c * std::cos(phi);
  }
  // Gradient of the potential (angle psi) or of the yield function (angle phi); rounded at the corners as there.
  Vector4 gradient(const Invariants& i, double angle) const {
    if (von_mises) return 1.5 / i.dsbar * i.d_J2();
    const double sn = std::sin(i.lode), a = std::sin(angle);
    if (std::abs(sn) > 0.49) {
      const double sign = sn < 0.0 ? -1.0 : 1.0;
      return a * i.d_mean() + (kRoot3 / 2.0 - sign * a / 2.0 / kRoot3) * kRoot3 / 2.0 / i.dsbar * i.d_J2();
    }
    const double cs = std::cos(i.lode), t3 = std::tan(3.0 * i.lode), t = sn / cs;
    const double d2 = kRoot3 * cs / i.dsbar * ((1.0 + t * t3) + a * (t3 - t) / kRoot3) / 2.0;
    const double d3 = 1.5 * (kRoot3 * sn + a * cs) / (std::cos(3.0 * i.lode) * i.dsbar * i.dsbar);
    return a * i.d_mean() + d2 * i.d_J2() + d3 * i.d_J3();
  }
};

struct Point {
  double w = 0.0, y = 0.0;
  Eigen::MatrixXd Bt;  // dofs x 4
  std::vector<int> dofs;
  int material = 0;
  Vector4 stress = Vector4::Zero(), plastic = Vector4::Zero();
};

// A body whose stiffness is the elastic one throughout.
class Body {
 public:
  Body(const Model& model, const std::vector<Fixity>& more) : model_(model) {
    std::vector<char> later(model.groups.size(), 0);
    for (const Stage& stage : model.stages)
      for (const int g : stage.births) later[g] = 1;
    const auto dofs = static_cast<std::size_t>(2 * model.mesh.nodes());
    std::vector<char> held(dofs, 0), used(dofs, 0);
    weight = Vec::Zero(static_cast<Eigen::Index>(dofs));
    for (const std::vector<Fixity>* list : {&model.fixities, &more})
      for (const Fixity& f : *list)
        for (std::size_t c = 0; c < 2; ++c)
          if (f.code[c] == FixityCode::fixed) held[static_cast<std::size_t>(2 * f.node) + c] = 1;
    for (std::size_t g = 0; g < model.groups.size(); ++g)
      if (later[g] == 0) add_group(model.groups[g], used);
    for (std::size_t d = 0; d < dofs; ++d) place_.push_back(used[d] != 0 && held[d] == 0 ? free_++ : -1);
    std::vector<Eigen::Triplet<double>> entries;
    for (const Point& p : points) {
      const Eigen::MatrixXd K = p.w * p.Bt * D(p.material) * p.Bt.transpose();
      for (std::size_t i = 0; i < p.dofs.size(); ++i)
        for (std::size_t j = 0; j < p.dofs.size(); ++j)
          entries.emplace_back(p.dofs[i], p.dofs[j],
                               K(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
    }
    K_.resize(dofs, static_cast<Eigen::Index>(dofs));
    K_.setFromTriplets(entries.begin(), entries.end());
    std::vector<Eigen::Triplet<double>> inside;
    for (const auto& e : entries)
      if (place(e.row()) >= 0 && place(e.col()) >= 0)
        inside.emplace_back(place(e.row()), place(e.col()), e.value());
    Eigen::SparseMatrix<double> K(free_, free_);
    K.setFromTriplets(inside.begin(), inside.end());
    solver_.compute(K);
  }

  // Displacements under forces, with given values where dofs are held (0 elsewhere).
  Vec solve(const Vec& force, const Vec& given) const {
    const Vec all = force - K_ * given;
    Vec b(free_);
    for (Eigen::Index d = 0; d < all.size(); ++d)
      if (place(d) >= 0) b[place(d)] = all[d];
    const Vec x = solver_.solve(b);
    Vec u = given;
    for (Eigen::Index d = 0; d < all.size(); ++d)
      if (place(d) >= 0) u[d] = x[place(d)];
    return u;
  }
  Vec none() const { return Vec::Zero(weight.size()); }
  Matrix4 D(int material) const {
    const double E = parameter(material, 0), nu = parameter(material, 1);
    const double f = E / ((1 + nu) * (1 - 2 * nu));
    Matrix4 d = Matrix4::Zero();
    d.topLeftCorner<3, 3>().setConstant(f * nu);
    for (int i = 0; i < 3; ++i) d(i, i) = f * (1 - nu);
    d(3, 3) = f * (1 - 2 * nu) / 2;
    return d;
  }
  double parameter(int material, std::size_t i) const { return model_.materials[material].parameters[i]; }
  Vector4 strain(const Point& p, const Vec& u) const {
    Vec local(static_cast<Eigen::Index>(p.dofs.size()));
    for (std::size_t i = 0; i < p.dofs.size(); ++i) local[i] = u[p.dofs[i]];
    return p.Bt.transpose() * local;
  }
  void add_force(const Point& p, const Vector4& stress, Vec& f) const {
    const Vec local = p.w * p.Bt * stress;
    for (std::size_t i = 0; i < p.dofs.size(); ++i) f[p.dofs[i]] += local[i];
  }

  std::vector<Point> points;
  Vec weight;  // downwards

 private:
  int place(Eigen::Index dof) const { return place_[dof]; }
  void add_group(const Group& group, std::vector<char>& used) {
    const ElementTraits& t = group.element->traits();
    std::vector<double> geometry(static_cast<std::size_t>(t.geometry_size()));
    Eigen::Matrix2Xd x;
    for (int e = 0; e < group.elements(); ++e) {
      element_coordinates(model_.mesh, group, e, x);
      group.element->geometry(x, geometry);
      std::vector<int> dofs;
      for (std::size_t n = 0; n < group.node_count(); ++n)
        for (int c = 0; c < 2; ++c) dofs.push_back(2 * group.nodes_of(e)[n] + c);
      for (const int d : dofs) used[d] = 1;
      for (int p = 0; p < t.points; ++p) {
        const double* at = geometry.data() + p * (1 + 4 * t.dofs);
        points.push_back({at[0], group.element->position(x, p).y(),
                          Eigen::Map<const Eigen::MatrixXd>(at + 1, t.dofs, 4), dofs, group.material});
      }
      std::vector<double> f(static_cast<std::size_t>(t.dofs), 0.0);
      group.element->body_load(x, Vector2(0.0, -model_.material_of(group).unit_weight), f);
      for (std::size_t i = 0; i < dofs.size(); ++i) weight[dofs[i]] += f[i];
    }
  }

  const Model& model_;
  std::vector<int> place_;
  int free_ = 0;
  Eigen::SparseMatrix<double> K_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
};

double largest(const Vec& v) {
  return v.cwiseAbs().maxCoeff();
}

struct Outcome {
  Vec u;
  int iterations = 0;
};

// One increment of visco-plastic strains.  Stresses of the points are taken on; `old` is the last solution.
Outcome visco_plastic(Body& body, const std::vector<Strength>& strength, const Vec& force, double tolerance,
                      int limit, Vec& old) {
  double dt = 1e15;
  for (const Point& p : body.points) {
    const double E = body.parameter(p.material, 0), nu = body.parameter(p.material, 1);
    const Strength& s = strength[p.material];
    const double sn = std::sin(s.phi);
    dt = std::min(
        dt, s.von_mises ? 4 * (1 + nu) / (3 * E) : 4 * (1 + nu) * (1 - 2 * nu) / (E * (1 - 2 * nu + sn * sn)));
  }
  std::vector<Matrix4> D;
  for (std::size_t m = 0; m < strength.size(); ++m) D.push_back(body.D(static_cast<int>(m)));
  for (Point& p : body.points) p.plastic.setZero();
  Vec extra = body.none();
  Outcome out;
  while (true) {
    ++out.iterations;
    out.u = body.solve(force + extra, body.none());
    const bool done =
        (out.iterations > 1 && largest(out.u - old) <= tolerance * largest(out.u)) || out.iterations == limit;
    old = out.u;
    for (Point& p : body.points) {
      const auto m = static_cast<std::size_t>(p.material);
      const Vector4 stress = p.stress + D[m] * (body.strain(p, out.u) - p.plastic);
      if (done) {
        p.stress = stress;
        continue;
      }
      const Invariants i(stress);
      const double f = strength[m].yield(i);
      if (f < 0.0) continue;
      const Vector4 rate = f * dt * strength[m].gradient(i, strength[m].psi);
      p.plastic += rate;
      body.add_force(p, D[m] * rate, extra);
    }
    if (done) return out;
  }
}

Model model_of(const std::string& deck) {
  InputOptions input;
  input.layout = "sg_" + deck.substr(0, deck.find('_'));
  return build_model(read_input(SAGE_SOURCE_DIR "/legacy_inputs/smith_griffiths/" + deck + ".dat", input),
                     full_catalogue(), {});
}

RunOutcome run_of(const std::string& deck) {
  RunRequest request;
  request.deck = SAGE_SOURCE_DIR "/legacy_inputs/smith_griffiths/" + deck + ".dat";
  request.input.layout = "sg_" + deck.substr(0, deck.find('_'));
  request.quiet = true;
  request.output.folder = test::scratch_folder("textbook");
  return run_deck(request, full_catalogue());
}

Vec loads_of(const Model& model, const Stage& stage) {
  Vec f = Vec::Zero(2 * model.mesh.nodes());
  for (const NodalLoad& load : stage.loads) f.segment<2>(2 * load.node) += load.force;
  return f;
}

struct WallStep {
  double force = 0.0;
  int iterations = 0;
};

// Displacement increments of the initial-stress method; the wall's force after each.
std::vector<WallStep> earth_pressure(Body& body, const Strength& strength, const Vec& step, int increments,
                                     double tolerance, int limit) {
  const Matrix4 D = body.D(0);
  std::vector<WallStep> steps;
  Vec old = body.none(), extra = body.none();
  for (int k = 0; k < increments; ++k) {
    Vec internal = body.none();
    int iteration = 1;
    for (;; ++iteration) {
      const Vec u = body.solve(extra, step);
      const bool done = (iteration > 1 && largest(u - old) <= tolerance * largest(u)) || iteration == limit;
      old = u;
      extra.setZero();
      for (Point& p : body.points) {
        const Vector4 strain = body.strain(p, u), trial = D * strain;
        Vector4 excess = Vector4::Zero();
        const double after = strength.yield(Invariants(p.stress + trial));
        if (after > 0.0) {
          const double before = strength.yield(Invariants(p.stress)), part = after / (after - before);
          const Invariants at((1.0 - part) * trial + p.stress);
          const Vector4 a = strength.gradient(at, strength.phi), q = strength.gradient(at, strength.psi);
          excess = part * (D * q) * (D * a).dot(strain) / a.dot(D * q);
          body.add_force(p, excess, extra);
        }
        if (!done) continue;
        p.stress += trial - excess;
        body.add_force(p, p.stress, internal);
      }
      if (done) break;
    }
    double sum = 0.0;
    for (Eigen::Index d = 0; d < step.size(); ++d)
      if (step[d] != 0.0) sum += internal[d];
    steps.push_back({sum, iteration});
  }
  return steps;
}

// Half of the last of four printed digits; what is rounded exactly in the middle may go either way.
double half_digit(double printed) {
  return 0.5001e-4 * std::pow(10.0, std::ceil(std::log10(std::abs(printed))));
}

// Rows of numbers of a .res file that begin with an integer.
std::vector<std::vector<double>> printed(const std::string& deck) {
  std::ifstream in(SAGE_SOURCE_DIR "/legacy_inputs/smith_griffiths/" + deck + ".res");
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(in, line);) {
    std::stringstream stream(line);
    std::vector<double> row;
    for (double value; stream >> value;) row.push_back(value);
    if (row.size() >= 3) rows.push_back(row);
  }
  return rows;
}

Strength mohr_coulomb(const Model& model, double factor = 1.0) {
  const std::vector<double>& p = model.materials.front().parameters;  // E nu c phi psi
  const auto angle = [&](double degrees) { return std::atan(std::tan(degrees * kRadiansPerDegree) / factor); };
  return {false, p[2] / factor, angle(p[3]), angle(p[4])};
}

// 6.4: with the deck's tolerance, 0.0001 of the displacements, every printed digit and count of iterations.
TEST(Textbook, SlopeByItsOwnIterations) {
  const Model model = model_of("p64");
  const auto rows = printed("p64");
  ASSERT_EQ(rows.size(), 6u);
  for (const std::vector<double>& row : rows) {
    Body body(model, {});
    Vec old = body.none();
    const Outcome o = visco_plastic(body, {mohr_coulomb(model, row[0])}, body.weight, 1e-4, 500, old);
    EXPECT_NEAR(largest(o.u), row[1], half_digit(row[1])) << row[0];
    EXPECT_EQ(o.iterations, static_cast<int>(row[2])) << row[0];
  }
}

// What this program has instead: less than 9 % more, and the same verdicts.  The whole weight comes in one step,
// and visco-plastic strains take another way to the yield surface than an implicit return: in 16 steps the two
// differ by less than a quarter of what they do in one.
TEST(Textbook, SlopeInSmallerSteps) {
  const RunOutcome outcome = run_of("p64");
  const auto rows = printed("p64");
  const std::vector<StrengthRow>& ours = outcome.record.strength.rows();
  ASSERT_EQ(ours.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(ours[i].factor, rows[i][0]);
    EXPECT_EQ(ours[i].equilibrium != 0, rows[i][2] < 500) << "that program stops at 500 iterations";
    if (ours[i].equilibrium == 0) continue;
    EXPECT_NEAR(ours[i].largest, rows[i][1], 0.09 * rows[i][1]) << rows[i][0];
  }
  EXPECT_NEAR(ours[0].largest, rows[0][1], 0.001 * rows[0][1]);
  EXPECT_NEAR(ours[5].load_factor, 0.97, 0.03) << "of the weight, at the factor without equilibrium";
  std::array<double, 2> apart{};
  for (std::size_t k = 0; k < 2; ++k) {
    const int steps = k == 0 ? 1 : 16;
    Model model = model_of("p64");
    Body body(model, {});
    const Strength strength = mohr_coulomb(model, 1.2);
    Vec old = body.none(), total = body.none();
    for (int step = 0; step < steps; ++step)
      total += visco_plastic(body, {strength}, body.weight / steps, 1e-6, 5000, old).u;
    model.materials[0] = std::move(model.materials[1]);  // divided by 1.2
    model.materials.resize(1);
    model.groups.resize(1);
    model.stages.resize(1);
    model.stages[0].increments = steps;
    apart[k] = make_workbench().run(std::move(model)).largest_u() - largest(total);
  }
  EXPECT_LT(std::abs(apart[1]), 0.25 * std::abs(apart[0]))
      << apart[0] << " in one step, " << apart[1] << " in 16";
}

// 6.2: its equations are solved to 0.0001 only, so that the digits come back to 0.15 %; in 16 times as many
// steps it and this program differ by less than a fifth of what they do in the deck's.
TEST(Textbook, BearingCapacityByItsOwnIterations) {
  const auto rows = printed("p62");
  ASSERT_GE(rows.size(), 10u);
  const std::vector<Strength> strength{{true, 100.0, 0.0, 0.0}};
  std::array<std::array<double, 9>, 2> apart{};
  for (const int steps : {1, 16}) {
    Model model = model_of("p62");
    for (Stage& stage : model.stages) stage.increments = steps;
    Body body(model, {});
    Vec old = body.none(), total = body.none();
    std::vector<double> theirs;
    for (std::size_t s = 0; s < 9; ++s) {
      const Vec part = loads_of(model, model.stages[s]) / steps;
      for (int k = 0; k < steps; ++k)
        total += visco_plastic(body, strength, part, steps == 1 ? 1e-3 : 1e-6, 5000, old).u;
      theirs.push_back(total[1]);
      if (steps == 1) {
        EXPECT_NEAR(total[1], rows[s][2], 0.0015 * std::abs(rows[s][2])) << s + 1;
      }
    }
    const scenes::WholeRun run = make_workbench().run(std::move(model));
    for (std::size_t s = 0; s < 9; ++s)
      apart[steps == 1 ? 0 : 1][s] =
          std::abs(run.increments[(s + 1) * static_cast<std::size_t>(steps) - 1].u[1] - theirs[s]);
  }
  for (const std::size_t s : {1u, 2u, 5u, 6u, 7u, 8u}) EXPECT_LT(apart[1][s], 0.2 * apart[0][s]) << s + 1;
}

// 6.5: with the deck's tolerance of 0.001 all digits and counts; with 0.00001 its forces come to this program's,
// to 0.1 %.
TEST(Textbook, EarthPressureByItsOwnIterations) {
  const Model model = model_of("p65");
  const RunOutcome outcome = run_of("p65");
  const auto rows = printed("p65");
  ASSERT_EQ(rows.size(), 35u);
  const Stage& moved = model.stages[1];
  for (const double tolerance : {1e-3, 1e-5}) {
    Body body(model, moved.fixities);
    Vec step = body.none();
    for (const Fixity& f : moved.fixities) step[2 * f.node] = f.value[0] / moved.increments;
    const std::array<double, 6>& start = model.initials.front().value;  // level, unit weight, K0
    for (Point& p : body.points)
      p.stress = -start[1] * (start[0] - p.y) * Vector4(start[2], 1.0, start[2], 0.0);
    const auto wall =
        earth_pressure(body, mohr_coulomb(model), step, 35, tolerance, tolerance == 1e-3 ? 75 : 2000);
    for (std::size_t k = 0; k < 35; ++k) {
      if (tolerance == 1e-3) {
        EXPECT_NEAR(wall[k].force, rows[k][3], half_digit(rows[k][3])) << k + 1;
        EXPECT_EQ(wall[k].iterations, static_cast<int>(rows[k][5])) << k + 1;
      } else {
        EXPECT_NEAR(outcome.reports->nodes(0)[k].force[0], wall[k].force, 0.001 * wall[k].force) << k + 1;
      }
    }
  }
}

}  // namespace
}  // namespace sage::app
