#include "tests/studies/figures/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "sage/page/page.hpp"

namespace sage::figures {

namespace {

const char* name_of(Quantity quantity) {
  constexpr const char* kNames[] = {"",
                                    "sigma_r",
                                    "sigma_theta",
                                    "sigma_z",
                                    "tau",
                                    "dev",
                                    "conf",
                                    "stress level",
                                    "normal",
                                    "shear",
                                    "stress level of the interface"};
  return kNames[static_cast<std::size_t>(quantity)];
}

const char* name_of(Place place) {
  switch (place) {
    case Place::everywhere:
      return "";
    case Place::near_ends:
      return "z >= .75 H";
    case Place::near_axis:
      return "r <= .25 R";
    case Place::near_rim:
      return "r >= .75 R";
    case Place::end:
      return "last row of elements";
    case Place::away_from_end:
      return "z <= .5 H";
    case Place::not_near_ends:
      return "z < .75 H";
    case Place::below_ends:
      return "z < .70 H";
    case Place::halfway:
      return ".25 H <= z <= .75 H";
    case Place::mid_axis:
      return "z <= .25 H, r <= .25 R";
    case Place::end_axis:
      return "z >= .75 H, r <= .25 R";
    case Place::at_end_axis:
      return "axis and end";
    case Place::at_end_rim:
      return "rim and end";
    case Place::at_mid_axis:
      return "axis and mid-height";
    case Place::at_mid_rim:
      return "rim and mid-height";
  }
  return "";
}

// x and y: values of the first and the second source; c: correct; q: correct deviator stress.
// NOLINTNEXTLINE(readability-function-size): a row a measure
const char* words_of(Measure measure) {
  switch (measure) {
    case Measure::elements:
      return "solid elements";
    case Measure::diameter:
      return "diameter, in";
    case Measure::height:
      return "height of the whole specimen, in";
    case Measure::platen_flat:
      return "largest \\|u_z / prescribed - 1\\| of the platen";
    case Measure::change_most:
      return "largest \\|x - c\\| / q";
    case Measure::percent_most:
      return "largest \\|x - c\\| / c";
    case Measure::change_mean:
      return "mean (x - c) / q";
    case Measure::percent_mean:
      return "mean (x - c) / c";
    case Measure::excess_least:
      return "smallest (x - c) / q";
    case Measure::nearness:
      return "(largest x - correct conf) / (correct dev - correct conf)";
    case Measure::least:
      return "smallest x / q";
    case Measure::distance_most:
      return "from the largest x to the place, radii";
    case Measure::distance_least:
      return "from the smallest x to the place, radii";
    case Measure::rows_at_axis:
      return "share of rows whose largest x is at the axis";
    case Measure::row_range:
      return "largest range of x in a row / q";
    case Measure::share_close:
      return "share with \\|x - c\\| <= p q";
    case Measure::share_below:
      return "share with x <= p";
    case Measure::share_above:
      return "share with x >= p";
    case Measure::above_r:
      return "mean r / R of where x >= p";
    case Measure::above_in:
      return "share of where x >= p that lies there";
    case Measure::difference:
      return "largest \\|x - y\\| / q";
    case Measure::correlation:
      return "correlation of x - c and y - c";
    case Measure::change_ratio:
      return "largest \\|x - c\\| / largest \\|y - c\\|";
    case Measure::change_ratio_mean:
      return "mean \\|x - c\\| / mean \\|y - c\\|";
    case Measure::mean_gap:
      return "mean x there less mean x elsewhere";
    case Measure::mean_step:
      return "\\|mean x - mean y\\|";
    case Measure::range:
      return "largest x - smallest x";
    case Measure::yielded:
      return "share of points that have yielded";
    case Measure::yielded_ratio:
      return "yielded share, x / y";
    case Measure::yielded_r:
      return "mean r / R of yielded points";
    case Measure::yielded_z:
      return "mean z / H of yielded points";
    case Measure::yielded_r_step:
      return "mean r / R of yielded points, x - y";
    case Measure::yielded_z_step:
      return "z / H below which 95 % of the yielded points lie, x - y";
    case Measure::yielded_edge:
      return "z / H above which less than half of every row has yielded";
    case Measure::unyielded:
      return "share of points that have not yielded";
    case Measure::joint_most:
      return "largest value";
    case Measure::joint_most_ever:
      return "largest value at any strain";
    case Measure::ratio:
      return "measured / correct";
    case Measure::excess:
      return "measured / correct - 1";
    case Measure::excess_most:
      return "largest \\|measured / correct - 1\\| at any strain";
    case Measure::excess_ratio:
      return "(measured / correct - 1), x / y";
    case Measure::excess_difference:
      return "difference of measured / correct";
    case Measure::excess_spread:
      return "(largest - smallest) / largest of measured / correct - 1";
    case Measure::ratio_spread:
      return "largest - smallest measured / correct";
    case Measure::ratio_spread_both:
      return "largest - smallest measured / correct of both";
    case Measure::normalised:
      return "largest difference of measured / E, relative";
    case Measure::first_above:
      return "strain in % from which measured / correct > p";
    case Measure::yield_strain:
      return "strain in % at which half of the points yield";
    case Measure::measured:
      return "measured deviator stress, psi";
    case Measure::nu_rises:
      return "least rise of the excess with nu, relative";
    case Measure::nu_bow:
      return "distance from the chord over nu, relative";
  }
  return "";
}

std::string source_text(const Source& source) {
  std::string text = name_of(source.quantity);
  text += (text.empty() ? "" : " of ") + fmt::format("`{}` at {:g} %", source.scene, source.strain);
  return text;
}

bool of_model(Measure measure) {
  return measure == Measure::elements || measure == Measure::diameter || measure == Measure::height ||
         measure == Measure::platen_flat;
}

std::string rounded(double number) {
  return std::isnan(number) ? "none" : fmt::format("{:.4g}", number);
}

// "0.2403", or "0.243 (0.240)": in brackets away from the corner where that is another number.
std::string with_corner(const std::array<double, 2>& number) {
  const std::string all = rounded(number[0]), away = rounded(number[1]);
  return all == away ? all : all + " (" + away + ")";
}

std::string verdict_text(const Result& result) {
  return fmt::format("**{}**{}", verdict_words(result), result.b_bar_only ? " (with B-bar it does)" : "");
}

void append_check(Page& out, const Result& result) {
  const Check& check = *result.check;
  bool first = true;
  for (const Outcome& outcome : result.outcomes) {
    const std::string k_j =
        outcome.k_j > 0.0 ? fmt::format("K_j = {:.3g}: {}", outcome.k_j, name_of(verdict_of(outcome))) : "";
    out.row({first ? check.quote : "", first ? what_of(check) : "", first ? limits_of(check) : "",
             with_corner(outcome.number[0]), with_corner(outcome.number[1]),
             first ? verdict_text(result) + (k_j.empty() ? "" : "; " + k_j) : k_j,
             first ? result.shown_to_fail : ""});
    first = false;
  }
}

std::set<std::string> scenes_of(const std::vector<Result>& results, int figure) {
  std::set<std::string> names;
  for (const Result& result : results) {
    if (result.check->figure != figure) continue;
    names.insert(result.check->a.scene);
    if (result.check->b.scene != nullptr) names.insert(result.check->b.scene);
  }
  return names;
}

void append_figure(Page& out, const Evaluation& all, int figure, const std::string& ending) {
  out.heading(2, fmt::format("Figure 7.{}: {}", figure, caption_of(figure).title));
  out.figure(fmt::format("Figure 7.{}", figure), file_of(figure, ending));
  for (const std::string& name : scenes_of(all.results, figure))
    out.item("`" + name + "`: " + parameters_of(scene_named(name)));
  out.paragraph(tally(all.results, figure) + ".");
  out.table({"the chapter", "computed", "limit", "full 4-node", "B-bar", "verdict", "seen to fail"});
  for (const Result& result : all.results)
    if (result.check->figure == figure) append_check(out, result);
}

std::string name_of(const StiffnessRow& row) {
  return fmt::format("K_j = {:.3g} ({})", row.choice.k_j, row.choice.name);
}

void append_ratios(Page& out, const std::vector<StiffnessRow>& rows) {
  std::vector<std::string> head{"", "printed"};
  for (const StiffnessRow& row : rows) head.push_back(name_of(row));
  out.table(head);
  for (std::size_t i = 0; i < rows[0].entries.size(); ++i) {
    std::vector<std::string> cells{rows[0].entries[i].what, fmt::format("{:g}", rows[0].entries[i].printed)};
    for (const StiffnessRow& row : rows) {
      const char* mark = row.entries[i].meets() ? "**" : "";
      cells.push_back(fmt::format("{}{:.5f}{}", mark, row.entries[i].computed, mark));
    }
    out.row(cells);
  }
}

// Figures that the K_j of row k meets, and those that it does not.
std::string met_and_not(const std::vector<Result>& results, std::size_t k, std::size_t count) {
  std::set<int> all, missed;
  for (const Result& result : results) {
    if (result.outcomes.size() != count) continue;
    all.insert(result.check->figure);
    const Verdict verdict = verdict_of(result.outcomes[k]);
    if (verdict != Verdict::holds && verdict != Verdict::away_from_corner) missed.insert(result.check->figure);
  }
  std::string met, not_met;
  for (int figure : all) (missed.contains(figure) ? not_met : met) += fmt::format(" 7.{}", figure);
  return fmt::format("met{}; not met{}", met, not_met.empty() ? " none" : not_met);
}

void append_stiffness(Page& out, const std::vector<StiffnessRow>& rows, const std::vector<Result>& results) {
  if (rows.empty()) return;
  out.heading(2, "K_j of the lubricated platen");
  if (rows.size() < 3) out.paragraph("No K_j meets the 3 percent of Figure 7.18.");
  out.paragraph(
      "Ratios of Tables 7.3 (10 %) and 7.4 as printed, and with three K_j (full 4-node elements, "
      "increments of 0.05 %); **bold**: rounds to the printed number.");
  append_ratios(out, rows);
  out.paragraph(
      "Figures of which it meets every check that depends on K_j, with both elements (there or away from the "
      "corner):");
  for (std::size_t k = 0; k < rows.size(); ++k)
    out.item(name_of(rows[k]) + ": " + met_and_not(results, k, rows.size()));
}

}  // namespace

std::string what_of(const Check& check) {
  std::string text = words_of(check.measure);
  if (of_model(check.measure)) return text;
  if (check.target != Place::everywhere) text += std::string(" (") + name_of(check.target) + ")";
  if (check.p != 0.0) text += fmt::format(", p = {:g}", check.p);
  text += "; x: " + source_text(check.a);
  if (check.b.scene != nullptr) text += "; y: " + source_text(check.b);
  if (check.place != Place::everywhere) text += std::string("; where ") + name_of(check.place);
  return text;
}

std::string limits_of(const Check& check) {
  std::string text;
  if (check.low == check.high)
    text = fmt::format("{:.6g}", check.low);
  else if (std::isfinite(check.low) && std::isfinite(check.high))
    text = fmt::format("{:.4g} to {:.4g}", check.low, check.high);
  else if (std::isfinite(check.low))
    text = fmt::format("at least {:.4g}", check.low);
  else
    text = fmt::format("at most {:.4g}", check.high);
  if (*check.word != '\0') text += fmt::format(" ({})", check.word);
  return text;
}

std::string file_of(int figure, const std::string& ending) {
  return fmt::format("figure_7_{:02}.{}", figure, ending);
}

std::string parameters_of(const Scene& scene) {
  const char* end = scene.end == scenes::SpecimenEnd::pinned   ? "pinned ends"
                    : scene.end == scenes::SpecimenEnd::smooth ? "frictionless ends"
                    : scene.lubricated()                       ? "platen with phi = 0.8, n = 1, K_j as said"
                                                               : "platen with phi = 28.5, K_j = 5000, n = 0.9";
  return fmt::format(
      "L/D = {:g}, {}, {}, E = {:g} psi, nu = {:.4g}, cell pressure {:g} psi; {} elements, to {:g} % of strain",
      scene.slenderness, end,
      scene.plastic ? "Drucker-Prager with c = 0, phi = 36.87, no volume change after yield" : "linear elastic",
      scene.E, scene.nu, scene.cell(), scene.slenderness == 1.0 ? "20 x 20" : "14 x 28", scene.last_strain());
}

const Caption& caption_of(int figure) {
  return captions()[figure - 1];
}

std::string tally(const std::vector<Result>& results, int figure) {
  std::array<int, 5> count{}, near{};
  for (const Result& result : results) {
    if (figure != 0 && result.check->figure != figure) continue;
    ++count[static_cast<std::size_t>(result.verdict)];
    near[static_cast<std::size_t>(result.verdict)] += result.near_limit ? 1 : 0;
  }
  std::string text;
  for (std::size_t v = 0; v < count.size(); ++v) {
    if (count[v] == 0) continue;
    text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", name_of(static_cast<Verdict>(v)), count[v]);
    if (near[v] > 0) text += fmt::format(" ({} near the limit)", near[v]);
  }
  return text;
}

bool StiffnessRow::Entry::meets() const {
  return std::abs(computed - printed) <= tolerance;
}

std::vector<StiffnessRow> stiffness_rows(Runs& runs, const std::vector<StiffnessChoice>& choices) {
  struct Printed {
    const char *what, *scene;
    double strain, ratio, tolerance;
  };
  constexpr Printed kPrinted[] = {{"Table 7.3, nu = 0.250", "lub_nu25", 10, 1.0, 5e-5},
                                  {"Table 7.3, nu = 0.333", "lub_nu333", 10, 1.0, 5e-5},
                                  {"Table 7.3, nu = 0.495", "lub", 10, 1.0, 5e-5},
                                  {"Table 7.4, 2 %", "dp_lub", 2, 1.0, 5e-4},
                                  {"Table 7.4, 5 %", "dp_lub", 5, 1.0, 5e-4},
                                  {"Table 7.4, 10 %", "dp_lub", 10, 1.001, 5e-4},
                                  {"Table 7.4, 15 %", "dp_lub", 15, 1.001, 5e-4}};
  std::vector<StiffnessRow> rows;
  for (const StiffnessChoice& choice : choices) {
    StiffnessRow& row = rows.emplace_back();
    row.choice = choice;
    for (const Printed& one : kPrinted)
      row.entries.push_back({one.what, runs.get(one.scene, Elements::full, choice.k_j).ratio(one.strain),
                             one.ratio, one.tolerance});
  }
  return rows;
}

std::string page_text(const Evaluation& all, const std::string& ending) {
  Page out("The source chapter's figures");
  out.paragraph(
      "Computed by `sagefe figures`. Compression positive; psi, "
      "inches; conf = sigma_3, dev = sigma_1 - sigma_3; R = radius, H = half height, z from the "
      "mid-height; c = the correct value, q = the correct deviator stress (frictionless ends). Stresses "
      "are the means of elements, stress levels those of such means. `near the limit`: the verdict would be "
      "another one if numbers within 5 percent of a limit were on its other side. In brackets: away from the "
      "corner (without the 2 x 2 elements at the rim of the end). `seen to fail`: the scenes that were "
      "put in its place and the alterations of its field with which the check fails; `itself`: it holds "
      "nowhere.");
  out.paragraph(tally(all.results, 0) + ".");
  append_stiffness(out, all.stiffness, all.results);
  for (int figure : all.figures) append_figure(out, all, figure, ending);
  out.heading(2, "What the words mean");
  out.table({"words", "number", "reason"});
  for (const Word& word : words()) out.row({word.words, word.number, word.reason});
  return out.text();
}

std::string csv_text(const std::vector<Result>& results) {
  const auto quoted = [](std::string text) {
    std::erase(text, '\\');  // of Markdown's tables
    for (std::size_t at = text.find('"'); at != std::string::npos; at = text.find('"', at + 2))
      text.insert(at, "\"");
    return "\"" + text + "\"";
  };
  std::string out = "figure,quote,computed,low,high,k_j,full,full_away,b_bar,b_bar_away,verdict,seen_to_fail\n";
  for (const Result& result : results)
    for (const Outcome& outcome : result.outcomes) {
      const Check& check = *result.check;
      out += fmt::format("7.{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{},{}\n", check.figure,
                         quoted(check.quote), quoted(what_of(check)), check.low, check.high, outcome.k_j,
                         outcome.number[0][0], outcome.number[0][1], outcome.number[1][0], outcome.number[1][1],
                         verdict_words(result), quoted(result.shown_to_fail));
    }
  return out;
}

}  // namespace sage::figures
