#include "sage/python/state_arrays.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <limits>

#include "sage/record/field_reader.hpp"

namespace sage::python {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

const FieldEntry& field_at_place(const FieldTable& table, const std::string& name, FieldPlace place,
                                 const char* where) {
  const FieldEntry* field = table.find(name);
  if (field != nullptr && field->place() == place) return *field;
  std::string known;
  for (const FieldEntry& row : table.rows())
    if (row.place() == place) known += (known.empty() ? "" : ", ") + row.name;
  throw py::key_error("no field " + name + " at " + where + "; there are: " + known);
}

// An empty table of rows x components, which is one-dimensional for a single number.
py::array_t<double> table_of(py::ssize_t rows, std::size_t components) {
  return components == 1
             ? py::array_t<double>(std::vector<py::ssize_t>{rows})
             : py::array_t<double>(std::vector<py::ssize_t>{rows, static_cast<py::ssize_t>(components)});
}

py::ssize_t count_points(const Model& model, ElementKind kind) {
  py::ssize_t count = 0;
  for (const Group& group : model.groups)
    if (group.entry->kind == kind) count += group.elements() * group.element->traits().points;
  return count;
}

const char* kind_word(ElementKind kind) {
  switch (kind) {
    case ElementKind::interface:
      return "interface";
    case ElementKind::structure:
      return "structure";
    case ElementKind::flow:
      return "flow";
    case ElementKind::solid:
      break;
  }
  return "solid";
}

}  // namespace

ElementKind kind_named(const std::string& name) {
  for (const ElementKind kind : kElementKinds)
    if (name == kind_word(kind)) return kind;
  throw py::key_error("no kind of elements " + name);
}

py::array read_only(py::array array) {
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

py::array node_field(const std::shared_ptr<const State>& state, const std::string& name) {
  const Model& model = *state->model;
  const Solution solution = state->frame->view();
  const py::ssize_t nodes = model.mesh.nodes();
  if (name == "displacement") {
    auto* const held = new std::shared_ptr<const State>(state);
    const py::capsule keep(held,
                           [](void* object) { delete static_cast<std::shared_ptr<const State>*>(object); });
    return read_only(py::array_t<double>(std::vector<py::ssize_t>{nodes, 2}, solution.u->data(), keep));
  }
  const FieldTable table = fields_of(model);
  const FieldEntry& field = field_at_place(table, name, FieldPlace::node, "nodes");
  py::array_t<double> values = table_of(nodes, field.size());
  double* to = values.mutable_data();
  {
    const py::gil_scoped_release unlocked;
    const NodeViews views(model, solution);
    for (int node = 0; node < nodes; ++node, to += field.size()) read_field(field, views.at(node), to);
  }
  return read_only(values);
}

py::array point_field(const std::shared_ptr<const State>& state, ElementKind kind, const std::string& name) {
  const Model& model = *state->model;
  const FieldTable table = fields_of(model);
  const FieldEntry& field = field_at_place(table, name, FieldPlace::point, "integration points");
  if (!applies(field, kind))
    throw py::key_error("the field " + name + " has no values in " + kind_word(kind) + "s");
  py::array_t<double> values = table_of(count_points(model, kind), field.size());
  double* to = values.mutable_data();
  const Solution solution = state->frame->view();
  const py::gil_scoped_release unlocked;
  for (const GroupData& data : solution.groups()) {
    if (data.group->entry->kind != kind) continue;
    const auto points = static_cast<std::size_t>(data.group->elements() * data.group->element->traits().points);
    if (!data.active || !applies(field, data)) {
      to = std::fill_n(to, points * field.size(), kNone);
      continue;
    }
    for (std::size_t point = 0; point < points; ++point, to += field.size())
      read_applying(field, PointState(model.mesh, data, point), to);
  }
  const py::gil_scoped_acquire locked;
  return read_only(values);
}

std::vector<std::string> field_names(const Model& model, FieldPlace place, ElementKind kind) {
  std::vector<std::string> names;
  const FieldTable table = fields_of(model);
  for (const FieldEntry& row : table.rows()) {
    if (row.place() != place) continue;
    if (place == FieldPlace::point && std::ranges::none_of(model.groups, [&](const Group& group) {
          return group.entry->kind == kind && applies(row, group, model.material_of(group).law_ref());
        }))
      continue;
    names.push_back(row.name);
  }
  return names;
}

std::vector<std::string> field_words(const Model& model, const std::string& name) {
  const FieldTable table = fields_of(model);
  const FieldEntry* field = table.find(name);
  return field == nullptr ? std::vector<std::string>() : field->words;
}

py::object field_unit_text(const Model& model, const std::string& name) {
  const FieldTable table = fields_of(model);
  const FieldEntry* field = table.find(name);
  if (field == nullptr) throw py::key_error("there is no field " + name);
  return py::str(unit_text(field->dimension, model.units));
}

py::array node_places(const Model& model) {
  py::array_t<double> places(std::vector<py::ssize_t>{model.mesh.nodes(), 2});
  std::copy_n(model.mesh.x.data(), model.mesh.x.size(), places.mutable_data());
  return read_only(places);
}

py::array node_numbers(const Model& model) {
  py::array_t<int> numbers(static_cast<py::ssize_t>(model.mesh.number.size()));
  std::copy(model.mesh.number.begin(), model.mesh.number.end(), numbers.mutable_data());
  return read_only(numbers);
}

py::tuple point_places(const Model& model, ElementKind kind) {
  const py::ssize_t count = count_points(model, kind);
  py::array_t<int> numbers(std::vector<py::ssize_t>{count, 3});
  py::array_t<double> places(std::vector<py::ssize_t>{count, 2});
  int* number = numbers.mutable_data();
  double* place = places.mutable_data();
  Eigen::Matrix2Xd x;
  for (const Group& group : model.groups) {
    if (group.entry->kind != kind) continue;
    for (int e = 0; e < group.elements(); ++e) {
      element_coordinates(model.mesh, group, e, x);
      for (int p = 0; p < group.element->traits().points; ++p) {
        const Vector2 at = group.element->position(x, p);
        *number++ = group.number;
        *number++ = group.element_numbers[e];
        *number++ = p + 1;
        *place++ = at.x();
        *place++ = at.y();
      }
    }
  }
  return py::make_tuple(read_only(numbers), read_only(places));
}

py::list groups_of(const Model& model) {
  py::list groups;
  for (const Group& group : model.groups) {
    const auto per_element = static_cast<py::ssize_t>(group.node_count());
    py::array_t<int> nodes(std::vector<py::ssize_t>{group.elements(), per_element});
    std::copy(group.nodes.begin(), group.nodes.end(), nodes.mutable_data());
    py::array_t<int> elements(static_cast<py::ssize_t>(group.element_numbers.size()));
    std::copy(group.element_numbers.begin(), group.element_numbers.end(), elements.mutable_data());
    py::dict one;
    one["number"] = group.number;
    one["name"] = group.name;
    one["element"] = group.entry->name;
    one["kind"] = kind_word(group.entry->kind);
    one["material"] = model.material_of(group).number;
    one["elements"] = read_only(elements);
    one["nodes"] = read_only(nodes);
    one["corners"] = group.entry->corners;
    one["points"] = group.element->traits().points;
    one["vtk_type"] = group.entry->vtk.type;
    one["vtk_nodes"] = group.entry->vtk.nodes;
    groups.append(one);
  }
  return groups;
}

}  // namespace sage::python
