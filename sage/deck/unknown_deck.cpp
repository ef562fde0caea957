#include "sage/deck/unknown_deck.hpp"

#include <algorithm>
#include <array>

#include "sage/deck/deck_reader.hpp"
#include "sage/deck/other_programs.hpp"
#include "sage/deck/record.hpp"

namespace sage {

namespace {

constexpr std::size_t kShown = 3;              // of the problems as the standard layout
constexpr std::size_t kTrialSize = 4'000'000;  // larger decks are not read once more for every layout

// Lines of the deck's second and third records; 0 = there is none.  The first is a
// title, which any line can be.
std::array<int, 2> first_lines(const SourceText& source, const Layout& layout) {
  RecordSource records(source, layout.records);
  std::array<int, 2> lines{};
  if (!records.next()) return lines;
  for (int& line : lines) line = records.next() ? records.line() : 0;
  return lines;
}

// Units and control are wrong from end to end.  One slip on each, or two on one, can happen to anybody; a deck
// that ends behind its title says nothing.
bool looks_foreign(const std::array<int, 2>& lines, const Diagnostics& problems) {
  std::array<int, 2> errors{};
  for (const Diagnostic& problem : problems.list())
    for (std::size_t i = 0; i < 2; ++i)
      if (problem.severity == Severity::error && lines[i] > 0 && problem.where.line == lines[i]) ++errors[i];
  return errors[0] + errors[1] >= 3;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

// What a deck's owner can do where it bears the marks of no layout.
std::string ways_on(const SourceText& source) {
  return "--layout NAME, one of those built in (" + joined(built_in_layouts()) +
         ") or the path of a layout file; sagefe layout guess " + source.name() +
         " makes a first layout for a program that has none";
}

// Names of the layouts other than `tried` that read the whole deck without an error or a warning.  `rejecting`: of
// those that read it and say that it asks for what is not computed, with that.
std::vector<std::string> layouts_that_read(const SourceText& source, const std::string& tried,
                                           std::string* rejecting = nullptr) {
  std::vector<std::string> names;
  if (source.text()->size() > kTrialSize) return names;
  for (const std::string& name : built_in_layouts()) {
    if (name == tried) continue;
    try {
      const Layout layout = load_layout(name);
      const Deck deck = DeckReader(source, layout, {}).read();
      if (deck.diagnostics.warnings() > 0) continue;
      if (!deck.has("left_out"))
        names.push_back(name);
      else if (rejecting != nullptr && rejecting->empty())
        *rejecting = name + ", which asks for " + deck.all("left_out").front().text("what", "more");
    } catch (const InputError&) {
    }
  }
  return names;
}

// Where several read it, only the deck's owner knows which program it was written for.
std::string fitting_words(const std::vector<std::string>& names) {
  if (names.size() == 1)
    return "without a mistake it reads as " + names.front() + ": --layout " + names.front();
  return "without a mistake it reads as each of " + joined(names) +
         ", which are different programs: name the one that it was written for with --layout";
}

}  // namespace

std::optional<Diagnostic> other_layouts_that_read(const SourceText& source, const std::string& layout) {
  const std::vector<std::string> fitting = layouts_that_read(source, layout);
  if (fitting.empty()) return std::nullopt;
  return Diagnostic{Severity::note,
                    "S107",
                    {source.name(), 0, 0, 0},
                    "the deck has mistakes as " + layout + ", but " + fitting_words(fitting),
                    {}};
}

std::optional<Diagnostic> read_as_standard(const SourceText& source, const Layout& standard,
                                           const Diagnostics& problems) {
  const std::array<int, 2> lines = first_lines(source, standard);
  const bool flawed = std::any_of(problems.list().begin(), problems.list().end(), [&](const Diagnostic& d) {
    return d.severity == Severity::error && d.where.line > 0 &&
           (lines[1] == 0 || d.where.line == lines[0] || d.where.line == lines[1]);
  });
  if (!flawed) return std::nullopt;
  return Diagnostic{
      Severity::note,
      "S108",
      {source.name(), 0, 0, 0},
      "the deck was read as " + standard.name +
          ", since it has the marks of no other layout; if it was written for another program, name "
          "its layout: " +
          ways_on(source),
      {}};
}

// What the program has for the decks of another one that no layout reads; empty = nothing.
std::string own_means(const std::string& program) {
  for (const char* of_flow : {"program 7.1 ", "program 7.3 ", "program 7.4 ", "program 7.5 "})
    if (program.starts_with(of_flow))
      return "flow through soil is computed by elements of flow, docs/manual/water.md";
  for (const char* of_bars : {"program 4.1 ", "program 4.2 ", "program 4.3 ", "program 4.4 "})
    if (program.starts_with(of_bars))
      return "bars and beams in the plane are elements of their own, docs/manual/structures.md";
  return {};
}

std::optional<Diagnostics> outside_of_scope(const SourceText& source) {
  const std::string program = other_program(source);
  if (program.empty()) return std::nullopt;
  Diagnostics alone;
  if (const std::string means = own_means(program); !means.empty()) {
    alone.add({Severity::error,
               "S105",
               {source.name(), 0, 0, 0},
               "this looks like a deck of " + program + ", which no layout reads; " + means +
                   "; name a layout with --layout, or make one: sagefe layout guess " + source.name(),
               {}});
    return alone;
  }
  alone.add({Severity::error,
             "S106",
             {source.name(), 0, 0, 0},
             "this looks like a deck of " + program +
                 ": outside of what this program does, solids, structures and steady flow in plane strain and "
                 "axisymmetry; if it is another kind of deck, name its layout with --layout",
             {}});
  return alone;
}

std::optional<Diagnostics> no_layout_fits(const SourceText& source, const Layout& standard,
                                          const Diagnostics& problems) {
  if (!looks_foreign(first_lines(source, standard), problems)) return std::nullopt;
  std::string rejecting;
  const std::vector<std::string> fitting = layouts_that_read(source, standard.name, &rejecting);
  Diagnostics all;
  if (!fitting.empty()) {  // then mistakes as the standard layout mean nothing
    all.add({Severity::error,
             "S105",
             {source.name(), 0, 0, 0},
             "the deck has the marks of no layout; " + fitting_words(fitting),
             {}});
    return all;
  }
  if (!rejecting.empty()) {
    all.add({Severity::error,
             "S106",
             {source.name(), 0, 0, 0},
             "without a mistake it reads as " + rejecting + ": that is not computed here",
             {}});
    return all;
  }
  if (std::optional<Diagnostics> outside = outside_of_scope(source)) return outside;
  all.add({Severity::error,
           "S105",
           {source.name(), 0, 0, 0},
           "no layout fits this deck: it has the marks of none, and its first cards are not those of " +
               standard.name + "; name its layout: " + ways_on(source),
           {}});
  std::size_t shown = 0;
  for (const Diagnostic& problem : problems.list()) {
    if (problem.severity != Severity::error || problem.where.line == 0) continue;
    if (++shown > kShown) break;
    Diagnostic one = problem;
    one.message = "as " + standard.name + ": " + one.message;
    all.add(std::move(one));
  }
  if (shown > kShown)
    all.add({Severity::note, "S109", {source.name(), 0, 0, 0}, "and more mistakes as " + standard.name, {}});
  return all;
}

}  // namespace sage
