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

void table(std::string& text, const std::vector<Row>& rows) {
  const auto out = std::back_inserter(text);
  std::string section;
  for (const Row& row : rows) {
    if (row.section != section) {
      section = row.section;
      fmt::format_to(out, "\n{:<46} {:>8} {:>13} {:>13} {:>13} {:>10} {:>9}\n", section, "unit", "A", "B",
                     "B - A", "relative", "B/A exp.");
    }
    fmt::format_to(out, "  {:<44} {:>8} {:>13} {:>13} {:>13} {:>10} {:>9}\n", row.name, row.unit,
                   row.zero_a() ? "0" : shown(row.a, row.scale), row.zero_b() ? "0" : shown(row.b, row.scale),
                   shown(row.difference(), row.scale), shown_relative(row), shown(row.expected));
  }
}

std::string outcome(const Side& side) {
  const std::string open = side.not_reached().empty() ? "" : "; NOT REACHED: " + one_line(side.not_reached());
  if (side.error().empty()) return completed_words(side.model(), side.record().result.motion) + open;
  const std::string reason = one_line(side.error());
  return (side.has_state() ? "NOT COMPLETE, compared up to its last state in equilibrium: " : "NO RESULTS: ") +
         reason;
}

std::string signs(const Side& a, const Side& b) {
  std::string text =
      "stress and strain compression positive; displacements, loads and reactions along the axes; shear stress "
      "of "
      "a side along +x or +y";
  for (const Side* side : {&a, &b})
    if (side->has_model())
      text += fmt::format("; {}: forces {}", side == &a ? "A" : "B", forces_per(side->model()));
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

std::string why_of(const Answer& answer) {
  std::string text = answer.why;
  const bool a = !answer.reached_a, b = !answer.reached_b;
  if (a || b) text += std::string("; NOT REACHED in ") + (a && b ? "A and B" : a ? "A" : "B");
  for (const auto& [letter, error] : {std::pair{"A", answer.error_a}, std::pair{"B", answer.error_b}})
    if (std::isinf(error)) text += std::string("; error unknown in ") + letter;
  return text;
}

// The question that is asked first: what the reports say in both, and what was to be expected of it.
void answers(std::string& text, const Comparison& c, const Side& a, const Side& b) {
  const auto out = std::back_inserter(text);
  if (!a.has_state() || !b.has_state()) return;
  if (c.answers.empty()) {
    text +=
        "\nThe decks report nothing that both have: a report card or --point x,y says what is to be "
        "compared.\n";
    return;
  }
  const auto title = [](const Side& side, const char* letter) {
    return fmt::format("{} ({})", letter,
                       side.model().geometry == Geometry::axisymmetric ? "axisymmetry" : "plane strain");
  };
  fmt::format_to(out, "\n{:<28} {:>8} {:>34} {:>34} {:>30} {:>10}\n", "reported at the end", "unit",
                 title(a, "A"), title(b, "B"), "B / A", "theory");
  for (const Answer& answer : c.answers)
    fmt::format_to(out, "  {:<26} {:>8} {:>34} {:>34} {:>30} {:>10}  {}\n", answer.name, answer.unit,
                   with_mesh_error(answer.a, answer.error_a), with_mesh_error(answer.b, answer.error_b),
                   answer.ratio_known() ? with_mesh_error(answer.ratio(), answer.ratio_error()) : "-",
                   shown(answer.expected), why_of(answer));
}

void theory(std::string& text, const Comparison& c) {
  if (c.theory.empty()) return;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "\n{:<46} {:>8} {:>13} {:>13} {:>10}\n", "theory", "unit", "expected", "found",
                 "relative");
  for (const Expectation& e : c.theory) {
    const Row row{"", "", "", e.expected, e.found};
    fmt::format_to(out, "  {:<44} {:>8} {:>13} {:>13} {:>10}  {}\n", e.what, e.unit, shown(e.expected),
                   shown(e.found), std::isfinite(e.expected) ? shown_relative(row) : "-", e.why);
  }
}

}  // namespace

std::string to_text(const Comparison& c, const Side& a, const Side& b) {
  std::string text;
  const auto out = std::back_inserter(text);
  for (const Side* side : {&a, &b}) fmt::format_to(out, "{}\n   {}\n", side->label(), outcome(*side));
  answers(text, c, a, b);
  theory(text, c);
  table(text, c.rows);
  text += '\n';
  for (const std::string& note : c.notes) text += "note: " + note + "\n";
  text +=
      "relative: (B - A) / |A|, or (found - expected) / |expected|. B/A exp.: what theory expects of B / A.\n";
  text += "signs: " + signs(a, b) + "\n";
  return text;
}

std::string to_csv(const Comparison& c, const Side& a, const Side& b, int digits) {
  std::string text;
  for (const Side* side : {&a, &b}) text += "# " + side->label() + ": " + outcome(*side) + "\n";
  text += "# signs: " + signs(a, b) + "\n";
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
