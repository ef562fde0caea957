#include "sage/record/nodal_values.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>

#include "sage/record/point_fields.hpp"

namespace sage {

namespace {

using NodePair = std::pair<int, int>;

NodePair pair_of(int a, int b) {
  return {std::min(a, b), std::max(a, b)};
}

// The active structures: their nodes, and their elements by end nodes.
struct Walls {
  std::vector<char> at_node;
  std::set<NodePair> pairs;

  Walls(const Model& model, const Activity& activity) {
    for (std::size_t g = 0; g < model.groups.size(); ++g) {
      const Group& group = model.groups[g];
      if (!activity.group[g] || !group.structure() || group.entry->corners < 2) continue;
      if (at_node.empty()) at_node.resize(model.mesh.nodes(), 0);
      for (int node : group.nodes) at_node[node] = 1;
      for (int e = 0; e < group.elements(); ++e)
        pairs.insert(pair_of(group.nodes_of(e)[0], group.nodes_of(e)[1]));
    }
  }
  bool at(int node) const { return !at_node.empty() && at_node[node] != 0; }
  // Also where two structures lie along one edge with a node in its middle.
  bool along(const int* nodes, const std::vector<int>& edge) const {
    const auto has = [&](std::size_t end) { return pairs.contains(pair_of(nodes[edge[0]], nodes[edge[end]])); };
    return has(1) || (edge.size() > 2 && has(2));
  }
};

// An element at an entry, and where the entry stands in NodalLayout::of_group.
struct Use {
  std::size_t group = 0, item = 0;
  int element = 0;
};

// Whether two elements that share a node hang together there.
bool hang_together(const Model& model, const Walls& walls, int node, const Use& a, const Use& b) {
  const Group &ga = model.groups[a.group], &gb = model.groups[b.group];
  const int *na = ga.nodes_of(a.element), *nb = gb.nodes_of(b.element);
  const std::span<const int> all_a(na, ga.node_count()), all_b(nb, gb.node_count());
  if (ga.interface())
    return std::ranges::any_of(all_a, [&](int other) {
      return other != node && model.mesh.x.col(other) == model.mesh.x.col(node) &&
             std::ranges::find(all_b, other) != all_b.end();
    });
  const auto ends = [](const int* nodes, const std::vector<int>& edge) {
    return pair_of(nodes[edge[0]], nodes[edge[1]]);
  };
  for (const std::vector<int>& edge : ga.element->edges()) {
    const bool here = std::ranges::any_of(edge, [&](int local) { return na[local] == node; });
    if (!here || walls.along(na, edge)) continue;
    for (const std::vector<int>& other : gb.element->edges())
      if (ends(na, edge) == ends(nb, other)) return true;
  }
  return false;
}

// For each of the elements at a node the first of those that it hangs together with, over others or at once.
std::vector<std::size_t> first_of_body(const Model& model, const Walls& walls, int node,
                                       const std::vector<Use>& uses) {
  std::vector<std::size_t> first(uses.size());
  std::iota(first.begin(), first.end(), std::size_t{0});
  for (std::size_t i = 0; i < uses.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      if (first[i] == first[j] || !hang_together(model, walls, node, uses[i], uses[j])) continue;
      const std::size_t low = std::min(first[i], first[j]), high = std::max(first[i], first[j]);
      std::ranges::replace(first, high, low);
    }
  return first;
}

// Entries of their own for bodies that a structure or an interface keeps apart.
void split_entries(const Model& model, const Activity& activity, NodalLayout& layout) {
  const Walls walls(model, activity);
  std::map<int, std::vector<Use>> of_entry;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    const bool area = group.solid() || group.flow();
    if (layout.of_group[g].empty() || !(area ? !walls.pairs.empty() : group.interface())) continue;
    for (std::size_t item = 0; item < group.nodes.size(); ++item)
      if (!area || walls.at(group.nodes[item]))
        of_entry[layout.of_group[g][item]].push_back({g, item, static_cast<int>(item / group.node_count())});
  }
  for (const auto& [entry, uses] : of_entry) {
    const int node = layout.node[entry];
    const std::vector<std::size_t> first = first_of_body(model, walls, node, uses);
    std::map<std::size_t, int> entries{{first[0], entry}};
    for (std::size_t i = 0; i < uses.size(); ++i) {
      const auto [at, added] = entries.try_emplace(first[i], layout.entries());
      if (added) layout.node.push_back(node);
      layout.of_group[uses[i].group][uses[i].item] = at->second;
    }
  }
}

}  // namespace

NodalLayout nodal_layout(const Model& model, const Activity& activity) {
  NodalLayout layout;
  layout.of_group.resize(model.groups.size());
  const auto nodes = static_cast<std::size_t>(model.mesh.nodes());
  std::vector<int> entry(nodes * model.materials.size(), -1);
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    if (!activity.group[g]) continue;
    const Group& group = model.groups[g];
    const std::size_t first = static_cast<std::size_t>(group.material) * nodes;
    for (int node : group.nodes) {
      int& e = entry[first + static_cast<std::size_t>(node)];
      if (e < 0) {
        e = layout.entries();
        layout.node.push_back(node);
      }
      layout.of_group[g].push_back(e);
    }
  }
  split_entries(model, activity, layout);
  return layout;
}

std::size_t size_of(const FieldList& fields) {
  std::size_t size = 0;
  for (const FieldEntry* field : fields) size += field->size();
  return size;
}

std::size_t carried_size_of(const FieldList& fields) {
  std::size_t size = 0;
  for (const FieldEntry* field : fields) size += carried_size(*field);
  return size;
}

namespace {

// What the entries `first` to `last` - 1 have of the group's elements, added in the order of elements.
void add_to_entries(const Model& model, const GroupData& data, const std::vector<int>& entries,
                    const FieldList& fields, NodalRule rule, int first, int last, double* sum, int* uses) {
  const Group& group = *data.group;
  const auto points = static_cast<std::size_t>(group.element->traits().points);
  const std::size_t nodes = group.node_count(), n = carried_size_of(fields);
  const PointFields reader(fields, data);
  std::vector<double> at_points(points * n);
  const std::vector<double> equal(points * nodes, 1.0 / static_cast<double>(points));
  const auto is_here = [&](int entry) { return entry >= first && entry < last; };
  Eigen::Matrix2Xd x;
  for (std::size_t e = 0; e < static_cast<std::size_t>(group.elements()); ++e) {
    const std::span<const int> own(entries.data() + e * nodes, nodes);
    if (std::ranges::none_of(own, is_here)) continue;
    for (std::size_t p = 0; p < points; ++p)
      reader.carry_all({model.mesh, data, e * points + p}, at_points.data() + p * n);
    element_coordinates(model.mesh, group, static_cast<int>(e), x);
    const std::span<const double> map =
        rule == NodalRule::element_means ? std::span<const double>(equal) : group.element->point_to_node(x);
    for (std::size_t i = 0; i < nodes; ++i) {
      if (!is_here(own[i])) continue;
      ++uses[own[i]];
      double* const to = sum + static_cast<std::size_t>(own[i]) * n;
      for (std::size_t p = 0; p < points; ++p) {
        const double part = map[i * points + p];
        const double* const from = at_points.data() + p * n;
#pragma GCC ivdep
        for (std::size_t c = 0; c < n; ++c) to[c] += part * from[c];
      }
    }
  }
}

}  // namespace

std::vector<double> nodal_average(const Model& model, const Solution& solution, const NodalLayout& layout,
                                  const FieldList& fields, NodalRule rule, ThreadPool* pool) {
  const std::size_t n = carried_size_of(fields);
  std::vector<double> sum(static_cast<std::size_t>(layout.entries()) * n, 0.0);
  std::vector<int> uses(static_cast<std::size_t>(layout.entries()), 0);
  const auto average = [&](int first, int last) {
    for (std::size_t g = 0; g < model.groups.size(); ++g)
      if (!layout.of_group[g].empty())
        add_to_entries(model, solution.groups()[g], layout.of_group[g], fields, rule, first, last, sum.data(),
                       uses.data());
    for (auto e = static_cast<std::size_t>(first); e < static_cast<std::size_t>(last); ++e)
      for (std::size_t c = 0; c < n; ++c) sum[e * n + c] /= std::max(uses[e], 1);
  };
  const int parts = pool != nullptr ? pool->threads() : 1, entries = layout.entries();
  if (parts == 1)
    average(0, entries);
  else
    pool->run(parts, [&](int part, int /*thread*/) {
      average(static_cast<int>(std::int64_t{entries} * part / parts),
              static_cast<int>(std::int64_t{entries} * (part + 1) / parts));
    });
  return sum;
}

namespace {

// Adds one of `points` points to the mean over its element; what a field of_mean adds is what it carries.
void add_share(const FieldList& fields, const PointFields& reader, const PointState& point, double points,
               std::vector<double>& one, double* sum) {
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const std::size_t n = fields[f]->of_mean ? carried_size(*fields[f]) : fields[f]->size();
    if (fields[f]->of_mean)
      reader.carry(f, point, one.data());
    else
      reader.read(f, point, one.data());
    for (std::size_t c = 0; c < n; ++c) sum[c] += one[c] / points;
    sum += n;
  }
}

// The values of one element from such sums.
void take_means(const FieldList& fields, const GroupData& data, const double* from, double* to) {
  for (const FieldEntry* field : fields) {
    if (field->of_mean && !applies(*field, data))  // the mean of no stress has an angle, 0, all the same
      std::fill_n(to, field->size(), std::nan(""));
    else if (field->of_mean)
      value_of_carried(*field, from, to);
    else
      std::copy_n(from, field->size(), to);
    from += field->of_mean ? carried_size(*field) : field->size();
    to += field->size();
  }
}

}  // namespace

std::vector<double> element_average(const Mesh& mesh, const GroupData& data, const FieldList& fields,
                                    ThreadPool* pool) {
  const std::size_t n = size_of(fields);
  std::size_t summed = 0, most = 0;
  for (const FieldEntry* field : fields) {
    summed += field->of_mean ? carried_size(*field) : field->size();
    most = std::max({most, carried_size(*field), field->size()});
  }
  const auto points = static_cast<std::size_t>(data.group->element->traits().points);
  const auto elements = static_cast<std::size_t>(data.group->elements());
  std::vector<double> mean(elements * n, 0.0);
  const PointFields reader(fields, data);
  in_pieces(pool, elements, [&](std::size_t first, std::size_t last) {
    std::vector<double> sum(summed), one(most);
    for (std::size_t e = first; e < last; ++e) {
      std::ranges::fill(sum, 0.0);
      for (std::size_t p = 0; p < points; ++p)
        add_share(fields, reader, {mesh, data, e * points + p}, static_cast<double>(points), one, sum.data());
      take_means(fields, data, sum.data(), mean.data() + e * n);
    }
  });
  return mean;
}

}  // namespace sage
