// What is written about the cases: terminal, CSV, Markdown, plots.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "sage/draw/plot.hpp"
#include "sage/page/page.hpp"
#include "tests/studies/verify/book.hpp"

namespace sage::verify {

namespace {

// Seven digits are those of a card; blank where there is no number.
std::string value(double x) {
  if (std::isnan(x)) return "";
  if (x == 0.0) return "0";
  return std::abs(x) < 1e-3 || std::abs(x) >= 1e6 ? fmt::format("{:.3e}", x) : fmt::format("{:.7g}", x);
}

std::string error_text(const Row& row) {
  return std::isnan(row.error) ? "" : fmt::format("{:.1e}", row.error);
}

std::string gate_text(const Row& row) {
  return std::isnan(row.gate) ? "" : fmt::format("{:.2g}{}", row.gate, row.relative ? " rel" : "");
}

std::string result_text(const Row& row) {
  return row.pass ? "pass" : "**FAIL**";
}

std::string order_text(const Row& row) {
  return std::isnan(row.order) ? "" : fmt::format("{:.2f} ({:.2f})", row.order, row.theory);
}

std::string line_of(const std::string& name, const Row& row, const std::string& what, double seconds) {
  return fmt::format("{:<26} {:<12} {:>11} {:>11} {:>8} {:>9} {:>11} {:>6.2f} s {}  {}\n", name,
                     name_of(row.where), value(row.reference), value(row.computed), error_text(row),
                     gate_text(row), order_text(row), seconds, row.pass ? "pass" : "FAIL", what);
}

// Rows of one geometry together.
struct Part {
  const Row* worst = nullptr;
  int rows = 0;
  double seconds = 0.0;
};

std::vector<Part> parts_of(const CaseResult& outcome) {
  std::vector<Part> parts;
  for (Where where : {Where::plane_strain, Where::axisymmetric, Where::point}) {
    Part part;
    for (const Row& row : outcome.rows) {
      if (row.where != where) continue;
      ++part.rows;
      part.seconds += row.seconds;
      if (part.worst == nullptr || row.used > part.worst->used) part.worst = &row;
    }
    if (part.rows > 0) parts.push_back(part);
  }
  return parts;
}

// Sequences of one case, geometry and quantity (the name up to its comma): a picture.
struct Figure {
  std::string file, title;
  std::vector<const Sequence*> sequences;
};

std::vector<Figure> figures_of(const CaseResult& result) {
  std::vector<Figure> figures;
  for (const Sequence& s : result.sequences) {
    const std::string quantity = s.name.substr(0, s.name.find(','));
    const std::string title = fmt::format("{}: error of {}, {}", result.of->name, quantity, name_of(s.where));
    const auto same =
        std::find_if(figures.begin(), figures.end(), [&](const Figure& g) { return g.title == title; });
    if (same != figures.end()) {
      same->sequences.push_back(&s);
      continue;
    }
    figures.push_back({fmt::format("{}_{}.svg", result.of->name, figures.size() + 1), title, {&s}});
  }
  return figures;
}

// The theory's slopes pass below the curves.
Plot plot_of(const Figure& figure) {
  Plot plot;
  plot.title = figure.title;
  plot.x_label = "size of cells or steps [-]";
  plot.y_label = "relative error [-]";
  plot.log_x = plot.log_y = true;
  plot.width = 900;
  std::map<double, std::pair<double, const Sequence*>> lowest;  // by theory: last error of the best curve
  for (const Sequence* s : figure.sequences) {
    const std::size_t comma = s->name.find(',');
    plot.series.push_back({comma == std::string::npos ? s->name : s->name.substr(comma + 2), s->size, s->error,
                           true, true, false});
    auto& [error, best] = lowest[s->theory];
    if (best == nullptr || s->error.back() < error) error = s->error.back(), best = s;
  }
  for (const auto& [theory, end] : lowest) {
    const double first = end.second->size.front(), last = end.second->size.back(), low = 0.5 * end.first;
    plot.series.push_back({fmt::format("theory: order {:.3g}", theory),
                           {first, last},
                           {low * std::pow(first / last, theory), low},
                           true,
                           false,
                           true});
  }
  return plot;
}

void add_case(Page& page, const CaseResult& outcome, const std::string& picture_folder) {
  const Case& c = *outcome.of;
  page.heading(3, c.name + ": " + c.title);
  page.prose(fmt::format("Reference: {} ({}). Gate: {}. {:.2g} s, **{}**.", c.source, name_of(c.grade), c.gate,
                         outcome.seconds, outcome.pass() ? "pass" : "FAIL"));
  const bool orders = std::any_of(outcome.rows.begin(), outcome.rows.end(),
                                  [](const Row& row) { return !std::isnan(row.order); });
  std::vector<std::string> head{"geometry", "what", "reference", "computed", "error", "gate", "result"};
  if (orders) head.insert(head.end() - 1, "order (theory)");
  page.table(head);
  for (const Row& row : outcome.rows) {
    std::vector<std::string> cells{name_of(row.where),  Page::cell(row.what), value(row.reference),
                                   value(row.computed), error_text(row),      gate_text(row),
                                   result_text(row)};
    if (orders) cells.insert(cells.end() - 1, order_text(row));
    page.row(cells);
  }
  for (const Figure& figure : figures_of(outcome))
    page.figure(figure.title, picture_folder + "/" + figure.file);
}

void add_overview(Page& page, const std::vector<Chapter>& chapters) {
  page.table(
      {"case", "geometry", "what", "row closest to its gate", "error", "gate", "order (theory)", "result"});
  for (const Chapter& chapter : chapters)
    for (const CaseResult& outcome : chapter.outcomes)
      for (const Part& part : parts_of(outcome))
        page.row({outcome.of->name, name_of(part.worst->where), Page::cell(outcome.of->title),
                  Page::cell(part.worst->what), error_text(*part.worst), gate_text(*part.worst),
                  order_text(*part.worst), result_text(*part.worst)});
}

constexpr const char* kPreface[] = {
    "Every case builds a deck, reads it with the program's own reader, runs it and compares. The *gate* of a "
    "row "
    "is its largest permitted error. If the gate is marked `rel`, the error is computed/reference - 1, "
    "otherwise "
    "computed - reference. If a range is permitted, the reference is its middle and the gate half its width. A "
    "row with an order of convergence has no gate: it passes if the order is at least the theoretical one, in "
    "brackets, minus 0.15, unless the case has another limit. A failing "
    "case stays in the table as failing, and `sagefe verify` then ends with exit code 3.",
    "**Signs and units.** As in decks and results, pressures and bearing loads are positive in compression. "
    "Stress "
    "components that are compared with formulas (sigma_r, sigma_z, ...) are tension positive, and marked so. "
    "Displacements are along the axes. Forces are per unit thickness in plane strain and for the full circle "
    "in "
    "axisymmetry. Numbers are in consistent units, mostly with E, a pressure and a length of 1; angles are in "
    "degrees.",
    "**References.** *closed form*: exact, with the formula in the source file of the case. *converged "
    "computation*: "
    "an independent hp finite-element, root-finding or ODE computation, good to the digits shown. *published "
    "value*: "
    "printed in the named source. *two ways*: one model computed in two ways that must agree."};

}  // namespace

std::string table_header() {
  return fmt::format("{:<26} {:<12} {:>11} {:>11} {:>8} {:>9} {:>11} {:>8}       {}\n", "case", "geometry",
                     "reference", "computed", "error", "gate", "order (th.)", "time",
                     "row closest to its gate [of so many]");
}

std::string table_text(const Chapter& chapter, bool with_rows) {
  std::string text;
  for (const CaseResult& outcome : chapter.outcomes) {
    if (with_rows)
      for (const Row& row : outcome.rows) text += line_of(outcome.of->name, row, row.what, row.seconds);
    else
      for (const Part& part : parts_of(outcome)) {
        const std::string more = part.rows > 1 ? fmt::format(" [{}]", part.rows) : "";
        text += line_of(outcome.of->name, *part.worst, part.worst->what + more, part.seconds);
      }
    // What fails is never hidden behind what fails more.
    for (const Row& row : outcome.rows)
      if (!row.pass) text += fmt::format("    FAIL {}: {}\n", name_of(row.where), row.what);
  }
  return text;
}

std::string csv_text(const std::vector<Chapter>& chapters) {
  std::string text =
      "section,case,geometry,what,reference,computed,error,error_kind,gate,order,theory,seconds,pass,grade,"
      "source\n";
  const auto quoted = [](std::string s) {
    for (std::size_t at = 0; (at = s.find('"', at)) != std::string::npos; at += 2) s.insert(at, "\"");
    return "\"" + s + "\"";
  };
  const auto number = [](double x) { return std::isfinite(x) ? fmt::format("{:.10g}", x) : std::string(); };
  for (const Chapter& chapter : chapters)
    for (const CaseResult& outcome : chapter.outcomes)
      for (const Row& row : outcome.rows)
        text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{:.4f},{},{},{}\n", quoted(chapter.title),
                            outcome.of->name, name_of(row.where), quoted(row.what), number(row.reference),
                            number(row.computed), number(row.error), row.relative ? "relative" : "absolute",
                            number(row.gate), number(row.order), number(row.theory), row.seconds,
                            row.pass ? 1 : 0, name_of(outcome.of->grade), quoted(outcome.of->source));
  return text;
}

std::string markdown_text(const std::vector<Chapter>& chapters, const std::string& picture_folder) {
  int cases = 0, rows = 0, failing = 0;
  double seconds = 0.0;
  for (const Chapter& chapter : chapters)
    for (const CaseResult& outcome : chapter.outcomes) {
      ++cases;
      rows += static_cast<int>(outcome.rows.size());
      failing += outcome.pass() ? 0 : 1;
      seconds += outcome.seconds;
    }
  Page page("Verification book");
  page.note("Written by `sagefe verify --write`: run it again, do not edit.");
  for (const char* words : kPreface) page.prose(words);
  page.prose(fmt::format("{} cases with {} rows, {} failing; {:.0f} s.", cases, rows, failing, seconds));
  add_overview(page, chapters);
  bool first = true;
  for (const Chapter& chapter : chapters) {
    if (chapter.outcomes.empty()) continue;
    if (!first) page.gap();
    first = false;
    page.heading(2, chapter.title);
    for (const CaseResult& outcome : chapter.outcomes) add_case(page, outcome, picture_folder);
  }
  return page.text();
}

std::vector<NamedPicture> pictures(const std::vector<Chapter>& chapters) {
  std::vector<NamedPicture> list;
  for (const Chapter& chapter : chapters)
    for (const CaseResult& result : chapter.outcomes)
      for (const Figure& figure : figures_of(result)) list.push_back({figure.file, plot_svg(plot_of(figure))});
  return list;
}

}  // namespace sage::verify
