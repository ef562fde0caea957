#include "sage/analysis/stream_function.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <unordered_map>

#include "sage/analysis/explain.hpp"
#include "sage/analysis/flow_through.hpp"
#include "sage/analysis/observer.hpp"
#include "sage/math/rounding.hpp"

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

// A part of the flow that hangs together by edges.
struct Part {
  std::vector<int> outlines, nodes;
  bool flows = false;   // there is more than the rounding of heads
  double jump = 0.0;    // by which sums around outlines miss
  double source = 0.0;  // largest amount put in or taken out at a node inside, without its sign
  int source_node = 0;
  double least = 0.0, largest = 0.0;
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
        ++halves_[at(half)].elements;
        elements_of_[at(half)].push_back(static_cast<int>(o));
      }
  }

  StreamFunction solve();

 private:
  static std::size_t at(int index) { return static_cast<std::size_t>(index); }
  void add(const GroupData& data, int element);
  int half(int a, int b);
  void walk(int first);
  void settle(Part& part, int outline);
  double miss(const Outline& outline) const;
  void sum_nodes(StreamFunction& result);
  void share_out();
  void finish(Part& part, const StreamFunction& result) const;
  void fill_middles(StreamFunction& result) const;
  std::string reason(const Part& part) const;

  const Model& model_;
  std::vector<Outline> outlines_;
  std::vector<Half> halves_;
  std::vector<std::vector<int>> elements_of_;  // of a half
  std::vector<char> done_;                     // of an outline
  std::vector<char> steep_;                    // of an outline: heads differ by more than rounding
  std::vector<Part> parts_;
  std::vector<double> taken_;  // by node: what all elements together take in there
  std::vector<char> on_edge_;  // by node: it is not inside the flow
  static constexpr int kNoPart = -1, kShared = -2;
  std::vector<int> part_of_;  // by node
  std::unordered_map<std::uint64_t, int> index_;
};

int Net::half(int a, int b) {
  const auto [low, high] = std::minmax(a, b);
  const std::uint64_t key = (static_cast<std::uint64_t>(low) << 32U) | static_cast<std::uint64_t>(high);
  const auto [found, added] = index_.try_emplace(key, static_cast<int>(halves_.size()));
  if (added) halves_.push_back({low, high});
  return found->second;
}

// Gradients below this are rounding of heads.
bool is_steep(const GroupData& data, int element) {
  constexpr double kLevel = 1e-8;
  const std::size_t numbers = 3 * static_cast<std::size_t>(data.group->element->traits().points);
  const double* const eps = data.state.committed.eps.data() + static_cast<std::size_t>(element) * numbers;
  for (std::size_t i = 0; i < numbers; i += 3)
    if (std::hypot(eps[i], eps[i + 1]) > kLevel) return true;
  return false;
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
  steep_.push_back(is_steep(data, element) ? 1 : 0);
}

// From the first half that is known round the outline.
void Net::settle(Part& part, int index) {
  const Outline& outline = outlines_[at(index)];
  const std::size_t n = outline.halves.size();
  const auto psi = [&](std::size_t i) -> double& { return halves_[at(outline.halves[i % n])].psi; };
  std::size_t known = 0;
  while (std::isnan(psi(known))) ++known;
  for (std::size_t k = 1; k < n; ++k)
    if (const std::size_t now = known + k; std::isnan(psi(now)))
      psi(now) = psi(now - 1) - outline.taken[now % n];
  for (const int one : outline.halves)
    for (const int other : elements_of_[at(one)])
      if (done_[at(other)] == 0) {
        done_[at(other)] = 1;
        part.outlines.push_back(other);
      }
}

// Breadth first, so that wells leave a short jump.
void Net::walk(int first) {
  Part& part = parts_.emplace_back();
  part.outlines.push_back(first);
  done_[at(first)] = 1;
  halves_[at(outlines_[at(first)].halves[0])].psi = 0.0;
  for (std::size_t i = 0; i < part.outlines.size(); ++i) settle(part, part.outlines[i]);
}

// Where two ways to a half give it two values.
double Net::miss(const Outline& outline) const {
  const std::size_t n = outline.halves.size();
  double largest = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double before = halves_[at(outline.halves[(i + n - 1) % n])].psi;
    largest = std::max(largest, std::abs(halves_[at(outline.halves[i])].psi - before + outline.taken[i]));
  }
  return largest;
}

void Net::sum_nodes(StreamFunction& result) {
  const auto n = static_cast<std::size_t>(model_.mesh.nodes());
  taken_.assign(n, 0.0);
  on_edge_.assign(n, 0);
  for (const Outline& outline : outlines_)
    for (std::size_t i = 0; i < outline.nodes.size(); ++i) taken_[at(outline.nodes[i])] += outline.taken[i];
  double scale = 0.0;
  for (const double taken : taken_) scale = std::max(scale, std::abs(taken));
  // Sums of psi and weights: of what lies around a node, of what lies on the edge, of what is closed there.
  constexpr double kClosed = rounding::kText;
  std::array<std::vector<double>, 3> sum, weight;
  for (std::size_t kind = 0; kind < sum.size(); ++kind) {
    sum[kind].assign(n, 0.0);
    weight[kind].assign(n, 0.0);
  }
  for (const Half& half : halves_) {
    const double w = 1.0 / (model_.mesh.x.col(half.a) - model_.mesh.x.col(half.b)).norm();
    const double least = std::min(std::abs(taken_[at(half.a)]), std::abs(taken_[at(half.b)]));
    const std::size_t kinds = half.elements != 1 ? 1 : least > kClosed * scale ? 2 : 3;
    for (const int node : {half.a, half.b}) {
      if (kinds > 1) on_edge_[at(node)] = 1;
      for (std::size_t kind = 0; kind < kinds; ++kind) {
        sum[kind][at(node)] += w * half.psi;
        weight[kind][at(node)] += w;
      }
    }
  }
  for (std::size_t node = 0; node < n; ++node)
    for (std::size_t kind = sum.size(); kind-- > 0;)
      if (weight[kind][node] > 0.0) {
        result.at_node[node] = sum[kind][node] / weight[kind][node];
        break;
      }
}

std::string Net::reason(const Part& part) const {
  const auto number = [&](int node) { return std::to_string(model_.mesh.number[at(node)]); };
  const std::string unit = unit_text(Dimension::discharge, model_.units);
  if (part.source > StreamFunction::kLeastJump * (part.largest - part.least))
    return "water is put in or taken out inside the flow, most at node " + number(part.source_node) + " (" +
           short_number(part.source) + " " + unit + ")";
  return "water is put in or taken out around a hole in the flow (" + short_number(part.jump) + " " + unit +
         ")";
}

// A node where two parts meet has a value in each, and so none.
void Net::share_out() {
  part_of_.assign(model_.mesh.nodes(), kNoPart);
  for (std::size_t p = 0; p < parts_.size(); ++p)
    for (const int o : parts_[p].outlines)
      for (const int node : outlines_[at(o)].nodes) {
        int& part = part_of_[at(node)];
        if (part == kNoPart) parts_[p].nodes.push_back(node);
        part = part == kNoPart || part == static_cast<int>(p) ? static_cast<int>(p) : kShared;
      }
}

void Net::finish(Part& part, const StreamFunction& result) const {
  for (const int o : part.outlines) {
    const Outline& outline = outlines_[at(o)];
    part.flows = part.flows || steep_[at(o)] != 0;
    part.jump = std::max(part.jump, miss(outline));
  }
  part.least = std::numeric_limits<double>::infinity();
  part.largest = -part.least;
  for (const int node : part.nodes) {
    if (part_of_[at(node)] == kShared) continue;
    part.least = std::min(part.least, result.at_node[node]);
    part.largest = std::max(part.largest, result.at_node[node]);
    if (on_edge_[at(node)] != 0 || !(std::abs(taken_[at(node)]) > part.source)) continue;
    part.source = std::abs(taken_[at(node)]);
    part.source_node = node;
  }
}

// A node in the middle of an element has the mean of its corners.
void Net::fill_middles(StreamFunction& result) const {
  for (const Group& group : model_.groups) {
    if (!group.flow()) continue;
    for (int e = 0; e < group.elements(); ++e) {
      const int* const nodes = group.nodes_of(e);
      double sum = 0.0;
      bool unique = true;
      for (int i = 0; i < group.entry->corners; ++i) {
        sum += result.at_node[nodes[i]];
        unique = unique && result.unique[at(nodes[i])] != 0;
      }
      for (std::size_t i = 0; i < group.node_count(); ++i)
        if (double& value = result.at_node[nodes[i]]; std::isnan(value)) {
          value = sum / group.entry->corners;
          result.unique[at(nodes[i])] = unique ? 1 : 0;
        }
    }
  }
}

StreamFunction Net::solve() {
  StreamFunction result;
  result.at_node.setConstant(model_.mesh.nodes(), kUnknown);
  result.unique.assign(model_.mesh.nodes(), 0);
  done_.assign(outlines_.size(), 0);
  for (std::size_t o = 0; o < outlines_.size(); ++o)
    if (done_[o] == 0) walk(static_cast<int>(o));
  sum_nodes(result);
  share_out();
  for (Part& part : parts_) finish(part, result);
  for (const Part& part : parts_) {
    const double span = part.largest - part.least;
    const bool unique = !part.flows || part.jump <= StreamFunction::kLeastJump * span;
    for (const int node : part.nodes) {
      if (part_of_[at(node)] == kShared) continue;
      result.at_node[node] = part.flows ? result.at_node[node] - part.least : 0.0;
      result.unique[at(node)] = unique ? 1 : 0;
    }
    if (!part.flows) continue;
    result.largest = std::max(result.largest, span);
    if (span > 0.0) result.jump = std::max(result.jump, part.jump / span);
    if (!unique && result.reason.empty()) result.reason = reason(part);
  }
  fill_middles(result);
  return result;
}

}  // namespace

double StreamFunction::value(int node) const {
  return unique[node] != 0 ? at_node[node] : kUnknown;
}

StreamFunction stream_function(const Model& model, const std::vector<char>& active,
                               std::span<const GroupData> groups) {
  return Net(model, active, groups).solve();
}

const StreamFunction& stream_function(const Model& model, const Solution& solution) {
  static std::mutex one_at_a_time;  // outputs read nodes on several threads
  const std::lock_guard lock(one_at_a_time);
  if (solution.stream == nullptr)
    solution.stream = std::make_shared<const StreamFunction>(
        stream_function(model, solution.activity->group, solution.groups()));
  return *solution.stream;
}

}  // namespace sage
