// Fields of a state as arrays of numpy, in the signs and units of the outputs.
#pragma once

#include <pybind11/numpy.h>

#include <memory>
#include <string>
#include <vector>

#include "sage/python/python_model.hpp"

namespace sage::python {

// One committed state of a model.
struct State {
  std::shared_ptr<const Model> model;
  std::shared_ptr<const Frame> frame;
};

// Where a field lives in Python: "nodes", "solids", "interfaces", "structures", "flow".
ElementKind kind_named(const std::string& name);

// (nodes, components), or (nodes,) of a single number; read-only.  Rows of nodes in the order of the mesh.  A view of the
// state where nothing has to be computed (displacement), which keeps it alive.  Throws KeyError for a field that nodes lack.
py::array node_field(const std::shared_ptr<const State>& state, const std::string& name);
// (points, components), or (points,); NaN where the field has no value, as in groups that are not active.  Words (status)
// are numbers: point_words().
py::array point_field(const std::shared_ptr<const State>& state, ElementKind kind, const std::string& name);
std::vector<std::string> field_names(const Model& model, FieldPlace place, ElementKind kind);
// Words that stand for 0, 1, ... of such a field; empty for numbers.
std::vector<std::string> field_words(const Model& model, const std::string& name);
py::object field_unit_text(const Model& model, const std::string& name);

// Of the mesh: (nodes, 2) places and numbers of nodes.
py::array node_places(const Model& model);
py::array node_numbers(const Model& model);
// Rows group, element, point (numbers from 1) and the places of all points of a kind.
py::tuple point_places(const Model& model, ElementKind kind);
// A dictionary a group: number, name, element, kind, material, elements, nodes (as indices of rows), VTK's type and order.
py::list groups_of(const Model& model);

py::array read_only(py::array array);

}  // namespace sage::python
