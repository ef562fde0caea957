#include "sage/bounds/model_domain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "sage/math/dense.hpp"
#include "sage/model/activity.hpp"
#include "sage/model/spread_loads.hpp"
#include "sage/model/water.hpp"

namespace sage::bounds {

namespace {

using Key = std::pair<int, int>;
Key key_of(int a, int b) {
  return {std::min(a, b), std::max(a, b)};
}

std::string named(const Group& group) {
  return group.name.empty() ? fmt::format("group {}", group.number)
                            : fmt::format("group {} {}", group.number, group.name);
}

// An edge of one solid alone, with all its nodes: corner, corner, others.
struct Side {
  std::vector<int> nodes;
  int group = 0, element = 0, local = 0;
};

class GroundMaker {
 public:
  GroundMaker(const Model& model, int first_live, int stage, const Eigen::VectorXd* unknowns, int room)
      : m_(model), first_live_(first_live), stage_(stage), activity_(model), unknowns_(unknowns) {
    for (int s = 0; s <= stage; ++s) activity_.enter(m_.stages[at(s)]);
    halves_ = room > 0 && wants_halves(room);
  }
  bool wants_halves(int room) const {
    int elements = 0;
    for (std::size_t g = 0; g < m_.groups.size(); ++g)
      if (is_ground(g)) elements += m_.groups[g].elements();
    return 4 * elements > 3 * room / 4;
  }
  bool wants_heads() const {
    for (std::size_t g = 0; g < m_.groups.size(); ++g) {
      const WaterCard* card = is_ground(g) ? water_card(m_, stage_, static_cast<int>(g)) : nullptr;
      if (card != nullptr && card->kind == WaterKind::heads) return true;
    }
    return false;
  }

  Ground make() {
    if (m_.stages[at(stage_)].strength_factor > 0.0)
      ground_.stated_factor = m_.stages[at(stage_)].strength_factor;
    check_groups();
    add_soils();
    add_triangles();
    add_joints();
    find_sides();
    check_hanging();
    add_supports();
    add_loads();
    add_water();
    for (auto& [key, boundary] : boundary_) ground_.domain.boundary.push_back(boundary);
    return std::move(ground_);
  }

 private:
  [[noreturn]] void reject(Code code, const SourcePosition& where, const std::string& message) const {
    throw InputError(code, where.file.empty() ? SourcePosition{m_.file, 0, 0, 0} : where, message);
  }
  bool active(std::size_t g) const { return activity_.group[g] != 0; }
  bool is_ground(std::size_t g) const { return active(g) && m_.groups[g].solid() && !m_.groups[g].overlay; }

  void check_groups() const {
    if (m_.combines_dofs())
      reject("S369", {}, "bounds know supports along x and y alone, without supports at an angle and ties");
    if (m_.geometry == Geometry::axisymmetric)
      reject("S570", {}, "bounds are for plane strain; this model is axisymmetric");
    if (m_.large_strain)
      reject("S553", {}, "large strain: bounds are of the mesh as it stands, and for small strain alone");
    for (std::size_t g = 0; g < m_.groups.size(); ++g) {
      const Group& group = m_.groups[g];
      if (!active(g) || group.flow() || group.overlay) continue;
      if (group.structure())
        reject("S571", group.where,
               fmt::format("{} ({}) is a structure: bounds know soil and interfaces only", named(group),
                           group.element_name));
      if (group.second_material >= 0)
        reject("S577", group.where,
               fmt::format(
                   "{} ({}) solves for the pressure of its pore water, which the load path decides; use an "
                   "element without it, and water cards or the undrained strength",
                   named(group), group.element_name));
      check_law(group);
    }
  }
  void check_law(const Group& group) const {
    const Material& material = m_.material_of(group);
    const auto no = [&](const std::string& why) {
      reject("S572", material.where,
             fmt::format("material {} ({}) of {} has no bounds: {}", material.number, material.law_name,
                         named(group), why));
    };
    if (group.solid()) {
      if (material.law_name != "mohr_coulomb" && material.law_name != "drucker_prager")
        no("they need mohr_coulomb or drucker_prager");
      if (!material.variants.empty()) no("its law differs by point or stage; they take one law for each group");
      if (material.saturated_unit_weight > 0.0)
        no("its weight changes at the phreatic line; give the soil below the line a material of its own");
      if (material.undrained) no("its undrained pore pressure is no given load; use the undrained strength");
      const double limit = material.parameter(ParameterRole::tension_limit).value_or(-1.0);
      const Strength s = strength_of(material).in_plane();
      if (s.friction > 89.9 * kRadiansPerDegree) no("its cone has no limit in plane strain");
      if (limit >= 0.0 && limit < s.cohesion / std::max(std::tan(s.friction), 1e-12) * (1.0 - 1e-9))
        no("they know no tension cut-off");
    } else if (!material.parameter(ParameterRole::strength) ||
               !material.parameter(ParameterRole::friction_angle)) {
      no("they need an interface with cohesion and friction angle");
    }
  }
  static Strength strength_of(const Material& material) {
    Strength s{material.parameter(ParameterRole::strength).value_or(0.0),
               material.parameter(ParameterRole::friction_angle).value_or(0.0) * kRadiansPerDegree};
    if (material.law_name == "drucker_prager") {
      const int cone = material.entry->find("cone");
      s.yield = cone >= 0 && at(cone) < material.parameters.size()
                    ? static_cast<Yield>(static_cast<int>(material.parameters[at(cone)]))
                    : Yield::cone_compression;
    }
    return s;
  }

  void add_soils() {
    Vector2 before = Vector2::Zero(), now = Vector2::Zero();
    for (int s = 0; s <= stage_; ++s) (s < first_live_ ? before : now) += m_.stages[at(s)].gravity;
    for (std::size_t g = 0; g < m_.groups.size(); ++g) {
      soil_of_.push_back(static_cast<int>(ground_.domain.soils.size()));
      if (!is_ground(g)) continue;
      const Group& group = m_.groups[g];
      const Material& material = m_.material_of(group);
      const double weight = weight_density(m_, group);
      ground_.domain.soils.push_back({strength_of(material), before * weight, now * weight});
      if (weight > 0.0 && !now.isZero(0.0)) ground_.has_live = true;
    }
    std::set<int> seen;
    for (std::size_t g = 0; g < m_.groups.size(); ++g)
      if (is_ground(g) && seen.insert(m_.groups[g].material).second) describe(m_.material_of(m_.groups[g]));
  }
  void describe(const Material& material) {
    const double phi = material.parameter(ParameterRole::friction_angle).value_or(0.0);
    ground_.soils.push_back(fmt::format("{} {} ({}): c {:.6g}, phi {:.6g}", material.number, material.name,
                                        material.law_name,
                                        material.parameter(ParameterRole::strength).value_or(0.0), phi));
    const auto psi = material.parameter(ParameterRole::dilation_angle);
    if (ground_.stated_factor != 1.0 && ground_.notes.empty())
      ground_.notes.push_back(
          fmt::format("the strengths of stage {} are divided by {:.6g} already; a factor of safety counts from "
                      "the deck's own",
                      m_.stages[at(stage_)].number, ground_.stated_factor));
    if (psi && *psi < phi)
      ground_.notes.push_back(
          fmt::format("material {}: the bounds have psi = phi = {:.6g}; the deck has psi = {:.6g}",
                      material.number, phi, *psi));
  }

  int node(int deck_node) {
    auto [place, made] = node_.try_emplace(deck_node, static_cast<int>(ground_.domain.x.size()));
    if (made) ground_.domain.x.emplace_back(m_.mesh.x.col(deck_node));
    return place->second;
  }

  void add_triangles() {
    for (std::size_t g = 0; g < m_.groups.size(); ++g) {
      if (!is_ground(g)) continue;
      const Group& group = m_.groups[g];
      for (int e = 0; e < group.elements(); ++e) {
        std::vector<int> corners;
        for (const std::vector<int>& edge : group.element->edges()) {
          const int corner = group.nodes_of(e)[edge[0]];
          if (corners.empty() || node(corner) != corners.back()) corners.push_back(node(corner));
        }
        divide(corners, soil_of_[g]);
        ground_.elements.push_back({static_cast<int>(g), e});
      }
    }
    if (ground_.domain.triangles.empty())
      reject("S574", {}, fmt::format("stage {} has no soil", m_.stages[at(stage_)].number));
  }
  // A quadrilateral becomes four triangles that meet where its diagonals cross, or two at its shorter diagonal.
  void divide(const std::vector<int>& corner, int soil) {
    Domain& d = ground_.domain;
    const int origin = static_cast<int>(ground_.elements.size());
    if (corner.size() == 3) {
      d.triangles.push_back({{corner[0], corner[1], corner[2]}, soil, origin});
      return;
    }
    const Vector2 a = d.x[at(corner[0])], b = d.x[at(corner[1])], p = d.x[at(corner[2])] - a,
                  q = d.x[at(corner[3])] - b, r = b - a;
    if (halves_ && convex(corner)) {
      const std::size_t i = p.squaredNorm() <= q.squaredNorm() ? 0 : 1;
      d.triangles.push_back({{corner[i], corner[i + 1], corner[(i + 2) % 4]}, soil, origin});
      d.triangles.push_back({{corner[i], corner[(i + 2) % 4], corner[(i + 3) % 4]}, soil, origin});
      return;
    }
    const double turn = p.x() * q.y() - p.y() * q.x();
    const double s = turn != 0.0 ? (r.x() * q.y() - r.y() * q.x()) / turn : 0.5;
    const int middle = static_cast<int>(d.x.size());
    d.x.emplace_back(a + s * p);
    for (std::size_t i = 0; i < 4; ++i)
      d.triangles.push_back({{corner[i], corner[(i + 1) % 4], middle}, soil, origin});
  }

  bool convex(const std::vector<int>& corner) const {
    const std::vector<Vector2>& x = ground_.domain.x;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vector2 a = x[at(corner[(i + 1) % 4])] - x[at(corner[i])],
                    b = x[at(corner[(i + 2) % 4])] - x[at(corner[(i + 1) % 4])];
      if (a.x() * b.y() - a.y() * b.x() <= 1e-6 * a.norm() * b.norm()) return false;
    }
    return true;
  }

  void add_joints() {
    for (std::size_t g = 0; g < m_.groups.size(); ++g) {
      const Group& group = m_.groups[g];
      if (!active(g) || !group.interface()) continue;
      const Material& material = m_.material_of(group);
      Joint joint;
      joint.strength = strength_of(material);
      joint.lower_cohesion = cohesion_before_opening(group, joint.strength);
      for (int e = 0; e < group.elements(); ++e) {
        const int* n = group.nodes_of(e);
        for (int k = 0; k < 4; ++k)
          if (!node_.contains(n[k]))
            reject(
                "S576", {m_.file, group.element_lines[at(e)], 0, 0},
                fmt::format("interface element {} of {} lies on no soil on one side; bounds need soil on both",
                            group.element_numbers[at(e)], named(group)));
        joint.first = {node_.at(n[0]), node_.at(n[1])};
        joint.second = {node_.at(n[3]), node_.at(n[2])};
        ground_.domain.joints.push_back(joint);
        jointed_.insert(key_of(n[0], n[1]));
        jointed_.insert(key_of(n[3], n[2]));
      }
    }
  }
  // An interface opens at its tensile strength, before adhesion is used up.
  double cohesion_before_opening(const Group& group, const Strength& strength) {
    const Material& material = m_.material_of(group);
    double tension = 0.0;
    const int place = material.entry->find("tensile_strength");
    if (place >= 0 && at(place) < material.parameters.size()) tension = material.parameters[at(place)];
    const double usable = std::min(strength.cohesion, tension * std::tan(strength.friction));
    if (usable < strength.cohesion)
      ground_.notes.push_back(fmt::format(
          "{}: it opens in tension; the lower bound counts on an adhesion of {:.6g} in place of {:.6g}",
          named(group), usable, strength.cohesion));
    return usable;
  }

  void find_sides() {
    std::map<Key, int> count;
    for (int pass = 0; pass < 2; ++pass)
      for (std::size_t g = 0; g < m_.groups.size(); ++g) {
        if (!is_ground(g)) continue;
        const Group& group = m_.groups[g];
        const auto& edges = group.element->edges();
        for (int e = 0; e < group.elements(); ++e)
          for (std::size_t k = 0; k < edges.size(); ++k) {
            Side side{{}, static_cast<int>(g), e, static_cast<int>(k)};
            for (const int local : edges[k]) side.nodes.push_back(group.nodes_of(e)[local]);
            if (side.nodes[0] == side.nodes[1]) continue;
            const Key key = key_of(side.nodes[0], side.nodes[1]);
            if (pass == 0)
              ++count[key];
            else if (count[key] == 1 && !jointed_.contains(key))
              sides_.push_back(std::move(side));
          }
      }
  }
  // A node inside another element's side would be a crack to the bounds.
  void check_hanging() const {
    std::set<int> nodes;
    for (const Side& side : sides_) nodes.insert(side.nodes.begin(), side.nodes.begin() + 2);
    std::vector<std::pair<double, int>> by_x;
    for (const int n : nodes) by_x.emplace_back(m_.mesh.x(0, n), n);
    std::ranges::sort(by_x);
    for (const Side& side : sides_) {
      const Vector2 a = m_.mesh.x.col(side.nodes[0]), d = m_.mesh.x.col(side.nodes[1]) - a;
      const double length = d.norm(), low = std::min(a.x(), a.x() + d.x()) - 1e-6 * length,
                   high = std::max(a.x(), a.x() + d.x()) + 1e-6 * length;
      for (auto place = std::ranges::lower_bound(by_x, std::pair{low, -1});
           place != by_x.end() && place->first <= high; ++place) {
        const Vector2 r = m_.mesh.x.col(place->second) - a;
        const double along = r.dot(d) / length, off = std::abs(r.x() * d.y() - r.y() * d.x()) / length;
        if (off < 1e-6 * length && along > 1e-6 * length && along < (1.0 - 1e-6) * length)
          reject("S576", {},
                 fmt::format("node {} lies within the side between nodes {} and {}: bounds need a mesh "
                             "without hanging nodes",
                             m_.mesh.number[at(place->second)], m_.mesh.number[at(side.nodes[0])],
                             m_.mesh.number[at(side.nodes[1])]));
      }
    }
  }

  Boundary& boundary(const Side& side) {
    Boundary& one = boundary_[key_of(side.nodes[0], side.nodes[1])];
    one.a = node_.at(side.nodes[0]);
    one.b = node_.at(side.nodes[1]);
    return one;
  }

  // A side is supported where all its nodes are.
  void add_supports() {
    std::map<std::pair<int, int>, double> motion;
    for (int s = first_live_; s <= stage_; ++s)
      for (const Fixity& f : m_.stages[at(s)].fixities)
        for (int c = 0; c < 2; ++c)
          if (f.code[at(c)] == FixityCode::fixed && f.value[at(c)] != 0.0)
            motion[{f.node, c}] += f.value[at(c)];
    const std::size_t moves = motion.size();
    std::set<std::pair<int, int>> used;
    for (const Side& side : sides_)
      for (int c = 0; c < 2; ++c) {
        if (!std::ranges::all_of(side.nodes, [&](int n) { return activity_.holds(n, c); })) continue;
        Boundary& one = boundary(side);
        one.held[at(c)] = true;
        for (std::size_t i = 0; i < 2; ++i) {
          const auto found = motion.find({side.nodes[i], c});
          if (found != motion.end()) one.motion[i][c] = found->second;
        }
        for (const int n : side.nodes) used.insert({n, c});
      }
    for (const auto& [place, value] : motion)
      if (!used.contains(place))
        reject("S573", {},
               fmt::format("node {} alone is moved: bounds need whole sides of elements that move",
                           m_.mesh.number[at(place.first)]));
    if (moves > 0) ground_.has_live = true;
  }

  void add_loads() {
    for (int s = 0; s <= stage_; ++s) {
      const Stage& stage = m_.stages[at(s)];
      const bool live = s >= first_live_;
      for (EdgeLoad load : stage.pressures) {
        const double share = share_of(load, 1.0, stage.duration);
        load.normal *= share;
        load.shear *= share;
        add_pressure(load, live);
      }
      std::map<int, Vector2> forces;
      for (const NodalLoad& load : stage.loads)
        if (!load.force.isZero(0.0))
          forces.try_emplace(load.node, Vector2::Zero()).first->second +=
              share_of(load, 1.0, stage.duration) * load.force;
      if (!forces.empty()) add_forces(forces, live, stage);
      if (live && (!stage.pressures.empty() || !forces.empty())) ground_.has_live = true;
    }
  }
  void add_pressure(const EdgeLoad& load, bool live) {
    const Group& group = m_.groups[at(load.group)];
    if (!active(at(load.group))) return;
    const auto side = std::ranges::find_if(sides_, [&](const Side& s) {
      return s.group == load.group && s.element == load.element && s.local == load.edge;
    });
    if (side == sides_.end())
      reject(
          "S573", {m_.file, load.line, 0, 0},
          fmt::format("the pressure on element {} of {} acts within the soil: bounds need loads on free sides",
                      group.element_numbers[at(load.element)], named(group)));
    Boundary& one = boundary(*side);
    const Vector2 along = (m_.mesh.x.col(side->nodes[1]) - m_.mesh.x.col(side->nodes[0])).normalized();
    const Vector2 into(-along.y(), along.x());
    for (std::size_t i = 0; i < 2; ++i) {
      const auto end = static_cast<Eigen::Index>(i);
      (live ? one.live : one.fixed)[i] += load.normal[end] * into + load.shear[end] * along;
    }
  }

  // Forces on nodes become tractions that are linear along the sides: equal ones where they fit, else with one value
  // at each corner.
  void add_forces(const std::map<int, Vector2>& forces, bool live, const Stage& stage) {
    std::vector<const Side*> loaded;
    for (const Side& side : sides_)
      if (std::ranges::all_of(side.nodes, [&](int n) { return forces.contains(n); })) loaded.push_back(&side);
    if (!fit_tractions(forces, loaded, live, true) && !fit_tractions(forces, loaded, live, false)) {
      const auto first =
          std::ranges::find_if(stage.loads, [](const NodalLoad& l) { return !l.force.isZero(0.0); });
      reject(
          "S573", {m_.file, first->line, 0, 0},
          fmt::format("the forces on nodes of stage {} are no traction along sides: a force at a point has no "
                      "bounds, the ground yields below it at once",
                      stage.number));
    }
  }
  bool fit_tractions(const std::map<int, Vector2>& forces, const std::vector<const Side*>& loaded, bool live,
                     bool constant) {
    std::map<int, int> row, column;
    for (const auto& [n, force] : forces) row.try_emplace(n, static_cast<int>(row.size()));
    const auto unknown = [&](std::size_t i, std::size_t end) {
      return constant
                 ? static_cast<int>(i)
                 : column.try_emplace(loaded[i]->nodes[end], static_cast<int>(column.size())).first->second;
    };
    for (std::size_t i = 0; i < loaded.size(); ++i)
      for (std::size_t end = 0; end < 2; ++end) (void)unknown(i, end);
    const auto columns = static_cast<Eigen::Index>(constant ? loaded.size() : column.size());
    if (columns == 0 || columns > 2000) return false;
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(row.size()), columns);
    for (std::size_t i = 0; i < loaded.size(); ++i)
      add_side_columns(
          *loaded[i], row, [&](std::size_t end) { return unknown(i, end); }, A);
    Eigen::MatrixXd F(A.rows(), 2);
    for (const auto& [n, force] : forces) F.row(row.at(n)) = force.transpose();
    const Eigen::MatrixXd t = dense_matrix::smallest_solutions(A, F);
    if ((A * t - F).cwiseAbs().maxCoeff() > 1e-4 * F.cwiseAbs().maxCoeff()) return false;
    for (std::size_t i = 0; i < loaded.size(); ++i) {
      Boundary& one = boundary(*loaded[i]);
      for (std::size_t end = 0; end < 2; ++end)
        (live ? one.live : one.fixed)[end] += t.row(unknown(i, end)).transpose();
    }
    return true;
  }
  // What tractions at both ends of a side put on its nodes: of two or three.
  template <class Unknown>
  void add_side_columns(const Side& side, const std::map<int, int>& row, const Unknown& unknown,
                        Eigen::MatrixXd& A) const {
    const double length = (m_.mesh.x.col(side.nodes[1]) - m_.mesh.x.col(side.nodes[0])).norm();
    const bool three = side.nodes.size() == 3;
    for (std::size_t end = 0; end < 2; ++end) {
      const int c = unknown(end);
      A(row.at(side.nodes[end]), c) += length / (three ? 6.0 : 3.0);
      if (three)
        A(row.at(side.nodes[2]), c) += length / 3.0;
      else
        A(row.at(side.nodes[1 - end]), c) += length / 6.0;
    }
  }

  void add_water() {
    if (unknowns_ == nullptr && wants_heads())
      reject("S577", {},
             "pore pressures from the heads of flow elements need the heads at the start of the stage");
    std::vector<char> groups(m_.groups.size(), 0);
    for (std::size_t g = 0; g < groups.size(); ++g) groups[g] = activity_.group[g];
    auto water = std::make_shared<PorePressure>(m_, stage_, groups, activity_.dof_map, unknowns_);
    bool any = false;
    for (std::size_t g = 0; g < m_.groups.size(); ++g) {
      const WaterCard* card = is_ground(g) ? water->card(g) : nullptr;
      if (card == nullptr) continue;
      if (card->kind == WaterKind::drawdown && card->value < 1.0)
        reject("S577", card->where,
               "bounds know no rapid drawdown with B-bar below 1: the ground's pressure at free edges is not "
               "that of the water there");
      any = true;
    }
    if (!any) return;
    for (const Side& side : sides_) {
      const WaterCard* card = water->card(at(side.group));
      if (card != nullptr && card->action == WaterAction::none) boundary(side).water = false;
    }
    // At corners of the deck's elements from the cards; linear between, in the triangles of the first mesh.
    auto elements = ground_.elements;
    auto mesh = std::make_shared<std::vector<Corners>>();
    for (const auto& [g, e] : elements) mesh->push_back(corners_of(m_.groups[at(g)], e, *water, at(g)));
    const Model* model = &m_;
    ground_.domain.pore_pressure = [water, mesh, elements, model](const Triangle& t, const Vector2& x) {
      const auto [g, e] = elements[at(t.origin)];
      const WaterCard* card = water->card(at(g));
      if (card == nullptr) return 0.0;
      if (card->by_place())
        return water->at(at(g), e, x, std::vector<double>(model->groups[at(g)].node_count(), 0.0));
      return interpolated((*mesh)[at(t.origin)], x);
    };
  }
  struct Corner {
    Vector2 x = Vector2::Zero();
    double u = 0.0;
  };
  using Corners = std::vector<Corner>;
  Corners corners_of(const Group& group, int e, const PorePressure& water, std::size_t g) const {
    Corners corners;
    for (const std::vector<int>& edge : group.element->edges()) {
      std::vector<double> N(group.node_count(), 0.0);
      N[at(edge[0])] = 1.0;
      const Vector2 x = m_.mesh.x.col(group.nodes_of(e)[edge[0]]);
      corners.push_back({x, water.card(g) == nullptr ? 0.0 : water.at(g, e, x, N)});
    }
    return corners;
  }
  // Linear in the triangles that divide() makes; the mean of the corners where they meet.
  static double interpolated(const Corners& corner, const Vector2& x) {
    std::vector<std::array<Corner, 3>> triangles;
    if (corner.size() == 3) {
      triangles.push_back({corner[0], corner[1], corner[2]});
    } else {
      const Vector2 a = corner[0].x, p = corner[2].x - a, q = corner[3].x - corner[1].x, r = corner[1].x - a;
      const double turn = p.x() * q.y() - p.y() * q.x();
      const double s = turn != 0.0 ? (r.x() * q.y() - r.y() * q.x()) / turn : 0.5;
      const Corner middle{a + s * p, 0.25 * (corner[0].u + corner[1].u + corner[2].u + corner[3].u)};
      for (std::size_t i = 0; i < 4; ++i) triangles.push_back({corner[i], corner[(i + 1) % 4], middle});
    }
    double best = -1e300, value = 0.0;
    for (const auto& t : triangles) {
      const Vector2 d1 = t[1].x - t[0].x, d2 = t[2].x - t[0].x, r = x - t[0].x;
      const double twice = d1.x() * d2.y() - d1.y() * d2.x();
      if (!(std::abs(twice) > 0.0)) continue;
      const double b = (r.x() * d2.y() - r.y() * d2.x()) / twice, c = (d1.x() * r.y() - d1.y() * r.x()) / twice;
      const double least = std::min({1.0 - b - c, b, c});
      if (least <= best) continue;
      best = least;
      value = (1.0 - b - c) * t[0].u + b * t[1].u + c * t[2].u;
    }
    return std::max(0.0, value);
  }

  const Model& m_;
  int first_live_, stage_;
  Activity activity_;
  const Eigen::VectorXd* unknowns_;
  bool halves_ = false;
  Ground ground_;
  std::vector<int> soil_of_;
  std::map<int, int> node_;
  std::set<Key> jointed_;
  std::vector<Side> sides_;
  std::map<Key, Boundary> boundary_;
};

}  // namespace

Ground make_ground(const Model& model, int first_live, int stage, const Eigen::VectorXd* unknowns, int room) {
  return GroundMaker(model, first_live, stage, unknowns, room).make();
}

bool wants_heads(const Model& model, int stage) {
  return GroundMaker(model, stage, stage, nullptr, 0).wants_heads();
}

}  // namespace sage::bounds
