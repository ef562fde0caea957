#include "sage/exchange/foreign_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sage/deck/text.hpp"
#include "sage/math/rounding.hpp"
#include "sage/messages/parse_number.hpp"

namespace sage {

namespace {

// Gmsh's lines by their number of nodes.
constexpr std::array<int, 12> kLines{0, 0, 1, 8, 26, 27, 28, 62, 63, 64, 65, 66};

struct Extent {
  double low = 0.0, high = 0.0;
  double size() const { return high - low; }
};

// Nodes of elements that fill an area alone: points of the geometry may lie anywhere.
std::array<Extent, 3> extents(const ForeignMesh& mesh) {
  std::vector<std::array<double, 3>> places;
  for (const auto& [number, x] : mesh.nodes) places.push_back({x.x(), x.y(), mesh.z.at(number)});
  std::array<Extent, 3> all;
  bool first = true;
  for (const MeshBlock& block : mesh.blocks) {
    if (block.shape.dimension != 2) continue;
    for (const ForeignMeshElement& element : block.elements)
      for (const int node : element.nodes) {
        const std::array<double, 3>& at = places[node];
        for (std::size_t c = 0; c < 3; ++c)
          all[c] =
              first ? Extent{at[c], at[c]} : Extent{std::min(all[c].low, at[c]), std::max(all[c].high, at[c])};
        first = false;
      }
  }
  return all;
}

// The plane of the mesh must be that of x and y, at any height.
void check_plane(ForeignMesh& mesh, const std::string& file) {
  constexpr double kFlat = rounding::kText;  // of the mesh's size
  const std::array<Extent, 3> all = extents(mesh);
  const double size = std::max({all[0].size(), all[1].size(), all[2].size()});
  if (all[2].size() <= kFlat * size) {
    if (std::abs(all[2].low) > kFlat * size)
      mesh.note(Severity::note, "S704", file,
                "all nodes have z = " + rounded_text(all[2].low) + ", which is left out");
    return;
  }
  static constexpr std::array<const char*, 3> kNames{"y-z", "x-z", "x-y"}, kNormals{"x", "y", "z"};
  std::string where =
      "in no plane of two axes: z goes from " + number_text(all[2].low) + " to " + number_text(all[2].high);
  for (std::size_t c = 0; c < 2; ++c)
    if (all[c].size() <= kFlat * size)
      where = std::string("in the ") + kNames[c] + " plane " + kNormals[c] + " = " + rounded_text(all[c].low);
  throw InputError(
      "S251", {file, 0, 0, 0},
      "the mesh lies " + where + "; it must lie in an x-y plane (one z for all nodes), with y upwards");
}

// Numbers of elements that fill an area are those of the deck's cards.
void check_numbers(const ForeignMesh& mesh, const std::string& file) {
  std::map<int, int> line_of;
  for (const MeshBlock& block : mesh.blocks)
    for (const ForeignMeshElement& element : block.elements)
      if (block.shape.dimension == 2 && !line_of.try_emplace(element.number, element.line).second)
        throw InputError(
            "S710", {file, element.line, 0, 0},
            "element " + std::to_string(element.number) + " stands twice; each needs a number of its own");
}

// An area belongs to one group.
void check_areas(const ForeignMesh& mesh, const std::string& file) {
  for (const MeshBlock& block : mesh.blocks) {
    if (block.shape.dimension != 2 || block.names.size() < 2 || block.elements.empty()) continue;
    std::string names;
    for (const std::string& name : block.names) names += (names.empty() ? "'" : " and '") + name + "'";
    throw InputError("S252", {file, block.elements.front().line, 0, 0},
                     block.otherwise + " belongs to " + names + ", and each must belong to one group");
  }
}

template <class Number>
bool parse(std::string_view text, Number& value) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const std::optional<Number> read = parse_number<Number>(text);
  value = read.value_or(value);
  return read.has_value();
}

}  // namespace

int gmsh_line_type(std::size_t nodes) {
  return nodes < kLines.size() ? kLines[nodes] : 0;
}

bool read_number(std::string_view text, int& value) {
  return parse(text, value);
}

// The exponent may have Fortran's D.
bool read_number(std::string_view text, double& value) {
  std::string copy(text.substr(0, 100));
  std::ranges::replace_if(
      copy, [](char c) { return c == 'd' || c == 'D'; }, 'e');
  return text.size() <= 100 && parse(copy, value) && std::isfinite(value);
}

void ForeignMesh::number_nodes() {
  int next = 0;
  for (const auto& [number, x] : nodes) index[number] = next++;
}

ForeignMesh read_mesh(std::string_view text, const std::string& file, const Registry<ElementEntry>& elements) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";  // of UTF-8
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  ForeignMesh mesh = first != std::string_view::npos && text[first] == '$' ? read_msh(text, file, elements)
                                                                           : read_inp(text, file, elements);
  check_plane(mesh, file);
  check_areas(mesh, file);
  check_numbers(mesh, file);
  return mesh;
}

}  // namespace sage
