#include "solvers/equation_graph.hpp"

#include <algorithm>

namespace sage {

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

// Finds equations with equal element lists.  Candidates share their first element, so chains stay short.
// inner: equations before the border.
void group_equations(const IndexLists& elements_of, int elements, int inner, EquationGraph& graph) {
  const int equations = elements_of.count();
  std::vector<int> first_group(at(elements), -1);  // element -> latest group whose list begins with it
  std::vector<int> next_group, representative;
  graph.group_of.assign(at(equations), -1);
  for (int equation = 0; equation < equations; ++equation) {
    const auto list = elements_of.of(equation);
    int group = list.empty() ? -1 : first_group[at(list.front())];
    const auto same = [&](int other) {
      return (equation < inner) == (other < inner) && std::ranges::equal(list, elements_of.of(other));
    };
    while (group >= 0 && !same(representative[at(group)])) group = next_group[at(group)];
    if (group < 0) {
      group = static_cast<int>(representative.size());
      representative.push_back(equation);
      next_group.push_back(list.empty() ? -1 : first_group[at(list.front())]);
      if (!list.empty()) first_group[at(list.front())] = group;
    }
    graph.group_of[at(equation)] = group;
  }
  graph.members.start.assign(representative.size() + 1, 0);
  graph.members.item.resize(at(equations));
  for (const int group : graph.group_of) ++graph.members.start[at(group) + 1];
  for (std::size_t g = 1; g < graph.members.start.size(); ++g)
    graph.members.start[g] += graph.members.start[g - 1];
  std::vector<int> end(graph.members.start.begin(), graph.members.start.end() - 1);
  for (int equation = 0; equation < equations; ++equation)
    graph.members.item[at(end[at(graph.group_of[at(equation)])]++)] = equation;
}

// Groups of every element, without repetition.
IndexLists groups_of_elements(const ElementEquations& elements, const std::vector<int>& group_of, int groups) {
  IndexLists lists;
  lists.start.reserve(at(elements.count()) + 1);
  lists.item.reserve(elements.equations.size());
  std::vector<int> seen_in(at(groups), -1);
  for (int element = 0; element < elements.count(); ++element) {
    for (const int equation : elements.of(element)) {
      if (equation < 0) continue;
      const int group = group_of[at(equation)];
      if (seen_in[at(group)] == element) continue;
      seen_in[at(group)] = element;
      lists.item.push_back(group);
    }
    lists.start.push_back(static_cast<int>(lists.item.size()));
  }
  return lists;
}

}  // namespace

IndexLists elements_of_equations(int equations, const ElementEquations& elements) {
  IndexLists lists;
  lists.start.assign(at(equations) + 1, 0);
  std::vector<int> latest(at(equations), -1);
  const auto visit = [&](auto&& use) {
    std::ranges::fill(latest, -1);
    for (int element = 0; element < elements.count(); ++element)
      for (const int equation : elements.of(element)) {
        if (equation < 0 || latest[at(equation)] == element) continue;
        latest[at(equation)] = element;
        use(equation, element);
      }
  };
  visit([&](int equation, int) { ++lists.start[at(equation) + 1]; });
  for (std::size_t i = 1; i < lists.start.size(); ++i) lists.start[i] += lists.start[i - 1];
  lists.item.resize(at(lists.start.back()));
  std::vector<int> end(lists.start.begin(), lists.start.end() - 1);
  visit([&](int equation, int element) { lists.item[at(end[at(equation)]++)] = element; });
  return lists;
}

EquationGraph make_equation_graph(int equations, const ElementEquations& elements, int border) {
  EquationGraph graph;
  graph.pressure = elements.pressure;
  const IndexLists elements_of = elements_of_equations(equations, elements);
  group_equations(elements_of, elements.count(), equations - border, graph);
  const int groups = graph.members.count();
  const IndexLists groups_of = groups_of_elements(elements, graph.group_of, groups);

  std::vector<int> seen_by(at(groups), -1);
  graph.neighbours.start.reserve(at(groups) + 1);
  for (int group = 0; group < groups; ++group) {
    seen_by[at(group)] = group;
    const std::size_t begin = graph.neighbours.item.size();
    for (const int element : elements_of.of(graph.members.of(group).front()))
      for (const int other : groups_of.of(element)) {
        if (seen_by[at(other)] == group) continue;
        seen_by[at(other)] = group;
        graph.neighbours.item.push_back(other);
      }
    std::sort(graph.neighbours.item.begin() + static_cast<std::ptrdiff_t>(begin), graph.neighbours.item.end());
    graph.neighbours.start.push_back(static_cast<int>(graph.neighbours.item.size()));
  }
  return graph;
}

}  // namespace sage
