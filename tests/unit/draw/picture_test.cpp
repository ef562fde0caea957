#include "sage/draw/picture.hpp"

#include <gtest/gtest.h>

#include <regex>

#include "sage/draw/colour_map.hpp"
#include "sage/draw/contour.hpp"
#include "sage/draw/picture_field.hpp"
#include "tests/support/text.hpp"
#include "tests/unit/record/specimen.hpp"

namespace sage {
namespace {

using test::contents;
using test::fresh_folder;
using test::has;
using test::Specimen;

// Closed form of the fixture: sigma_zz = 10 psi compressive, so the picture says +10.
TEST(FieldSvg, SaysCompressionPositiveWithUnits) {
  Specimen specimen;
  specimen.compress(0.01);
  const std::string svg = field_svg(specimen.model, specimen.solution(), "stress_yy");
  EXPECT_TRUE(has(svg, "sig-z [psi], compression positive<") && has(svg, "from 10 to 10"))
      << svg.substr(0, 800);
  EXPECT_TRUE(has(svg, "compressed specimen"));
  EXPECT_TRUE(has(svg, "r [in]"));
  EXPECT_TRUE(svg.starts_with("<svg"));
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
}

TEST(FieldSvg, DisplacementsAreAlongTheAxes) {
  Specimen specimen(Geometry::plane_strain, false);
  specimen.compress(0.01);
  const std::string svg = field_svg(specimen.model, specimen.solution(), "displacement_y");
  EXPECT_TRUE(has(svg, "u-y [in], positive along +y<") && has(svg, "from -0.02 to 0")) << svg.substr(0, 800);
}

// Largest displacement |(0.0025, 0.02)| of a mesh 2 high: 5 % is 0.1, so a factor of 4.96, rounded down to 2.
TEST(FieldSvg, ScalesTheDeformationByARoundNumber) {
  Specimen specimen(Geometry::axisymmetric, false);
  specimen.compress(0.01);
  PictureOptions deformed;
  deformed.deformed = true;
  EXPECT_TRUE(has(field_svg(specimen.model, specimen.solution(), "deviator", deformed), "deformation x 2<"));
  EXPECT_FALSE(has(field_svg(specimen.model, specimen.solution(), "deviator"), "deformation"));
}

TEST(FieldSvg, EscapesTheTitle) {
  Specimen specimen;
  specimen.model.title = "L/D < 2 & \"pinned\"";
  EXPECT_TRUE(
      has(field_svg(specimen.model, specimen.solution(), "stress_xx"), "L/D &lt; 2 &amp; &quot;pinned&quot;"));
}

TEST(FieldSvg, NamesAreThoseOfTheTable) {
  Specimen specimen;
  specimen.compress(0.01);
  for (const char* name : {"stress_xx", "deviator", "displacement", "displacement_y", "principal_stress_3"})
    EXPECT_NO_THROW(field_svg(specimen.model, specimen.solution(), name)) << name;
  // No field, a field of increments, one that is a word, three numbers without a choice.
  for (const char* name : {"nonsense", "iterations", "status", "principal_stress", "stress"})
    EXPECT_THROW(field_svg(specimen.model, specimen.solution(), name), std::invalid_argument) << name;
}

// Displacements of 1e-17 in a mesh 2 high are what subtraction leaves; magnified to be seen they look like a result.
TEST(FieldSvg, DoesNotMagnifyRounding) {
  Specimen specimen(Geometry::axisymmetric, false);
  specimen.compress(1e-17);
  PictureOptions look;
  look.arrows = true;
  look.deformed = true;
  const std::string svg = field_svg(specimen.model, specimen.solution(), "displacement", look);
  EXPECT_FALSE(has(svg, "deformation x"));
  EXPECT_TRUE(has(svg, "displacements are rounding")) << svg.substr(0, 900);
  EXPECT_TRUE(has(svg, "arrows: none")) << svg.substr(0, 900);
  EXPECT_TRUE(has(svg, "from 0 to 0"));
}

// What iterations leave of a constant field is one colour with one number.
TEST(FieldSvg, OneValueHasOneNumber) {
  EXPECT_EQ(band_limits(9.99999, 10.00001, 10).size(), 2u);
  EXPECT_GT(band_limits(9.99, 10.01, 10).size(), 2u);
  Specimen specimen;
  specimen.compress(0.01);
  specimen.model.fields.add(
      {.name = "nearly", .meaning = "nearly", .value = StressField{[](const Vector4& s, double* v) {
                                                *v = s[1] * (1.0 + 1e-7 * s[1]);
                                              }}});
  const std::string svg = field_svg(specimen.model, specimen.solution(), "nearly");
  EXPECT_TRUE(has(svg, ">10</text>")) << svg;
}

TEST(FieldSvg, LongTitlesStayOnThePaper) {
  Specimen specimen;
  specimen.compress(0.01);
  specimen.model.title = std::string(500, 'n');
  const std::string svg = field_svg(specimen.model, specimen.solution(), "stress_yy");
  EXPECT_TRUE(has(svg, "<title>" + specimen.model.title + "</title>"));
  EXPECT_TRUE(has(svg, "nnn..."));
  const std::size_t at = svg.find("width=\"");
  EXPECT_LT(std::stoi(svg.substr(at + 7)), 900);
}

// sigma_1 = 10 psi along the axis, sigma_3 = 0 around it.
// A field that is known nowhere (no strength left, a law without such a history) leaves the mesh white.
TEST(FieldSvg, StaysWhiteWhereAFieldIsNotKnown) {
  Specimen specimen;
  specimen.compress(0.01);
  specimen.model.fields.add(
      {.name = "unknown", .meaning = "unknown", .value = StressField{[](const Vector4&, double* v) {
                                                  *v = std::numeric_limits<double>::quiet_NaN();
                                                }}});
  const std::string svg = field_svg(specimen.model, specimen.solution(), "unknown");
  EXPECT_FALSE(has(svg, "stroke-width=\"0.4\""));
  EXPECT_FALSE(has(svg, "nan"));
  EXPECT_TRUE(has(svg, "stroke-opacity"));  // the mesh
}

TEST(FieldSvg, PrincipalStressesOfTheCompressedSpecimen) {
  Specimen specimen;
  specimen.compress(0.01);
  const std::string major = field_svg(specimen.model, specimen.solution(), "principal_stress_1"),
                    minor = field_svg(specimen.model, specimen.solution(), "principal_stress_3");
  EXPECT_TRUE(has(major, "sig-1 [psi], compression positive<") && has(major, "from 10 to 10"))
      << major.substr(0, 600);
  EXPECT_TRUE(has(minor, "from 0 to 0")) << minor.substr(0, 600);
}

TEST(Contour, CutsAPolygonWhereTheValueIs) {
  // Unit square, value = x.  Above 0.25 remain three quarters of it.
  const std::vector<Corner> square{{{0, 0}, 0}, {{1, 0}, 1}, {{1, 1}, 1}, {{0, 1}, 0}};
  const std::vector<Corner> part = above(square, 0.25);
  double area = 0.0;
  for (std::size_t i = 0; i < part.size(); ++i) {
    const Vector2 &a = part[i].at, &b = part[(i + 1) % part.size()].at;
    area += 0.5 * (a.x() * b.y() - b.x() * a.y());
  }
  EXPECT_DOUBLE_EQ(area, 0.75);
  EXPECT_EQ(above(square, 2.0).size(), 0u);
  EXPECT_EQ(above(square, -1.0).size(), 4u);
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++found;
  return found;
}

// sigma_z = 10 psi in one, 20 in the other: both scales reach from 10 to 20, or each has its own.
TEST(FieldSheet, PanelsOfAFieldShareAScale) {
  Specimen one, two;
  one.compress(0.01);
  two.compress(0.02);
  FieldSheet sheet{
      "both", {{&one.model, one.solution(), "stress_yy", "a"}, {&two.model, two.solution(), "stress_yy", "b"}}};
  const std::string together = sheet_svg(sheet);
  EXPECT_EQ(count(together, ">10</text>"), 2u);
  EXPECT_EQ(count(together, ">20</text>"), 2u);
  EXPECT_EQ(count(together, ">both</text>"), 1u);
  sheet.panels[1].scale = "of its own";
  const std::string named = sheet_svg(sheet);
  EXPECT_EQ(count(named, ">20</text>"), 1u);
  sheet.panels[1].scale.clear();
  sheet.one_scale = false;
  const std::string apart = sheet_svg(sheet);
  EXPECT_EQ(named, apart);
  EXPECT_EQ(count(apart, ">10</text>"), 1u);
  EXPECT_EQ(count(apart, ">20</text>"), 1u);
}

// Panels of different heights: the mesh of one is flat.
TEST(FieldSheet, NotesOfARowStandAtOneHeight) {
  Specimen one, flat;
  flat.model.mesh.x.row(1) *= 0.1;
  one.compress(0.01);
  flat.compress(0.01);
  FieldSheet sheet{
      "", {{&one.model, one.solution(), "stress_yy", "a"}, {&flat.model, flat.solution(), "stress_yy", "b"}}};
  sheet.columns = 2;
  const auto heights = [&] {
    const std::string svg = sheet_svg(sheet);
    const std::regex note("y=\"([0-9.]+)\"[^>]*>values: means");
    std::vector<std::string> found;
    for (std::sregex_iterator at(svg.begin(), svg.end(), note), none; at != none; ++at)
      found.push_back((*at)[1]);
    return found;
  };
  const std::vector<std::string> beside = heights();
  ASSERT_EQ(beside.size(), 2u);
  EXPECT_EQ(beside[0], beside[1]);
  sheet.columns = 1;  // below one another: each below its own mesh
  const std::vector<std::string> below = heights();
  ASSERT_EQ(below.size(), 2u);
  EXPECT_NE(below[0], below[1]);
}

// The other three quarters are the first one reflected: about its left side, its lower side, both.
TEST(FieldSheet, MirroredSpecimensAreReflections) {
  Specimen specimen(Geometry::axisymmetric, false);
  specimen.compress(0.01);
  FieldSheet sheet{"", {{&specimen.model, specimen.solution(), "stress_yy"}}};
  EXPECT_EQ(count(sheet_svg(sheet), "<use"), 0u);
  sheet.look.mirror_left = sheet.look.mirror_down = true;
  const std::string svg = sheet_svg(sheet);
  EXPECT_EQ(count(svg, "<use"), 3u);
  for (const char* matrix : {"matrix(-1 0 0 1 ", "matrix(1 0 0 -1 ", "matrix(-1 0 0 -1 "})
    EXPECT_EQ(count(svg, matrix), 1u) << matrix;
  EXPECT_EQ(count(svg, ">-1.0</text>"), 1u) << "z below the middle, but no negative radius";
}

// Reflections are copies: a component that is odd across the line has the other sign there.
TEST(FieldSheet, MirroredPicturesSayWhatTurnsItsSign) {
  Specimen specimen(Geometry::axisymmetric, false);
  specimen.compress(0.01);
  const auto says_so = [&](const char* field, bool left, bool down) {
    PictureOptions look;
    look.mirror_left = left;
    look.mirror_down = down;
    return has(field_svg(specimen.model, specimen.solution(), field, look), "turns its sign");
  };
  EXPECT_TRUE(says_so("stress_xy", true, false));
  EXPECT_TRUE(says_so("strain_xy", false, true));
  EXPECT_TRUE(says_so("displacement_x", true, false));
  EXPECT_TRUE(says_so("displacement_y", true, true));
  EXPECT_TRUE(says_so("principal_angle", true, false));
  EXPECT_FALSE(says_so("displacement_x", false, true));
  EXPECT_FALSE(says_so("displacement_y", true, false));
  EXPECT_FALSE(says_so("displacement", true, true)) << "a length";
  EXPECT_FALSE(says_so("stress_yy", true, true));
  EXPECT_FALSE(says_so("stress_xy", false, false));
}

// 89 and -89 degrees are 2 degrees apart, and 91 says so; angles about the first axis are best as they are.
TEST(PictureField, AnglesNearTheVerticalAreOnOneSide) {
  const FieldTable table;
  const auto unfolded = [&](const char* field, std::vector<double> values) {
    std::vector<double*> places;
    for (double& value : values) places.push_back(&value);
    unfold_angles(*table.find(field), places);
    return values;
  };
  EXPECT_EQ(unfolded("principal_angle", {-89, 89, 88, -10}), (std::vector<double>{91, 89, 88, 170}));
  EXPECT_EQ(unfolded("principal_angle", {-10, 10, 89, 5}), (std::vector<double>{-10, 10, 89, 5}));
  EXPECT_EQ(unfolded("deviator", {-89, 89, 88}), (std::vector<double>{-89, 89, 88}));
}

// 8 integration points, none at strength; 10 psi is the larger principal stress everywhere.
TEST(FieldSheet, MarksSayWhatTheyAre) {
  Specimen specimen(Geometry::axisymmetric, false);
  specimen.compress(0.01);
  FieldSheet sheet{"", {{&specimen.model, specimen.solution(), "stress_yy"}}};
  sheet.look.arrows = sheet.look.crosses = sheet.look.yielded = true;
  const std::string svg = sheet_svg(sheet);
  const std::string words =
      std::regex_replace(svg, std::regex("</text>\\n<text[^>]*>"), " ");  // lines are wrapped
  EXPECT_TRUE(has(words, "full points: 0 of 8 integration points at strength"));
  EXPECT_TRUE(has(words, "the longest 10 psi; tension dashed"));
  EXPECT_TRUE(has(words, "arrows: displacement, the longest 0.02016 in"));  // |(0.0025, 0.02)|
}

TEST(Contour, LimitsAreRoundAndHoldTheRange) {
  const std::vector<double> limits = band_limits(-0.37, 9.2, 10);
  EXPECT_LE(limits.front(), -0.37);
  EXPECT_GE(limits.back(), 9.2);
  EXPECT_DOUBLE_EQ(limits[1] - limits[0], 1.0);
  EXPECT_EQ(band_limits(3.0, 3.0, 10), (std::vector<double>{3.0, 3.0}));
}

TEST(Contour, PaintsLowBandsFirst) {
  const CellGrid grid{{0, 1, 2, 3}, {{{0, 1, 2, 3}, 4}}};
  const Patch patch{&grid, {{{0, 0}, 0}, {{8, 0}, 2}, {{8, 8}, 2}, {{0, 8}, 0}, {{4, 4}, 1}}};
  const std::vector<std::string> paths = band_paths({patch}, {0.0, 1.0, 2.0});
  ASSERT_EQ(paths.size(), 2u);
  EXPECT_EQ(paths[0], "M0 0L8 0L8 8L0 8Z");  // the whole element, then what is above 1 on top
  EXPECT_TRUE(has(paths[1], "8 8"));
  EXPECT_FALSE(has(paths[1], "0 8"));
}

TEST(ColourMap, IsViridisFromDarkToLight) {
  EXPECT_EQ(hex(viridis(0.0)), "#440154");
  EXPECT_EQ(hex(viridis(1.0)), "#fde725");
  double last = 0.0;
  for (int i = 0; i <= 100; ++i) {  // lightness (Rec. 601 luma) grows all the way
    const Colour c = viridis(0.01 * i);
    const double luma = 0.299 * c.red + 0.587 * c.green + 0.114 * c.blue;
    EXPECT_GT(luma, last);
    last = luma;
  }
}

TEST(Pictures, OneFileAFieldAndStage) {
  Specimen specimen;
  const auto folder = fresh_folder("pictures");
  Pictures pictures(folder, "t", {"stress_yy", "displacement"});
  specimen.run(pictures, 0.01, 2);
  EXPECT_EQ(pictures.files().size(), 2u);
  EXPECT_TRUE(has(contents(folder / "t_stage1_stress_yy.svg"), "end of stage 1"));
}

TEST(Pictures, AFailedRunSaysSo) {
  Specimen specimen;
  const auto folder = fresh_folder("pictures_fail");
  Pictures pictures(folder, "t", {"stress_yy"});
  specimen.run_and_fail(pictures, 0.01, 2);
  EXPECT_TRUE(has(contents(folder / "t_stage1_failed_stress_yy.svg"), "NOT CONVERGED"));
}

}  // namespace
}  // namespace sage
