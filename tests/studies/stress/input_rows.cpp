// Numbers that are none, and numbers too large: a message with the line, never a run.
#include <fmt/format.h>

#include <cmath>

#include "tests/studies/scenes/scenes.hpp"
#include "tests/studies/stress/row.hpp"

namespace sage::stress {

namespace {

using namespace scenes;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

TriaxialDeck column() {
  TriaxialDeck deck;
  deck.law = 4;
  deck.parameters = {3000.0, 0.3, 10.0, 30.0, 0.0};
  deck.cell = 50.0;
  return deck;
}

// Every real field of every card in turn.  A field is ten columns wide; a word fills it.
void not_a_number(Sweep& s) {
  struct Place {
    const char* what;
    int line, column;  // from 0
  };
  const int nodes = 9;
  const std::vector<std::string> deck = lines_of(column().text());
  const Place places[] = {
      {"atmospheric pressure", 1, 24},
      {"x of a node", 4, 15},
      {"y of a node", 7, 25},
      {"unit weight", 3 + nodes, 15},
      {"Young's modulus", 4 + nodes, 0},
      {"friction", 4 + nodes, 30},
  };
  for (const Place& place : places)
    for (const char* word : {"NaN", "Inf", "-Infinity", "1.E308", "1.E400", "1.E101", "1.O", "--1", "1.2.3"}) {
      std::vector<std::string> changed = deck;
      std::string& card = changed[place.line];
      card.resize(std::max<std::size_t>(card.size(), static_cast<std::size_t>(place.column) + 10), ' ');
      card.replace(static_cast<std::size_t>(place.column), 10, fmt::format("{:>10}", word));
      const Ran ran = s.run(joined(changed));
      s.says(fmt::format("{} in {}", word, place.what), kUnknown, ran, fmt::format("deck:{}", place.line + 1));
      // As Fortran reads it, "--1" is an exponent without digits before it, zero: that runs, with a warning.
      const bool runs = std::string(word) == "--1";
      s.trials.back().ok = s.trials.back().ok && (runs || !ran.run);
    }
}

void cut_short(Sweep& s) {
  const std::vector<std::string> deck = lines_of(column().text());
  s.says("an empty deck", kUnknown, s.run(""), "deck");
  for (std::size_t keep = 0; keep < deck.size(); keep += 3) {
    std::vector<std::string> part(deck.begin(), deck.begin() + static_cast<std::ptrdiff_t>(keep));
    const Ran ran = s.run(joined(part));
    s.says(fmt::format("the first {} of {} cards", keep, deck.size()), kUnknown, ran, "deck");
    s.trials.back().ok = s.trials.back().ok && !ran.run;
  }
  const std::pair<const char*, std::vector<std::string> DeckWriter::*> kinds[] = {
      {"no nodes", &DeckWriter::nodes},
      {"no materials", &DeckWriter::materials},
      {"no groups", &DeckWriter::groups},
      {"no elements", &DeckWriter::elements},
      {"no supports", &DeckWriter::fixities}};
  for (const auto& [label, cards] : kinds) {
    const Block block = column().block();
    DeckWriter writer(2);
    block.write_nodes(writer);
    writer.material(1, 1, {3000.0, 0.3});
    writer.group(1, 1, 2, 1);
    block.write_elements(writer, 1);
    for (int n : block.bottom()) writer.fix(n, 0, 1);
    writer.stage();
    (writer.*cards).clear();
    const Ran ran = s.run(writer.text());
    s.holds(label, kUnknown, !ran.run && !ran.refusal.empty(), "refused with a reason",
            ran.run ? "it ran" : ran.refusal.substr(0, ran.refusal.find('\n')));
  }
  // A group without elements and a stage without anything to do are not mistakes.
  const Block block = column().block();
  DeckWriter writer(2);
  block.write_nodes(writer);
  writer.material(1, 1, {3000.0, 0.3});
  writer.group(1, 1, 2, 1);
  writer.group(2, 1, 2, 1);
  block.write_elements(writer, 1);
  for (int n : block.bottom()) writer.fix(n, 0, 1);
  writer.stage();
  const Ran ran = s.run(writer.text());
  s.right("an empty group, a stage with nothing to do", kUnknown, ran,
          ran.completed() ? ran.run->largest_u() : kUnknown, 0.0);
}

// Large numbers that a card may hold: their squares must not overflow on the way.
void large_numbers(Sweep& s) {
  for (double power : {-90.0, -60.0, -30.0, 30.0, 60.0, 90.0}) {
    const double factor = std::pow(10.0, power);
    TriaxialDeck deck;
    deck.parameters = {factor, 0.3};
    const Ran ran = s.run(deck.text());
    s.right(fmt::format("E = 1e{:g}", power), factor, ran,
            ran.completed() ? axial_stress(deck, *ran.run, 0) / (0.01 * factor) - 1.0 : kUnknown, 1e-12);
  }
  for (double strain : {1e20, 1e40, 1e60, 1e90}) {
    TriaxialDeck deck;
    deck.law = 1;
    deck.parameters = {3000.0, 0.3};
    deck.strains = {strain};
    const Ran ran = s.run(deck.text());
    s.right(fmt::format("elastic, strain {:g}", strain), kUnknown, ran,
            ran.completed() ? axial_stress(deck, *ran.run, 0) / (3000.0 * strain) - 1.0 : kUnknown, 1e-12);
    deck.law = 4;
    deck.parameters = {3000.0, 0.3, 10.0, 30.0, 0.0};
    s.clean(fmt::format("Mohr-Coulomb, strain {:g}", strain), kUnknown, s.run(deck.text()));
  }
}

}  // namespace

std::vector<Row> input_rows() {
  const std::string family = "Input";
  return {
      {"not-a-number", family, "NaN, infinity, overflow and misprints in every kind of field",
       "refused, with the line of the card", "", false, not_a_number},
      {"cut-short", family, "decks that end early, empty sets", "refused, with a place", "", false, cut_short},
      {"large-numbers", family, "moduli 1e-90 to 1e90, strains to 1e90", "E eps. Allowed: 1e-12",
       "Young's modulus", true, large_numbers},
  };
}

}  // namespace sage::stress
