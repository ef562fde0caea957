#include "sage/safety/safety_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "sage/draw/picture.hpp"
#include "sage/draw/plot.hpp"

namespace sage::safety {

namespace {

auto to(std::string& text) {
  return std::back_inserter(text);
}

std::string number_of_node(const Model& model, int node) {
  return node < 0 ? "-" : std::to_string(model.mesh.number[node]);
}

const char* dilation_words(DilationRule rule) {
  for (const DilationRuleName& name : kDilationRules)
    if (name.rule == rule) return name.what.data();
  return "";
}

// "c / F, tan(phi) / F, tension limits / F; tan(psi) / F, like friction"
std::string rule_words(const Options& options) {
  std::string text;
  const auto add = [&](const std::string& words) { text += (text.empty() ? "" : "; ") + words; };
  if (options.divides(ModelPart::soil) || options.divides(ModelPart::joints))
    add(std::string("c / F, tan(phi) / F, tension limits / F; ") + dilation_words(options.dilation));
  if (options.divides(ModelPart::anchors)) add("forces of anchors / F");
  if (options.divides(ModelPart::walls)) add("M_p and N_p of walls / F");
  return text;
}

std::string head(const Model& model, const Options& options, const Safety& found) {
  std::string text =
      fmt::format("{}: {}\nstrength reduction: {}\n", model.file, model.title, rule_words(options));
  for (const std::string& line : found.reduced) fmt::format_to(to(text), "  divided      material {}\n", line);
  for (const std::string& line : found.untouched)
    fmt::format_to(to(text), "  not divided  material {}\n", line);
  const int stage = found.stages;
  if (options.start == Start::carried)
    fmt::format_to(
        to(text),
        "each factor starts from the state of the last one that stands; the first from stages 1 to {}\n",
        stage);
  else
    fmt::format_to(to(text), "each factor runs stages 1 to {} from the beginning\n", stage);
  return text;
}

std::string table(const Model& model, const Safety& found) {
  std::string text =
      fmt::format("{:>10}{:>11}{:>22}{:>8}{:>12}{:>10}\n", "factor", "",
                  "largest displ. [" + model.units.length + "]", "node", "iterations", "yielding");
  for (const FactorTrial& trial : found.trials)
    fmt::format_to(to(text), "{:>10.6g}{:>11}{:>22.4E}{:>8}{:>12}{:>10}\n", trial.factor,
                   verdict_word(trial.verdict), trial.displacement, number_of_node(model, trial.node),
                   trial.iterations, trial.yielded);
  return text;
}

std::string end_line(const char* name, const Safety& found, std::optional<double> factor) {
  const FactorTrial* trial = found.at(factor);
  if (trial == nullptr) return fmt::format("  {}  none found\n", name);
  return fmt::format("  {}  {:<10.6g}{}\n", name, *factor, trial->reason);
}

// What fails at the upper end, the largest part first.
std::string failing_lines(const Model& model, const Safety& found) {
  constexpr double kLeast = 0.005;
  constexpr std::size_t kMost = 6;
  std::string text;
  for (std::size_t i = 0; i < std::min(found.failing.size(), kMost); ++i) {
    const Failing& part = found.failing[i];
    if (i > 0 && part.share < kLeast) break;
    fmt::format_to(to(text), "  {}{:>5.1f} % of the dissipation  {}\n", i == 0 ? "fails    " : "         ",
                   100.0 * part.share, part_words(model.groups[part.group]));
  }
  return text;
}

}  // namespace

const char* verdict_word(Verdict verdict) {
  switch (verdict) {
    case Verdict::stands:
      return "stands";
    case Verdict::falls:
      return "falls";
    case Verdict::undecided:
      return "undecided";
  }
  return "";
}

std::string part_words(const Group& group) {
  const std::optional<ModelPart> part = part_of(group);
  return fmt::format("{}: group {}{}", part ? name_of(*part) : "water", group.number,
                     group.name.empty() ? "" : " (" + group.name + ")");
}

std::string bracket_words(const Safety& found) {
  if (found.lower && found.upper) return fmt::format("between {:.6g} and {:.6g}", *found.lower, *found.upper);
  if (found.lower) return fmt::format("above {:.6g}", *found.lower);
  if (found.upper) return fmt::format("below {:.6g}", *found.upper);
  return "unknown";
}

std::string to_text(const Model& model, const Options& options, const Safety& found) {
  std::string text = head(model, options, found) + table(model, found);
  fmt::format_to(to(text), "safety factor {}\n", bracket_words(found));
  text += end_line("lower end", found, found.lower) + end_line("upper end", found, found.upper);
  text += failing_lines(model, found);
  if (!found.incomplete.empty()) fmt::format_to(to(text), "  NOT PROVED: {}\n", found.incomplete);
  return text;
}

std::string to_csv(const Model& model, const Safety& found, int digits) {
  std::string text = "factor,from,verdict,displacement,node,out_of_balance,released,iterations,cuts,yielding\n";
  for (const FactorTrial& t : found.trials)
    fmt::format_to(to(text), "{:.{}g},{:.{}g},{},{:.{}g},{},{:.{}g},{:.{}g},{},{},{}\n", t.factor, digits,
                   t.from, digits, verdict_word(t.verdict), t.displacement, digits,
                   number_of_node(model, t.node), t.out_of_balance, digits, t.released, digits, t.iterations,
                   t.cuts, t.yielded);
  return text;
}

namespace {

// Groups of solids that have a curve of their own: those that move most, where the deck has several.
std::vector<std::size_t> groups_of_curves(const Model& model, const std::vector<const FactorTrial*>& rows) {
  constexpr std::size_t kMost = 6;
  std::vector<std::size_t> groups;
  const bool known =
      std::ranges::any_of(rows, [](const FactorTrial* t) { return !t->displacement_of_groups.empty(); });
  for (std::size_t g = 0; known && g < model.groups.size(); ++g)
    if (model.groups[g].solid() && !model.groups[g].overlay && model.groups[g].elements() > 0)
      groups.push_back(g);
  if (groups.size() < 2) return {};
  const auto last = [&](std::size_t g) {
    const std::vector<double>& moved = rows.back()->displacement_of_groups;
    return g < moved.size() ? -moved[g] : 0.0;
  };
  std::ranges::stable_sort(groups, {}, last);
  groups.resize(std::min(groups.size(), kMost));
  return groups;
}

}  // namespace

std::string curve_svg(const Model& model, const Safety& found) {
  Plot plot;
  plot.title = model.title;
  plot.x_label = "largest displacement [" + model.units.length + "]";
  plot.y_label = "strength reduction factor F";
  PlotSeries stands{.name = "equilibrium", .x = {}, .y = {}, .markers = true, .style = 0};
  std::vector<const FactorTrial*> rows;
  for (const FactorTrial& trial : found.trials)
    if (trial.verdict == Verdict::stands) rows.push_back(&trial);
  std::ranges::sort(rows, {}, [](const FactorTrial* t) { return t->factor; });
  for (const FactorTrial* trial : rows) {
    stands.x.push_back(trial->displacement);
    stands.y.push_back(trial->factor);
  }
  const double most = stands.x.empty() ? 1.0 : std::max(stands.x.back(), 1e-300);
  plot.series.push_back(std::move(stands));
  int style = 2;
  for (const std::size_t g : groups_of_curves(model, rows)) {
    const Group& group = model.groups[g];
    PlotSeries curve{.name = group.name.empty() ? fmt::format("group {}", group.number) : group.name,
                     .x = {},
                     .y = {},
                     .markers = true,
                     .style = style++};
    for (const FactorTrial* trial : rows) {
      curve.x.push_back(trial->displacement_of_groups.empty() ? 0.0 : trial->displacement_of_groups[g]);
      curve.y.push_back(trial->factor);
    }
    plot.series.push_back(std::move(curve));
  }
  if (found.upper)
    plot.series.push_back({.name = "no equilibrium",
                           .x = {0.0, most},
                           .y = {*found.upper, *found.upper},
                           .dashed = true,
                           .style = 1});
  return plot_svg(plot);
}

std::string mechanism_svg(Model& model, const Safety& found) {
  if (!found.mechanism) return {};
  if (model.fields.find("shear_strain") == nullptr)
    model.fields.add({.name = "shear_strain",
                      .meaning = "largest shear strain in the plane",
                      .value = StrainField{
                          [](const Vector4& e, double* value) { *value = std::hypot(e[0] - e[1], e[3]); }}});
  PictureOptions look;
  look.deformed = true;  // a mechanism is a movement
  look.state = fmt::format("attempt at F = {:.6g}, scaled", found.mechanism_factor);
  look.arrows = true;
  return field_svg(model, found.mechanism->view(), "shear_strain", look);
}

}  // namespace sage::safety
