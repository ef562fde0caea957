// The coarsest mesh of quadrilaterals that means the same as the deck's.  Its lines of edges run on from
// element to element; those are kept that pass a node which something hangs on (a corner of the outline, of a
// group or of the mesh's pattern, a load, the end of a support, a reported node), all others are left out, and
// what lies between the kept ones becomes one element.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "sage/mesh/subdivide.hpp"

namespace sage::mesh {

namespace {

constexpr double kStraight = 1e-9;  // of the lengths: what is left out must not change the shape

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

struct Cell {
  int group = 0, element = 0;
  std::array<int, 4> corner{};
};

struct Line {  // an edge between two corners
  int a = 0, z = 0;
  int middle = -1;  // a node that a card gives between them
  bool middle_stays = false;
  std::vector<std::pair<int, int>> cells;  // cell, side
  int solids = 0;
  bool frontier = false;  // of the outline or of a group: it can't be left out
  bool outer = false;     // fixities, pressures and reports are inherited along it
  bool kept = false;
};

// A fixity list, or membership in a report, as codes and values of a node.
struct Mark {
  std::array<FixityCode, 2> code{};
  std::array<double, 2> value{};
};
using Marks = std::map<int, Mark>;  // nodes that are not there have none

// Pressure and shear in a stage at the ends of a side, in the order of the side.
using SideLoad = std::array<Vector2, 2>;

// Corners and sides of what becomes one element; each side with all nodes from corner to corner.
struct Block {
  std::vector<int> cells;
  std::array<std::vector<int>, 4> side;
};

class Coarsening {
 public:
  explicit Coarsening(Work& b) : b_(&b), model_(&b.model) {}
  // False: the mesh stays as it is.
  bool run();

 private:
  bool collect();
  bool add_cell(std::size_t g, int e);
  Mark mark_of(const Marks& marks, int node) const;
  void find_marks();
  void find_loads();
  void require_by_pattern();
  void require_by_model();
  bool moves_as_one(const Report& report, std::size_t c) const;
  void require_report(const Report& report);
  void require_middle(Line& line);
  void require_cells(const Line& line);
  void require_by_frontier(int before, int node, int after, int line_before, int line_after);
  bool loads_run_on(int line_before, int node, int line_after) const;
  void keep_lines();
  bool make_blocks();
  bool walk(Block& block) const;
  bool faults_in(const Block& block);
  bool faults_in_side(const std::vector<int>& side);
  bool split_long(const Block& block);
  bool well_shaped(const Block& block) const;
  std::vector<int> nodes_of(const Block& block) const;
  void rebuild();
  void carry_loads(std::size_t stage);
  void drop_nodes(std::vector<char> gone);

  Vector2 x(int node) const { return model_->mesh.x.col(node); }
  Line& line(int a, int z) { return lines_[at(index_.at(edge_key(a, z)))]; }
  const Line& line(int a, int z) const { return lines_[at(index_.at(edge_key(a, z)))]; }
  bool require(int node) { return std::exchange(required_[at(node)], 1) == 0; }

  Work* b_;
  Model* model_;
  std::vector<Cell> cells_;
  std::vector<Line> lines_;
  std::map<EdgeKey, int> index_;
  std::vector<std::vector<int>> lines_of_, cells_of_;  // by node
  std::vector<char> required_;
  std::vector<Marks> marks_;
  std::vector<std::map<std::pair<int, int>, SideLoad>> loads_;  // by stage; cell, side
  std::vector<Block> blocks_;
};

Mark Coarsening::mark_of(const Marks& marks, int node) const {
  const auto it = marks.find(node);
  return it == marks.end() ? Mark{} : it->second;
}

// False where three elements share an edge or two corners are one node.
bool Coarsening::add_cell(std::size_t g, int e) {
  const Group& group = model_->groups[g];
  const int* nodes = group.nodes_of(e);
  const Cell cell{static_cast<int>(g), e, {nodes[0], nodes[1], nodes[2], nodes[3]}};
  const int c = static_cast<int>(cells_.size());
  for (int k = 0; k < 4; ++k) {
    const int a = cell.corner[at(k)], z = cell.corner[at((k + 1) % 4)];
    if (a == z) return false;
    cells_of_[at(a)].push_back(c);
    const auto [it, is_new] = index_.try_emplace(edge_key(a, z), static_cast<int>(lines_.size()));
    if (is_new) {
      lines_of_[at(a)].push_back(it->second);
      lines_of_[at(z)].push_back(it->second);
      lines_.emplace_back().a = a;
      lines_.back().z = z;
    }
    Line& on = lines_[at(it->second)];
    on.cells.emplace_back(c, k);
    on.solids += group.interface() ? 0 : 1;
    if (on.cells.size() > 2) return false;
  }
  for (const auto& edge : group.element->edges())
    if (const int m = middle_of(edge); m >= 0 && nodes[m] >= 0)
      line(nodes[edge[0]], nodes[edge[1]]).middle = nodes[m];
  cells_.push_back(cell);
  return true;
}

// False where an element is no quadrilateral that its sides determine.
bool Coarsening::collect() {
  const auto nodes = at(model_->mesh.nodes());
  lines_of_.resize(nodes);
  cells_of_.resize(nodes);
  required_.assign(nodes, 0);
  for (std::size_t g = 0; g < model_->groups.size(); ++g) {
    const Group& group = model_->groups[g];
    if (group.elements() == 0) continue;
    if (!group.entry->square()) return false;
    std::vector<char> known(group.node_count(), 0);
    std::fill_n(known.begin(), 4, 1);
    for (const auto& edge : group.element->edges())
      if (middle_of(edge) >= 0) known[at(middle_of(edge))] = 1;
    for (int e = 0; e < group.elements(); ++e) {
      for (std::size_t i = 0; i < known.size(); ++i)
        if (!known[i] && group.nodes_of(e)[i] >= 0) return false;
      if (!add_cell(g, e)) return false;
    }
  }
  for (Line& l : lines_) {
    l.frontier =
        l.cells.size() == 1 || cells_[at(l.cells[0].first)].group != cells_[at(l.cells[1].first)].group;
    l.outer = l.solids <= 1;
  }
  return !cells_.empty();
}

void Coarsening::find_marks() {
  const auto add = [&](const std::vector<Fixity>& fixities) {
    Marks marks;
    for (const Fixity& f : fixities)
      for (std::size_t c = 0; c < 2; ++c)
        if (f.code[c] != FixityCode::unchanged) {
          marks[f.node].code[c] = f.code[c];
          marks[f.node].value[c] = f.value[c];
        }
    marks_.push_back(std::move(marks));
  };
  add(model_->fixities);
  for (const Stage& stage : model_->stages) add(stage.fixities);
  for (const Report& report : model_->reports) {
    Marks marks;
    for (int node : report.nodes) marks[node].code = {FixityCode::fixed, FixityCode::unchanged};
    marks_.push_back(std::move(marks));
  }
}

void Coarsening::find_loads() {
  if (model_->combines_dofs())
    throw InputError("S369", {model_->file, 0, 0, 0},
                     "--coarsen can't merge edges with supports at an angle or ties");
  std::map<std::pair<int, int>, int> cell_of;
  for (std::size_t c = 0; c < cells_.size(); ++c)
    cell_of[{cells_[c].group, cells_[c].element}] = static_cast<int>(c);
  for (const Stage& stage : model_->stages) {
    if (stage.has_mechanical_histories())
      throw InputError("S591", stage.where, "--coarsen cannot merge loads or supports with tables of time");
    auto& loads = loads_.emplace_back();
    for (const EdgeLoad& p : stage.pressures) {
      const int c = cell_of.at({p.group, p.element});
      const Group& group = model_->groups[at(p.group)];
      const auto& edge = group.element->edges()[at(p.edge)];
      const int* nodes = group.nodes_of(p.element);
      const Line& on = line(nodes[edge[0]], nodes[edge[1]]);
      int side = -1;
      for (const auto& [cell, k] : on.cells)
        if (cell == c) side = k;
      const bool forward = cells_[at(c)].corner[at(side)] == nodes[edge[0]];
      auto [it, is_new] = loads.try_emplace({c, side}, SideLoad{Vector2::Zero(), Vector2::Zero()});
      const Vector2 first(p.normal.x(), p.shear.x()), second(p.normal.y(), p.shear.y());
      it->second[0] += forward ? first : second;
      it->second[1] += forward ? second : first;
      if (on.outer) continue;
      require(on.a);
      require(on.z);
    }
  }
}

// Nodes where the mesh is no grid.
void Coarsening::require_by_pattern() {
  for (int node = 0; node < model_->mesh.nodes(); ++node) {
    const std::size_t cells = cells_of_[at(node)].size(), lines = lines_of_[at(node)].size();
    if (cells == 0) continue;
    const bool inside = cells == 4 && lines == 4, side = cells == 2 && lines == 3;
    if (!inside && !side) require(node);
  }
}

bool Coarsening::loads_run_on(int line_before, int node, int line_after) const {
  const auto load_on = [&](const auto& loads, const Line& on, int from) -> std::optional<SideLoad> {
    for (const auto& [cell, side] : on.cells)
      if (const auto it = loads.find({cell, side}); it != loads.end())
        return cells_[at(cell)].corner[at(side)] == from ? it->second : SideLoad{it->second[1], it->second[0]};
    return {};
  };
  const Line &in = lines_[at(line_before)], &out = lines_[at(line_after)];
  const int before = in.a == node ? in.z : in.a, after = out.a == node ? out.z : out.a;
  const double l1 = (x(node) - x(before)).norm(), l2 = (x(after) - x(node)).norm();
  for (const auto& loads : loads_) {
    const auto first = load_on(loads, in, before), second = load_on(loads, out, node);
    if (!first && !second) continue;
    if (!first || !second) return false;
    const double size = (*first)[0].norm() + (*first)[1].norm() + (*second)[1].norm();
    const Vector2 linear = (l2 * (*first)[0] + l1 * (*second)[1]) / (l1 + l2);
    if (((*first)[1] - (*second)[0]).norm() > kStraight * size ||
        (linear - (*first)[1]).norm() > kStraight * size)
      return false;
  }
  return true;
}

// A node on the outline or on a border of groups can go where its neighbours' line passes it and everything
// that hangs on it is what a new node between them would get.
void Coarsening::require_by_frontier(int before, int node, int after, int line_before, int line_after) {
  const Vector2 in = x(node) - x(before), out = x(after) - x(node);
  const double l1 = in.norm(), l2 = out.norm();
  if (std::abs(in.x() * out.y() - in.y() * out.x()) > kStraight * l1 * l2 || in.dot(out) <= 0.0) {
    require(node);
    return;
  }
  if (!lines_[at(line_before)].outer || !lines_[at(line_after)].outer) return;
  for (const Marks& marks : marks_) {
    const Mark p = mark_of(marks, before), v = mark_of(marks, node), n = mark_of(marks, after);
    for (std::size_t c = 0; c < 2; ++c) {
      if (v.code[c] == p.code[c] && v.code[c] == n.code[c]) {
        const double linear = (l2 * p.value[c] + l1 * n.value[c]) / (l1 + l2);
        const double size = std::max(std::abs(p.value[c]), std::abs(n.value[c]));
        if (std::abs(v.value[c] - linear) > kStraight * size) require(node);
      } else if (v.code[c] != FixityCode::unchanged || p.code[c] == n.code[c]) {
        require(node);
      }
    }
  }
  if (!loads_run_on(line_before, node, line_after)) require(node);
}

// Held in a direction when the report begins, and moved alike from then on.
bool Coarsening::moves_as_one(const Report& report, std::size_t c) const {
  const std::size_t begin = at(report.stage) + 1;  // list 0 comes before the stages
  const Mark first = mark_of(marks_[begin], report.nodes.front());
  for (int node : report.nodes) {
    FixityCode code = FixityCode::unchanged;
    for (std::size_t list = 0; list <= begin; ++list)
      if (const FixityCode now = mark_of(marks_[list], node).code[c]; now != FixityCode::unchanged) code = now;
    if (code != FixityCode::fixed || mark_of(marks_[begin], node).value[c] != first.value[c]) return false;
    for (std::size_t list = begin + 1; list <= model_->stages.size(); ++list) {
      const Mark mark = mark_of(marks_[list], node), its = mark_of(marks_[list], report.nodes.front());
      if (mark.code[c] == FixityCode::released || mark.value[c] != its.value[c]) return false;
    }
  }
  return true;
}

// A mean displacement is that of the nodes which the deck lists: they stay, unless
// supports move all of them alike.
void Coarsening::require_report(const Report& report) {
  if (report.nodes.empty()) return;
  const bool line = report.kind == ReportKind::discharge || report.kind == ReportKind::uplift;
  bool alike = !line && moves_as_one(report, 1);
  if (report.kind != ReportKind::triaxial) alike = alike && moves_as_one(report, 0);
  if (alike) return;
  for (int node : report.nodes) require(node);
}

void Coarsening::require_cells(const Line& on) {
  for (const auto& mine : on.cells)
    for (int node : cells_[at(mine.first)].corner) require(node);
}

// The elements of a line stay whole where its middle node makes it a curve or has more hanging on it than a new
// node would get.
void Coarsening::require_middle(Line& on) {
  if (on.middle < 0) return;
  const Vector2 a = x(on.a), z = x(on.z);
  bool& stays = on.middle_stays;
  stays = required_[at(on.middle)] != 0 || (x(on.middle) - 0.5 * (a + z)).norm() > kStraight * (z - a).norm();
  for (const Marks& marks : marks_) {
    const Mark p = mark_of(marks, on.a), v = mark_of(marks, on.middle), n = mark_of(marks, on.z);
    for (std::size_t c = 0; c < 2; ++c) {
      const bool inherits = on.outer && p.code[c] == n.code[c];
      stays = stays || v.code[c] != (inherits ? p.code[c] : FixityCode::unchanged);
      if (inherits)
        stays =
            stays || std::abs(v.value[c] - 0.5 * (p.value[c] + n.value[c])) > kStraight * std::abs(p.value[c]);
    }
  }
  if (stays) require_cells(on);
}

void Coarsening::require_by_model() {
  for (const Stage& stage : model_->stages)
    for (const NodalLoad& load : stage.loads) require(load.node);
  for (const Stage& stage : model_->stages)
    for (const int node : {stage.control.node, stage.control.other})
      if (node >= 0) require(node);
  // Of other fields than displacement no node is dropped that has a card.
  for (const FieldFixity& f : model_->field_fixities) require(f.node);
  for (const Stage& stage : model_->stages) {
    for (const FieldFixity& f : stage.field_fixities) require(f.node);
    for (const Exit& exit : stage.exits) require(exit.node);
    for (const FieldLoad& load : stage.field_loads) require(load.node);
  }
  for (const Grading& grading : b_->meshing.gradings)
    if (const int* node = b_->node_index.find(grading.node)) require(*node);
  for (const Report& report : model_->reports) require_report(report);
  for (Line& on : lines_) require_middle(on);
  for (int node = 0; node < model_->mesh.nodes(); ++node) {
    std::vector<int> frontier;
    bool outer = false;
    for (int l : lines_of_[at(node)])
      if (lines_[at(l)].frontier) {
        frontier.push_back(l);
        outer = outer || lines_[at(l)].outer;
      }
    if (!outer)
      for (const Marks& marks : marks_)
        if (marks.count(node) != 0) require(node);
    if (frontier.empty() || required_[at(node)] != 0) continue;
    const auto other = [&](int l) { return lines_[at(l)].a == node ? lines_[at(l)].z : lines_[at(l)].a; };
    if (frontier.size() == 2)
      require_by_frontier(other(frontier[0]), node, other(frontier[1]), frontier[0], frontier[1]);
    else
      require(node);
  }
}

// From required nodes along the lines of the mesh, through every node of a grid, to the outline or the next
// node that is required.
void Coarsening::keep_lines() {
  std::vector<int> open;
  const auto keep = [&](int l) {
    if (std::exchange(lines_[at(l)].kept, true)) return;
    open.push_back(l);
  };
  for (std::size_t l = 0; l < lines_.size(); ++l)
    if (lines_[l].frontier) keep(static_cast<int>(l));
  for (int node = 0; node < model_->mesh.nodes(); ++node)
    if (required_[at(node)] != 0)
      for (int l : lines_of_[at(node)]) keep(l);
  while (!open.empty()) {
    const int l = open.back();
    open.pop_back();
    for (int node : {lines_[at(l)].a, lines_[at(l)].z}) {
      if (cells_of_[at(node)].size() != 4) continue;  // the outline, or all lines are kept
      for (int other : lines_of_[at(node)]) {
        bool touches = false;
        for (const auto& mine : lines_[at(l)].cells)
          for (const auto& its : lines_[at(other)].cells) touches = touches || mine.first == its.first;
        if (!touches) keep(other);
      }
    }
  }
}

// Its four corners and sides, counter-clockwise from the first corner of an element; false where it has others.
bool Coarsening::walk(Block& block) const {
  std::map<int, int> cells_at, next, local;
  const std::set<int> inside(block.cells.begin(), block.cells.end());
  for (int c : block.cells)
    for (int k = 0; k < 4; ++k) {
      const int a = cells_[at(c)].corner[at(k)], z = cells_[at(c)].corner[at((k + 1) % 4)];
      ++cells_at[a];
      local[a] = k;
      if (!line(a, z).kept) continue;
      if (!next.try_emplace(a, z).second) return false;
    }
  std::vector<int> corners;
  for (const auto& [node, count] : cells_at)
    if (count == 1) corners.push_back(node);
  if (corners.size() != 4) return false;
  // Interfaces: bottom and top keep their places.
  int start =
      *std::min_element(corners.begin(), corners.end(), [&](int p, int q) { return local[p] < local[q]; });
  std::size_t steps = 0;
  for (auto& side : block.side) {
    side.assign(1, start);
    do {
      const auto it = next.find(side.back());
      if (it == next.end() || ++steps > next.size()) return false;
      side.push_back(it->second);
    } while (std::find(corners.begin(), corners.end(), side.back()) == corners.end());
    start = side.back();
  }
  if (block.side[3].back() != block.side[0].front() || steps != next.size()) return false;
  if (!model_->groups[at(cells_[at(block.cells.front())].group)].interface()) return true;
  for (int k = 0; k < 4; ++k)
    if (local[block.side[at(k)].front()] != k) return false;
  return block.side[1].size() == 2 && block.side[3].size() == 2;
}

bool Coarsening::make_blocks() {
  std::vector<int> block_of(cells_.size(), -1);
  blocks_.clear();
  for (std::size_t first = 0; first < cells_.size(); ++first) {
    if (block_of[first] >= 0) continue;
    Block block;
    block.cells.push_back(static_cast<int>(first));
    const int name = static_cast<int>(blocks_.size());
    block_of[first] = name;
    for (std::size_t i = 0; i < block.cells.size(); ++i)
      for (int k = 0; k < 4; ++k) {
        const auto& corner = cells_[at(block.cells[i])].corner;
        const Line& l = line(corner[at(k)], corner[at((k + 1) % 4)]);
        if (l.kept) continue;
        for (const auto& [cell, side] : l.cells)
          if (std::exchange(block_of[at(cell)], name) < 0) block.cells.push_back(cell);
      }
    if (!walk(block)) return false;
    blocks_.push_back(std::move(block));
  }
  return true;
}

// New nodes on a side inherit what both of its ends have: it must be what the nodes between have now.
bool Coarsening::faults_in_side(const std::vector<int>& side) {
  if (side.size() < 3 || !line(side[0], side[1]).outer) return false;
  for (const Marks& marks : marks_) {
    const Mark a = mark_of(marks, side.front()), z = mark_of(marks, side.back()),
               middle = mark_of(marks, side[side.size() / 2]);
    for (std::size_t c = 0; c < 2; ++c)
      if (a.code[c] == z.code[c] && middle.code[c] != a.code[c]) return require(side[side.size() / 2]);
  }
  return false;
}

// The angles of an element must be those of a quadrilateral that can be integrated well.
bool Coarsening::well_shaped(const Block& block) const {
  constexpr double kLeastSine = 0.05;  // three degrees
  if (block.cells.size() == 1 || model_->groups[at(cells_[at(block.cells.front())].group)].interface())
    return true;
  for (int k = 0; k < 4; ++k) {
    const Vector2 c = x(block.side[at(k)].front());
    const Vector2 out = x(block.side[at(k)].back()) - c, in = x(block.side[at((k + 3) % 4)].front()) - c;
    if (out.x() * in.y() - out.y() * in.x() < kLeastSine * out.norm() * in.norm()) return false;
  }
  return true;
}

// Elements that are much longer than wide converge slowly near singular corners: lines of the deck cut them.
bool Coarsening::split_long(const Block& block) {
  constexpr double kLongest = 4.0;
  if (model_->groups[at(cells_[at(block.cells.front())].group)].interface()) return false;
  const auto length = [&](std::size_t k) {
    return (x(block.side[k].back()) - x(block.side[k].front())).norm();
  };
  for (std::size_t k = 0; k < 2; ++k) {
    const double along = std::max(length(k), length(k + 2)),
                 across = std::min(length(k + 1), length((k + 3) % 4));
    const auto& side = block.side[k];
    if (along <= kLongest * across || side.size() < 3) continue;
    const Vector2 middle = 0.5 * (x(side.front()) + x(side.back()));
    const int nearest = *std::min_element(side.begin() + 1, side.end() - 1, [&](int p, int q) {
      return (x(p) - middle).norm() < (x(q) - middle).norm();
    });
    return require(nearest);
  }
  return false;
}

// True where nodes had to be required: then all begins anew.
bool Coarsening::faults_in(const Block& block) {
  bool any = false;
  for (const auto& side : block.side) any = faults_in_side(side) || any;
  any = split_long(block) || any;
  if (well_shaped(block)) return any;
  for (int c : block.cells)
    for (int node : cells_[at(c)].corner) any = require(node) || any;
  return any;
}

void Coarsening::carry_loads(std::size_t s) {
  Stage& stage = model_->stages[s];
  const auto load_at = [&](int a, int z) -> const SideLoad* {
    for (const auto& own : line(a, z).cells)
      if (const auto it = loads_[s].find(own);
          it != loads_[s].end() && cells_[at(own.first)].corner[at(own.second)] == a)
        return &it->second;
    return nullptr;
  };
  std::vector<EdgeLoad> carried;
  std::vector<int> elements(model_->groups.size(), 0);  // made so far
  for (const Block& block : blocks_) {
    const int group = cells_[at(block.cells.front())].group, element = elements[at(group)]++;
    for (int k = 0; k < 4; ++k) {
      const auto& side = block.side[at(k)];
      const SideLoad *first = load_at(side[0], side[1]), *last = load_at(side[side.size() - 2], side.back());
      if (first == nullptr || last == nullptr) continue;
      EdgeLoad load;
      load.group = group;
      load.element = element;
      load.edge = model_->groups[at(group)].interface() ? k / 2 : k;
      load.normal = {(*first)[0].x(), (*last)[1].x()};
      load.shear = {(*first)[0].y(), (*last)[1].y()};
      load.line = stage.pressures.front().line;
      carried.push_back(load);
    }
  }
  stage.pressures = std::move(carried);
}

// Middle nodes that a straight side does without are left out too.
std::vector<int> Coarsening::nodes_of(const Block& block) const {
  const Cell& first = cells_[at(block.cells.front())];
  const Group& group = model_->groups[at(first.group)];
  std::vector<int> nodes(group.node_count(), -1);
  for (std::size_t k = 0; k < 4; ++k) nodes[k] = block.side[k].front();
  if (block.cells.size() > 1) return nodes;
  const int* card = group.nodes_of(first.element);
  std::copy_n(card, 4, nodes.begin());
  for (const auto& edge : group.element->edges())
    if (middle_of(edge) >= 0 && line(card[edge[0]], card[edge[1]]).middle_stays)
      nodes[at(middle_of(edge))] = line(card[edge[0]], card[edge[1]]).middle;
  return nodes;
}

void Coarsening::rebuild() {
  for (std::size_t s = 0; s < model_->stages.size(); ++s) carry_loads(s);
  std::vector<Group> made = model_->groups;
  std::vector<char> gone(at(model_->mesh.nodes()), 0);
  for (Group& group : made) {
    for (int node : group.nodes)
      if (node >= 0) gone[at(node)] = 1;
    group.element_numbers.clear();
    group.element_lines.clear();
    group.nodes.clear();
  }
  for (const Block& block : blocks_) {
    const Cell& first = cells_[at(block.cells.front())];
    const Group& from = model_->groups[at(first.group)];
    Group& to = made[at(first.group)];
    to.element_numbers.push_back(from.element_numbers[at(first.element)]);
    to.element_lines.push_back(from.element_lines[at(first.element)]);
    const std::vector<int> nodes = nodes_of(block);
    for (int node : nodes)
      if (node >= 0) gone[at(node)] = 0;
    to.nodes.insert(to.nodes.end(), nodes.begin(), nodes.end());
  }
  model_->groups = std::move(made);
  drop_nodes(std::move(gone));
}

void Coarsening::drop_nodes(std::vector<char> gone) {
  Mesh& mesh = model_->mesh;
  std::vector<int> to(gone.size(), -1);
  int count = 0;
  for (int node = 0; node < mesh.nodes(); ++node) {
    if (gone[at(node)] != 0) continue;
    mesh.x.col(count) = Vector2(mesh.x.col(node));
    mesh.number[at(count)] = mesh.number[at(node)];
    to[at(node)] = count++;
  }
  mesh.x.conservativeResize(2, count);
  mesh.number.resize(at(count));
  mesh.deck_nodes = count;
  const auto renumber = [&](auto& list) {
    std::erase_if(list, [&](const auto& entry) { return gone[at(entry.node)] != 0; });
    for (auto& entry : list) entry.node = to[at(entry.node)];
  };
  renumber(model_->fixities);
  renumber(model_->field_fixities);
  for (Stage& stage : model_->stages) {
    renumber(stage.fixities);
    renumber(stage.loads);
    renumber(stage.field_fixities);
    renumber(stage.exits);
    renumber(stage.field_loads);
    for (int* node : {&stage.control.node, &stage.control.other})
      if (*node >= 0) *node = to[at(*node)];
  }
  for (Report& report : model_->reports) {
    std::erase_if(report.nodes, [&](int node) { return gone[at(node)] != 0; });
    for (int& node : report.nodes) node = to[at(node)];
  }
  for (Group& group : model_->groups)
    for (int& node : group.nodes)
      if (node >= 0) node = to[at(node)];
  b_->node_index.erase_if([&](int node) { return gone[at(node)] != 0; });
  b_->node_index.for_each([&](int, int& node) { node = to[at(node)]; });
}

bool Coarsening::run() {
  if (!collect()) return false;
  find_marks();
  find_loads();
  require_by_pattern();
  require_by_model();
  for (bool faults = true; faults;) {
    keep_lines();
    if (!make_blocks()) return false;
    faults = false;
    for (const Block& block : blocks_) faults = faults_in(block) || faults;
  }
  const bool middles = std::any_of(lines_.begin(), lines_.end(),
                                   [](const Line& on) { return on.middle >= 0 && !on.middle_stays; });
  if (blocks_.size() == cells_.size() && !middles) return false;
  rebuild();
  return true;
}

}  // namespace

bool coarsen(Work& b) {
  if (!b.model.mesh.arcs.empty()) return false;  // every node of them shapes the outline
  return Coarsening(b).run();
}

}  // namespace sage::mesh
