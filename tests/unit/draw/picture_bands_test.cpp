// Where the bands and edges of a picture are, read back from its paths: every solid element of the catalogue.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>

#include "sage/draw/contour.hpp"
#include "sage/draw/picture.hpp"
#include "tests/support/elements.hpp"
#include "tests/unit/record/specimen.hpp"

namespace sage {
namespace {

using test::ElementCase;
using Polygon = std::vector<Vector2>;
using Displacement = std::function<Vector2(const Vector2&)>;

// Elements of one kind with displacements at their nodes; no stress.
struct Sheet {
  Model model;
  Eigen::VectorXd u, none;

  // Each item of `shapes`: the nodes of one element.  No two elements share nodes, as a picture does not ask.
  Sheet(const ElementCase& element, const std::vector<Eigen::Matrix2Xd>& shapes, const Displacement& field) {
    const auto nodes = shapes.front().cols();
    model.title = element.name;
    model.units = {"m", "kN", "kPa", 101.325, 9.81};
    model.materials.resize(1);
    Group group;
    set_element(group, test::element_catalogue(), element.code, element.formulation, element.geometry);
    model.mesh.x.resize(2, nodes * static_cast<Eigen::Index>(shapes.size()));
    for (std::size_t e = 0; e < shapes.size(); ++e) {
      model.mesh.x.middleCols(static_cast<Eigen::Index>(e) * nodes, nodes) = shapes[e];
      group.element_numbers.push_back(static_cast<int>(e) + 1);
    }
    for (int n = 0; n < model.mesh.x.cols(); ++n) {
      model.mesh.number.push_back(n + 1);
      group.nodes.push_back(n);
    }
    model.groups.push_back(std::move(group));
    u.resize(DofMap(model).dofs());
    for (int n = 0; n < model.mesh.nodes(); ++n) u.segment<2>(2 * n) = field(model.mesh.x.col(n));
    none = Eigen::VectorXd::Zero(DofMap(model).dofs());
  }

  std::string svg(std::string_view field, bool deformed = false, PictureOptions options = {}) const {
    Activity activity(model);
    activity.group[0] = 1;
    options.deformed = deformed;
    return field_svg(model, {&u, &none, &none, nullptr, &activity}, field, options);
  }
};

// The polygons of one path: M x y L x y ... Z.
std::vector<Polygon> polygons_of(const std::string& path) {
  std::vector<Polygon> all;
  const char* at = path.c_str();
  while (*at != '\0') {
    if (*at == 'M') all.emplace_back();
    if (*at == 'M' || *at == 'L') {
      char* end = nullptr;
      const double x = std::strtod(at + 1, &end);
      const double y = std::strtod(end, &end);
      all.back().push_back({x, y});
      at = end;
    } else {
      ++at;
    }
  }
  return all;
}

struct Drawn {
  std::vector<std::string> colours;         // of the bands, in the order of painting
  std::vector<std::vector<Polygon>> bands;  // of the same
  std::vector<Polygon> mesh;                // outlines of the elements
};

Drawn drawn(const std::string& svg) {
  Drawn result;
  for (const std::string& line : test::lines_of(svg)) {
    const std::size_t d = line.find(" d=\"");
    if (!line.starts_with("<path fill=") || d == std::string::npos) continue;
    const std::vector<Polygon> polygons = polygons_of(line.substr(d + 4, line.rfind('"') - d - 4));
    if (line.starts_with("<path fill=\"none\"")) {
      if (result.mesh.empty()) result.mesh = polygons;
    } else {
      result.colours.push_back(line.substr(12, 7));
      result.bands.push_back(polygons);
    }
  }
  return result;
}

bool inside(const Polygon& polygon, const Vector2& p) {
  bool in = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Vector2 &a = polygon[i], &b = polygon[j];
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
      in = !in;
  }
  return in;
}

// The band that a viewer sees at a place; -1 = the paper.
int band_at(const Drawn& picture, const Vector2& place) {
  for (std::size_t band = picture.bands.size(); band-- > 0;)
    for (const Polygon& polygon : picture.bands[band])
      if (inside(polygon, place)) return static_cast<int>(band);
  return -1;
}

struct Box {
  Vector2 low, high;
};

Box box_of(const std::vector<Polygon>& polygons) {
  Box box{polygons[0][0], polygons[0][0]};
  for (const Polygon& polygon : polygons)
    for (const Vector2& p : polygon) box = {box.low.cwiseMin(p), box.high.cwiseMax(p)};
  return box;
}

// A parallelogram, (0, 0) (1, 0) (1.3, 1) (0.3, 1): two triangles, or one quadrilateral.  Straight sides, so
// that every element of degree 2 or more holds a quadratic field exactly.
std::vector<Eigen::Matrix2Xd> parallelogram(const ElementEntry& entry) {
  Eigen::Matrix2Xd corners(2, 4);
  corners << 0.0, 1.0, 1.3, 0.3, 0.0, 0.0, 1.0, 1.0;
  if (entry.square()) return {test::straight_element(entry, corners)};
  return {test::straight_element(entry, corners(Eigen::all, std::vector<int>{0, 1, 2})),
          test::straight_element(entry, corners(Eigen::all, std::vector<int>{0, 2, 3}))};
}

// A column under its own weight: u_y = -(2 y - y^2) depends on y alone, so the bands are level.  Degree 1
// can't hold the square: u_y = -y there.
TEST(PictureBands, AreLevelWhereTheFieldDependsOnHeightAlone) {
  for (const ElementCase& element : test::solid_cases()) {
    SCOPED_TRACE(element.name);
    const int degree = element.make()->traits().degree;
    const double square = degree > 1 ? 1.0 : 0.0, slope = degree > 1 ? 2.0 : 1.0;
    const auto exact = [&](double y) { return square * y * y - slope * y; };
    const Sheet sheet(element, parallelogram(*element.entry),
                      [&](const Vector2& x) { return Vector2(0.0, exact(x.y())); });
    const Drawn picture = drawn(sheet.svg("displacement_y"));
    const Box box = box_of(picture.mesh);
    const double unit = (box.high - box.low).y();  // on the paper
    const auto height = [&](const Vector2& p) { return (box.high.y() - p.y()) / unit; };
    const std::vector<double> limits = band_limits(-1.0, 0.0, 10);
    ASSERT_EQ(picture.bands.size() + 1, limits.size());
    // A chord of a parabola, u'' = 2, over one of at least 16 cells is off by u'' h^2 / 8 at most; coordinates
    // are rounded to 0.01.
    const double off = square * 2.0 / (16.0 * 16.0) / 8.0 + 0.01 * slope / unit;

    for (std::size_t band = 0; band < picture.bands.size(); ++band)
      for (const Polygon& polygon : picture.bands[band])
        for (const Vector2& p : polygon) EXPECT_GE(exact(height(p)), limits[band] - off) << p.transpose();

    int seen = 0;
    for (int j = 1; j < 60; ++j)
      for (int i = 1; i < 30; ++i) {
        const double y = j / 60.0, u = exact(y);
        const Vector2 place(box.low.x() + unit * (0.3 * y + i / 30.0), box.high.y() - unit * y);
        int band = 0;
        while (limits[static_cast<std::size_t>(band) + 1] < u) ++band;
        const auto b = static_cast<std::size_t>(band);
        if (std::min(u - limits[b], limits[b + 1] - u) < off) continue;  // either band is right
        ++seen;
        ASSERT_EQ(band_at(picture, place), band) << "x " << i / 30.0 << " y " << y << " u_y " << u;
      }
    EXPECT_GT(seen, 1000);
  }
}

// u_y is 0.5, a limit between two bands, up to 1e-8 above and below; a corner at 0 and one at 1 set the range.
TEST(PictureBands, RoundingAboutALimitIsOneColour) {
  const ElementCase element = test::element_case(1, 1, Geometry::plane_strain);
  std::vector<Eigen::Matrix2Xd> squares;
  for (int i = 0; i < 12; ++i) {
    Eigen::Matrix2Xd x = test::parent_nodes(*element.entry);
    x.row(0).array() += 2.0 * i;
    squares.push_back(x);
  }
  Sheet sheet(element, squares,
              [](const Vector2& x) { return Vector2(0.0, 0.5 + 1e-8 * std::sin(17.0 * x.x() + 3.0 * x.y())); });
  sheet.u[1] = 0.0;
  sheet.u[sheet.u.size() - 1] = 1.0;
  const Drawn picture = drawn(sheet.svg("displacement_y"));
  const Box box = box_of(picture.mesh);
  for (int i = 0; i < 200; ++i) {
    const Vector2 part((2.1 + 19.7 * i / 200.0) / 24.0, 0.05 + 0.9 * (i % 7) / 7.0);
    EXPECT_EQ(band_at(picture, box.low + (box.high - box.low).cwiseProduct(part)), 5) << i;
  }
}

// |u| of u = (x, 0) is |x|: 0 in the middle and 1 at all corners of a four-node square.
// Half a percent of the area is fifty times what the rest has: the colours are those of the rest, and the picture says so.
TEST(PictureBands, ASingularCornerDoesNotTakeTheScale) {
  const ElementCase element = test::element_case(1, 1, Geometry::plane_strain);
  std::vector<Eigen::Matrix2Xd> squares;
  for (int i = 0; i < 200; ++i) {
    squares.push_back(test::parent_nodes(*element.entry));
    squares.back().row(0).array() += 3.0 * i;
  }
  const Sheet sheet(element, squares,
                    [](const Vector2& x) { return Vector2(0.0, x.x() > 595.5 ? 2000.0 : 0.1 * x.x()); });
  const std::string svg = sheet.svg("displacement_y");
  EXPECT_NE(svg.find("to 2000; colours end at 60: 0.5 % of the area lies beyond"), std::string::npos)
      << svg.substr(0, 900);
  PictureOptions whole;
  whole.robust = false;
  EXPECT_EQ(sheet.svg("displacement_y", false, whole).find("colours end"), std::string::npos);
  whole.low = 0.0;
  whole.high = 10.0;
  EXPECT_NE(sheet.svg("displacement_y", false, whole).find("colours end at 0 and 10"), std::string::npos);
}

// What rises evenly has no corner: its colours are all of it.
TEST(PictureBands, AnEvenFieldKeepsItsRange) {
  const ElementCase element = test::element_case(1, 1, Geometry::plane_strain);
  std::vector<Eigen::Matrix2Xd> squares;
  for (int i = 0; i < 100; ++i) {
    squares.push_back(test::parent_nodes(*element.entry));
    squares.back().row(0).array() += 2.0 * i;
  }
  const Sheet sheet(element, squares, [](const Vector2& x) { return Vector2(0.0, 0.1 * x.x()); });
  EXPECT_EQ(sheet.svg("displacement_y").find("colours end"), std::string::npos);
}

TEST(PictureBands, LengthOfAVectorIsFoundBetweenTheNodes) {
  for (const ElementCase& element : test::solid_cases()) {
    if (!element.entry->square()) continue;
    SCOPED_TRACE(element.name);
    Eigen::Matrix2Xd corners(2, 4);
    corners << -1.0, 1.0, 1.0, -1.0, -1.0, -1.0, 1.0, 1.0;
    const Sheet sheet(element, {test::straight_element(*element.entry, corners)},
                      [](const Vector2& x) { return Vector2(x.x(), 0.0); });
    const std::string svg = sheet.svg("displacement");
    EXPECT_NE(svg.find("from 0 to 1<"), std::string::npos);
    const Drawn picture = drawn(svg);
    const Box box = box_of(picture.mesh);
    for (int i = 0; i < 40; ++i) {
      const double x = -1.0 + (i + 0.5) / 20.0;  // between two limits of bands 0.1 wide
      const Vector2 place = box.low + 0.5 * (box.high - box.low).cwiseProduct(Vector2(1.0 + x, 0.7));
      EXPECT_EQ(band_at(picture, place), static_cast<int>(std::floor(std::abs(x) / 0.1))) << x;
    }
  }
}

// Nodes on y = x^2 / 4 along the lower side: elements of degree 2 and more draw that parabola, not its chord.
TEST(PictureBands, SidesAreCurvedWhereTheElementIs) {
  for (const ElementCase& element : test::solid_cases()) {
    if (element.make()->traits().degree < 2 || !element.entry->square()) continue;
    SCOPED_TRACE(element.name);
    Eigen::Matrix2Xd x = test::parent_nodes(*element.entry);
    for (Eigen::Index i = 0; i < x.cols(); ++i) x(1, i) += 0.25 * x(0, i) * x(0, i) * 0.5 * (1.0 - x(1, i));
    const Sheet sheet(element, {x}, [](const Vector2& at) { return Vector2(0.0, 0.001 * at.y()); });
    const Drawn picture = drawn(sheet.svg("displacement_y"));
    const Box box = box_of(picture.mesh);
    const double unit = 0.5 * (box.high - box.low).x();
    const Polygon& outline = picture.mesh.at(0);
    EXPECT_EQ(picture.mesh.size(), 1u);
    int below = 0;
    for (const Vector2& p : outline) {
      const double px = (p.x() - box.low.x()) / unit - 1.0, py = 1.0 - (p.y() - box.low.y()) / unit;
      if (py > -0.74) continue;  // the other sides
      ++below;
      EXPECT_NEAR(py, -1.0 + 0.25 * px * px, 0.02 / unit) << px;  // coordinates are rounded to 0.01
    }
    EXPECT_GE(below, 15);
    const Box right = box_of(picture.mesh);
    EXPECT_NEAR((right.high - right.low).y(), 2.0 * unit, 0.02);
  }
}

// The outline of the undeformed mesh follows curved sides too, not only the chords between corners.
TEST(PictureBands, DashedOutlineOfTheUndeformedMeshIsCurved) {
  const ElementCase element = test::element_case(2, 1, Geometry::plane_strain);
  Eigen::Matrix2Xd x = test::parent_nodes(*element.entry);
  x(1, 4) = -1.5;  // the lower side bulges by half its half-length
  const Sheet sheet(element, {x}, [](const Vector2& at) { return Vector2(0.0, 0.001 * (at.y() - 1.0)); });
  const std::string svg = sheet.svg("displacement_y", true);
  const std::string group = svg.substr(svg.find("stroke-dasharray"));
  std::size_t longest = 0;
  for (const std::string& line : test::lines_of(group.substr(0, group.find("</g>")))) {
    const std::size_t d = line.find(" d=\"");
    if (d != std::string::npos) longest = std::max(longest, polygons_of(line.substr(d + 4)).at(0).size());
  }
  EXPECT_GE(longest, 16u);
}

// 40 x 40 patches of one value each, that share their nodes; with `shared` false none knows its neighbours.
std::vector<Patch> tiny_patches(const CellGrid& grid, bool shared,
                                const std::function<double(int, int)>& value) {
  constexpr int kSide = 40;
  std::vector<Patch> all;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      Patch patch{&grid, {}};
      for (const auto& [di, dj] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
        const auto corner = patch.places.size();
        patch.places.push_back({{1.5 * (i + di), 1.5 * (j + dj)}, value(i, j)});
        if (shared) patch.nodes[corner] = (kSide + 1) * (j + dj) + i + di;
      }
      all.push_back(std::move(patch));
    }
  return all;
}

double signed_area(const std::vector<Polygon>& polygons) {
  double twice = 0.0;
  for (const Polygon& polygon : polygons)
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vector2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      twice += a.x() * b.y() - a.y() * b.x();
    }
  return 0.5 * twice;
}

// A ring with an island in its hole, and patches that touch at corners alone: the region of a band has the area of its
// patches, in few lines.
TEST(PictureBands, TinyPatchesOfOneColourAreOneRegion) {
  const CellGrid grid{{0, 1, 2, 3}, {{{0, 1, 2}, -1}, {{0, 2, 3}, -1}}};
  const std::vector<double> limits{0.0, 1.0, 2.0, 3.0};
  const auto value = [](int i, int j) {
    const double r = std::hypot(i - 20.0, j - 20.0);
    if (i < 4 && j < 4) return (i + j) % 2 == 0 ? 2.5 : 0.5;
    return r < 3.0 ? 2.5 : r < 8.0 ? 0.5 : r < 15.0 ? 1.5 : 0.5;
  };
  const std::vector<Patch> patches = tiny_patches(grid, true, value);
  const std::vector<std::string> paths = band_paths(patches, limits);
  ASSERT_EQ(paths.size(), 3u);
  for (std::size_t band = 0; band < 3; ++band) {
    double wanted = 0.0;
    for (const Patch& patch : patches) {
      const double at = patch.places[0].value;
      wanted += at >= limits[band] && at < limits[band + 1] ? 1.5 * 1.5 : 0.0;
    }
    EXPECT_NEAR(signed_area(polygons_of(paths[band])), wanted, 1e-6 * wanted) << band;
  }
  std::size_t places = 0;
  for (const Polygon& polygon : polygons_of(paths[1])) places += polygon.size();
  EXPECT_GT(places, 50u);   // around and within the ring
  EXPECT_LT(places, 200u);  // of 4 x 500
}

}  // namespace
}  // namespace sage
