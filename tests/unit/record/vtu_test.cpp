// Read back by an independent program: meshio (Debian's python3-meshio).
#include "sage/record/vtu.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include "sage/messages/error.hpp"
#include "sage/model/dof_map.hpp"
#include "tests/support/elements.hpp"
#include "tests/unit/record/specimen.hpp"

namespace sage {
namespace {

using test::contents;
using test::fresh_folder;
using test::lines_of;
using test::Specimen;

bool meshio_is_here() {
  return std::system("/usr/bin/python3 -c 'import meshio' 2>/dev/null") == 0;
}

// Prints what meshio finds, a line a fact.
constexpr const char* kReader = R"(
import sys, meshio, numpy as np
m = meshio.read(sys.argv[1])
print('points', len(m.points))
for block in m.cells: print('cells', block.type, len(block.data))
nodes = m.point_data['node'].ravel()
cell = np.concatenate([np.ravel(d) for d in m.cell_data['stress_level']])
for name in ('displacement', 'reaction', 'stress'):
    for n, v in zip(nodes, m.point_data[name]): print(name, int(n), *('%.12g' % x for x in v))
for name in ('mean_stress', 'q', 'yielded', 'group', 'element'):
    print(name, *('%.12g' % x for x in np.concatenate([np.ravel(d) for d in m.cell_data[name]])))
if 'interface_normal' in m.cell_data:
    print('interface_normal', *('%.12g' % x for x in np.concatenate([np.ravel(d) for d in m.cell_data['interface_normal']])))
)";

std::vector<std::string> read_back(const std::filesystem::path& vtu) {
  const auto folder = vtu.parent_path();
  std::ofstream(folder / "read.py") << kReader;
  const std::string command = "/usr/bin/python3 " + (folder / "read.py").string() + " " + vtu.string() + " > " +
                              (folder / "read.txt").string();
  EXPECT_EQ(std::system(command.c_str()), 0);
  return lines_of(contents(folder / "read.txt"));
}

std::vector<double> numbers(const std::string& line, const std::string& start) {
  std::vector<double> result;
  std::istringstream stream(line.substr(start.size()));
  for (std::string word; stream >> word;) result.push_back(std::stod(word));
  return result;
}

// Every line that starts with `start`, as numbers.
std::vector<std::vector<double>> facts(const std::vector<std::string>& lines, const std::string& start) {
  std::vector<std::vector<double>> result;
  for (const std::string& line : lines)
    if (line.starts_with(start + " ")) result.push_back(numbers(line, start));
  return result;
}

class VtuReadBack : public testing::Test {
 protected:
  void SetUp() override {
    if (meshio_is_here()) return;
    ASSERT_EQ(std::getenv("CI"), nullptr) << "python3-meshio is missing in CI";
    GTEST_SKIP() << "python3-meshio is not installed (apt-get install python3-meshio)";
  }
};

TEST_F(VtuReadBack, AxisymmetricSpecimenWithInterface) {
  Specimen specimen;
  const auto folder = fresh_folder("vtu");
  Vtu vtu(folder, "t");
  specimen.run(vtu, 0.01, 1);
  const auto lines = read_back(folder / "t_0001.vtu");
  ASSERT_FALSE(lines.empty());
  // 6 specimen nodes and 4 interface nodes: nodes 50 and 60 stand in both.
  EXPECT_EQ(lines[0], "points 10");
  EXPECT_EQ(lines[1], "cells quad 2");
  EXPECT_EQ(lines[2], "cells line 1");
  const auto displacement = facts(lines, "displacement");
  ASSERT_EQ(displacement.size(), 10u);
  for (const auto& d : displacement) {
    const auto index = static_cast<Eigen::Index>(d[0] / 10.0) - 1;
    EXPECT_DOUBLE_EQ(d[3], 0.0);
    EXPECT_NEAR(d[1], specimen.u[2 * index], 1e-12);
    EXPECT_NEAR(d[2], specimen.u[2 * index + 1], 1e-12);
  }
  // Compression positive: sigma_yy = +10 at the nodes of the specimen, none (NaN) at those of the interface.
  int solid = 0;
  for (const auto& s : facts(lines, "stress")) {
    if (std::isnan(s[2])) continue;
    ++solid;
    EXPECT_NEAR(s[1], 0.0, 1e-9);
    EXPECT_NEAR(s[2], 10.0, 1e-9);
    EXPECT_NEAR(s[4], 0.0, 1e-9);
  }
  EXPECT_EQ(solid, 6);
  EXPECT_EQ(facts(lines, "group")[0], (std::vector<double>{1, 1, 2}));
  EXPECT_EQ(facts(lines, "element")[0], (std::vector<double>{101, 102, 201}));
  const auto mean = facts(lines, "mean_stress")[0], q = facts(lines, "q")[0];
  EXPECT_NEAR(mean[0], 10.0 / 3.0, 1e-9);
  EXPECT_NEAR(q[1], 10.0, 1e-9);
  EXPECT_TRUE(std::isnan(q[2]));
  EXPECT_NEAR(facts(lines, "interface_normal")[0][2], 10.0, 1e-9);
  // The platen (nodes 70, 80) is held and pushes down.
  double platen = 0.0;
  for (const auto& r : facts(lines, "reaction"))
    if (r[0] >= 70.0) platen += r[2];
  EXPECT_NEAR(platen, -10.0 * kPi, 1e-8);
}

// "--" would end the comment for an XML reader.
TEST(VtuText, SaysSignsAndUnitsAtItsTop) {
  Specimen specimen;
  specimen.model.title = "two lifts ---- dam";
  specimen.compress(0.01);
  const auto folder = fresh_folder("vtu_signs");
  const std::string text = vtu_text(specimen.model, specimen.solution(), "NOT CONVERGED");
  write_file(folder / "a.vtu", text);
  const std::string top = text.substr(0, text.find("<VTKFile"));
  for (const char* words :
       {"dam", "compression positive", "stress psi", "forces: for the full circle", "NOT CONVERGED"})
    EXPECT_NE(top.find(words), std::string::npos) << words << "\n" << top;
  EXPECT_EQ(top.find("--", top.find("<!--") + 4), top.rfind("-->")) << top;
  if (!meshio_is_here()) return;
  EXPECT_EQ(read_back(folder / "a.vtu").front().substr(0, 6), "points");
}

TEST_F(VtuReadBack, LeavesOutGroupsThatAreNotActive) {
  Specimen specimen;
  specimen.compress(0.01);
  specimen.activity->group[1] = 0;
  for (GroupData& data : specimen.assembly->groups()) data.active = data.group->number == 1;
  const auto folder = fresh_folder("vtu_active");
  write_file(folder / "a.vtu", vtu_text(specimen.model, specimen.solution()));
  const auto lines = read_back(folder / "a.vtu");
  ASSERT_GE(lines.size(), 2u);
  EXPECT_EQ(lines[0], "points 6");
  EXPECT_EQ(lines[1], "cells quad 2");
}

// One element of every solid shape and interface: VTK's types by meshio's names.
// A law for elements that are no solids and no interfaces.
Material some_material(const Catalogue& catalogue, const ElementEntry& element) {
  const std::map<int, std::pair<int, std::vector<double>>> codes{
      {1, {31, {1000.0, 1.0}}}, {3, {41, {1e-3}}}, {5, {36, {1e6, 2e4, 3e5, 2e4, 30.0}}}};
  const auto& [code, values] = codes.at(element.law_size);
  Material material;
  material.number = 1;
  material.code = code;
  material.entry = catalogue.materials.share(code);
  material.parameters = values;
  material.parameters.resize(material.entry->parameters.size());
  for (std::size_t i = values.size(); i < material.parameters.size(); ++i)
    material.parameters[i] = material.entry->parameters[i].fallback;
  material.law = material.entry->make(material.parameters, UnitSystem{"m", "kN", "kPa", 0.0, 0.0});
  return material;
}

TEST_F(VtuReadBack, KnowsEveryShape) {
  const auto folder = fresh_folder("vtu_shapes");
  const std::map<int, const char*> names{{1, "vertex"},
                                         {3, "line"},
                                         {5, "triangle"},
                                         {9, "quad"},
                                         {21, "line3"},
                                         {22, "triangle6"},
                                         {23, "quad8"},
                                         {28, "quad9"},
                                         {69, "VTK_LAGRANGE_TRIANGLE"},
                                         {70, "VTK_LAGRANGE_QUADRILATERAL"}};
  const Specimen all;
  for (const auto& [code, of_catalogue] : all.catalogue.elements.entries()) {
    const char* const name = names.at(of_catalogue.vtk.type);
    Specimen base;
    Model model;
    model.units = base.model.units;
    const ElementEntry* entry = base.catalogue.elements.find(code);
    ASSERT_NE(entry, nullptr) << code;
    const bool moves_only = entry->solid() || entry->interface();
    if (moves_only)
      model.materials.push_back(std::move(base.model.materials[entry->solid() ? 0 : 1]));
    else
      model.materials.push_back(some_material(base.catalogue, *entry));
    Group group;
    group.number = 1;
    model.geometry =
        entry->nodes == 1 ? Geometry::axisymmetric : Geometry::plane_strain;  // a ring has one node
    set_element(group, base.catalogue, code, 0, model.geometry);
    if (entry->has_pores()) {
      Material water;
      const char* const law = entry->interface() ? "pore_joint" : "pore_flow";
      water.entry = base.catalogue.materials.share(base.catalogue.materials.code_of(law));
      water.law = water.entry->make(std::array{1.0}, UnitSystem{"m", "kN", "kPa", 0.0, 1.0});
      model.materials.push_back(std::move(water));
      group.second_material = 1;
    }
    group.element_numbers = {1};
    model.mesh.x = test::sample_shape(*entry);
    for (int i = 0; i < entry->nodes; ++i) {
      group.nodes.push_back(i);
      model.mesh.number.push_back(i + 1);
    }
    model.groups.push_back(group);
    collect_unknowns(model);
    const Scene scene = analyse_scene(model);
    WorkCounters work;
    const std::unique_ptr<Assembly> owned = make_assembly(model, scene, Skips{}, work);
    Assembly& assembly = *owned;
    const Activity activity(model);
    const Eigen::VectorXd u = Eigen::VectorXd::LinSpaced(DofMap(model).dofs(), 0.0, 1.0);
    assembly.enter_stage(activity, Eigen::VectorXd::Zero(DofMap(model).dofs()));
    assembly.recover_states();
    write_file(folder / "a.vtu", vtu_text(model, {&u, &u, &u, &assembly, &activity}));
    const auto lines = read_back(folder / "a.vtu");
    ASSERT_GE(lines.size(), 2u) << entry->name;
    EXPECT_EQ(lines[0], "points " + std::to_string(entry->nodes)) << entry->name;
    EXPECT_EQ(lines[1], std::string("cells ") + name + " 1") << entry->name;
    if (entry->flow()) continue;  // the reader prints displacements alone
    const auto displacement = facts(lines, "displacement");
    ASSERT_EQ(displacement.size(), static_cast<std::size_t>(entry->nodes)) << entry->name;
    if (moves_only) {  // unknowns behind the displacements are those of pore water
      const double last = 2.0 * entry->nodes - 1.0;
      EXPECT_NEAR(displacement.back()[2], last / static_cast<double>(u.size() - 1), 1e-12);
    }
  }
}

TEST(Vtu, PvdListsEveryOutputIncrementWithItsTime) {
  Specimen specimen;
  specimen.model.stages[0].output_every = 2;
  const auto folder = fresh_folder("pvd");
  Vtu vtu(folder, "t");
  specimen.run(vtu, 0.01, 5);
  const std::string pvd = contents(folder / "t.pvd");
  EXPECT_NE(pvd.find("timestep=\"0.4\" part=\"0\" file=\"t_0001.vtu\""), std::string::npos) << pvd;
  EXPECT_NE(pvd.find("timestep=\"1\" part=\"0\" file=\"t_0003.vtu\""), std::string::npos) << pvd;
  EXPECT_EQ(vtu.files().size(), 4u);
  EXPECT_EQ(pvd.find("NOT CONVERGED"), std::string::npos);
}

TEST(Vtu, FilesSayTheirStepAndUnits) {
  Specimen specimen;
  specimen.compress(0.01);
  const StepReport step = specimen.step(3, 4);
  const std::string text = vtu_text(specimen.model, specimen.solution(), "", &step);
  for (const char* name : {"TimeValue", "stage", "increment", "load_factor"})
    EXPECT_NE(text.find("Name=\"" + std::string(name) + "\" NumberOfComponents=\"1\" NumberOfTuples=\"1\""),
              std::string::npos)
        << name;
  EXPECT_NE(text.find("location=\"vtkDataArray\">psi, compression positive</InformationKey>"),
            std::string::npos);
  EXPECT_EQ(vtu_text(specimen.model, specimen.solution()).find("FieldData"), std::string::npos);
}

TEST(Vtu, FailedRunKeepsTheLastConvergedStateAndSaysSo) {
  Specimen specimen;
  const auto folder = fresh_folder("vtu_fail");
  Vtu vtu(folder, "t");
  specimen.run_and_fail(vtu, 0.01, 2);
  EXPECT_NE(contents(folder / "t.pvd").find("NOT CONVERGED"), std::string::npos);
  EXPECT_NE(contents(folder / "t_0002.vtu")
                .find("\n  NOT CONVERGED: last state in equilibrium, stage 1, load factor 0.75"),
            std::string::npos);
}

TEST(Vtu, RefusesAnUnwritableFolderAtOnce) {
  EXPECT_THROW(Vtu("/dev/null/results", "t"), OutputError);
}

}  // namespace
}  // namespace sage
