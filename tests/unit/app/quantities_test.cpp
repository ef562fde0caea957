// Every quantity of a model, written into every format: it is there, or a message names what is lost.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <fstream>
#include <functional>

#include "sage/app/commands.hpp"
#include "sage/builder/build_model.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/exchange/convert.hpp"
#include "sage/model/fingerprint.hpp"
#include "tests/install/consumer/bar.hpp"
#include "tests/install/consumer/diffusion.hpp"
#include "tests/studies/scenes/consolidation.hpp"
#include "tests/studies/scenes/deck_writer.hpp"

namespace sage::app {
namespace {

using scenes::DeckWriter;

constexpr int kDiffusion = 1041, kBar = 50, kRod = 80, kSwelling = 92;
constexpr int kFlow = 41, kDarcy = 41;  // of the program

const Catalogue& catalogue() {
  static const Catalogue all = [] {
    Catalogue catalogue = full_catalogue();
    catalogue.elements.add(kDiffusion, own::diffusion_quad());
    catalogue.materials.add(kSwelling, own::swelling_soil());
    catalogue.elements.add(kBar, own::bar2());
    catalogue.materials.add(kRod, own::rod());
    return catalogue;
  }();
  return all;
}

Model model_of(const std::string& text) {
  return build_model(read_deck_text(text, "deck", load_layout(detect_layout(text))), catalogue());
}

struct Soil {
  int law = 1;
  std::vector<double> parameters{1000.0, 0.25};
  double unit_weight = 0.0;
};

// Two rows of two squares, each row a group, held at the base; one stage in which nothing happens.  Nodes 1-3
// below, 4-6, 7-9; elements 1 2, 3 4.
Model plain(int element = 1, int formulation = 1, const Soil& soil = {}, bool held = true) {
  DeckWriter deck(1);
  deck.atmospheric_pressure = deck.water_unit_weight = 0.0;
  if (soil.law != 1) deck.atmospheric_pressure = 100.0;
  for (int i = 0; i < 9; ++i) deck.node(i + 1, 1.0 + i % 3, i / 3);
  deck.material(1, soil.law, soil.parameters, soil.unit_weight);
  for (const int group : {1, 2}) deck.group(group, element, formulation, 1);
  for (int e = 0; e < 4; ++e) {
    const int n = 1 + e % 2 + 3 * (e / 2);
    deck.element(e + 1, e < 2 ? 1 : 2, {n, n + 1, n + 4, n + 3});
  }
  if (held)
    for (const int node : {1, 2, 3}) deck.fix(node, 1, 1);
  deck.stage();
  Model model = model_of(deck.text());
  model.title.clear();
  model.units.length = model.units.force = model.units.stress = "-";
  return model;
}

struct Written {
  std::string text, messages;
};

using Writer = std::function<std::string(const Model&, Diagnostics&)>;

Written written(const Writer& writer, const Model& model) {
  Diagnostics diagnostics;
  Written all{writer(model, diagnostics), {}};
  for (const Diagnostic& d : diagnostics.list()) all.messages += d.message + "\n";
  return all;
}

// What becomes of a quantity in a format: empty, it is in the text; else words of the message that names it.
struct Fate {
  const char *dat, *msh, *inp;
};

struct Row {
  const char* name;
  Fate fate;
  std::function<void(Model&)> with;
  std::function<Model()> base = [] { return plain(); };
};

Stage& first(Model& m) {
  return m.stages.front();
}

Fixity held(int node, FixityCode x, double dx = 0.0) {
  Fixity f;
  f.node = node;
  f.code[0] = x;
  f.value[0] = dx;
  return f;
}

EdgeLoad edge(double a, double b, double shear) {
  EdgeLoad load;  // the top of element 4
  load.group = 1;
  load.element = 1;
  load.edge = 2;
  load.normal = {a, b};
  load.shear = {shear, shear};
  return load;
}

InitialStress start(InitialKind kind, std::initializer_list<double> values) {
  InitialStress initial;
  initial.kind = kind;
  std::copy(values.begin(), values.end(), initial.value.begin());
  return initial;
}

Report report(ReportKind kind) {
  Report r;
  r.kind = kind;
  r.nodes = {6, 7, 8};
  if (kind == ReportKind::point) r.place = {1.5, 0.5};
  if (kind == ReportKind::triaxial) {
    r.group = 0;
    r.height = 2.0;
    r.area = 1.0;
  }
  return r;
}

Model mohr_coulomb() {
  return plain(1, 1, {4, {1000.0, 0.25, 5.0, 30.0, 0.0}});
}

// Soil whose pore water flows, drained at its top; one stage in which nothing happens.
Model of_pores() {
  const LatticeMesh mesh{.x = {1.0, 2.0}, .y = {0.0, 1.0}};
  ModelInput input = scenes::pore_input(mesh, 1000.0, 0.25, 1e-3);
  input.supports = {scenes::held(mesh.row(0), true, true), scenes::drained(mesh.corner_row(2))};
  input.stages.emplace_back();
  Model model = build_model(input, catalogue());
  model.file.clear();
  return model;
}
Model of_flowing_pores() {
  Model model = of_pores();
  model.stages.front().pores = PoreWater::flows;
  return model;
}

constexpr const char *kMaterials = "material(s)", *kStages = "stage(s)", *kReports = "report(s)",
                     *kControl = "method, limit of iterations, tolerance and output interval";

const std::vector<Row>& rows() {
  static const std::vector<Row> all{
      {"title", {"", "title", ""}, [](Model& m) { m.title = "dam"; }},
      {"axisymmetry", {"", "axisymmetry", ""}, [](Model& m) { m.geometry = Geometry::axisymmetric; }},
      {"large strain",
       {"", "large strain", "large strain"},
       [](Model& m) {
         m.large_strain = true;
         Diagnostics none;
         m = model_of(sage1_text(m, none));  // with the elements that follow
       }},
      {"unit names", {"", "units", ""}, [](Model& m) { m.units.length = "m"; }},
      {"p_a", {"", "units", ""}, [](Model& m) { m.units.atmospheric_pressure = 101.0; }},
      {"gamma_w", {"", "units", ""}, [](Model& m) { m.units.water_unit_weight = 9.81; }},
      {"solver", {"", "solver", "solver"}, [](Model& m) { m.solver = 1; }},
      {"coordinates", {"", "", ""}, [](Model& m) { m.mesh.x(0, 4) += 0.01; }},
      {"node numbers", {"", "", ""}, [](Model& m) { m.mesh.number[8] = 12; }},
      {"material number", {"", kMaterials, ""}, [](Model& m) { m.materials[0].number = 7; }},
      {"material name", {"", kMaterials, ""}, [](Model& m) { m.materials[0].name = "clay"; }},
      {"parameters", {"", kMaterials, ""}, [](Model& m) { m.materials[0].parameters[0] = 2000.0; }},
      {"law with strength",
       {"", kMaterials, "only its elastic constants"},
       [](Model& m) { m = mohr_coulomb(); }},
      {"law without E",
       {"", kMaterials, "*ELASTIC must be added by hand"},
       [](Model& m) {
         m = plain(1, 1, {2, {1000.0, 400.0}});
       }},
      {"unit weight", {"", kMaterials, ""}, [](Model& m) { m.materials[0].unit_weight = 18.0; }},
      {"saturated unit weight",
       {"", kMaterials, "its saturated unit weight is left out"},
       [](Model& m) { m.materials[0].saturated_unit_weight = 20.0; }},
      {"uplift",
       {"", kMaterials, "its unit weight is left out"},
       [](Model& m) { m.materials[0].unit_weight = -8.0; }},
      {"group number", {"", "", ""}, [](Model& m) { m.groups[1].number = 5; }},
      {"group name", {"", "", ""}, [](Model& m) { m.groups[1].name = "fill"; }},
      {"element", {"", "", ""}, [](Model& m) { m = plain(2, 1); }},
      {"high degree",
       {"", "written by their corners", "written by their corners"},
       [](Model& m) { m = plain(7); }},
      {"formulation",
       {"", "formulation", "integrates in its own way"},
       [](Model& m) { m = plain(1, 1); },
       [] { return plain(1, 2); }},
      {"overlay", {"", "lie on others", ""}, [](Model& m) { m.groups[1].overlay = true; }},
      {"level of water",
       {"", "1 water card(s)", "1 water card(s)"},
       [](Model& m) {
         m.units.water_unit_weight = 9.81;
         m.water.push_back({0, -1, WaterKind::line, WaterAction::edges, 0.0, {{0.0, 1.0}, {2.0, 0.5}}, {}, {}});
       }},
      {"pressure at a node",
       {"", "1 water card(s)", "1 water card(s)"},
       [](Model& m) {
         m.water.push_back({0, 0, WaterKind::nodes, WaterAction::none, 0.0, {}, {{0, 3.5}}, {}});
       }},
      {"element numbers", {"", "", ""}, [](Model& m) { m.groups[1].element_numbers[1] = 9; }},
      {"support of an edge",
       {"", "", ""},
       [](Model& m) {
         for (const int node : {3, 6}) m.fixities.push_back(held(node, FixityCode::fixed));
       }},
      {"support of a node",
       {"", "held node(s) that are no whole edge", ""},
       [](Model& m) { m.fixities.push_back(held(4, FixityCode::fixed)); }},
      {"tie",
       {"", "inclined supports and ties", "inclined supports and ties"},
       [](Model& m) {
         m.ties.push_back({4, 5, {1, 0}, 0});
       }},
      {"rapid drawdown",
       {"", "2 water card(s)", "2 water card(s)"},
       [](Model& m) {
         m.units.water_unit_weight = 9.81;
         m.water.push_back({0, 0, WaterKind::line, WaterAction::edges, 0.0, {{0.0, 9.0}}, {}, {}});
         m.stages.push_back(m.stages.back());
         m.stages.back().number = 2;
         m.water.push_back({1, 0, WaterKind::drawdown, WaterAction::edges, 0.5, {{0.0, 8.0}}, {}, {}});
       }},
      {"support along a turned line",
       {"", "inclined supports", "inclined supports"},
       [](Model& m) {
         m.turned_fixities.push_back({held(4, FixityCode::fixed), 30.0});
       }},
      {"support along a turned line in a stage",
       {"", "inclined supports", "inclined supports"},
       [](Model& m) {
         first(m).turned_fixities.push_back({held(4, FixityCode::fixed, 0.01), 30.0});
       }},
      {"initial stress",
       {"", "initial stress", "initial stresses"},
       [](Model& m) {
         m.initials.push_back(start(InitialKind::uniform, {1.0, 2.0, 1.0, 0.5}));
       }},
      {"K0 start",
       {"", "initial stress", "initial stresses"},
       [](Model& m) {
         m.initials.push_back(start(InitialKind::geostatic, {2.0, 18.0, 0.5}));
       }},
      {"earth pressure at rest",
       {"", "initial stress", "initial stresses"},
       [](Model& m) {
         m.initials.push_back(start(InitialKind::at_rest, {0.5, 2.0, 10.0, 5.0}));
       }},
      {"no start stress",
       {"", "initial stress", "initial stresses"},
       [](Model& m) { m.initials.push_back(start(InitialKind::zero, {})); }},
      {"history",
       {"", "initial stress", "histories"},
       [](Model& m) {
         constexpr double kBlank = std::numeric_limits<double>::quiet_NaN();
         m.initials.push_back(start(InitialKind::history, {1.0, 0.01, kBlank, kBlank, kBlank, kBlank}));
       },
       mohr_coulomb},
      {"growth of a parameter",
       {"", "initial stress", "changes of laws"},
       [](Model& m) {
         m.initials.push_back(start(InitialKind::parameter, {1.0, 0.0, 50.0, 0.0}));
         Diagnostics none;
         m = model_of(sage1_text(m, none));  // with the laws that follow
       }},
      {"displacements from zero",
       {"", kStages, "reset of displacements"},
       [](Model& m) { first(m).resets_displacements = true; }},
      {"stage title", {"", kStages, ""}, [](Model& m) { first(m).title = "filling"; }},
      {"increments", {"", kStages, ""}, [](Model& m) { first(m).increments = 4; }},
      {"duration", {"", kStages, ""}, [](Model& m) { first(m).duration = 3.0; }},
      {"pore water",
       {"", kStages, "pore water"},
       [](Model& m) { first(m).pores = PoreWater::flows; },
       of_pores},
      {"theta", {"", kStages, "theta"}, [](Model& m) { first(m).theta = 0.5; }},
      {"grading of increments", {"", kStages, "grading"}, [](Model& m) { first(m).grading = 1.5; }},
      {"steps by their error",
       {"", kStages, "steps in time"},
       [](Model& m) {
         first(m).time_error = 1e-3;
         first(m).end_degree = 0.9;
       },
       of_flowing_pores},
      {"output times",
       {"", kStages, "steps in time"},
       [](Model& m) {
         first(m).output_times = {0.25};
         Diagnostics none;
         m = model_of(sage1_text(m, none));  // with the increments that follow
       },
       of_flowing_pores},
      {"history of a support",
       {"", "the excess_pressure of nodes is left out", "the excess_pressure of nodes is left out"},
       [](Model& m) {
         first(m).field_fixities.push_back({m.pore_field(), 0, FixityCode::fixed, 2.0, 0, {{0.5, 1.0}}});
       },
       of_flowing_pores},
      {"controlled load",
       {"", kStages, "displacement that controls its load"},
       [](Model& m) {
         first(m).loads.push_back({8, {0.0, -1.0}, 0});
         first(m).control = {8, 7, 1, -0.25};
       }},
      {"method", {"", kStages, kControl}, [](Model& m) { first(m).method = Method::dogleg; }},
      {"iterations", {"", kStages, kControl}, [](Model& m) { first(m).max_iterations = 40; }},
      {"output interval", {"", kStages, kControl}, [](Model& m) { first(m).output_every = 3; }},
      {"tolerance", {"", kStages, kControl}, [](Model& m) { first(m).tolerance = 1e-6; }},
      {"strength factor", {"", kStages, "strength factor"}, [](Model& m) { first(m).strength_factor = 1.2; }},
      {"second stage", {"", kStages, ""}, [](Model& m) { m.stages.emplace_back().number = 2; }},
      {"gravity",
       {"", "load(s)", ""},
       [](Model& m) {
         first(m).gravity = {0.0, -1.0};
       },
       [] {
         return plain(1, 1, {1, {1000.0, 0.25}, 18.0});
       }},
      {"displacement",
       {"", "fixities of stages", ""},
       [](Model& m) { first(m).fixities.push_back(held(8, FixityCode::fixed, 0.01)); }},
      {"release",
       {"", "fixities of stages", "the release of"},
       [](Model& m) { first(m).fixities.push_back(held(2, FixityCode::released)); }},
      {"load",
       {"", "load(s)", ""},
       [](Model& m) {
         first(m).loads.push_back({8, {1.0, -2.0}, 0});
       }},
      {"pressure", {"", "load(s)", ""}, [](Model& m) { first(m).pressures.push_back(edge(5.0, 5.0, 0.0)); }},
      {"pressure that varies",
       {"", "load(s)", "vary along an edge"},
       [](Model& m) { first(m).pressures.push_back(edge(5.0, 7.0, 0.0)); }},
      {"edge shear",
       {"", "load(s)", "edge shear"},
       [](Model& m) { first(m).pressures.push_back(edge(0.0, 0.0, 3.0)); }},
      {"birth", {"", "birth(s)", "activated or removed"}, [](Model& m) { first(m).births.push_back(1); }},
      {"death", {"", "death(s)", "activated or removed"}, [](Model& m) { first(m).deaths.push_back(1); }},
      {"stress at birth",
       {"", "initial stress", "initial stresses"},
       [](Model& m) {
         first(m).births.push_back(1);
         first(m).initials.push_back(start(InitialKind::uniform, {1.0, 2.0, 1.0, 0.5}));
         first(m).initials.back().group = 1;
       }},
      {"report of a specimen",
       {"", kReports, kReports},
       [](Model& m) { m.reports.push_back(report(ReportKind::triaxial)); }},
      {"report of nodes",
       {"", kReports, kReports},
       [](Model& m) { m.reports.push_back(report(ReportKind::nodes)); }},
      {"report of any nodes",
       {"", kReports, kReports},
       [](Model& m) {
         m.reports.push_back(report(ReportKind::nodes));
         m.reports[0].nodes = {8, 3, 6};
       }},
      {"report of a point",
       {"", kReports, kReports},
       [](Model& m) {
         m.reports.push_back(report(ReportKind::point));
         m.reports[0].name = "crest";
         m.reports[0].nodes.clear();
       }},
      {"report of uplift",
       {"", kReports, kReports},
       [](Model& m) {
         m.units.water_unit_weight = 9.81;
         m.reports.push_back(report(ReportKind::uplift));
       }},
      {"report of a section",
       {"", kReports, kReports},
       [](Model& m) {
         m.reports.push_back(report(ReportKind::section));
         m.reports[0].name = "slab";
         m.reports[0].nodes.clear();
         m.reports[0].place = {1.25, 0.25};
         m.reports[0].end = {1.75, 0.75};
       }},
      {"fields of a point",
       {"further fields", kReports, kReports},
       [](Model& m) {
         m.reports.push_back(report(ReportKind::point));
         m.reports[0].nodes.clear();
         m.reports[0].fields = {"stress_level"};
       }},
      {"long names",
       {"longer than their columns", "", ""},
       [](Model& m) { m.groups[0].name = "a name of more than forty characters, cut there"; }},
      {"an unknown",
       {"", "the concentration of nodes is left out", "the concentration of nodes is left out"},
       [](Model& m) {
         m = plain(kDiffusion, 1, {kSwelling, {1000.0, 0.25, 2.0, 0.0, 90.0, 0.0}});
         m.field_fixities.push_back({1, 0, FixityCode::fixed, 0.0, 0});
         first(m).field_fixities.push_back({1, 8, FixityCode::fixed, 1.0, 0});
         first(m).field_loads.push_back({1, 4, 0.5, 0});
       }},
      {"an exit of water",
       {"", "the head of nodes is left out", "the head of nodes is left out"},
       [](Model& m) {
         m = plain(kFlow, 1, {kDarcy, {1e-3}}, false);
         m.field_fixities.push_back({1, 0, FixityCode::fixed, 0.0, 0});
         first(m).exits.push_back({8, 0.5, 0});
       }},
  };
  return all;
}

const Writer kDat = [](const Model& m, Diagnostics& d) { return sage1_text(m, d); };

class Quantities : public testing::TestWithParam<std::size_t> {};

TEST_P(Quantities, SurviveOrAreNamed) {
  const Row& row = rows()[GetParam()];
  const Model base = row.base();
  Model model = row.base();
  row.with(model);
  const std::pair<Writer, const char*> formats[] = {
      {kDat, row.fate.dat}, {msh_text, row.fate.msh}, {inp_text, row.fate.inp}};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& [writer, words] = formats[i];
    SCOPED_TRACE(i == 0 ? ".dat" : i == 1 ? ".msh" : ".inp");
    const Written before = written(writer, base), after = written(writer, model);
    if (*words != '\0') {
      EXPECT_NE(after.messages.find(words), std::string::npos) << words << " is not in\n" << after.messages;
      continue;
    }
    EXPECT_NE(after.text, before.text) << "the text says nothing of it, and no message";
    if (i > 0) continue;
    EXPECT_EQ(after.messages, "");
    EXPECT_NE(fingerprint(model), fingerprint(base));
    EXPECT_EQ(fingerprint(model_of(after.text)), fingerprint(model)) << after.text;
  }
}

INSTANTIATE_TEST_SUITE_P(Table, Quantities, testing::Range(std::size_t{0}, rows().size()), [](const auto& one) {
  std::string name = rows()[one.param].name;
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return name;
});

// Elements that only we have.
TEST(Quantities, InterfacesAndStructuresAreNamed) {
  DeckWriter deck(1);
  const double x[] = {0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0}, y[] = {0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 2.0, 2.0};
  for (int i = 0; i < 8; ++i) deck.node(i + 1, x[i], y[i]);
  deck.material(1, 1, {1000.0, 0.25});
  deck.material(2, 21, {1e5, 1e5, 0.0});
  deck.material(3, kRod, {1000.0, 0.2});
  deck.group(1, 1, 1, 1);
  deck.group(2, 11, 1, 2);
  deck.group(3, kBar, 1, 3);
  deck.element(1, 1, {1, 2, 4, 3});
  deck.element(2, 1, {5, 6, 8, 7});
  deck.element(3, 2, {3, 4, 6, 5});
  deck.element(4, 3, {7, 8});
  for (const int node : {1, 2}) deck.fix(node, 1, 1);
  deck.stage();
  const Model model = model_of(deck.text());
  const Written dat = written(kDat, model);
  EXPECT_EQ(dat.messages, "");
  EXPECT_EQ(fingerprint(model_of(dat.text)), fingerprint(model));
  const Written mesh = written(msh_text, model);
  const std::string &msh = mesh.messages, inp = written(inp_text, model).messages;
  EXPECT_EQ(msh.find("interface"), std::string::npos) << msh;
  EXPECT_EQ(msh.find("own_bar2"), std::string::npos) << msh;
  EXPECT_NE(mesh.text.find("\n4 7 8\n"), std::string::npos) << "no line with the number of the bar";
  EXPECT_NE(inp.find("1 interface4 row-sum element(s) left out"), std::string::npos) << inp;
  EXPECT_NE(inp.find("1 own_bar2 one point element(s) left out"), std::string::npos) << inp;
}

// A member that a structure gains breaks the build here: give it a row in the table above, then a name below.
// What has none needs none: it follows from the rest, or is about the deck and not about the problem.
[[maybe_unused]] void known(const Model& one) {
  [[maybe_unused]] const auto& [file, title, geometry, units, solver, large_strain, fields, mesh, materials,
                                groups, unknowns, fixities, turned_fixities, ties, field_fixities, initials,
                                stages, water, reports, diagnostics, left_out, plugins] = one;
}
[[maybe_unused]] void known(const UnitSystem& one) {
  [[maybe_unused]] const auto& [length, force, stress, p_a, gamma_w] = one;
}
[[maybe_unused]] void known(const Mesh& one) {
  [[maybe_unused]] const auto& [x, number, deck_nodes, made_between, reach, arcs] = one;
}
[[maybe_unused]] void known(const Material& one) {
  [[maybe_unused]] const auto& [number, name, code, law_name, entry, parameters, unit_weight,
                                saturated_unit_weight, law, where, undrained, twin, variants] = one;
}
[[maybe_unused]] void known(const Group& one) {
  [[maybe_unused]] const auto& [number, name, element_code, formulation, element_name, entry, element, material,
                                second_material, element_numbers, element_lines, nodes, overlay, where, excess,
                                choices] = one;
}
[[maybe_unused]] void known(const WaterCard& one) {
  [[maybe_unused]] const auto& [stage, group, kind, action, value, line, nodes, where] = one;
}
[[maybe_unused]] void known(const Fixity& one) {
  [[maybe_unused]] const auto& [node, code, value, line, history] = one;
}
[[maybe_unused]] void known(const FieldFixity& one) {
  [[maybe_unused]] const auto& [field, node, code, value, line, history] = one;
}
[[maybe_unused]] void known(const InitialStress& one) {
  [[maybe_unused]] const auto& [group, kind, value, where] = one;
}
[[maybe_unused]] void known(const Stage& one) {
  [[maybe_unused]] const auto& [number, title, increments, duration, pores, theta, grading, time_error,
                                end_degree, end_pressure, output_times, ends, divisions, method, max_iterations,
                                output_every, output_at, tolerance, gravity, fixities, turned_fixities, loads,
                                field_fixities, field_loads, exits, pressures, births, deaths, initials,
                                strength_factor, resets_displacements, control, where] = one;
}
[[maybe_unused]] void known(const LoadControl& one) {
  [[maybe_unused]] const auto& [node, other, component, growth] = one;
}
[[maybe_unused]] void known(const NodalLoad& one) {
  [[maybe_unused]] const auto& [node, force, line, history] = one;
}
[[maybe_unused]] void known(const FieldLoad& one) {
  [[maybe_unused]] const auto& [field, node, value, line, history] = one;
}
[[maybe_unused]] void known(const EdgeLoad& one) {
  [[maybe_unused]] const auto& [group, element, edge, normal, shear, line, history] = one;
}
[[maybe_unused]] void known(const Report& one) {
  [[maybe_unused]] const auto& [kind, group, nodes, height, area, cell_pressure, place, end, name, fields,
                                stage, where] = one;
}

}  // namespace
}  // namespace sage::app
