#include "tests/studies/scenes/soil_structure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sage/math/line_shapes.hpp"
#include "sage/math/quadrature.hpp"
#include "tests/studies/scenes/structures.hpp"

namespace sage::scenes {

namespace {

constexpr int kQuad4 = 1, kQuad8 = 2, kElastic = 1, kMohrCoulomb = 4, kCloughDuncan = 22, kJoint = 23,
              kOneWay = 32, kPlasticBar = 33, kPlasticSection = 37;

constexpr int kBBar = 2, kEnhanced = 5;  // formulations of quad4

// Numbers of elements, one after the other.
struct Numbers {
  int next = 1;
  int operator()(int count) {
    next += count;
    return next - count;
  }
};

int group_at(const WholeRun& run, int number) {
  for (std::size_t g = 0; g < run.model->groups.size(); ++g)
    if (run.model->groups[g].number == number) return static_cast<int>(g);
  return -1;
}

// What interface elements (row-sum, plane strain or along the axis) put on the body at their nodes 1 and 2, pair by pair:
// use(place, force).
template <class Use>
void each_pair(const WholeRun& run, int group_number, const Use& use) {
  const int g = group_at(run, group_number);
  if (g < 0) return;
  const Group& group = run.model->groups[g];
  const PointStresses& stress = run.stress[g];
  const bool middle = group.node_count() == 6;
  const int pairs = middle ? 3 : 2;
  for (int e = 0; e < group.elements(); ++e) {
    const int* n = group.nodes_of(e);
    Eigen::Matrix<double, 2, 3> x = Eigen::Matrix<double, 2, 3>::Zero();
    x.col(0) = run.model->mesh.x.col(n[0]);
    x.col(1) = run.model->mesh.x.col(n[1]);
    if (middle) x.col(2) = run.model->mesh.x.col(n[4]);
    Eigen::Vector3d length = Eigen::Vector3d::Zero();
    for (const auto& [xi, w] : GaussLine<5>::table)
      length += w * (x * line_slopes(middle, xi)).norm() * line_shapes(middle, xi);
    for (int p = 0; p < pairs; ++p) {
      const Vector2 along = (x * line_slopes(middle, p == 2 ? 0.0 : 2.0 * p - 1.0)).normalized();
      const Vector2 left(-along.y(), along.x());
      const auto t = stress.col(pairs * e + p);
      use(Vector2(x.col(p)), Vector2((t[0] * along + t[1] * left) * length[p]));
    }
  }
}

}  // namespace

int WallInGround::stages() const {
  int last = 1 + static_cast<int>(levels.size());
  for (const Strut& s : struts) last = std::max({last, s.born, s.dies});
  return last;
}

// NOLINTNEXTLINE(readability-function-size): one kind of card after the other
DeckWriter WallInGround::deck(int last_stage) const {
  DeckWriter deck(geometry);
  const double bottom = -depth;
  const int c = inside, right = node(c, toe) + 5000;
  deck.node(node(0, depth), 0.0, bottom);
  deck.node(node(c, depth), half_width, bottom);
  deck.node(node(c + outside, depth), half_width + far, bottom);
  deck.node(node(0, 0), 0.0, 0.0);
  deck.node(node(c, 0), half_width, 0.0);
  deck.node(node(c + outside, 0), half_width + far, 0.0);
  deck.fill(node(0, depth), inside, 1, depth, stride());
  deck.fill(node(c, depth), outside, 1, depth, stride(), 6.0);
  // The outside's own nodes along the wall, and the wall's.
  deck.node(right + stride(), half_width, 1.0 - toe);
  deck.node_row(node(c, 0) + 5000, stride(), half_width, 0.0);
  deck.node(wall(toe), half_width, -toe);
  deck.node_row(wall(0), stride(), half_width, 0.0);

  deck.material(1, kMohrCoulomb, {E, 0.3, cohesion, friction, dilation}, weight, "ground");
  const double E_wall = 3e7, EA = E_wall * thickness;
  if (moment_strength > 0.0)
    deck.material(2, kPlasticSection, {EA, EA * thickness * thickness / 12.0, 0.0, moment_strength}, 0.0,
                  "wall that yields");
  else
    deck.material(2, kPlate, {E_wall, 0.2, thickness, goes_around ? 1.0 : 0.0}, 0.0,
                  goes_around ? "wall" : "wall of strips");
  deck.material(3, kJoint, {1e5, 1e6, adhesion, wall_friction}, 0.0, "wall and ground");
  const bool rings = geometry == 2;
  std::vector<double> tie{strut_stiffness, spacing};
  if (rings) tie.pop_back();
  const auto some = [&](bool anchor) {
    return std::any_of(struts.begin(), struts.end(), [&](const Strut& s) { return s.anchor == anchor; });
  };
  if (some(false)) deck.material(4, kAxial, tie, 0.0, rings ? "rings" : "struts");
  if (tip_spring > 0.0) deck.material(9, kAxial, {tip_spring, 1.0}, 0.0, "spring of length 1");
  if (some(true) && anchor_strength > 0.0)
    deck.material(5, kPlasticBar, {strut_stiffness, anchor_strength, 0.0, spacing}, 0.0, "anchors that yield");
  else if (some(true))
    deck.material(5, kOneWay, {strut_stiffness, 1.0, spacing}, 0.0, "anchors");

  Numbers numbers;
  // Elements of rows between two depths, below first.
  const auto soil = [&](int group, int from, int to) {  // inside, from above to below
    const int n = node(0, to);
    deck.elements_block(numbers(inside * (to - from)), group, {n, n + 1, n + 1 + stride(), n + stride()},
                        inside, to - from, 1, stride());
  };
  const auto face = [&](int group, int from, int to, bool outer) {
    int w = wall(to);
    if (outer) {  // the ground on the right of the way up
      const int first = to == toe ? node(c, toe) : node(c, to) + 5000;
      if (to == toe) {
        deck.element(numbers(1), group, {first, right + stride(), w + stride(), w});
        deck.elements_block(numbers(to - from - 1), group,
                            {right + stride(), right + 2 * stride(), w + 2 * stride(), w + stride()}, 1,
                            to - from - 1, 1, stride());
        return;
      }
    }
    const int n = node(c, to);
    deck.elements_block(numbers(to - from), group, {w, w + stride(), n + stride(), n}, 1, to - from, 1,
                        stride());
  };
  const int quad4 = dilation > 0.0 ? kEnhanced : kBBar;
  deck.group(kSoil, kQuad4, quad4, 1, "ground");
  int above = 0;
  const int lifts = static_cast<int>(levels.size());
  for (int k = 0; k < lifts; ++k) deck.group(2 + k, kQuad4, quad4, 1, fmt::format("lift {}", k + 1));
  deck.group(kWall, kBeam2, 1, 2, "wall");
  deck.group(kInside, kInterface4, 1, 3, "inner face");
  for (int k = 0; k < lifts; ++k)
    deck.group(kInside + 1 + k, kInterface4, 1, 3, fmt::format("inner face, lift {}", k + 1));
  deck.group(kOutside, kInterface4, 1, 3, "outer face");

  soil(kSoil, levels.back(), depth);
  for (int k = 0; k < lifts; ++k) {
    soil(2 + k, above, levels[static_cast<std::size_t>(k)]);
    above = levels[static_cast<std::size_t>(k)];
  }
  // Outside: below the toe the column beside the wall is joined to the inside.
  const int s = stride();
  int n = node(c, depth);
  deck.elements_block(numbers(outside * (depth - toe)), kSoil, {n, n + 1, n + 1 + s, n + s}, outside,
                      depth - toe, 1, s);
  n = node(c, toe);
  deck.element(numbers(1), kSoil, {n, n + 1, n + 1 + s, right + s});
  deck.elements_block(numbers(toe - 1), kSoil, {right + s, n + 1 + s, n + 1 + 2 * s, right + 2 * s}, 1, toe - 1,
                      1, s);
  deck.elements_block(numbers((outside - 1) * toe), kSoil, {n + 1, n + 2, n + 2 + s, n + 1 + s}, outside - 1,
                      toe, 1, s);
  deck.elements_block(numbers(toe), kWall, {wall(toe), wall(toe - 1)}, 1, toe, 1, s);
  face(kInside, levels.back(), toe, false);
  above = 0;
  for (int k = 0; k < lifts; ++k) {
    face(kInside + 1 + k, above, levels[static_cast<std::size_t>(k)], false);
    above = levels[static_cast<std::size_t>(k)];
  }
  face(kOutside, 0, toe, true);
  int group = kStruts;
  const int last = last_stage == 0 ? stages() : last_stage;
  for (const Strut& strut : struts) {
    if (strut.born > last) continue;  // a group that is never born is there from the first
    deck.group(group, rings ? kRing1 : kBar2, 0, strut.anchor ? 5 : 4,
               fmt::format("{} at {} m",
                           strut.anchor ? "anchor"
                           : rings      ? "ring"
                                        : "strut",
                           strut.level));
    if (strut.anchor) {
      deck.node(7000 + group, half_width + 0.5 * far + 0.3, -strut.level);
      deck.fix(7000 + group, 1, 1);
      deck.element(numbers(1), group, {wall(strut.level), 7000 + group});
    } else {
      deck.element(numbers(1), group, {wall(strut.level), rings ? wall(strut.level) : node(0, strut.level)});
    }
    ++group;
  }
  if (tip_spring > 0.0) {
    deck.group(90, kBar2, 0, 9, "spring below the tip");
    deck.node(7990, half_width, -toe - 1.0);
    deck.fix(7990, 1, 1);
    deck.element(numbers(1), 90, {wall(toe), 7990});
  }
  deck.fix_row(node(0, depth), node(c + outside, depth), 1, 1, 1);
  deck.fix_row(node(0, depth), node(0, 0), s, 1, 0);
  deck.fix_row(node(c + outside, depth), node(c + outside, 0), s, 1, 0);
  for (int g = 0; g <= lifts; ++g) deck.initial(g + 1, 1, 0.0, weight, K0, 0.0);
  for (int k = 0; k <= lifts; ++k) deck.initial(kInside + k, 3, k + 1);
  deck.initial(kOutside, 3, kSoil);

  for (int stage = 1; stage <= last; ++stage) {
    StageCards& cards = deck.stage(stage == 1 ? 1 : 2);
    cards.max_iterations = 40;
    cards.title = stage == 1 ? "At rest, with the wall in place" : "";
    if (stage == 1) cards.gravity_y = -1.0;
    group = kStruts;
    for (const Strut& strut : struts) {
      const std::string kind = strut.anchor ? "anchor" : rings ? "ring" : "strut";
      if (strut.born == stage) {
        cards.births.push_back(group);
        cards.title += fmt::format("{} at {} m, ", kind, strut.level);
        const double each = rings ? strut.prestress : strut.prestress / spacing;
        if (each != 0.0) cards.initial(group, 0, each);
        if (!rings && !strut.anchor &&
            strut.level < levels.back())  // on the line of symmetry, where the soil is gone
          cards.fix(node(0, strut.level), 0, 1);
      }
      if (strut.dies == stage) {
        cards.deaths.push_back(group);
        cards.title += fmt::format("{} at {} m taken away, ", kind, strut.level);
      }
      ++group;
    }
    if (stage >= 2 && stage - 2 < lifts) {
      cards.deaths.insert(cards.deaths.end(), {stage, kInside + stage - 1});
      cards.title += fmt::format("dug to {} m", levels[stage - 2]);
    }
    if (cards.title.size() > 2 && cards.title.substr(cards.title.size() - 2) == ", ")
      cards.title.resize(cards.title.size() - 2);
  }
  return deck;
}

WallForces wall_forces(const WallInGround& scene, const WholeRun& run) {
  WallForces f;
  f.outer_pressure.assign(scene.toe + 1, 0.0);
  const auto lifts = static_cast<int>(scene.levels.size());
  const std::size_t stage = run.model->stages.size();
  for (int k = 0; k <= lifts; ++k) {
    if (k > 0 && stage >= static_cast<std::size_t>(k + 1)) continue;  // dug
    each_pair(run, WallInGround::kInside + k, [&](const Vector2& at, const Vector2& on_lower) {
      f.inside += on_lower;  // the wall is the body on the right
      f.inside_moment -= at.y() * on_lower.x();
    });
  }
  each_pair(run, WallInGround::kOutside, [&](const Vector2& at, const Vector2& on_lower) {
    f.outside -= on_lower;
    f.outside_moment += at.y() * on_lower.x();
    const auto depth = static_cast<std::size_t>(std::lround(-at.y()));
    f.outer_pressure[depth] += on_lower.x() / (depth == 0 || at.y() < 1e-9 - scene.toe ? 0.5 : 1.0);
  });
  int group = WallInGround::kStruts;
  for (const WallInGround::Strut& strut : scene.struts) {
    const bool there = stage >= static_cast<std::size_t>(strut.born) &&
                       (strut.dies == 0 || stage < static_cast<std::size_t>(strut.dies));
    const double N = there ? run.stress[group_at(run, group)](0, 0) : 0.0;  // tension positive
    const double on_wall = strut.anchor ? N : scene.geometry == 2 ? -N / scene.half_width : -N;
    f.each.push_back(-N);
    f.struts += on_wall;
    f.struts_moment += strut.level * on_wall;
    ++group;
  }
  const PointStresses& wall = run.stress[group_at(run, WallInGround::kWall)];
  for (Eigen::Index p = 0; p < wall.cols(); ++p) {
    f.largest_moment = std::max(f.largest_moment, std::abs(wall(kMoment, p)));
    if (scene.geometry != 2) continue;
    const Eigen::Index element = p / 3,
                       part = p % 3;  // Simpson: an end, the middle, the other end, from the toe up
    const double weight[] = {1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0};
    const double place[] = {0.0, 0.5, 1.0};
    const double towards = wall(kHoopForce, p) / scene.half_width * weight[part];
    f.hoop -= towards;
    f.hoop_moment -= towards * (scene.toe - static_cast<double>(element) - place[part]);
  }
  f.top = run.u(scene.wall(0)).x();
  return f;
}

WallInGround braced_excavation(int geometry) {
  WallInGround scene;
  scene.geometry = geometry;
  scene.struts = {{1, 3, 0, 90.0}, {3, 4, 5}, {6, 5}};
  if (geometry == 2) scene.goes_around = false;
  if (geometry == 2) scene.struts = {{1, 3}, {3, 4, 5}, {6, 5}};
  return scene;
}

WallInGround cantilever_sheet_pile() {
  WallInGround scene;
  scene.half_width = 8.0;
  scene.levels = {1, 2, 3};
  scene.toe = 8;
  scene.cohesion = 1.0;
  scene.adhesion = 0.0;
  scene.wall_friction = 2.0;  // nearly smooth, but something must hold the wall up
  scene.thickness = 0.12;
  return scene;
}

WallInGround anchored_sheet_pile() {
  WallInGround scene = cantilever_sheet_pile();
  scene.levels = {2, 4, 6};
  scene.toe = 10;
  scene.struts = {{1, 3, 0, -150.0, true}};
  scene.spacing = 2.5;
  scene.strut_stiffness = 1e5;
  return scene;
}

// NOLINTNEXTLINE(readability-function-size): one kind of card after the other
DeckWriter Culvert::deck(int last_stage) const {
  DeckWriter deck(1);
  const int last = last_stage == 0 ? 1 + lifts : last_stage, raised = last - 1;
  const int solid = slipping ? kQuad8 : kQuad4;
  const int box = 4;  // half of its width
  deck.node(1, 1.0, -90.0, true);
  deck.node_row(1 + 7 * kAround, 7, 1.0, 90.0, 0.0, true);
  deck.node(7, 0.0, -box);
  deck.node_row(7 + 7 * 4, 7, box, -box);
  deck.node_row(7 + 7 * 12, 7, box, box);
  deck.node_row(7 + 7 * 16, 7, 0.0, box);
  deck.node(5001, 1.0, -90.0, true);
  deck.node_row(5001 + 7 * kAround, 7, 1.0, 90.0, 0.0, true);
  if (slipping)  // in the middle of the pipe's elements: chords would lock it, and it must be round to slip
    for (const int first : {8001, 9001}) {
      deck.node(first, 1.0, -84.375, true);
      deck.node_row(first + 7 * (kAround - 1), 7, 1.0, 84.375, 0.0, true);
    }
  const double right[] = {5.0, 6.5, 9.0, 12.0};
  for (int i = 1; i <= 4; ++i) {
    deck.node(1001 + i, right[i - 1], -box);
    deck.node_row(1001 + i + 56, 7, right[i - 1], box);
  }
  // Above the box numbers grow by 7 towards the axis, as those of its upper side do.
  for (int k = 1; k <= raised; ++k) {
    deck.node(2001 + 100 * k, box, box + k);
    deck.node_row(2001 + 100 * k + 28, 7, 0.0, box + k);
    for (int i = 1; i <= 4; ++i) deck.node(3001 + 100 * k + i, right[i - 1], box + k);
  }
  deck.fill(1, 6, 1, kAround, 7, 4.0);
  deck.material(1, kElastic, {E, nu}, weight, "fill");
  deck.material(2, kSection, {EA, EI}, 0.0, "pipe");
  deck.material(3, kGoodman, {slipping ? 1e-3 : 1e7, 1e7, 1.0}, 0.0, slipping ? "slipping" : "bonded");
  deck.group(1, solid, slipping ? 1 : 2, 1, "bedding and fill beside the pipe");
  deck.group(2, slipping ? kBeam3 : kBeam2, 1, 2, "pipe");
  deck.group(3, slipping ? kInterface6 : kInterface4, 1, 3, "pipe and fill");
  for (int k = 1; k <= raised; ++k) deck.group(3 + k, solid, slipping ? 1 : 2, 1, fmt::format("lift {}", k));
  Numbers numbers;
  if (slipping) {
    deck.elements_block(numbers(kAround), 1, {1, 2, 9, 8, 0, 0, 0, 8001}, 1, kAround, 1, 7);
    deck.elements_block(numbers(5 * kAround), 1, {2, 3, 10, 9}, 5, kAround, 1, 7);
    deck.elements_block(numbers(kAround), 2, {5001, 5008, 9001}, 1, kAround, 1, 7);
    deck.elements_block(numbers(kAround), 3, {1, 8, 5008, 5001, 8001, 9001}, 1, kAround, 1, 7);
  } else {
    deck.elements_block(numbers(6 * kAround), 1, {1, 2, 9, 8}, 6, kAround, 1, 7);
    deck.elements_block(numbers(kAround), 2, {5001, 5008}, 1, kAround, 1, 7);
    deck.elements_block(numbers(kAround), 3, {1, 8, 5008, 5001}, 1, kAround, 1, 7);
  }
  deck.elements_block(numbers(8), 1, {35, 1002, 1009, 42}, 1, 8, 1, 7);
  deck.elements_block(numbers(24), 1, {1002, 1003, 1010, 1009}, 3, 8, 1, 7);
  for (int k = 1; k <= raised; ++k) {
    const int above = 2001 + 100 * k, side = 3001 + 100 * k, group = 3 + k;
    const int below = k == 1 ? 91 : above - 100, beside = k == 1 ? 1057 : side - 100;
    deck.elements_block(numbers(4), group, {below + 7, below, above, above + 7}, 4, 1, 7, 1000);
    deck.element(numbers(1), group, {below, beside + 1, side + 1, above});
    deck.elements_block(numbers(3), group, {beside + 1, beside + 2, side + 2, side + 1}, 3, 1, 1, 1000);
  }
  deck.fix_row(7, 35, 7, 1, 1);
  deck.fix_row(1002, 1005, 1, 1, 1);
  deck.fix_row(1005, 1061, 7, 1, 0);
  deck.fix_row(1, 6, 1, 1, 0);
  deck.fix_row(113, 119, 1, 1, 0);
  for (const int n : {5001, 5001 + 7 * kAround}) {
    deck.fix(n, 1, 0);
    deck.fixities.push_back(rotation_held(n));
  }
  for (int k = 1; k <= raised; ++k) {
    deck.fix(2001 + 100 * k + 28, 1, 0);
    deck.fix(3001 + 100 * k + 4, 1, 0);
  }
  for (int stage = 1; stage <= last; ++stage) {
    StageCards& cards = deck.stage();
    cards.title = stage == 1 ? "Bedding and fill up to 3 m above the pipe" : fmt::format("Lift {}", stage - 1);
    if (stage == 1)
      cards.gravity_y = -1.0;
    else
      cards.births.push_back(2 + stage);
  }
  return deck;
}

CulvertForces culvert_forces(const WholeRun& run) {
  CulvertForces f;
  each_pair(run, 3, [&](const Vector2& at, const Vector2& on_ground) {
    if (at.y() > 1e-9) f.down += on_ground.y();
  });
  const auto g = static_cast<std::size_t>(group_at(run, 2));
  const Group& group = run.model->groups[g];
  const PointStresses& pipe = run.stress[g];
  const bool middle = group.node_count() == 3;
  const int points = group.element->traits().points;
  // N, Q and M at the first (-1) or last (1) node of an element: of two Gauss points, the line through them.
  const auto at_end = [&](int e, double xi) -> Eigen::Vector3d {
    const auto of = [&](int p) {
      const auto column = pipe.col(points * e + p);
      return Eigen::Vector3d(column[kAxialForce], column[kShearForce], column[kMoment]);
    };
    if (!middle) return of(xi < 0.0 ? 0 : points - 1);
    return 0.5 * (of(0) + of(1)) + 0.5 * xi * std::sqrt(3.0) * (of(1) - of(0));
  };
  const int beside = Culvert::kAround / 2;  // the first element above the horizontal axis
  const Eigen::Vector3d cut = at_end(beside, -1.0), crown = at_end(Culvert::kAround - 1, 1.0);
  Eigen::Matrix<double, 2, 3> x = Eigen::Matrix<double, 2, 3>::Zero();
  for (std::size_t k = 0; k < group.node_count(); ++k)
    x.col(static_cast<Eigen::Index>(k)) = run.model->mesh.x.col(group.nodes_of(beside)[k]);
  const Vector2 t = (x * line_slopes(middle, -1.0)).normalized();
  f.thrust_down = -(cut[0] * t.y() + cut[1] * t.x());
  f.springline = -cut[0];
  f.crown = -crown[0];
  f.moment = -crown[2];
  f.least = -pipe.row(kAxialForce).maxCoeff();
  f.most = -pipe.row(kAxialForce).minCoeff();
  return f;
}

DeckWriter TankOnSoil::deck() const {
  DeckWriter deck(2);
  const int s = stride(), above = 24;
  const double far = 25.0, water = 10.0;
  for (int j : {0, rows}) {
    const double y = j == 0 ? -far : 0.0;
    deck.node(1 + j * s, 0.0, y);
    deck.node(1 + j * s + columns, radius, y);
    deck.node(1 + j * s + 2 * columns, far, y);
  }
  deck.fill(1, columns, 1, rows, s, 0.25, 0.1);
  deck.fill(1 + columns, columns, 1, rows, s, 8.0, 0.1);
  deck.material(1, kElastic, {E_soil, nu_soil}, 0.0, "ground");
  deck.group(1, kQuad8, 1, 1, "ground");
  deck.elements_block(1, 1, {1, 2, 2 + s, 1 + s}, 2 * columns, rows, 1, s);
  deck.fix_row(1, s, 1, 1, 1);
  deck.fix_row(1, 1 + rows * s, s, 1, 0);
  deck.fix_row(s, s + rows * s, s, 1, 0);
  StageCards stage;
  stage.title = "Filled";
  if (!shell) {
    for (int i = 0; i < columns; ++i)
      stage.pressure(1 + 2 * columns * (rows - 1) + i, 3, water * height, water * height);
    deck.stages.push_back(stage);
    return deck;
  }
  for (int j = 1; j <= above; ++j) deck.node(wall_node(j + 1), radius, height * j / above);
  deck.material(2, kPlate, {3e7, 0.2, bottom}, 0.0, "bottom");
  deck.material(3, kPlate, {3e7, 0.2, wall}, 0.0, "wall");
  deck.group(2, kBeam3, 1, 2, "bottom");
  deck.group(3, kBeam3, 1, 3, "wall");
  // Towards the axis and down: pressure pushes to the left.
  const int bottoms = 2 * columns * rows + 1, walls = bottoms + columns;
  deck.elements_block(bottoms, 2, {surface(1), surface(0)}, columns, 1, 1, 1000);
  deck.element(walls, 3, {wall_node(2), surface(columns)});
  deck.elements_block(walls + 1, 3, {wall_node(3), wall_node(2)}, above - 1, 1, 1, 1000);
  for (int i = 0; i < columns; ++i) stage.pressure(bottoms + i, 1, water * height, water * height);
  for (int j = 0; j < above; ++j)
    stage.pressure(walls + j, 1, water * height * (above - j - 1) / above,
                   water * height * (above - j) / above);
  deck.stages.push_back(stage);
  return deck;
}

DeckWriter RaftOnGround::deck() const {
  DeckWriter deck(1);
  const int s = stride(), layers = static_cast<int>(moduli.size());
  const double far = 5.0;
  const auto row = [&](int first, double y) {
    deck.node(first, 0.0, y);
    deck.node(first + columns, 1.0, y);
    deck.node(first + columns + outside, far, y);
  };
  for (int k = 0; k <= layers; ++k)
    row(1 + rows * k / layers * s, far * (static_cast<double>(k) / layers - 1.0));
  for (int k = 0; k < layers; ++k) {
    const int first = 1 + rows * k / layers * s, n = rows / layers;
    const double grow = layers == 1 ? 0.05 : 1.0;
    deck.fill(first, columns, 1, n, s, 0.1, grow);
    deck.fill(first + columns, outside, 1, n, s, 20.0, grow);
    deck.material(1 + k, kElastic, {moduli[layers - 1 - k], nu}, 0.0,
                  fmt::format("layer {} from below", k + 1));
    deck.group(1 + k, kQuad8, 1, 1 + k, fmt::format("layer {} from below", k + 1));
    deck.elements_block(1 + rows * k / layers * (s - 1), 1 + k, {first, first + 1, first + 1 + s, first + s},
                        s - 1, n, 1, s);
  }
  const int raft = layers + 1, width = whole_width ? s - 1 : columns;
  deck.material(raft, kSection, {EA, EI}, 0.0, "raft");
  deck.group(raft, kBeam3, 1, raft, "raft");
  const int rafts = rows * (s - 1) + 1;  // towards the middle: pressure pushes to the left, down
  deck.elements_block(rafts, raft, {surface(1), surface(0)}, width, 1, 1, 1000);
  deck.fix_row(1, s, 1, 1, 1);
  deck.fix_row(1, surface(0), s, 1, 0);
  deck.fix_row(s, surface(s - 1), s, 1, 0);
  deck.fixities.push_back(rotation_held(surface(0)));
  if (whole_width) deck.fixities.push_back(rotation_held(surface(s - 1)));
  StageCards& stage = deck.stage();
  stage.title = "Loaded";
  for (int i = 0; i < width; ++i) stage.pressure(rafts + i, 1, load, load);
  return deck;
}

DeckWriter PipePile::deck() const {
  DeckWriter deck(2);
  const int s = stride(), tip = pile_rows;
  const double weight = 18.0, far = 8.0;
  const auto node = [&](int i, int at) { return 1 + (rows - at) * s + i; };
  deck.node(node(0, rows), 0.0, -rows);
  deck.node(node(2, rows), radius, -rows);
  deck.node(node(2 + columns, rows), far, -rows);
  deck.node(node(0, tip), 0.0, -tip);
  deck.node(node(2, 0), radius, 0.0);
  deck.node(node(2 + columns, 0), far, 0.0);
  deck.node(node(2, tip), radius, -tip);
  deck.fill(node(2, rows), columns, 1, rows, s, 20.0);
  deck.fill(node(0, rows), 2, 1, rows - tip, s);
  // The pile's: bottom from the axis, then up.
  deck.node(pile(tip) - 2, 0.0, -tip);
  deck.node_row(pile(tip), 1, radius, -tip);
  deck.node_row(pile(0), s, radius, 0.0);
  deck.material(1, kMohrCoulomb, {E, nu, strength, 0.0, 0.0}, weight, "clay");
  deck.material(2, kSection, {EA, EA * 1e-4 / 12.0, 0.4 * EA, EA, EA * 1e-4 / 12.0}, 0.0, "pipe");
  deck.material(3, kSection, {EA, 1e4, 0.4 * EA, EA, 1e4}, 0.0, "end plate");
  // k_s = 1e4 times the unit weight of water; tension as well, since the ground weighs nothing on its surface.
  deck.material(4, kCloughDuncan, {adhesion, 0.0, 1000.0, 0.0, 1e4, 0.0, 1e6, 1e6, 0.0}, 0.0, "shaft");
  deck.material(5, kGoodman, {1e6, 1e6, 1.0}, 0.0, "tip");
  deck.group(1, kQuad4, 2, 1, "clay");
  deck.group(2, kBeam2, 1, 2, "pipe");
  deck.group(3, kBeam2, 1, 3, "end plate");
  deck.group(4, kInterface4, 1, 4, "shaft");
  deck.group(5, kInterface4, 1, 5, "tip");
  Numbers numbers;
  int n = node(0, rows);
  deck.elements_block(numbers(2 * (rows - tip)), 1, {n, n + 1, n + 1 + s, n + s}, 2, rows - tip, 1, s);
  n = node(2, rows);
  deck.elements_block(numbers(columns * rows), 1, {n, n + 1, n + 1 + s, n + s}, columns, rows, 1, s);
  deck.elements_block(numbers(tip), 2, {pile(tip - 1), pile(tip)}, 1, tip, 1, s);
  n = pile(tip) - 2;
  deck.elements_block(numbers(2), 3, {n + 1, n}, 2, 1, 1, 1000);
  deck.elements_block(numbers(2), 5, {node(0, tip), node(1, tip), n + 1, n}, 2, 1, 1, 1000);
  deck.elements_block(numbers(tip), 4, {node(2, tip), node(2, tip - 1), pile(tip - 1), pile(tip)}, 1, tip, 1,
                      s);
  deck.fix_row(node(0, rows), node(2 + columns, rows), 1, 1, 1);
  deck.fix_row(node(0, rows), node(0, tip), s, 1, 0);
  deck.fix(n, 1, 0);
  deck.fix_row(node(2 + columns, rows), node(2 + columns, 0), s, 1, 0);
  deck.initial(1, 1, 0.0, weight, 1.0, 0.0);
  deck.initial(4, 3, 1);
  deck.initial(5, 3, 1);
  // The pile is hollow and weighs nothing: what the earth presses on it is let go in the first stage.
  StageCards& rest = deck.stage();
  rest.title = "At rest, with the pile in place";
  rest.gravity_y = -1.0;
  double before = 0.0;
  for (const double down : settlements) {
    StageCards& push = deck.stage(2);
    push.title = fmt::format("Pushed down by {:g}", down);
    push.max_iterations = 40;
    push.fix(pile(0), 0, 1, 0.0, before - down);
    before = down;
  }
  return deck;
}

PileForces pile_forces(const PipePile& pile, const WholeRun& run) {
  PileForces f;
  f.head = -run.reaction(pile.pile(0)).y();
  const double around = 2.0 * kPi * pile.radius;
  each_pair(run, 4, [&](const Vector2&, const Vector2& on_ground) { f.shaft -= around * on_ground.y(); });
  const auto g = static_cast<std::size_t>(group_at(run, 5));
  const double h = 0.5 * pile.radius;
  for (int e = 0; e < 2; ++e)
    for (int p = 0; p < 2; ++p)  // the integral of N r
      f.tip -= 2.0 * kPi * run.stress[g](1, 2 * e + p) * h * (3.0 * h * e + h * (1 + p)) / 6.0;
  return f;
}

std::string ShippedDeck::text() const {
  const std::string cards = deck.text();
  const std::size_t end = cards.find('\n') + 1;
  return cards.substr(0, end) + comments + cards.substr(end);
}

std::vector<ShippedDeck> structure_decks() {
  std::vector<ShippedDeck> decks;
  const auto add = [&](const std::string& name, const std::string& title, const std::string& comments,
                       DeckWriter deck) {
    deck.title = title;
    decks.push_back({name, "* Numbers and what stands behind them: README.md one folder up.\n" + comments,
                     std::move(deck)});
  };
  const std::string wall =
      "* Half of it; nodes 1 m apart along depth. Soil Mohr-Coulomb, wall beam2 with nodes of its own (6000 + "
      "soil's),\n"
      "* interfaces (law 23) on both faces; soil outside has nodes 5000 + soil's along the wall.\n";
  add("braced_cut", "Braced excavation, 12 m wide and 6 m deep, in five stages", wall,
      braced_excavation(1).deck());
  add("braced_shaft", "Round shaft of 6 m radius and 6 m depth with rings, in five stages", wall,
      braced_excavation(2).deck());
  add("sheet_pile", "Cantilever sheet pile, 3 m above and 5 m in the ground", wall,
      cantilever_sheet_pile().deck());
  add("anchored_sheet_pile", "Anchored sheet pile, 6 m above and 4 m in the ground", wall,
      anchored_sheet_pile().deck());
  Culvert pipe;
  const std::string culvert =
      "* Right half; pipe of 1 m radius. Nodes of the pipe: 5000 + those of the ground around it.\n";
  add("culvert_bonded", "Culvert under a fill in lifts, bonded", culvert, pipe.deck());
  pipe.slipping = true;
  add("culvert_slipping", "Culvert under a fill in lifts, slipping", culvert, pipe.deck());
  add("tank", "Circular tank of 5 m radius, filled with water, on soil",
      "* Bottom and wall beam3, ground quad8.\n", TankOnSoil().deck());
  RaftOnGround raft;
  raft.EI = 1e4;
  raft.moduli = {2e4, 1e4, 4e4, 8e4};
  raft.load = 50.0;
  add("raft", "Raft on four layers", "* Right half; the raft is 2 m wide and carries 50 kPa.\n", raft.deck());
  add("pile", "Closed pipe pile pushed into clay",
      "* Pipe and end plate beam2, shaft and tip interfaces. The pile's nodes: 6000 + those of the ground "
      "beside it.\n",
      PipePile().deck());
  return decks;
}

}  // namespace sage::scenes
