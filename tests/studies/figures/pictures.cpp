#include "tests/studies/figures/pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sage/draw/picture.hpp"
#include "sage/draw/plot.hpp"
#include "sage/draw/svg.hpp"
#include "tests/studies/figures/page.hpp"

namespace sage::figures {

namespace {

using Q = Quantity;

// A figure of fields: every quantity at every strain, in two rows (full and B-bar elements; two K_j).
struct FieldFigure {
  int figure;
  const char* scene;
  std::vector<Quantity> quantities;
  std::vector<double> strains;
};

const std::vector<FieldFigure>& field_figures() {
  static const std::vector<FieldFigure> all = {
      {4, "pinned1", {Q::sigma_r, Q::sigma_theta}, {5, 10}},
      {5, "pinned1", {Q::sigma_z, Q::tau}, {5, 10}},
      {6, "pinned1", {Q::dev, Q::conf}, {5, 10}},
      {9, "pinned2", {Q::sigma_r, Q::sigma_theta}, {5, 10}},
      {10, "pinned2", {Q::sigma_z, Q::tau}, {5, 10}},
      {11, "pinned2", {Q::dev, Q::conf}, {5, 10}},
      {14, "conv", {Q::sigma_r, Q::sigma_theta}, {5, 10}},
      {15, "conv", {Q::sigma_z, Q::tau}, {5, 10}},
      {16, "conv", {Q::dev, Q::conf}, {5, 10}},
      {18, "lub", {Q::sigma_r, Q::sigma_theta}, {5, 10}},
      {19, "lub", {Q::sigma_z, Q::tau}, {5, 10}},
      {20, "lub", {Q::dev, Q::conf}, {5, 10}},
      {24, "dp_conv", {Q::dev, Q::conf}, {2, 4}},
      {25, "dp_conv", {Q::dev, Q::conf}, {4.5, 4.95}},
      {26, "dp_conv", {Q::dev, Q::conf}, {5, 5.05}},
      {27, "dp_conv", {Q::dev, Q::conf}, {5.1, 5.5}},
      {28, "dp_conv", {Q::dev, Q::conf}, {10, 15}},
      {29, "dp_conv", {Q::level}, {4.5, 4.95}},
      {30, "dp_conv", {Q::level}, {5, 5.5}},
      {31, "dp_conv", {Q::level}, {10, 15}},
      {33, "dp_lub", {Q::dev, Q::conf}, {2, 4}},
      {34, "dp_lub", {Q::dev, Q::conf}, {4.5, 4.95}},
      {35, "dp_lub", {Q::dev, Q::conf}, {5, 5.05}},
      {36, "dp_lub", {Q::dev, Q::conf}, {5.1, 5.5}},
      {37, "dp_lub", {Q::dev, Q::conf}, {4, 10}},
      {38, "dp_lub", {Q::level}, {4.5, 4.95}},
      {39, "dp_lub", {Q::level}, {5.05, 15}},
  };
  return all;
}

const char* field_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::sigma_r:
      return "stress_xx";
    case Quantity::sigma_theta:
      return "stress_zz";
    case Quantity::sigma_z:
      return "stress_yy";
    case Quantity::tau:
      return "stress_xy";
    case Quantity::dev:
      return "stress_difference";
    case Quantity::conf:
      return "principal_stress_3";
    default:
      return "stress_level";
  }
}

const char* title_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::sigma_r:
      return "Radial stress";
    case Quantity::sigma_theta:
      return "Circumferential stress";
    case Quantity::sigma_z:
      return "Axial stress";
    case Quantity::tau:
      return "Shear stress r-z";
    case Quantity::dev:
      return "Deviator stress";
    case Quantity::conf:
      return "Confining stress";
    default:
      return "Stress level";
  }
}

std::string titled(int figure) {
  return fmt::format("Figure 7.{}: {}", figure, caption_of(figure).title);
}

// A row of panels or a family of curves: one kind of element, one K_j.
struct PanelRow {
  std::string name;
  Elements elements;
  double k_j;
};

std::vector<PanelRow> panel_rows(const char* scene, const std::vector<StiffnessChoice>& choices) {
  if (!scene_named(scene).lubricated())
    return {{"full 4-node", Elements::full, 0.0}, {"B-bar", Elements::b_bar, 0.0}};
  std::vector<PanelRow> list;
  for (const StiffnessChoice& choice : {choices.front(), choices.back()})
    list.push_back({fmt::format("K_j = {:.3g}", choice.k_j), Elements::full, choice.k_j});
  return list;
}

FieldPanel panel_of(const SpecimenRun& run, Quantity quantity, double strain) {
  FieldPanel panel;
  panel.model = run.model.get();
  panel.solution = run.state(strain).frame->view();
  panel.field = field_of(quantity);
  return panel;
}

// Whether no value of the field at one strain occurs at another: on one scale each panel would be of one colour.
bool strains_lie_apart(const FieldFigure& figure, Quantity quantity, const PictureOptions& look, Runs& runs,
                       const std::vector<PanelRow>& rows) {
  std::vector<FieldRange> ranges;
  for (double strain : figure.strains) {
    FieldRange& range = ranges.emplace_back();
    for (const PanelRow& row : rows) {
      const FieldPanel panel = panel_of(runs.get(figure.scene, row.elements, row.k_j), quantity, strain);
      const FieldRange one = field_range(*panel.model, panel.solution, panel.field, look);
      range = {std::min(range.low, one.low), std::max(range.high, one.high)};
    }
  }
  for (std::size_t i = 0; i < ranges.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (ranges[i].low <= ranges[j].high && ranges[j].low <= ranges[i].high) return false;
  return ranges.size() > 1;
}

std::string field_figure(const FieldFigure& figure, Runs& runs, const std::vector<StiffnessChoice>& choices) {
  FieldSheet sheet;
  sheet.title = titled(figure.figure);
  sheet.columns = static_cast<int>(figure.quantities.size() * figure.strains.size());
  sheet.one_scale = figure.figure != 37;  // patterns before and after yield, whose stresses differ
  sheet.look.deformed = false;
  sheet.look.width = scene_named(figure.scene).slenderness == 1.0 ? 430 : 390;  // with axis and colour bar
  sheet.look.levels = 14;
  sheet.look.yielded = figure.quantities[0] == Quantity::level;
  const std::vector<PanelRow> rows = panel_rows(figure.scene, choices);
  std::vector<bool> apart;
  for (Quantity quantity : figure.quantities)
    apart.push_back(strains_lie_apart(figure, quantity, sheet.look, runs, rows));
  for (const PanelRow& row : rows)
    for (std::size_t q = 0; q < figure.quantities.size(); ++q)
      for (double strain : figure.strains) {
        const Quantity quantity = figure.quantities[q];
        FieldPanel& panel = sheet.panels.emplace_back(
            panel_of(runs.get(figure.scene, row.elements, row.k_j), quantity, strain));
        panel.title = fmt::format("{}, {}", title_of(quantity), row.name);
        panel.state = fmt::format("{:g} %", strain);
        if (apart[q]) panel.scale = panel.state;
      }
  return sheet_svg(sheet);
}

constexpr const char* kStrainAxis = "axial strain [%]";

PlotSeries series(const std::string& name, const std::vector<double>& x, const std::vector<double>& y) {
  PlotSeries one;
  one.name = name;
  one.x = x;
  one.y = y;
  one.markers = true;  // dashes alone are too few to tell eight curves apart in grey
  return one;
}

std::vector<double> correct_of(const SpecimenRun& run) {
  std::vector<double> all;
  for (double strain : run.strain) all.push_back(run.scene->correct(strain));
  return all;
}

std::vector<double> scaled(std::vector<double> values, double factor) {
  for (double& x : values) x *= factor;
  return values;
}

Plot panel(const std::string& title, const std::string& x, const std::string& y) {
  Plot plot;
  plot.title = title;
  plot.x_label = x;
  plot.y_label = y;
  plot.width = 560;
  plot.height = 400;
  return plot;
}

// The chapter's four panels: stress, the same over E, ratio against strain, and against stress over E.
std::vector<Plot> four_panels() {
  return {panel("Measured and correct", kStrainAxis, "deviator stress [psi]"),
          panel("Over the modulus", kStrainAxis, "deviator stress / E"),
          panel("Measured over correct", kStrainAxis, "measured / correct"),
          panel("Measured over correct", "correct deviator stress / E", "measured / correct")};
}

void add_run(std::vector<Plot>& panels, const std::string& name, const SpecimenRun& run) {
  const double E = run.scene->E;
  panels[0].series.push_back(series(name, run.strain, run.measured));
  panels[1].series.push_back(series(name, run.strain, scaled(run.measured, 1.0 / E)));
  panels[2].series.push_back(series(name, run.strain, run.ratios()));
  if (panels.size() > 3)
    panels[3].series.push_back(series(name, scaled(correct_of(run), 1.0 / E), run.ratios()));
}

std::string sheet_of(int figure, std::vector<Plot> panels) {
  PlotSheet sheet;
  sheet.title = titled(figure);
  sheet.panels = std::move(panels);
  return sheet_svg(sheet);
}

// Figures 7.2 and 7.7.
std::string modulus_figure(int figure, const std::string& scene, Runs& runs) {
  std::vector<Plot> panels = four_panels();
  for (const std::string& name : {scene, scene + "_soft"}) {
    const SpecimenRun& run = runs.get(name, Elements::full);
    const std::string E = fmt::format("E = {:g} psi", run.scene->E);
    add_run(panels, "measured, " + E, run);
    panels[0].series.push_back(series("correct, " + E, run.strain, correct_of(run)));
  }
  add_run(panels, "measured, E = 3000 psi, B-bar", runs.get(scene, Elements::b_bar));
  return sheet_of(figure, std::move(panels));
}

// Figures 7.3 and 7.8; the last panel is over nu.
std::string poisson_figure(int figure, const std::string& scene, Runs& runs) {
  std::vector<Plot> panels = four_panels();
  panels[3] = panel("At 10 % of strain", "Poisson's ratio", "measured / correct");
  for (Elements elements : {Elements::full, Elements::b_bar}) {
    const char* kind = elements == Elements::full ? "full 4-node" : "B-bar";
    std::vector<double> nu, ratio;
    for (const char* end : {"_nu0", "_nu25", "_nu333", ""}) {
      const SpecimenRun& run = runs.get(scene + end, elements);
      nu.push_back(run.scene->nu);
      ratio.push_back(run.ratio(10.0));
      const bool last = *end == '\0';
      if (elements == Elements::b_bar && !last) continue;  // the same to the eye
      std::vector<Plot> three(panels.begin(), panels.begin() + 3);
      add_run(three, fmt::format("nu = {:.3g}{}", run.scene->nu, elements == Elements::full ? "" : ", B-bar"),
              run);
      std::ranges::copy(three, panels.begin());
    }
    panels[3].series.push_back(series(std::string("last panel: ") + kind, nu, ratio));
    panels[3].series.back().markers = true;
  }
  const SpecimenRun& any = runs.get(scene, Elements::full);
  panels[0].series.push_back(series("correct", any.strain, correct_of(any)));
  return sheet_of(figure, std::move(panels));
}

// Figures 7.12, 7.13 (elastic) and 7.22, 7.23: measured stress, and its ratio to the correct one, of several ends.
struct End {
  std::string scene, name;
  Elements elements = Elements::full;
  double k_j = 0.0;
};

std::vector<End> lubricated_ends(const std::string& scene, const std::vector<StiffnessChoice>& choices) {
  std::vector<End> list;
  for (const StiffnessChoice& choice : choices)
    list.push_back({scene, fmt::format("phi = 0.8, K_j = {:.3g}", choice.k_j), Elements::full, choice.k_j});
  return list;
}

std::vector<Plot> ends_panels(const std::vector<End>& ends, Runs& runs) {
  std::vector<Plot> panels = four_panels();
  panels.erase(panels.begin() + 3);
  for (const End& end : ends) add_run(panels, end.name, runs.get(end.scene, end.elements, end.k_j));
  const SpecimenRun& any = runs.get(ends[0].scene, ends[0].elements, ends[0].k_j);
  panels[0].series.push_back(series("correct", any.strain, correct_of(any)));
  return {panels[0], panels[2]};
}

std::string elastic_ends(int figure, const std::string& nu, Runs& runs,
                         const std::vector<StiffnessChoice>& choices) {
  std::vector<End> ends{{"pinned2" + nu, "pinned"},
                        {"pinned2" + nu, "pinned, B-bar", Elements::b_bar},
                        {"conv" + nu, "phi = 28.5"}};
  for (const End& end : lubricated_ends("lub" + nu, choices)) ends.push_back(end);
  ends.push_back({"free" + nu, "frictionless"});
  return sheet_of(figure, ends_panels(ends, runs));
}

std::string plastic_ends(int figure, Runs& runs, const std::vector<StiffnessChoice>& choices) {
  std::vector<End> ends{{"dp_conv", "phi = 28.5"}, {"dp_conv", "phi = 28.5, B-bar", Elements::b_bar}};
  for (const End& end : lubricated_ends("dp_lub", choices)) ends.push_back(end);
  ends.push_back({"dp_free", "frictionless"});
  Plot plot = ends_panels(ends, runs)[figure == 22 ? 0 : 1];
  plot.title = titled(figure);
  plot.width = 900;
  plot.height = 560;
  return plot_svg(plot);
}

// Figures 7.17, 7.21, 7.32, 7.40: along the interface.
struct JointFigure {
  int figure;
  const char* scene;
  std::vector<double> strains;
};

const std::vector<JointFigure>& joint_figures() {
  static const std::vector<JointFigure> all = {{17, "conv", {5, 10}},
                                               {21, "lub", {5, 10}},
                                               {32, "dp_conv", {2, 5, 10, 15}},
                                               {40, "dp_lub", {2, 5, 10, 15}}};
  return all;
}

std::string joint_figure(const JointFigure& figure, Runs& runs, const std::vector<StiffnessChoice>& choices) {
  std::vector<Plot> panels{panel("Normal stress (of what the platen adds)", "r [in]", "normal stress [psi]"),
                           panel("Shear stress", "r [in]", "shear stress [psi]"),
                           panel("Stress level", "r [in]", "shear stress / strength")};
  for (const PanelRow& row : panel_rows(figure.scene, choices))
    for (double strain : figure.strains) {
      const SpecimenRun& run = runs.get(figure.scene, row.elements, row.k_j);
      const State& state = run.state(strain);
      const std::string name = fmt::format("{}, {:g} %", row.name, strain);
      std::vector<double> size;
      for (double shear : state.joint_shear) size.push_back(std::abs(shear));
      panels[0].series.push_back(series(name, run.joint_r, state.joint_normal));
      panels[1].series.push_back(series(name, run.joint_r, size));
      panels[2].series.push_back(series(name, run.joint_r, state.joint_level));
    }
  PlotSheet sheet;
  sheet.title = titled(figure.figure);
  sheet.panels = panels;
  return sheet_svg(sheet);
}

// Figure 7.1, with what holds and moves the mesh.
std::string mesh_figure(Runs& runs) {
  const SpecimenRun& run = runs.get("conv", Elements::full);
  constexpr double kScale = 200.0, kLeft = 190.0, kTop = 130.0, kPlatenHeight = 26.0;
  const double R = run.largest_radius, H = run.largest_height, right = kLeft + kScale * R,
               low = kTop + kScale * H;
  std::string out = svg::open(760, 760);
  svg::text(out, 380, 34, titled(1), svg::kTitleFont, "middle");
  const std::string hatch = "fill=\"#dddddd\" stroke=\"#000000\"";
  out += fmt::format("<rect x=\"{:g}\" y=\"{:g}\" width=\"{:g}\" height=\"{:g}\" {}/>\n", kLeft,
                     kTop - kPlatenHeight, kScale * R, kPlatenHeight - 4, hatch);
  for (int i = 0; i <= run.columns; ++i) {
    const double x = kLeft + kScale * R * i / run.columns;
    svg::line(out, x, kTop, x, low, "#555555", 0.8);
    if (i % 2 == 0)
      svg::line(out, x, kTop - kPlatenHeight - 34, x, kTop - kPlatenHeight - 4, "#0072b2", 1.4,
                "marker-end=\"url(#tip)\"");
    out += fmt::format("<circle cx=\"{:g}\" cy=\"{:g}\" r=\"3.5\" fill=\"#ffffff\" stroke=\"#000000\"/>\n", x,
                       low + 5);
  }
  for (int j = 0; j <= run.rows; ++j) {
    const double y = kTop + kScale * H * j / run.rows;
    svg::line(out, kLeft, y, right, y, "#555555", 0.8);
    out += fmt::format("<circle cx=\"{:g}\" cy=\"{:g}\" r=\"3.5\" fill=\"#ffffff\" stroke=\"#000000\"/>\n",
                       kLeft - 5, y);
    if (j % 4 == 2) svg::line(out, right + 42, y, right + 8, y, "#d55e00", 1.4, "marker-end=\"url(#tip)\"");
  }
  svg::line(out, kLeft, kTop - 2, right, kTop - 2, "#a00000", 3.0);
  out +=
      "<defs><marker id=\"tip\" viewBox=\"0 0 8 8\" refX=\"7\" refY=\"4\" markerWidth=\"7\" markerHeight=\"7\" "
      "orient=\"auto\"><path d=\"M0,0 L8,4 L0,8 z\"/></marker></defs>\n";
  const double middle = 0.5 * (kLeft + right);
  svg::text(out, middle, kTop - kPlatenHeight - 42, "prescribed displacement of the rigid platen", svg::kFont,
            "middle");
  svg::text(out, right + 52, kTop - 8, "end platen", svg::kFont, "start");
  svg::text(out, right + 52, kTop + 8, "14 interface elements", svg::kFont, "start");
  svg::text(out, right + 52, 0.5 * (kTop + low), "cell pressure 50 psi", svg::kFont, "start");
  svg::text(out, kLeft - 16, 0.5 * (kTop + low), "axis: u_r = 0", svg::kFont, "end");
  svg::text(out, middle, low + 28, "mid-height: u_z = 0", svg::kFont, "middle");
  svg::text(out, middle, low + 50,
            fmt::format("{} solid elements ({} x {}), R = {:g} in, H = {:g} in: a quarter of the section",
                        run.columns * run.rows, run.columns, run.rows, R, H),
            svg::kFont, "middle");
  out += svg::kClose;
  return out;
}

}  // namespace

std::string figure_svg(int figure, Runs& runs, const std::vector<StiffnessChoice>& choices) {
  for (const FieldFigure& one : field_figures())
    if (one.figure == figure) return field_figure(one, runs, choices);
  for (const JointFigure& one : joint_figures())
    if (one.figure == figure) return joint_figure(one, runs, choices);
  switch (figure) {
    case 1:
      return mesh_figure(runs);
    case 2:
    case 7:
      return modulus_figure(figure, figure == 2 ? "pinned1" : "pinned2", runs);
    case 3:
    case 8:
      return poisson_figure(figure, figure == 3 ? "pinned1" : "pinned2", runs);
    case 12:
    case 13:
      return elastic_ends(figure, figure == 12 ? "" : "_nu25", runs, choices);
    default:
      return plastic_ends(figure, runs, choices);
  }
}

}  // namespace sage::figures
