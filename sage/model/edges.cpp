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
    if (edge.solids > 1 || a == nullptr || z == nullptr) continue;
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
    if (edge.solids <= 1 && has(ends.first) && has(ends.second))
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

}  // namespace sage::build
