// The manual says what there is and what there is not: it has to be changed when that changes.
#include <gtest/gtest.h>

#include "sage/app/commands.hpp"
#include "tests/conformance/law_samples.hpp"
#include "tests/regression/program.hpp"

namespace sage::test {
namespace {

const std::string kSource = SAGE_SOURCE_DIR;

bool has(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

// What a new element or law adds to the program has to be added to docs/manual/deck.md, and what the page says
// is missing to be struck out there.
TEST(Manual, WhatADeckCanAskForIsWhatTheCatalogueHas) {
  const std::string page = read(kSource + "/docs/manual/deck.md");
  const std::string list = page.substr(0, page.find("## What the program does not do"));
  const Catalogue catalogue = app::full_catalogue();
  for (const auto& [code, entry] : catalogue.elements.entries()) {
    EXPECT_TRUE(has(list, "`" + entry.name + "`")) << entry.name;
    for (const Formulation& formulation : entry.formulations)
      for (const Geometry geometry : {Geometry::plane_strain, Geometry::axisymmetric}) {
        if ((!entry.solid() && !entry.interface()) || entry.has_pores()) continue;
        const ElementTraits traits = entry.make(geometry, formulation.code)->traits();
        EXPECT_EQ(traits.dofs, 2 * traits.nodes) << entry.name << ": more than two displacements a node";
      }
  }
  for (const auto& [code, entry] : catalogue.materials.entries())
    EXPECT_TRUE(has(list, "`" + entry.name + "`")) << entry.name;
  for (const char* missing : {"**Water.**", "**Structures.**", "**Large strain.**", "**Dynamics.**"})
    EXPECT_TRUE(has(page, missing)) << missing;
}

// A law that uses gamma_w can't be made without it: that is the shear stiffness of clough_duncan alone.
TEST(Manual, WaterIsUsedForOneLawAlone) {
  const Catalogue catalogue = app::full_catalogue();
  const UnitSystem dry{"m", "kN", "kPa", 101.325, 0.0};
  int refusals = 0;
  for (const conformance::LawSample& sample : samples()) {
    const MaterialEntry& entry = *catalogue.materials.find(sample.code);
    bool refused = false;
    try {
      entry.make(sample.values, dry);
    } catch (const ParameterError& error) {
      refused = has(error.what(), "unit weight of water gamma_w");
      EXPECT_TRUE(refused) << error.what();
    }
    EXPECT_EQ(refused, entry.name == "clough_duncan" && sample.values[4] > 0.0) << sample.what;
    refusals += refused ? 1 : 0;
  }
  EXPECT_GT(refusals, 3);
}

TEST(Manual, EchoAndListingSayWhatTheUnitWeightOfWaterIsFor) {
  const std::filesystem::path folder = empty_folder("gamma_w");
  write(folder / "deck.dat", block_deck().text());
  const std::string echo = sagefe(folder, "echo deck.dat").out;
  EXPECT_TRUE(
      has(echo,
          "(water_unit_weight: scales the shear stiffness of clough_duncan interfaces, and gives the pore "
          "pressures of water cards"))
      << echo;
  EXPECT_TRUE(has(echo, "there is no pore water")) << echo;
  EXPECT_EQ(count(echo, "(water_unit_weight:"), 1);
  EXPECT_EQ(sagefe(folder, "run deck.dat -q -o out").exit_code, 0);
  EXPECT_TRUE(has(read(folder / "out" / "deck.lst"), "no pore pressure is computed"));
}

}  // namespace
}  // namespace sage::test
