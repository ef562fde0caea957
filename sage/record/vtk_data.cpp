#include "sage/record/vtk_data.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sage/model/foreign_element.hpp"
#include "sage/record/end_forces.hpp"

namespace sage {

namespace {

// VTK's type of a group's cells: of their corners where it has none for the element.
int cell_type(const ElementEntry& entry) {
  if (entry.vtk.type != 0) return entry.vtk.type;
  switch (entry.shape) {
    case ParentShape::line:
      return 3;
    case ParentShape::triangle:
      return 5;
    case ParentShape::square:
      break;
  }
  return 9;
}

// Rows of `stride` numbers, of which a field's begin at `at`.
struct Rows {
  const std::vector<double>& values;
  std::size_t stride, at = 0;

  std::size_t count() const { return values.size() / stride; }
  double operator()(std::size_t row, std::size_t component) const {
    return values[row * stride + at + component];
  }
};

VtkArray array_of(const FieldEntry& field) {
  VtkArray array;
  array.name = field.arrays.empty() ? field.name : field.arrays.front();
  array.field = &field;
  return array;
}

void add_numbers(const FieldEntry& field, const Rows& rows, std::vector<VtkArray>& arrays) {
  VtkArray array = array_of(field);
  const std::size_t n = field.size();
  if (field.shape == FieldShape::tensor) array.components = {"xx", "yy", "zz", "xy", "yz", "xz"};
  if (field.shape == FieldShape::numbers)
    for (const FieldComponent& component : field.components) array.components.push_back(component.name);
  array.width = field.shape == FieldShape::tensor ? 6 : field.shape == FieldShape::vector ? 3 : n;
  std::vector<double> values(rows.count() * array.width, 0.0);
  for (std::size_t i = 0; i < rows.count(); ++i)
    for (std::size_t c = 0; c < n; ++c) values[i * array.width + c] = rows(i, c);
  array.values = std::move(values);
  arrays.push_back(std::move(array));
}

void add_field(const FieldEntry& field, const Rows& rows, std::vector<VtkArray>& arrays) {
  if (field.form == FieldForm::integer) {
    arrays.push_back(array_of(field));
    std::vector<std::int32_t> values(rows.count());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::int32_t>(rows(i, 0));
    arrays.back().values = std::move(values);
  } else if (field.arrays.size() > 1) {
    for (std::size_t c = 0; c < field.size(); ++c) {
      arrays.push_back(array_of(field));
      arrays.back().name = field.arrays[c];
      std::vector<double> values(rows.count());
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = rows(i, c);
      arrays.back().values = std::move(values);
    }
  } else {
    add_numbers(field, rows, arrays);
  }
}

// Rows of the arrays that have both ends of a structure's element as their components.
const FieldEntry& ends_field(std::size_t quantity) {
  static const std::vector<FieldEntry> rows = [] {
    std::vector<FieldEntry> all;
    for (std::size_t q = 0; q < kEndQuantities.size(); ++q) {
      FieldEntry row = end_field(q);
      row.name += "_ends";
      row.components = {{"1"}, {"2"}};
      all.push_back(std::move(row));
    }
    return all;
  }();
  return rows[quantity];
}

void add_ends(const Model& model, const Solution& s, std::vector<VtkArray>& arrays) {
  const std::vector<std::size_t> quantities = end_quantities(model);
  if (quantities.empty()) return;
  const std::size_t width = 2 * quantities.size();
  std::vector<double> rows;
  for (std::size_t g = 0; g < s.groups().size(); ++g) {
    if (!s.groups()[g].active) continue;
    const std::size_t first = rows.size();
    rows.resize(first + static_cast<std::size_t>(model.groups[g].elements()) * width,
                std::numeric_limits<double>::quiet_NaN());
    for (const ElementEnd& end : element_ends(model, s, g))
      for (std::size_t i = 0; i < quantities.size(); ++i)
        rows[first + static_cast<std::size_t>(end.element) * width + 2 * i +
             static_cast<std::size_t>(end.end - 1)] = end.value[quantities[i]];
  }
  for (std::size_t i = 0; i < quantities.size(); ++i)
    add_field(ends_field(quantities[i]), {rows, width, 2 * i}, arrays);
}

FieldList cell_fields(const Model& model, const FieldTable& table) {
  const auto shown = [&](const FieldEntry& field) {
    return std::ranges::any_of(model.groups, [&](const Group& group) {
      return applies(field, group, model.material_of(group).law_ref());
    });
  };
  FieldList fields;
  for (const FieldEntry& field : table.rows()) {
    if (field.place() != FieldPlace::point || field.shape == FieldShape::tensor) continue;
    const bool of_solids =
        applies(field, ElementKind::solid) && !field.has_law && field.element_history.empty();
    if (field.form != FieldForm::word && (of_solids || shown(field))) fields.push_back(&field);
  }
  return fields;
}

// Rows of all these fields, one behind the other.
std::vector<double> element_values(const Model& model, const Solution& s, const FieldList& fields,
                                   ThreadPool* pool) {
  std::size_t elements = 0;
  for (const GroupData& data : s.groups())
    if (data.active) elements += static_cast<std::size_t>(data.group->elements());
  std::vector<double> values(elements * size_of(fields));
  double* begin = values.data();
  for (const GroupData& data : s.groups()) {
    if (!data.active) continue;
    const Group& group = *data.group;
    const auto count = static_cast<std::size_t>(group.elements());
    in_pieces(pool, count, [&](std::size_t first, std::size_t last) {
      double* to = begin + first * size_of(fields);
      Eigen::Matrix2Xd x;
      for (std::size_t e = first; e < last; ++e) {
        element_coordinates(model.mesh, group, static_cast<int>(e), x);
        const ElementView view = element_view(model, group, static_cast<int>(e), x);
        for (const FieldEntry* field : fields) {
          read_field(*field, view, to);
          to += field->size();
        }
      }
    });
    begin += count * size_of(fields);
  }
  return values;
}

std::vector<double> node_values(const Model& model, const Solution& s, const NodalLayout& layout,
                                const FieldList& fields, ThreadPool* pool) {
  std::vector<double> values(layout.node.size() * size_of(fields));
  const NodeViews views(model, s);
  in_pieces(pool, layout.node.size(), [&](std::size_t first, std::size_t last) {
    double* to = values.data() + first * size_of(fields);
    for (std::size_t i = first; i < last; ++i) {
      const NodeView view = views.at(layout.node[i]);
      for (const FieldEntry* field : fields) {
        read_field(*field, view, to);
        if (field->shape == FieldShape::vector)
          for (std::size_t c = 0; c < field->size(); ++c)
            if (std::isnan(to[c])) to[c] = 0.0;  // the reaction where nothing is held
        to += field->size();
      }
    }
  });
  return values;
}

// One field after the other, from rows of all of them.
void add_fields(const FieldList& fields, const std::vector<double>& rows, std::vector<VtkArray>& arrays) {
  std::size_t at = 0;
  for (const FieldEntry* field : fields) {
    add_field(*field, {rows, size_of(fields), at}, arrays);
    at += field->size();
  }
}

}  // namespace

VtkGrid vtk_grid(const Model& model, const NodalLayout& layout) {
  VtkGrid grid;
  grid.points.reserve(layout.node.size() * 3);
  for (int node : layout.node)
    grid.points.insert(grid.points.end(), {model.mesh.x(0, node), model.mesh.x(1, node), 0.0});
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const std::vector<int>& entries = layout.of_group[g];
    if (entries.empty()) continue;
    const ElementEntry& entry = *model.groups[g].entry;
    const auto type = static_cast<std::uint8_t>(cell_type(entry));
    const std::vector<int> order = foreign_nodes(entry, entry.vtk);
    for (std::size_t at = 0; at < entries.size(); at += model.groups[g].node_count()) {
      for (int i : order) grid.connectivity.push_back(entries[at + static_cast<std::size_t>(i)]);
      grid.offsets.push_back(static_cast<std::int64_t>(grid.connectivity.size()));
      grid.types.push_back(type);
    }
  }
  return grid;
}

std::vector<VtkArray> vtk_point_data(const Model& model, const Solution& s, const NodalLayout& layout,
                                     const FieldTable& table, ThreadPool* pool) {
  std::vector<VtkArray> arrays;
  FieldList of_nodes, tensors;
  for (const FieldEntry& field : table.rows()) {
    if (field.place() == FieldPlace::node && field.form != FieldForm::word) of_nodes.push_back(&field);
    if (field.place() == FieldPlace::point && field.shape == FieldShape::tensor) tensors.push_back(&field);
  }
  add_fields(of_nodes, node_values(model, s, layout, of_nodes, pool), arrays);
  const std::vector<double> carried = nodal_average(model, s, layout, tensors, NodalRule::extrapolated, pool);
  const std::size_t stride = carried_size_of(tensors);
  std::size_t at = 0;
  for (const FieldEntry* field : tensors) {
    std::vector<double> values(layout.node.size() * field->size());
    for (std::size_t i = 0; i < layout.node.size(); ++i)
      value_of_carried(*field, carried.data() + i * stride + at, values.data() + i * field->size());
    add_field(*field, {values, field->size()}, arrays);
    at += carried_size(*field);
  }
  return arrays;
}

std::vector<VtkArray> vtk_cell_data(const Model& model, const Solution& s, const FieldTable& table,
                                    ThreadPool* pool) {
  std::vector<VtkArray> arrays;
  FieldList of_elements;
  for (const FieldEntry& field : table.rows())
    if (field.place() == FieldPlace::element && field.form != FieldForm::word) of_elements.push_back(&field);
  add_fields(of_elements, element_values(model, s, of_elements, pool), arrays);
  const FieldList fields = cell_fields(model, table);
  std::vector<double> rows;
  for (const GroupData& data : s.groups()) {
    if (!data.active) continue;
    const std::vector<double> more = element_average(model.mesh, data, fields, pool);
    rows.insert(rows.end(), more.begin(), more.end());
  }
  add_fields(fields, rows, arrays);
  add_ends(model, s, arrays);
  return arrays;
}

}  // namespace sage
