#include "sage/builder/lattice_mesh.hpp"

namespace sage {

int LatticeMesh::node(int i, int j) const {
  const bool middles = !element.starts_with("quad8");
  if (!middles && i % 2 == 1 && j % 2 == 1) return 0;
  const int full = 2 * columns() + 1, half = columns() + 1;
  if (middles) return j * full + i + 1;
  return (j / 2) * (full + half) + (j % 2) * full + (j % 2 == 1 ? i / 2 : i) + 1;
}

std::vector<int> LatticeMesh::row(int j) const {
  std::vector<int> nodes;
  for (int i = 0; i <= 2 * columns(); ++i)
    if (const int n = node(i, j); n > 0) nodes.push_back(n);
  return nodes;
}

std::vector<int> LatticeMesh::column(int i) const {
  std::vector<int> nodes;
  for (int j = 0; j <= 2 * rows(); ++j)
    if (const int n = node(i, j); n > 0) nodes.push_back(n);
  return nodes;
}

std::vector<int> LatticeMesh::corner_row(int j) const {
  std::vector<int> nodes;
  for (int i = 0; i <= 2 * columns(); i += 2) nodes.push_back(node(i, j));
  return nodes;
}

std::vector<int> LatticeMesh::corner_column(int i) const {
  std::vector<int> nodes;
  for (int j = 0; j <= 2 * rows(); j += 2) nodes.push_back(node(i, j));
  return nodes;
}

void LatticeMesh::write(ModelInput& input) const {
  const auto along = [](const std::vector<double>& lines, int i) {
    const auto k = static_cast<std::size_t>(i / 2);
    return i % 2 == 0 ? lines[k] : 0.5 * (lines[k] + lines[k + 1]);
  };
  for (int j = 0; j <= 2 * rows(); ++j)
    for (int i = 0; i <= 2 * columns(); ++i)
      if (node(i, j) > 0) input.nodes.push_back(place(along(x, i), along(y, j)));
  GroupInput group{.element = element, .material = 1, .elements = {}, .formulation = formulation};
  if (element != "quad8") group.second_material = 2;
  for (int j = 0; j < 2 * rows(); j += 2)
    for (int i = 0; i < 2 * columns(); i += 2) {
      const auto at = [&](int di, int dj) { return node(i + di, j + dj); };
      if (element == "tri6p3") {
        group.elements.push_back({at(0, 0), at(2, 0), at(2, 2), at(1, 0), at(2, 1), at(1, 1)});
        group.elements.push_back({at(0, 0), at(2, 2), at(0, 2), at(1, 1), at(1, 2), at(0, 1)});
        continue;
      }
      group.elements.push_back(
          {at(0, 0), at(2, 0), at(2, 2), at(0, 2), at(1, 0), at(2, 1), at(1, 2), at(0, 1)});
      if (element == "quad9p4") group.elements.back().push_back(at(1, 1));
    }
  input.groups.push_back(group);
}

std::vector<int> LatticeMesh::upper_elements() const {
  std::vector<int> numbers;
  for (int i = 0; i < columns(); ++i) {
    const int cell = (rows() - 1) * columns() + i;
    numbers.push_back(element == "tri6p3" ? 2 * cell + 2 : cell + 1);
  }
  return numbers;
}

std::vector<int> LatticeMesh::right_elements() const {
  std::vector<int> numbers;
  for (int j = 0; j < rows(); ++j) {
    const int cell = j * columns() + columns() - 1;
    numbers.push_back(element == "tri6p3" ? 2 * cell + 1 : cell + 1);
  }
  return numbers;
}

std::vector<double> graded(double a, double b, int intervals, double ratio) {
  std::vector<double> lines{a};
  double step = 1.0, sum = 0.0;
  std::vector<double> ends;
  for (int i = 0; i < intervals; ++i, step *= ratio) ends.push_back(sum += step);
  for (const double end : ends) lines.push_back(a + (b - a) * end / sum);
  lines.back() = b;
  return lines;
}

}  // namespace sage
