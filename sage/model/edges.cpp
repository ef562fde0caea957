#include "sage/model/edges.hpp"

#include <algorithm>
#include <unordered_map>

namespace sage::build {

namespace {

// What a node is held to, by the cards of one list; later cards win.
class HeldNodes {
 public:
  explicit HeldNodes(const std::vector<Fixity>& fixities) {
    for (const Fixity& f : fixities) {
      Fixity& all = of_node_[f.node];
      all.node = f.node;
      all.line = f.line;
      for (std::size_t c = 0; c < 2; ++c)
        if (f.code[c] != FixityCode::unchanged) {
          all.code[c] = f.code[c];
          all.value[c] = f.value[c];
        }
    }
  }
  const Fixity* find(int node) const {
    const auto it = of_node_.find(node);
    return it == of_node_.end() ? nullptr : &it->second;
  }

 private:
  std::unordered_map<int, Fixity> of_node_;
};

void inherit_fixities(std::vector<Fixity>& fixities, const MadeEdges& edges) {
  const HeldNodes held(fixities);
  for (const auto& [ends, edge] : edges) {
    const Fixity *a = held.find(ends.first), *z = held.find(ends.second);
    if (edge.solids != 1 || a == nullptr || z == nullptr) continue;
    for (std::size_t i = 0; i < edge.nodes.size(); ++i) {
      const double t = edge.at[i];
      Fixity mid;
      mid.node = edge.nodes[i];
      mid.line = a->line;
      bool any = false;
      for (std::size_t c = 0; c < 2; ++c) {
        mid.code[c] = a->code[c] == z->code[c] ? a->code[c] : FixityCode::unchanged;
        mid.value[c] = mid.code[c] == FixityCode::fixed ? (1 - t) * a->value[c] + t * z->value[c] : 0.0;
        any = any || mid.code[c] != FixityCode::unchanged;
      }
      if (any) fixities.push_back(mid);
    }
  }
}

void inherit_report(Report& report, const MadeEdges& edges) {
  std::vector<int> listed = report.nodes;
  std::sort(listed.begin(), listed.end());
  const auto has = [&](int node) { return std::binary_search(listed.begin(), listed.end(), node); };
  for (const auto& [ends, edge] : edges)
    if (edge.solids == 1 && has(ends.first) && has(ends.second))
      for (int node : edge.nodes)
        if (!has(node)) report.nodes.push_back(node);
}

}  // namespace

void inherit_along_edges(Model& model, const MadeEdges& edges) {
  inherit_fixities(model.fixities, edges);
  for (Stage& stage : model.stages) inherit_fixities(stage.fixities, edges);
  for (Report& report : model.reports) inherit_report(report, edges);
}

void NewNodes::append() {
  if (made_.empty()) return;
  const Eigen::Index old = mesh_->x.cols();
  mesh_->x.conservativeResize(2, old + static_cast<Eigen::Index>(made_.size()));
  int number = *std::max_element(mesh_->number.begin(), mesh_->number.end());
  for (std::size_t i = 0; i < made_.size(); ++i) {
    mesh_->x.col(old + static_cast<Eigen::Index>(i)) = made_[i];
    mesh_->number.push_back(++number);
  }
  first_ = mesh_->nodes();
  made_.clear();
}

Vector2 along_edge(const Vector2& a, const Vector2& z, const std::optional<Vector2>& middle, double t) {
  if (!middle) return (1 - t) * a + t * z;
  return (1 - t) * (1 - 2 * t) * a + t * (2 * t - 1) * z + 4 * t * (1 - t) * *middle;
}

bool CoarseShape::curved() const {
  return std::any_of(middle.begin(), middle.end(), [](const auto& m) { return m.has_value(); });
}

// Corner part plus, for each curved side, its middle node's distance from the chord times the middle node's
// function.
Vector2 CoarseShape::at(const Place& q) const {
  const auto [x, y] = q;
  std::array<double, 4> linear{}, bubble{};
  if (corners == 4) {
    linear = {(1 - x) * (1 - y) / 4, (1 + x) * (1 - y) / 4, (1 + x) * (1 + y) / 4, (1 - x) * (1 + y) / 4};
    bubble = {(1 - x * x) * (1 - y) / 2, (1 + x) * (1 - y * y) / 2, (1 - x * x) * (1 + y) / 2,
              (1 - x) * (1 - y * y) / 2};
  } else {
    linear = {1 - x - y, x, y, 0.0};
    bubble = {4 * (1 - x - y) * x, 4 * x * y, 4 * y * (1 - x - y), 0.0};
  }
  Vector2 point = Vector2::Zero();
  for (std::size_t k = 0; k < static_cast<std::size_t>(corners); ++k) {
    point += linear[k] * corner[k];
    const std::size_t next = (k + 1) % static_cast<std::size_t>(corners);
    if (middle[k]) point += bubble[k] * (*middle[k] - 0.5 * (corner[k] + corner[next]));
  }
  return point;
}

const std::array<Place, 4>& parent_corners(int corners) {
  static const std::array<Place, 4> square{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  static const std::array<Place, 4> triangle{{{0, 0}, {1, 0}, {0, 1}, {0, 0}}};
  return corners == 4 ? square : triangle;
}

}  // namespace sage::build
