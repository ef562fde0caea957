// A line of nodes through elements that water flows through, and which elements lie on its left.
#pragma once

#include <string>
#include <vector>

#include "sage/model/model.hpp"

namespace sage {

struct FlowLine {
  // A node of the line, as an element on its left has it.
  struct Corner {
    std::size_t group = 0;
    int element = 0, local = 0;  // element: index within the group
  };
  // An edge on the line, of the element on its left.
  struct Edge {
    std::size_t group = 0;
    int element = 0, edge = 0;
  };
  std::vector<Corner> corners;
  std::vector<Edge> edges;
  std::string fault;  // why there is no discharge through it; empty = there is one
};

// nodes: in the order of the line, which may be closed; nodes that refining has added may stand behind the
// others.  active: a flag a group.  At every node the line must part the elements around it, so it begins and
// ends at the edge of the flow, or is closed.
FlowLine flow_line(const Model& model, const std::vector<char>& active, const std::vector<int>& nodes);

}  // namespace sage
