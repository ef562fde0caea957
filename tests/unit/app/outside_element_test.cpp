// An element that the program does not know, a ten-node cubic triangle, goes through everything that a built-in
// one does: cards, made nodes, run, VTU, Gmsh, CalculiX, pictures, refinement, --converge.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>

#include "sage/app/commands.hpp"
#include "sage/app/converge.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/run_deck.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/exchange/convert.hpp"
#include "sage/exchange/mesh_model.hpp"
#include "tests/install/consumer/tri10.hpp"
#include "tests/studies/scenes/scenes.hpp"
#include "tests/support/scratch_folder.hpp"

namespace sage {
namespace {

constexpr int kCode = 40;

// known: the entry says what VTK and Gmsh call it.
Catalogue catalogue_with_tri10(bool known) {
  Catalogue catalogue = app::full_catalogue();
  ElementEntry entry = own::tri10();
  if (!known) entry.vtk = entry.gmsh = {};
  catalogue.elements.add(kCode, entry);
  return catalogue;
}

namespace fs = std::filesystem;

// Quarter of the restrained cylinder, L/D = 1, nu = .25, of 2 x 2 x 2 triangles whose cards give their corners.
std::string write_cylinder(const std::string& name) {
  const scenes::RestrainedCylinder scene{1.0, 0.25, scenes::Cell::tri3, 1, 2, 2, 1.0};
  const std::vector<int> end = scene.block().top();
  scenes::DeckWriter deck = scene.between_rough_platens(0.01);
  deck.groups.clear();
  deck.group(1, kCode, 0, 1);
  deck.triaxial_report(1, end.front(), end.back(), 1, 1.0);
  const fs::path path = test::scratch_folder("outside_element") / (name + ".dat");
  std::ofstream(path) << deck.text();
  return path.string();
}

app::RunRequest request_for(const std::string& path) {
  app::RunRequest request;
  request.deck = path;
  request.quiet = true;
  request.output.folder = fs::path(path).parent_path();
  return request;
}

std::string contents(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

std::size_t messages(const Model& model, const std::string& part) {
  std::size_t found = 0;
  for (const Diagnostic& d : model.diagnostics.list()) found += count(d.message, part);
  return found;
}

// An array of a VTU file: its offset stands in its tag, the data behind the underscore.
template <class T>
std::vector<T> vtu_array(const std::string& text, const std::string& name) {
  const std::size_t tag = text.find("Name=\"" + name + "\"");
  const std::size_t offset = std::stoul(text.substr(text.find("offset=\"", tag) + 8));
  const char* at = text.data() + text.find('_', text.find("encoding=\"raw\"")) + 1 + offset;
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, at, sizeof bytes);
  std::vector<T> values(bytes / sizeof(T));
  std::memcpy(values.data(), at + sizeof bytes, bytes);
  return values;
}

std::vector<int> int_values(const std::vector<std::uint8_t>& values) {
  return {values.begin(), values.end()};
}

// Converged ratio 1.036223: two independent hp solutions (docs/theory/accuracy.md).
TEST(OutsideElement, ConvergesByHalving) {
  const std::string path = write_cylinder("halved");
  app::ConvergeOptions options;
  options.tolerance = 1e-3;
  EXPECT_EQ(app::converge(request_for(path), options, catalogue_with_tri10(true)), app::kOk);
  const std::string table = contents(fs::path(path).parent_path() / "halved.convergence.csv");
  const auto at = table.rfind("report1.ratio ");
  ASSERT_NE(at, std::string::npos) << table;
  double value = 0.0, error = 0.0;
  ASSERT_EQ(std::sscanf(table.c_str() + at, "report1.ratio %lf +- %lf", &value, &error), 2) << table;
  EXPECT_LE(std::abs(value - 1.036223), error + 1e-6);
}

// What no format knows is written by its corners, with one warning a group; never as another shape.
TEST(OutsideElement, IsWrittenByItsCornersWhereAFormatLacksIt) {
  const Catalogue catalogue = catalogue_with_tri10(false);
  const std::string path = write_cylinder("corners");
  app::RunRequest request = request_for(path);
  request.output.vtu = true;
  request.output.pictures = {"stress_yy"};
  const app::RunOutcome outcome = app::run_deck(request, catalogue);
  ASSERT_EQ(outcome.exit_code, app::kOk);
  const Group& group = outcome.model->groups.front();
  EXPECT_EQ(group.element_name, "tri10 twelve points");
  EXPECT_EQ(group.node_count(), 10u);
  EXPECT_EQ(outcome.model->mesh.nodes(), 49);  // a lattice of 7 x 7
  EXPECT_EQ(messages(*outcome.model, "written by their corners"), 1u);
  const fs::path folder = fs::path(path).parent_path();
  const std::string vtu = contents(folder / "corners_0001.vtu");
  EXPECT_EQ(int_values(vtu_array<std::uint8_t>(vtu, "types")), std::vector<int>(8, 5));
  EXPECT_EQ(vtu_array<std::int64_t>(vtu, "connectivity").size(), 24u);
  bool drawn = false;
  for (const fs::path& file : outcome.files) drawn = drawn || count(contents(file), "<path") > 1;
  EXPECT_TRUE(drawn);

  Model model = build_model(read_deck(path), catalogue);
  const std::string msh = msh_text(model, model.diagnostics);
  EXPECT_EQ(count(msh, "\n2 1 2 8\n"), 1u) << msh;  // one surface, type 2, eight elements
  EXPECT_EQ(messages(model, "MSH has no element like tri10"), 1u);
  const std::string inp = inp_text(model, model.diagnostics);
  EXPECT_EQ(count(inp, "TYPE=CAX3"), 1u) << inp;
  EXPECT_EQ(messages(model, "CalculiX has no element like tri10"), 1u);
}

TEST(OutsideElement, IsWrittenWholeWhereItsEntrySaysHow) {
  const Catalogue catalogue = catalogue_with_tri10(true);
  const std::string path = write_cylinder("whole");
  app::RunRequest request = request_for(path);
  request.output.vtu = true;
  const app::RunOutcome outcome = app::run_deck(request, catalogue);
  EXPECT_EQ(messages(*outcome.model, "corners"), 0u);
  const std::string vtu = contents(fs::path(path).parent_path() / "whole_0001.vtu");
  EXPECT_EQ(int_values(vtu_array<std::uint8_t>(vtu, "types")), std::vector<int>(8, 69));
  EXPECT_EQ(vtu_array<std::int64_t>(vtu, "connectivity").size(), 80u);

  // Through Gmsh and back, one element listed clockwise.
  Model model = build_model(read_deck(path), catalogue);
  Group& written = model.groups.front();
  const std::vector<int> nodes = written.nodes;
  const std::array<std::size_t, 10> clockwise{0, 2, 1, 8, 7, 6, 5, 4, 3, 9};
  for (std::size_t i = 0; i < 10; ++i) written.nodes[i] = nodes[clockwise[i]];
  const std::string msh = msh_text(model, model.diagnostics);
  EXPECT_EQ(count(msh, "\n2 1 21 8\n"), 1u);
  EXPECT_GT(count(msh, " 26 2\n"), 0u);  // supported sides: lines of four nodes
  const Model back = model_from_mesh(msh, "back.msh", catalogue, {});
  ASSERT_EQ(back.groups.size(), 1u);
  EXPECT_EQ(back.groups.front().element_code, kCode);
  EXPECT_EQ(back.groups.front().nodes, nodes);
}

// Two triangles in a square; the first one's card gives 8 of its 10 nodes, the second one's its corners.  The
// nodes on the diagonal are those of both: a lattice of 4 x 4 and no node twice.
TEST(OutsideElement, SharesTheNodesInsideAnEdgeThatOneCardGives) {
  scenes::DeckWriter deck(1);
  const double third = 1.0 / 3.0, two = 2.0 / 3.0;
  const double at[][2] = {{0, 0},   {1, 0},       {0, 1},       {third, 0}, {two, 0},
                          {0, two}, {third, two}, {two, third}, {1, 1}};
  for (int i = 0; i < 9; ++i) deck.node(i + 1, at[i][0], at[i][1]);
  deck.material(1, 1, {1e4, 0.3});
  deck.group(1, kCode, 0, 1);
  deck.element(1, 1, {1, 2, 3, 4, 5, 8, 7, 6});
  deck.element(2, 1, {9, 3, 2});
  for (int n : {1, 2}) deck.fix(n, 1, 1);
  deck.stage().load(9, 0.0, -1.0);
  const Model model =
      build_model(read_deck_text(deck.text(), "shared.dat", load_layout("sage1")), catalogue_with_tri10(true));
  EXPECT_EQ(model.mesh.nodes(), 16);
  const std::array<int, 2> diagonal{model.groups[0].nodes_of(1)[5], model.groups[0].nodes_of(1)[6]};
  EXPECT_EQ(diagonal, (std::array<int, 2>{6, 7}));  // nodes 7 and 8, from corner 3 to corner 2
  for (int i = 0; i < model.mesh.nodes(); ++i)
    for (int j = 0; j < i; ++j) EXPECT_GT((model.mesh.x.col(i) - model.mesh.x.col(j)).norm(), 0.3);
}

}  // namespace
}  // namespace sage
