#include "sage/analysis/stream_function.hpp"

#include <algorithm>
#include <limits>
#include <unordered_map>

#include "sage/analysis/flow_through.hpp"

namespace sage {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// Two neighbouring nodes of outlines, and psi half-way between them.
struct Half {
  int a = 0, b = 0;
  int elements = 0;
  double psi = kUnknown;
};

// Outline of an element, counter-clockwise: its nodes, the halves behind each, and what it takes in there.
struct Outline {
  std::vector<int> nodes, halves;
  std::vector<double> taken;
};

class Net {
 public:
  Net(const Model& model, const std::vector<char>& active, std::span<const GroupData> groups) : model_(model) {
    for (std::size_t g = 0; g < model.groups.size(); ++g)
      if (model.groups[g].flow() && active[g] != 0)
        for (int e = 0; e < model.groups[g].elements(); ++e) add(groups[g], e);
    elements_of_.resize(halves_.size());
    for (std::size_t o = 0; o < outlines_.size(); ++o)
      for (const int half : outlines_[o].halves) {
        ++halves_[static_cast<std::size_t>(half)].elements;
        elements_of_[static_cast<std::size_t>(half)].push_back(static_cast<int>(o));
      }
  }

  StreamFunction solve();

 private:
  void add(const GroupData& data, int element);
  int half(int a, int b);
  void walk(int first);
  void settle(std::vector<int>& waiting, int outline);
  void at_nodes(StreamFunction& result) const;

  const Model& model_;
  std::vector<Outline> outlines_;
  std::vector<Half> halves_;
  std::vector<std::vector<int>> elements_of_;  // of a half
  std::vector<char> done_;                     // of an outline
  std::unordered_map<std::uint64_t, int> index_;
};

int Net::half(int a, int b) {
  const auto [low, high] = std::minmax(a, b);
  const std::uint64_t key = (static_cast<std::uint64_t>(low) << 32U) | static_cast<std::uint64_t>(high);
  const auto [at, added] = index_.try_emplace(key, static_cast<int>(halves_.size()));
  if (added) halves_.push_back({low, high});
  return at->second;
}

void Net::add(const GroupData& data, int element) {
  const Group& group = *data.group;
  const int* nodes = group.nodes_of(element);
  const Eigen::VectorXd taken = taken_in(model_, data, element);
  Outline outline;
  for (const std::vector<int>& edge : group.element->edges()) {
    const auto take = [&](int local) {
      outline.nodes.push_back(nodes[local]);
      outline.taken.push_back(taken[local]);
    };
    take(edge[0]);
    for (std::size_t i = 2; i < edge.size(); ++i) take(edge[i]);
  }
  const std::size_t n = outline.nodes.size();
  for (std::size_t i = 0; i < n; ++i)
    outline.halves.push_back(half(outline.nodes[i], outline.nodes[(i + 1) % n]));
  outlines_.push_back(std::move(outline));
}

// From the first half that is known round the outline.
void Net::settle(std::vector<int>& waiting, int index) {
  const Outline& outline = outlines_[static_cast<std::size_t>(index)];
  const std::size_t n = outline.halves.size();
  const auto psi = [&](std::size_t i) -> double& {
    return halves_[static_cast<std::size_t>(outline.halves[i % n])].psi;
  };
  std::size_t known = 0;
  while (std::isnan(psi(known))) ++known;
  for (std::size_t k = 1; k < n; ++k) {
    const std::size_t at = known + k;
    if (!std::isnan(psi(at))) continue;
    psi(at) = psi(at - 1) - outline.taken[at % n];
  }
  for (const int one : outline.halves)
    for (const int other : elements_of_[static_cast<std::size_t>(one)])
      if (done_[static_cast<std::size_t>(other)] == 0) {
        done_[static_cast<std::size_t>(other)] = 1;
        waiting.push_back(other);
      }
}

// Breadth first, so that wells leave a short jump.  psi is 0 at the least value of the part.
void Net::walk(int first) {
  std::vector<int> waiting{first};
  done_[static_cast<std::size_t>(first)] = 1;
  halves_[static_cast<std::size_t>(outlines_[static_cast<std::size_t>(first)].halves[0])].psi = 0.0;
  for (std::size_t i = 0; i < waiting.size(); ++i) settle(waiting, waiting[i]);
  double least = std::numeric_limits<double>::infinity();
  const auto each = [&](const auto& what) {
    for (const int o : waiting)
      for (const int one : outlines_[static_cast<std::size_t>(o)].halves)
        what(halves_[static_cast<std::size_t>(one)]);
  };
  each([&](const Half& half) { least = std::min(least, half.psi); });
  std::vector<char> moved(halves_.size(), 0);
  each([&](Half& half) {
    char& known = moved[static_cast<std::size_t>(&half - halves_.data())];
    if (known == 0) half.psi -= least;
    known = 1;
  });
}

void Net::at_nodes(StreamFunction& result) const {
  const Eigen::Index n = model_.mesh.nodes();
  Eigen::VectorXd inside = Eigen::VectorXd::Zero(n), on_edge = inside, source = inside;
  Eigen::VectorXi halves = Eigen::VectorXi::Zero(n), edges = halves;
  for (const Half& half : halves_)
    for (const int node : {half.a, half.b}) {
      inside[node] += half.psi;
      ++halves[node];
      if (half.elements != 1) continue;
      on_edge[node] += half.psi;
      ++edges[node];
    }
  for (const Outline& outline : outlines_)
    for (std::size_t i = 0; i < outline.nodes.size(); ++i) source[outline.nodes[i]] += outline.taken[i];
  result.at_node.setConstant(n, kUnknown);
  for (Eigen::Index node = 0; node < n; ++node) {
    if (halves[node] == 0) continue;
    result.at_node[node] = edges[node] > 0 ? on_edge[node] / edges[node] : inside[node] / halves[node];
    if (edges[node] == 0) result.sources = std::max(result.sources, std::abs(source[node]));
  }
  // A node in the middle of an element has the mean of the outline.
  for (const Group& group : model_.groups) {
    if (!group.flow()) continue;
    for (int e = 0; e < group.elements(); ++e) {
      double sum = 0.0;
      int known = 0;
      for (int i = 0; i < group.entry->corners; ++i, ++known) sum += result.at_node[group.nodes_of(e)[i]];
      for (std::size_t i = 0; i < group.node_count(); ++i)
        if (double& value = result.at_node[group.nodes_of(e)[i]]; std::isnan(value)) value = sum / known;
    }
  }
}

StreamFunction Net::solve() {
  StreamFunction result;
  done_.assign(outlines_.size(), 0);
  for (std::size_t o = 0; o < outlines_.size(); ++o)
    if (done_[o] == 0) walk(static_cast<int>(o));
  for (const Half& half : halves_) result.largest = std::max(result.largest, half.psi);
  at_nodes(result);
  if (result.largest > 0.0) result.sources /= result.largest;
  return result;
}

}  // namespace

StreamFunction stream_function(const Model& model, const std::vector<char>& active,
                               std::span<const GroupData> groups) {
  return Net(model, active, groups).solve();
}

}  // namespace sage
