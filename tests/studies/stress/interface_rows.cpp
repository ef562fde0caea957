// Interfaces: stiffness against the solids, the pair on the axis, no friction, opening and closing.
#include <fmt/format.h>

#include <cmath>

#include "tests/studies/scenes/lame.hpp"
#include "tests/studies/scenes/scenes.hpp"
#include "tests/studies/scenes/specimen_deck.hpp"
#include "tests/studies/stress/row.hpp"

namespace sage::stress {

namespace {

using namespace scenes;

// Lame on both rings.  The gap p/kn is a difference of displacements of size 1: kn digits go.
void normal_stiffness(Sweep& s) {
  for (int power = 0; power <= 12; ++power) {
    TwoRingDeck deck;
    deck.kn = std::pow(10.0, power);
    const TwoRingAnswer exact = two_ring_answer(deck.kn);
    const Ran ran = s.run(deck.text());
    double contact = kUnknown, u = kUnknown;
    if (ran.completed()) {
      contact = contact_error(*ran.run, exact);
      u = ran.run->u(TwoRingDeck::inner_node).x() / exact.u_a - 1.0;
    }
    const std::string label = fmt::format("kn = 1e{} E/a", power);
    s.right(label + ", contact pressure", deck.kn, ran, contact, 1e-12 + 100.0 * kUnit * deck.kn).series =
        "contact pressure";
    s.right(label + ", displacement", deck.kn, ran, u, 1e-12 + 10.0 * kUnit * deck.kn).series = "displacement";
    if (power >= 11) s.says(label, kUnknown, ran, "digits are lost");
    if (power <= 6) s.silent(label, kUnknown, ran, "digits are lost");
  }
}

// Two blocks and a joint between them, turned by an angle, pressed along their axis (nu = 0): uniform traction,
// and the ends approach by p (2/E + 1/kn).
void inclined_patch(Sweep& s) {
  const double p = 0.01;
  for (double angle : {0.0, 30.0, 90.0})
    for (int power = 0; power <= 12; power += 2) {
      const double kn = std::pow(10.0, power), c = std::cos(angle * kRadiansPerDegree),
                   t = std::sin(angle * kRadiansPerDegree);
      const auto turned = [=](double low) {
        return [=](double a, double b) { return Vector2(a * c - (low + b) * t, a * t + (low + b) * c); };
      };
      Block lower, upper;
      lower.columns = upper.columns = 3;
      lower.rows = upper.rows = 2;
      upper.first_node = upper.first_element = 101;
      lower.place = turned(0.0);
      upper.place = turned(1.0);
      DeckWriter deck(1);
      lower.write_nodes(deck);
      upper.write_nodes(deck);
      deck.material(1, 1, {1.0, 0.0});
      deck.material(2, 21, {kn, kn, 1.0});
      deck.group(1, 1, 1, 1);
      deck.group(2, 11, 0, 2);
      lower.write_elements(deck, 1);
      upper.write_elements(deck, 1);
      join(deck, 201, 2, lower.top(), upper.bottom(), 1);
      for (int n : lower.bottom()) deck.fix(n, 1, 1);
      StageCards& stage = deck.stage();
      for (int i = 0; i < 3; ++i) stage.pressure(upper.element(i, 1), 3, p, p);
      const Ran ran = s.run(deck.text());
      double error = kUnknown;
      if (ran.completed()) {
        error = (ran.run->stress[1].row(1).array() + p).abs().maxCoeff() / p;
        const Vector2 u = ran.run->u(upper.top().front()), exact = p * (2.0 + 1.0 / kn) * Vector2(t, -c);
        error = std::max(error, (u - exact).norm() / exact.norm());
      }
      Trial& trial = s.right(fmt::format("{:g} degrees, kn = 1e{} E/a", angle, power), kn, ran, error,
                             1e-7 + 100.0 * kUnit * kn);
      trial.series = fmt::format("{:g} degrees", angle);
    }
}

// kn to infinity is one ring: what is missing is the interface's own flexibility.
void bonded_limit(Sweep& s) {
  for (int power = 2; power <= 12; ++power) {
    TwoRingDeck deck;
    deck.kn = std::pow(10.0, power);
    const Ran ran = s.run(deck.text());
    const double bonded = lame(LameBody::strip, 0.3, 1.0).u;
    s.right(fmt::format("kn = 1e{} E/a", power), deck.kn, ran,
            ran.completed() ? ran.run->u(TwoRingDeck::inner_node).x() / bonded - 1.0 : kUnknown,
            2.0 / deck.kn + 10.0 * kUnit * deck.kn);
  }
}

// Cylinder L/D = 1, nu = .25, on a rigid rough platen, kn h/E = 50: axis traction -0.91972 E eps (hp solution).
void axis_rules(Sweep& s) {
  const double eps = 0.01, kn = 1000.0;
  const std::pair<const char*, int> rules[] = {{"row-sum", 1}, {"Gauss", 2}, {"Newton-Cotes", 3}};
  for (const auto& [name, formulation] : rules) {
    const RestrainedCylinder cylinder{1.0, 0.25, Cell::quad4, 1, 20, 20, 1.0};
    const Block block = cylinder.block();
    DeckWriter deck = cylinder.deck();
    const std::vector<int> platen = copy_row(deck, block, block.top(), 1001);
    deck.material(2, 21, {kn, kn, 1.0});
    deck.group(2, 11, formulation, 2);
    join(deck, 1001, 2, block.top(), platen, 1);
    for (int n : platen) {
      deck.fix(n, 1, 1);
      deck.stages[0].fix(n, 1, 1, 0.0, -eps);
    }
    const Ran ran = s.run(deck.text());
    const double traction = ran.completed() ? ran.run->stress[1](1, 0) / eps : kUnknown;
    if (formulation == 3) {
      s.says(name, kUnknown, ran, "gives no area to the pair").error = traction / -0.91972 - 1.0;
      s.trials.back().error = std::abs(s.trials.back().error);
    } else {
      s.right(name, kUnknown, ran, traction / -0.91972 - 1.0, 2e-3);
    }
  }
}

void sliding_block(Sweep& s) {
  for (double phi : {0.0, 1e-3, 0.1, 1.0, 10.0, 25.0, 45.0, 75.0}) {
    BlockOnPlane model(coulomb(0.0, phi, 1e5, 1e6));
    DeckWriter& deck = model.deck;
    deck.stage(2).gravity_y = -1.0;
    StageCards& push = deck.stage(10);
    push.fix(model.block.node(0, 0), 1, 0, phi > 60.0 ? 0.2 : 0.05);
    const Ran ran = s.run(deck.text());
    const double exact = BlockOnPlane::weight * std::tan(phi * kRadiansPerDegree);
    const std::string label = fmt::format("phi = {:g}", phi);
    if (phi == 0.0) {
      s.says(label, kUnknown, ran, "interface set 2");
      s.says(label, kUnknown, ran, "no shear resistance");
      s.clean(label, kUnknown, ran);
      continue;
    }
    const double found = ran.completed() ? ran.run->reaction(model.block.node(0, 0)).x() : kUnknown;
    s.right(label + ", push against W tan phi", phi, ran, found / exact - 1.0, 1e-6);
  }
  for (double slope : {24.9, 24.99, 25.01, 25.1}) {
    BlockOnPlane model(coulomb(0.0, 25.0, 1e5, 1e6));
    DeckWriter& deck = model.deck;
    StageCards& stage = deck.stage(4);
    stage.gravity_x = std::sin(slope * kRadiansPerDegree);
    stage.gravity_y = -std::cos(slope * kRadiansPerDegree);
    const Ran ran = s.run(deck.text());
    const std::string label = fmt::format("phi = 25 on a slope of {:g} degrees", slope);
    if (slope < 25.0)
      s.right(label + ": stays", kUnknown, ran, ran.completed() ? ran.run->out_of_balance : kUnknown, 1e-8);
    else
      s.says(label, kUnknown, ran, "limit load: between");
  }
}

// Zero stiffness is announced, whatever the law.
void no_resistance(Sweep& s) {
  struct Case {
    const char* label;
    int law;
    std::vector<double> parameters;
  };
  std::vector<double> free_ends = coulomb(0.0, 30.0, 0.0, 1e6), rest = coulomb(0.0, 0.0, 1e5, 1e6);
  rest[8] = 10.0;  // stiffness after slip
  for (const Case& c :
       {Case{"Goodman, k_s = 0", 21, {0.0, 1e6, 1.0}}, Case{"Clough-Duncan, k_j = 0", 22, free_ends}}) {
    BlockOnPlane model(coulomb(0.0, 30.0, 1e5, 1e6));
    DeckWriter& deck = model.deck;
    deck.materials.erase(deck.materials.begin() + 1);
    deck.material(2, c.law, c.parameters);
    deck.fix(model.block.node(0, 0), 1, 0);
    deck.stage().gravity_y = -1.0;
    s.says(c.label, kUnknown, s.run(deck.text()), "no shear resistance");
  }
  BlockOnPlane model(rest);
  DeckWriter& deck = model.deck;
  deck.stage().gravity_y = -1.0;
  s.silent("phi = c = 0 with stiffness after slip", kUnknown, s.run(deck.text()), "no shear resistance");
}

// A column on a joint that opens: lifted and put back, it is as it was.
void open_and_close(Sweep& s) {
  for (double kn : {1e2, 1e4, 1e6, 1e8})
    for (int law : {21, 22}) {
      Block block;
      block.columns = 2;
      block.rows = 4;
      block.place = rectangle(0.0, 1.0, 0.0, 2.0);
      DeckWriter deck(1);
      deck.water_unit_weight = 1.0;
      block.write_nodes(deck);
      const std::vector<int> base = copy_row(deck, block, block.bottom(), 101);
      std::vector<double> joint = coulomb(0.0, 30.0, kn, kn);
      joint[7] = 0.0;  // no tension
      deck.material(1, 1, {1000.0, 0.0});
      deck.material(2, law, law == 21 ? std::vector<double>{kn, kn} : joint);
      deck.group(1, 1, 1, 1);
      deck.group(2, 11, 0, 2);
      block.write_elements(deck, 1);
      join(deck, 101, 2, base, block.bottom(), 1);
      for (int n : base) deck.fix(n, 1, 1);
      for (int n : block.left()) deck.fix(n, 1, 0);
      const double steps[] = {-0.02, 0.05, -0.05, 0.05, -0.05};
      for (double step : steps) {
        StageCards& stage = deck.stage(2);
        for (int n : block.top()) stage.fix(n, 0, 1, 0.0, step);
      }
      const Ran ran = s.run(deck.text());
      // In series: 1/kn and the column's 2/1000.
      const double exact = 0.02 / (1.0 / kn + 2.0 / 1000.0);
      double error = kUnknown;
      if (ran.completed()) {
        error = 0.0;
        for (std::size_t i : {1u, 5u, 9u})  // pressed
          error = std::max(error,
                           std::abs(-ran.run->reaction(ran.run->increments[i], block.top(), 1) / exact - 1.0));
        for (std::size_t i : {3u, 7u})  // lifted
          error = std::max(error, std::abs(ran.run->reaction(ran.run->increments[i], block.top(), 1) / exact));
      }
      const char* name = law == 21 ? "Goodman" : "Clough-Duncan";
      const std::string label = fmt::format("{}, kn h/E = {:g}", name, 0.5 * kn / 1000.0);
      Trial& t = s.right(label, 0.5 * kn / 1000.0, ran, error, 1e-8);
      t.series = name;
      // At most three changes of state an increment: no chatter.
      int most = 0;
      if (ran.run)
        for (const Snapshot& at : ran.run->increments) most = std::max(most, at.iterations);
      s.holds(label + ": no chatter", kUnknown, ran.completed() && most <= 8,
              "at most 8 iterations an increment", fmt::format("{} iterations", most));
    }
}

// A specimen on a platen interface of any normal stiffness: its linear body condensed onto the border, and the whole
// system.  Forces of the joint are k_n times differences of displacements in both.
void condensed_border(Sweep& s) {
  for (int power = -9; power <= 9; ++power) {
    SpecimenDeck deck;
    deck.columns = 30;  // from 3000 equations on the solver keeps the border
    deck.rows = 60;
    deck.increments = 10;  // some of them are taken by the border alone

    const double kn = std::pow(10.0, power);  // h / E
    deck.normal_stiffness = 3000.0 * kn;
    RunSettings whole;
    whole.skips.condensation = false;
    whole.skips.prediction = false;  // whose increments end a little farther from equilibrium
    const Ran ran = s.run(deck.text()), reference = s.run(deck.text(), {}, whole);
    const std::string label = fmt::format("kn h/E = 1e{}", power);
    if (!ran.completed() || !reference.completed()) {
      s.clean(label + ", condensed", kn, ran);
      s.holds(label + ": both ways end alike", kUnknown, ran.completed() == reference.completed(),
              "the whole system ends as the condensed one does",
              reference.completed() ? "completed" : "stopped");
      continue;
    }
    const auto difference = [](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
      const double size = b.cwiseAbs().maxCoeff();
      return size > 0.0 ? (a - b).cwiseAbs().maxCoeff() / size : 0.0;
    };
    const WholeRun &a = *ran.run, &b = *reference.run;
    const auto largest = [&](Eigen::VectorXd Snapshot::*vector) {
      double all = 0.0;
      for (std::size_t i = 0; i < b.increments.size(); ++i)
        all = std::max(all, difference(a.increments[i].*vector, b.increments[i].*vector));
      return all;
    };
    s.holds(label + ": condensed", kUnknown, a.result.work.condensed > 3000,
            "more than 3000 equations condensed", fmt::format("{} condensed", a.result.work.condensed));
    const double allowed = 1e-9 + 100.0 * kUnit * kn;
    s.right(label + ", displacement", kn, ran, largest(&Snapshot::u), allowed).series = "displacement";
    s.right(label + ", forces", kn, ran, largest(&Snapshot::internal), allowed).series = "forces";
    s.right(label + ", stress of the joint", kn, ran, difference(a.stress[1], b.stress[1]), allowed).series =
        "stress of the joint";
  }
}

}  // namespace

std::vector<Row> interface_rows() {
  const std::string family = "Interfaces";
  return {
      {"interface-stiffness", family, "kn from 1 to 1e12 E/a, two rings in contact; a is the inner radius",
       "Lame on both rings, closed form. Allowed: 1e-12 + 100 u kn a/E for the pressure, a tenth for the "
       "displacement; "
       "u = 1.1e-16",
       "kn a/E", true, normal_stiffness},
      {"interface-patch", family, "kn from 1 to 1e12 E/a, a joint at 0, 30 and 90 degrees",
       "uniform traction, closed form. Allowed: 1e-7, since a coordinate on a card has ten columns, + 100 u kn "
       "a/E",
       "kn a/E", true, inclined_patch},
      {"interface-bonded", family, "kn to 1e12: the limit is the bonded ring",
       "Lame's one ring. Allowed: the interface's own flexibility 2 E/(kn a), and rounding 10 u kn a/E",
       "kn a/E", true, bonded_limit},
      {"interface-axis", family, "a pair of nodes on the axis, the three rules, kn h/E = 50",
       "normal traction on the axis / (E x axial strain) = -0.91972, an independent hp solution. Allowed: "
       "2e-3, the mesh's error. Newton-Cotes must be announced",
       "", false, axis_rules},
      {"interface-condensed", family,
       "kn h/E from 1e-9 to 1e9, the linear body condensed onto the joint's border",
       "the whole system, without condensation, in every increment. Allowed: 1e-9 + 100 u kn h/E, with h = 1. "
       "1e-9, because each run ends at a relative residual below 1e-8 and converges quadratically",
       "kn h/E", true, condensed_border},
      {"sliding-block", family, "friction of an interface from 0 to 75 degrees", "W tan phi, closed form",
       "friction angle [degrees]", true, sliding_block},
      {"no-shear-resistance", family, "interfaces without shear stiffness or strength",
       "the interface set is named", "", false, no_resistance},
      {"open-close", family, "a joint lifted and pressed again, kn h/E from 0.05 to 5e4",
       "springs in series, closed form; nothing while open", "kn h/E", true, open_and_close},
  };
}

}  // namespace sage::stress
