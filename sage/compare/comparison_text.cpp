#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "sage/compare/comparison.hpp"
#include "sage/record/discretisation.hpp"
#include "sage/record/number.hpp"
#include "sage/record/values.hpp"

namespace sage::compare {

namespace {

// Rounding beside numbers of size `scale` is shown as 0; the CSV has it.
std::string shown(double value, double scale = 0.0) {
  if (std::abs(value) < 1e-11 * scale) return "0";
  return std::isnan(value) ? "-" : fmt::format("{:.6g}", value);
}

std::string shown_relative(const Row& row) {
  const double r = row.relative();
  if (std::isnan(r)) return "-";
  return std::abs(r) < 1e-4 && r != 0.0 ? fmt::format("{:+.1e}", r) : fmt::format("{:+.3f}%", 100.0 * r);
}

// Columns of a page: the names and units of a table share the first ones.
constexpr std::size_t kNameAndUnit = 43;

// A name, its unit and the cells of a row.  A name that leaves its unit no room has a line of its own.
void line(std::string& text, const std::string& name, const std::string& unit, const std::string& first,
          const std::string& second, const std::string& last) {
  if (name.size() + 1 + unit.size() > kNameAndUnit)
    fmt::format_to(std::back_inserter(text), "{}\n{:>{}}", name, unit, kNameAndUnit);
  else
    fmt::format_to(std::back_inserter(text), "{}{:>{}}", name, unit, kNameAndUnit - name.size());
  fmt::format_to(std::back_inserter(text), " {:>12} {:>12} {:>10}\n", first, second, last);
}

void table(std::string& text, const std::vector<Row>& rows) {
  std::string section;
  for (const Row& row : rows) {
    if (row.section != section) {
      section = row.section;
      text += '\n';
      line(text, section, "unit", "A", "B", "relative");
    }
    line(text, "  " + row.name, row.unit, row.zero_a() ? "0" : shown(row.a, row.scale),
         row.zero_b() ? "0" : shown(row.b, row.scale), shown_relative(row));
    if (std::isfinite(row.expected)) text += "    theory expects B / A = " + shown(row.expected) + "\n";
  }
}

// How the run of a side ended; `joint` stands before what its meshes did not reach.
std::string outcome(const Side& side, const char* joint) {
  const std::string open =
      side.not_reached().empty() ? "" : joint + ("NOT REACHED: " + one_line(side.not_reached()));
  if (side.error().empty()) return completed_words(side.model(), side.record().result.motion) + open;
  const std::string reason = one_line(side.error());
  return (side.has_state() ? "NOT COMPLETE, compared up to its last state in equilibrium: " : "NO RESULTS: ") +
         reason;
}

std::string signs(const Side& a, const Side& b, const char* joint) {
  std::string text =
      "stress and strain compression positive; displacements, loads and reactions along the axes; shear stress "
      "of a side along +x or +y";
  for (const Side* side : {&a, &b})
    if (side->has_model())
      text += fmt::format("{}{}: forces {}", joint, side == &a ? "A" : "B", forces_per(side->model()));
  return text;
}

void cells(std::string& text, std::initializer_list<double> values, int digits) {
  for (double value : values) append_optional_cell(text, value, digits);
  text += '\n';
}

// With the error of the mesh where it is known.
std::string with_mesh_error(double value, double error) {
  if (value == 0.0) return "0";
  return std::isfinite(error) && std::isfinite(value) ? with_error(value, error) : shown(value);
}

// Sides whose value is less certain than was asked for; empty if there is none.
std::string doubt_of(const Answer& answer) {
  std::string text;
  const bool a = !answer.reached_a, b = !answer.reached_b;
  if (a || b) text += std::string("NOT REACHED in ") + (a && b ? "A and B" : a ? "A" : "B");
  for (const auto& [letter, error] : {std::pair{"A", answer.error_a}, std::pair{"B", answer.error_b}})
    if (std::isinf(error))
      text += (text.empty() ? "error unknown in " : "; error unknown in ") + std::string(letter);
  return text;
}

// What the reports of both sides end with, and the ratio that theory expects.
void answers(std::string& text, const Comparison& c, const Side& a, const Side& b) {
  if (!a.has_state() || !b.has_state()) return;
  if (c.answers.empty()) {
    text += "\nThe decks have no report in common. Add a report card, or --point x,y.\n";
    return;
  }
  const auto title = [](const Side& side, const char* letter) {
    return fmt::format("{} ({})", letter,
                       side.model().geometry == Geometry::axisymmetric ? "axisymmetry" : "plane strain");
  };
  const auto entry = [&text](const std::string& name, const std::string& value) {
    fmt::format_to(std::back_inserter(text), "    {:<18} {}\n", name, value);
  };
  text += "\nreported at the end\n";
  for (const Answer& answer : c.answers) {
    text += fmt::format("  {} [{}]\n", answer.name, answer.unit);
    entry(title(a, "A"), with_mesh_error(answer.a, answer.error_a));
    entry(title(b, "B"), with_mesh_error(answer.b, answer.error_b));
    entry("B / A", answer.ratio_known() ? with_mesh_error(answer.ratio(), answer.ratio_error()) : "-");
    const std::string expected = std::isfinite(answer.expected) ? shown(answer.expected) : "";
    entry("theory", expected + (expected.empty() || answer.why.empty() ? "" : ": ") + answer.why);
    if (const std::string doubt = doubt_of(answer); !doubt.empty()) entry("certainty", doubt);
  }
}

void theory(std::string& text, const Comparison& c) {
  if (c.theory.empty()) return;
  text += '\n';
  line(text, "theory", "unit", "expected", "found", "relative");
  for (const Expectation& e : c.theory) {
    const Row row{"", "", "", e.expected, e.found};
    line(text, "  " + e.what, e.unit, shown(e.expected), shown(e.found),
         std::isfinite(e.expected) ? shown_relative(row) : "-");
    if (!e.why.empty()) text += "    " + e.why + "\n";
  }
}

}  // namespace

std::string to_text(const Comparison& c, const Side& a, const Side& b) {
  std::string text;
  for (const Side* side : {&a, &b}) text += side->label() + "\n   " + outcome(*side, "\n   ") + "\n";
  answers(text, c, a, b);
  theory(text, c);
  table(text, c.rows);
  text += '\n';
  for (const std::string& note : c.notes) text += "note: " + note + "\n";
  text += "relative: (B - A) / |A|, or (found - expected) / |expected|\n";
  text += "signs: " + signs(a, b, "\n") + "\n";
  return text;
}

std::string to_csv(const Comparison& c, const Side& a, const Side& b, int digits) {
  std::string text;
  for (const Side* side : {&a, &b}) text += "# " + side->label() + ": " + outcome(*side, "; ") + "\n";
  text += "# signs: " + signs(a, b, "; ") + "\n";
  for (const std::string& note : c.notes) text += "# " + note + "\n";
  text += "section,quantity,unit,A,B,difference,relative[-],expected_ratio[-],error_A,error_B\n";
  const auto quoted = [](std::string words) {
    std::erase(words, '"');
    return words.find(',') == std::string::npos ? words : "\"" + words + "\"";
  };
  for (const Answer& answer : c.answers) {
    text += "reported at the end," + quoted(answer.name) + "," + quoted(answer.unit);
    const Row row{"", "", "", answer.a, answer.b};
    cells(
        text,
        {answer.a, answer.b, row.difference(), row.relative(), answer.expected, answer.error_a, answer.error_b},
        digits);
  }
  for (const auto* list : {&c.rows, &c.details})
    for (const Row& row : *list) {
      text += quoted(row.section) + "," + quoted(row.name) + "," + quoted(row.unit);
      cells(text, {row.a, row.b, row.difference(), row.relative(), row.expected, std::nan(""), std::nan("")},
            digits);
    }
  for (const Expectation& e : c.theory) {
    text += "theory (A = expected; B = found)," + quoted(e.what) + "," + quoted(e.unit);
    const Row row{"", "", "", e.expected, e.found};
    cells(text,
          {e.expected, e.found, e.found - e.expected, row.relative(), std::nan(""), std::nan(""), std::nan("")},
          digits);
  }
  return text;
}

}  // namespace sage::compare
