// What must not change an answer: numbers of nodes, order, units, steps, a second run.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "tests/studies/scenes/scenes.hpp"
#include "tests/studies/scenes/specimen_deck.hpp"
#include "tests/studies/stress/row.hpp"

namespace sage::stress {

namespace {

using namespace scenes;

// Free of units: platen force of every increment, displacements of the specimen at the end, iterations.
struct Answer {
  std::vector<double> values;
  int iterations = 0;
};

Answer answer_of(const SpecimenDeck& deck, const WholeRun& run) {
  const SpecimenVariant& v = deck.variant;
  const double sign = v.mirrored ? -1.0 : 1.0;
  Answer answer;
  for (const Snapshot& at : run.increments)
    answer.values.push_back(-sign * run.reaction(at, deck.platen(), 1) / (50.0 * v.stress) / v.length /
                            v.length);
  const double force = answer.values.back();
  for (int n : deck.solid_nodes()) {
    answer.values.push_back(force * run.u(n).x() / v.length);  // of the force's size
    answer.values.push_back(force * sign * run.u(n).y() / v.length);
  }
  answer.iterations = run.iterations();
  return answer;
}

double difference(const Answer& a, const Answer& b) {
  if (a.values.size() != b.values.size()) return kUnknown;
  double largest = 0.0, size = 0.0;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    largest = std::max(largest, std::abs(a.values[i] - b.values[i]));
    size = std::max(size, std::abs(b.values[i]));
  }
  return largest / size;
}

SpecimenDeck plain(bool drucker_prager) {
  SpecimenDeck deck;
  deck.drucker_prager = drucker_prager;
  deck.columns = 4;
  deck.rows = 8;
  deck.increments = 10;
  return deck;
}

const char* name_of(bool drucker_prager) {
  return drucker_prager ? "Drucker-Prager" : "elastic";
}

// A specimen on a hyperbolic interface in one variant against its plain form.
void against_plain(Sweep& s, const std::string& label, double parameter, bool drucker_prager,
                   const SpecimenVariant& variant, double allowed) {
  SpecimenDeck changed = plain(drucker_prager);
  changed.variant = variant;
  const Ran a = s.run(changed.text()), b = s.run(plain(drucker_prager).text());
  const bool both = a.completed() && b.completed();
  const Answer answer_a = both ? answer_of(changed, *a.run) : Answer{},
               answer_b = both ? answer_of(plain(drucker_prager), *b.run) : Answer{};
  Trial& t = s.right(fmt::format("{}, {}", name_of(drucker_prager), label), parameter, a,
                     both ? difference(answer_a, answer_b) : kUnknown, allowed);
  t.series = name_of(drucker_prager);
  t.outcome += fmt::format(", {} and {} iterations", answer_a.iterations, answer_b.iterations);
  t.ok = t.ok && std::abs(answer_a.iterations - answer_b.iterations) <= 1;
}

void numbering(Sweep& s) {
  for (bool law : {false, true})
    for (unsigned seed = 1; seed <= 4; ++seed) {
      SpecimenVariant variant;
      std::vector<int> numbers(5 * 9 + 5);
      std::iota(numbers.begin(), numbers.end(), 1);
      std::shuffle(numbers.begin(), numbers.end(), std::mt19937(seed));
      variant.number = [numbers](int n) { return numbers[n - 1]; };
      against_plain(s, fmt::format("random numbers {}", seed), kUnknown, law, variant, 1e-10);
    }
}

void placement(Sweep& s) {
  for (bool law : {false, true}) {
    SpecimenVariant backwards, mirrored, shifted;
    backwards.elements_backwards = true;
    mirrored.mirrored = true;
    against_plain(s, "elements backwards", kUnknown, law, backwards, 1e-10);
    against_plain(s, "z to -z", kUnknown, law, mirrored, 1e-10);
    for (double shift : {64.0, 4096.0}) {
      shifted.shift = shift;
      // Coordinates keep 16 digits of a number `shift` large.
      against_plain(s, fmt::format("{:g} up the axis", shift), kUnknown, law, shifted, 1e-10 + 1e-13 * shift);
    }
  }
}

void units(Sweep& s) {
  for (bool law : {false, true}) {
    for (int power : {-12, -9, -6, -3, 3, 6, 9, 12}) {
      SpecimenVariant lengths, stresses;
      lengths.length = std::pow(10.0, power);
      stresses.stress = std::pow(10.0, power);
      against_plain(s, fmt::format("lengths x 1e{}", power), kUnknown, law, lengths, 1e-9);
      against_plain(s, fmt::format("stresses x 1e{}", power), std::pow(10.0, power), law, stresses, 1e-9);
    }
    SpecimenVariant both;
    both.length = 1e12;
    both.stress = 1e-12;
    against_plain(s, "lengths x 1e12, stresses x 1e-12", kUnknown, law, both, 1e-9);
  }
}

void steps(Sweep& s) {
  // Elastic: one answer, whatever the increments.  Rounding adds up over the steps.
  double one = 0.0;
  for (int increments : {1, 10, 100, 1000}) {
    TriaxialDeck deck;
    deck.parameters = {3000.0, 0.3};
    deck.rough_base = true;
    deck.strains = {0.05};
    deck.increments = increments;
    const Ran ran = s.run(deck.text());
    const double stress = ran.completed() ? axial_stress(deck, *ran.run, 0) : kUnknown;
    if (increments == 1) one = stress;
    s.right(fmt::format("elastic, {} increments", increments), increments, ran, stress / one - 1.0,
            1e-13 * increments)
        .series = "elastic";
  }
  // Drucker-Prager on its platen: the radial return errs in proportion to the increment, 1 % is asked for.
  const SpecimenDeck many = [] {
    SpecimenDeck deck = plain(true);
    deck.increments = 320;
    return deck;
  }();
  const Ran fine = s.run(many.text());
  const double reference =
      fine.completed() ? -fine.run->reaction(fine.run->last(), many.platen(), 1) : kUnknown;
  for (int increments : {5, 20, 80}) {
    SpecimenDeck deck = many;
    deck.increments = increments;
    const Ran ran = s.run(deck.text());
    const double force = ran.completed() ? -ran.run->reaction(ran.run->last(), deck.platen(), 1) : kUnknown;
    s.right(fmt::format("Drucker-Prager, {} increments against 320", increments), increments, ran,
            force / reference - 1.0, 1e-2)
        .series = "Drucker-Prager";
  }
}

// Elastic steps so small that eps^2 means nothing: the modulus is still E.
void tiny_steps(Sweep& s) {
  for (int law : {1, 3, 4})
    for (double strain : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15}) {
      TriaxialDeck deck;
      deck.law = law;
      deck.parameters =
          law == 1 ? std::vector<double>{3000.0, 0.3} : std::vector<double>{3000.0, 0.3, 10.0, 30.0, 0.0};
      deck.strains = {strain};
      deck.increments = 20;
      const Ran ran = s.run(deck.text());
      Trial& t =
          s.right(fmt::format("law {}, strain {:g} in 20 increments", law, strain), strain, ran,
                  ran.completed() ? axial_stress(deck, *ran.run, 0) / (3000.0 * strain) - 1.0 : kUnknown, 1e-9);
      t.series = fmt::format("law {}", law);
    }
}

// Far beyond collapse in one increment.  Displacement controlled: the limit state.  Load controlled: no
// equilibrium, and the bracket says where it ended.
void huge_step(Sweep& s) {
  const double q = 50.0 * 2.0 + 2.0 * 10.0 * std::sqrt(3.0);
  for (int law : {3, 4}) {
    for (double strain : {1.0, 100.0, 1e4, 1e6}) {
      TriaxialDeck deck;
      deck.law = law;
      deck.parameters = {3000.0, 0.3, 10.0, 30.0, 0.0};
      deck.cell = 50.0;
      deck.strains = {strain};
      const Ran ran = s.run(deck.text());
      Trial& t = s.right(fmt::format("law {}, strain {:g} in one increment", law, strain), strain, ran,
                         ran.completed() ? (axial_stress(deck, *ran.run, 0) - 50.0) / q - 1.0 : kUnknown, 1e-6);
      t.series = fmt::format("law {}", law);
    }
    for (double pressure : {1.01, 2.0, 1e3, 1e9}) {
      TriaxialDeck column;
      column.law = law;
      Block block = column.block();
      DeckWriter deck(2);
      block.write_nodes(deck);
      deck.material(1, law, {3000.0, 0.3, 10.0, 30.0, 0.0});
      deck.group(1, 1, 2, 1);
      block.write_elements(deck, 1);
      for (int n : block.bottom()) deck.fix(n, 0, 1);
      StageCards& stage = deck.stage();
      for (int i = 0; i < block.columns; ++i)
        stage.pressure(block.element(i, block.rows - 1), 3, pressure * 2.0 * 10.0 * std::sqrt(3.0),
                       pressure * 2.0 * 10.0 * std::sqrt(3.0));
      const Ran ran = s.run(deck.text());
      const std::string label = fmt::format("law {}, load {:g} of collapse in one increment", law, pressure);
      s.says(label, kUnknown, ran, "limit load: between");
      double from = kUnknown, to = kUnknown;
      const std::size_t at = ran.words().find("limit load: between");
      if (at != std::string::npos)
        std::sscanf(ran.words().c_str() + at, "limit load: between %lf and %lf", &from, &to);
      // Twelve halvings of the whole: 1/4096 of the load.
      const double slack = pressure / 2048.0;
      s.holds(label + ": bracket", kUnknown,
              from * pressure <= 1.0 + 1e-3 && to * pressure >= 1.0 - slack - 1e-3, "collapse lies in it",
              fmt::format("{:g} to {:g} of collapse", from * pressure, to * pressure));
    }
  }
}

bool same_bits(const WholeRun& a, const WholeRun& b) {
  if (a.increments.size() != b.increments.size() || a.stress.size() != b.stress.size()) return false;
  for (std::size_t i = 0; i < a.increments.size(); ++i)
    if (a.increments[i].u != b.increments[i].u || a.increments[i].internal != b.increments[i].internal)
      return false;
  for (std::size_t g = 0; g < a.stress.size(); ++g)
    if (a.stress[g] != b.stress[g]) return false;
  return true;
}

void determinism(Sweep& s) {
  for (bool law : {false, true})
    for (const auto& [code, entry] : s.catalogue().solvers.entries()) {
      if (entry.symmetric) continue;
      RunSettings settings;
      settings.solver = code;
      const Ran first = s.run(plain(law).text(), {}, settings);
      bool same = first.completed();
      for (int again = 0; again < 3 && same; ++again) {
        const Ran other = s.run(plain(law).text(), {}, settings);
        same = other.completed() && same_bits(*first.run, *other.run);
      }
      s.holds(fmt::format("{}, solver {}, four runs", name_of(law), entry.name), kUnknown, same,
              "bit for bit the same", same ? "the same" : "different");
    }
}

// More threads than there are processors too: the same bits.
void threads(Sweep& s) {
  for (int law : {1, 3})
    for (const auto& [code, entry] : s.catalogue().solvers.entries()) {
      if (law != 1 && entry.name != "frontal") continue;  // the others have no threads of their own
      TriaxialDeck deck;
      deck.law = law;
      deck.parameters =
          law == 1 ? std::vector<double>{3000.0, 0.3} : std::vector<double>{3000.0, 0.3, 10.0, 30.0, 0.0};
      deck.cell = 50.0;
      deck.rough_base = true;
      deck.columns = 24;
      deck.rows = 48;
      deck.strains = {0.02};
      RunSettings settings;
      settings.solver = code;
      const Ran one = s.run(deck.text(), {}, settings);
      bool same = one.completed();
      for (int count : {2, 4}) {
        settings.threads = count;
        const Ran other = s.run(deck.text(), {}, settings);
        same = same && other.completed() && same_bits(*one.run, *other.run);
      }
      s.holds(fmt::format("law {}, solver {}, 1, 2 and 4 threads", law, entry.name), kUnknown, same,
              "bit for bit the same", same ? "the same" : "different");
    }
}

// Every solver that the scene allows against the profile solver.
void solvers(Sweep& s) {
  for (bool law : {false, true}) {
    RunSettings reference;
    reference.solver = 1;
    const Ran base = s.run(plain(law).text(), {}, reference);
    for (const auto& [code, entry] : s.catalogue().solvers.entries()) {
      if (entry.symmetric || code == 1) continue;
      RunSettings settings;
      settings.solver = code;
      const Ran ran = s.run(plain(law).text(), {}, settings);
      const bool both = base.completed() && ran.completed();
      s.right(fmt::format("{}, {}", name_of(law), entry.name), kUnknown, ran,
              both ? difference(answer_of(plain(law), *ran.run), answer_of(plain(law), *base.run)) : kUnknown,
              1e-9);
    }
    for (const auto& [code, entry] : s.catalogue().solvers.entries()) {
      if (!entry.symmetric || law) continue;
      RunSettings settings;
      settings.solver = code;
      s.says(fmt::format("symmetric solver {} on an unsymmetric scene", entry.name), kUnknown,
             s.run(plain(law).text(), {}, settings), "is for symmetric matrices only");
    }
  }
}

}  // namespace

std::vector<Row> invariance_rows() {
  const std::string family = "Invariance";
  const std::string specimen = "the same specimen in its plain form";
  return {
      {"numbering", family, "random node numbers", specimen + ". Allowed: 1e-10; iterations +-1", "", false,
       numbering},
      {"placement", family, "order of elements, mirror, place on the axis", specimen + ". Allowed: 1e-10", "",
       false, placement},
      {"units", family, "units of length and stress, 1e-12 to 1e12",
       specimen + ". Allowed: 1e-9; iterations +-1", "factor on every stress", true, units},
      {"steps", family, "1 to 1000 increments",
       "elastic: one increment, 1e-13 each; Drucker-Prager: 320 increments, 1 %", "increments", true, steps},
      {"tiny-steps", family, "strains to 1e-15", "E eps. Allowed: 1e-9", "axial strain", true, tiny_steps},
      {"huge-step", family, "one increment far beyond collapse",
       "strength in triaxial compression, closed form", "axial strain", true, huge_step},
      {"determinism", family, "the same run again", "the first run, bit for bit", "", false, determinism},
      {"threads", family, "1, 2 and 4 threads", "one thread, bit for bit", "", false, threads},
      {"solvers", family, "every solver", "the profile solver. Allowed: 1e-9", "", false, solvers},
  };
}

}  // namespace sage::stress
