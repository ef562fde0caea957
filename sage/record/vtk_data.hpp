// A state as VTK has it, for VTU files and for the result file: points, cells, and the table's fields at both.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "sage/record/nodal_values.hpp"

namespace sage {

// A node that two materials share is two points; active groups only.
struct VtkGrid {
  std::vector<double> points;                       // x y 0
  std::vector<std::int64_t> connectivity, offsets;  // offsets: of each cell's end
  std::vector<std::uint8_t> types;
};
VtkGrid vtk_grid(const Model& model, const NodalLayout& layout);

struct VtkArray {
  std::string name;
  std::size_t width = 1;                // numbers of a point or cell: 3 of a vector, 6 of a tensor
  std::vector<std::string> components;  // names; may be empty
  const FieldEntry* field = nullptr;    // of the table
  std::variant<std::vector<double>, std::vector<std::int32_t>> values;
};

// Fields of nodes; stress, strain and other tensors, extrapolated to them.  pool: threads that share the work, if there
// are; arrays do not depend on them.
std::vector<VtkArray> vtk_point_data(const Model& model, const Solution& solution, const NodalLayout& layout,
                                     const FieldTable& table, ThreadPool* pool = nullptr);
// Fields of elements, and those of integration points that are no tensors and no words: means over an element's
// points, NaN where they do not apply; and NAME_ends of structures, the values at both ends of an element.  Which
// arrays there are depends on the model alone.
std::vector<VtkArray> vtk_cell_data(const Model& model, const Solution& solution, const FieldTable& table,
                                    ThreadPool* pool = nullptr);

}  // namespace sage
