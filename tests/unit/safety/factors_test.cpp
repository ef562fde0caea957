// Partial factors: moments of a beam and factors of a compressed block by hand.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sage/app/commands.hpp"
#include "sage/model/partial_factors.hpp"
#include "sage/model_file/model_file.hpp"
#include "sage/record/factor_envelope.hpp"
#include "sage/safety/safety.hpp"
#include "solvers/choose_solver.hpp"
#include "tests/studies/workbench.hpp"

namespace sage::test {
namespace {

const scenes::Workbench& factor_bench() {
  static const scenes::Workbench bench = app::make_workbench();
  return bench;
}

RunSettings with_solver() {
  RunSettings settings;
  settings.choose_solver = choose_solver;
  return settings;
}

Model factored_model(const std::string& text, const std::string& set, const std::vector<int>& variable,
                     const std::vector<int>& structural = {}) {
  BuildOptions build;
  build.factors = partial_factors(set);
  build.actions = {variable, structural};
  return build_model(read_model_file_text(text, "factors.sage.toml"), factor_bench().catalogue(), build);
}

const std::string kUnitsOfFactors = "[units]\nlength = \"m\"\nforce = \"kN\"\nstress = \"kPa\"\n";

// A beam of span 4 with a force in its middle: 10 in stage 1, 20 more in stage 2.  M = P.
const std::string kBeam =
    "geometry = \"plane strain\"\n"
    "node = [{x = 0.0, y = 0.0}, {x = 2.0, y = 0.0}, {x = 4.0, y = 0.0}]\n"
    "element = [{group = 1, nodes = [1, 2]}, {group = 1, nodes = [2, 3]}]\n"
    "fixity = [{first = 1, x = \"fixed\", y = \"fixed\"}, {first = 3, y = \"fixed\"}]\n" +
    kUnitsOfFactors +
    "[[material]]\nlaw = \"section_elastic\"\naxial_stiffness = 1e6\nbending_stiffness = 1e4\n"
    "[[group]]\nname = \"slab\"\nelement = \"beam2\"\nmaterial = 1\n"
    "[[stage]]\nload = [{first = 2, y_force = -10.0}]\n"
    "[[stage]]\nload = [{first = 2, y_force = -20.0}]\n";

FactoredExtreme largest_moment(const std::vector<std::string>& names, const std::vector<int>& structural = {}) {
  std::vector<FactoredEnds> sets;
  std::optional<Model> model;
  for (const std::string& name : names) {
    model.emplace(factored_model(kBeam, name, {2}, structural));
    FactorEnvelope envelope;
    Observer* const watching[] = {&envelope};
    run(*model, factor_bench().catalogue(), with_solver(), watching);
    sets.push_back({partial_factors(name).front(), envelope.rows()});
  }
  for (const FactoredRange& range : factored_ranges(*model, sets))
    if (range.quantity == kBendingMoment) return range.largest;
  return {};
}

TEST(PartialFactors, MomentsOfABeamByHand) {
  EXPECT_NEAR(largest_moment({"DA1-1"}).value, 1.35 * 10.0 + 1.5 * 20.0, 1e-9);
  EXPECT_NEAR(largest_moment({"DA1-2"}).value, 1.0 * 10.0 + 1.3 * 20.0, 1e-9);
  EXPECT_NEAR(largest_moment({"DA2*"}).value, 1.35 * 10.0 + 1.5 * 20.0, 1e-9);
  EXPECT_NEAR(largest_moment({"DA3"}, {1, 2}).value, 1.35 * 10.0 + 1.5 * 20.0, 1e-9);
  EXPECT_NEAR(largest_moment({"DA3"}, {1}).value, 1.35 * 10.0 + 1.3 * 20.0, 1e-9);
  EXPECT_NEAR(largest_moment({"own:permanent=1.1,variable=2,effects=1.5"}).value, 1.5 * (11.0 + 40.0), 1e-9);
  const FactoredExtreme both = largest_moment({"DA1-2", "DA1-1"});
  EXPECT_NEAR(both.value, 43.5, 1e-9);
  EXPECT_EQ(both.set, 1u);
  EXPECT_EQ(both.stage, 2);
}

// A block or cylinder with free sides under a pressure of 40, and 20 more that is variable.
std::string block_under(double c, double phi, bool ring) {
  return fmt::format("geometry = \"{}\"\n", ring ? "axisymmetric" : "plane strain") +
         "node = [{x = 0.0, y = 0.0}, {x = 1.0, y = 0.0}, {x = 1.0, y = 1.0}, {x = 0.0, y = 1.0}]\n"
         "element = [{group = 1, nodes = [1, 2, 3, 4]}]\n"
         "fixity = [{first = 1, last = 2, y = \"fixed\"}, {first = 1, last = 4, step = 3, x = \"fixed\"}]\n" +
         kUnitsOfFactors +
         fmt::format(
             "[[material]]\nlaw = \"mohr_coulomb\"\nyoungs_modulus = 1e4\npoissons_ratio = 0.3\n"
             "cohesion = {}\nfriction_angle = {}\ndilation_angle = {}\n",
             c, phi, phi) +
         "[[group]]\nelement = \"quad4\"\nmaterial = 1\n"
         "[[stage]]\npressure = [{element = 1, edge = 3, normal1 = 40.0, normal2 = 40.0}]\n"
         "[[stage]]\npressure = [{element = 1, edge = 3, normal1 = 20.0, normal2 = 20.0}]\n";
}

// Unconfined strength 2 c tan(45 + phi / 2) with c / F and tan(phi) / F.
double factor_by_hand(double c, double phi, double pressure) {
  double low = 0.01, high = 100.0;
  for (int i = 0; i < 100; ++i) {
    const double F = 0.5 * (low + high), angle = std::atan(std::tan(phi * std::numbers::pi / 180.0) / F);
    (2.0 * c / F * std::tan(0.25 * std::numbers::pi + 0.5 * angle) > pressure ? low : high) = F;
  }
  return low;
}

// What the warning that strengths stay undivided lists; "" without it.
std::string undivided_in(const std::string& text, const std::string& set) {
  const Model model = factored_model(text, set, {2});
  for (const Diagnostic& one : model.diagnostics.list())
    if (to_string(one.code) == "S743") {
      EXPECT_EQ(one.severity, Severity::warning);
      return one.message;
    }
  return {};
}

// The block with another law.
std::string block_of(const std::string& law) {
  std::string text = block_under(60.0, 30.0, false);
  const std::size_t begin = text.find("law = "), end = text.find("[[group]]");
  return text.replace(begin, end - begin, law)
      .replace(text.find("[[group]]"), 9, "[[group]]\nname = \"crust\"");
}

// The critical state of Cam clay is a strength, and no parameter that a set divides.
TEST(PartialFactors, WarnOfStrengthsThatStayUndivided) {
  const std::string elastic = "law = \"linear_elastic\"\nyoungs_modulus = 1e4\npoissons_ratio = 0.3\n";
  const std::string clay =
      "name = \"clay\"\nlaw = \"modified_cam_clay\"\nM = 1.2\nlambda = 0.2\nkappa = 0.04\n"
      "specific_volume = 2.0\npoissons_ratio = 0.3\nocr = 1.0\n";
  const std::string start =
      "[[initial]]\ngroup = 1\nkind = \"uniform\"\nvalues = [50.0, 50.0, 50.0, 0.0]\n[[stage]]";
  std::string soft = block_of(clay);
  soft.replace(soft.find("[[stage]]"), 9, start);
  EXPECT_NE(undivided_in(soft, "DA1-2").find("1 clay (modified_cam_clay) of group 1 crust"), std::string::npos)
      << undivided_in(soft, "DA1-2");
  EXPECT_EQ(undivided_in(soft, "DA1-1"), "");  // divides nothing
  EXPECT_EQ(undivided_in(block_of(elastic), "DA1-2"), "");
  EXPECT_EQ(undivided_in(block_under(60.0, 30.0, false), "DA1-2"), "");
  EXPECT_EQ(undivided_in(kBeam, "DA1-2"), "");
}

TEST(PartialFactors, SafetyOfABlockByHand) {
  const double degree = std::numbers::pi / 180.0;
  for (const bool ring : {false, true})
    for (const double phi : {0.0, 30.0}) {
      const double phi_d = std::atan(std::tan(phi * degree) / 1.25) / degree;
      const double c_d = phi > 0.0 ? 60.0 / 1.25 : 60.0 / 1.4;
      for (const auto& [set, wanted] :
           {std::pair<std::string, double>{"DA1-2", factor_by_hand(c_d, phi_d, 40.0 + 1.3 * 20.0)},
            {"DA1-1", factor_by_hand(60.0, phi, 40.0 + 1.5 / 1.35 * 20.0)}}) {
        Model model = factored_model(block_under(60.0, phi, ring), set, {2});
        safety::Options options;
        options.limits.tolerance = 0.01;
        const safety::Safety found =
            safety::find_safety(model, factor_bench().catalogue(), with_solver(), options);
        ASSERT_TRUE(found.lower && found.upper) << found.incomplete;
        EXPECT_LE(*found.lower, wanted * 1.001) << set << " " << phi;
        EXPECT_GE(*found.upper, wanted * 0.999) << set << " " << phi;
        EXPECT_LE(*found.upper - *found.lower, 0.0101);
      }
    }
}

TEST(PartialFactors, SetsAreReadAndWrongOnesRejected) {
  const std::vector<PartialFactors> two = partial_factors("DA1-1, DA2*");
  ASSERT_EQ(two.size(), 2u);
  EXPECT_NEAR(two[1].required(), 1.35 * 1.1, 1e-12);
  EXPECT_EQ(factor_word(two[1]), "DA2star");
  const PartialFactors own = partial_factors("DA1-2:undrained=1.5").front();
  EXPECT_EQ(own.undrained, 1.5);
  EXPECT_EQ(own.friction, 1.25);
  EXPECT_EQ(text_of(partial_factors(text_of(own)).front()), text_of(own));
  for (const char* wrong : {"DA4", "", "a:b=1", "a:friction=x", "a:friction=0", "a:friction=-1", ":friction=1",
                            "a/b:friction=1", "a:variable=1e9", "a:friction=nan"})
    EXPECT_THROW(partial_factors(wrong), std::invalid_argument) << wrong;
  EXPECT_THROW(factored_model(kBeam, "DA1-2", {3}), InputError);
  EXPECT_THROW(factored_model(kBeam, "DA1-1,DA1-2", {2}), InputError);
}

}  // namespace
}  // namespace sage::test
