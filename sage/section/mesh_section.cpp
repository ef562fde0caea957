#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sage/section/flat_mesh.hpp"

namespace sage {

namespace section {

namespace {

// More elements than this are an error in a size, not a wish.
constexpr double kMostElements = 2e6;
// Edges of a circle, at least, and where lines pass close to it.
constexpr double kEdgesOfCircle = 16.0, kMostEdgesOfCircle = 1000.0;

[[noreturn]] void refuse(Code code, SectionItem item, int index, const std::string& message) {
  throw SectionError({{code, item, index, message}});
}

class Making {
 public:
  Making(const Section& section, const MeshSettings& settings) : section_(section), settings_(settings) {}

  SectionMesh make() {
    Faults faults;
    check_data(section_, faults);
    check_settings();
    if (faults.empty()) arrangement_ = arrange(section_, {}, faults);
    if (!faults.empty()) throw SectionError(faults);
    edges_of_circle_.assign(arrangement_.pieces.size(), kEdgesOfCircle);
    bool by_gmsh = !fill();
    for (std::vector<const Cell*> bad = bad_cells(); !bad.empty(); bad = bad_cells()) {
      if (!refine_arcs_at(bad)) refuse_cell(*bad.front());
      by_gmsh = !fill();
    }
    SectionMesh mesh = split(section_, arrangement_, mesh_);
    mesh.by_gmsh = by_gmsh;
    return mesh;
  }

 private:
  bool quadrilaterals() const { return section_.shape == ElementShape::quadrilateral; }

  void check_settings() const {
    if (!(settings_.size_factor > 0.0 && std::isfinite(settings_.size_factor)) ||
        !(settings_.growth > 0.0 && settings_.growth <= 1.0))
      refuse("S254", SectionItem::section, 0,
             fmt::format("sizes need a positive factor and a growth from 0 to 1, not {} and {}",
                         settings_.size_factor, settings_.growth));
  }

  // True if the tree's own means made the mesh.
  bool fill() {
    const bool first_blocks =
        settings_.mesher == Mesher::blocks || (settings_.mesher == Mesher::automatic && quadrilaterals());
    int area = 0;
    if (first_blocks && fill_as_blocks(area)) return true;
    std::string reason;
    if (settings_.mesher == Mesher::gmsh ||
        (settings_.mesher == Mesher::automatic && gmsh_available(&reason))) {
      fill_with_gmsh();
      return false;
    }
    if (!first_blocks && fill_as_blocks(area)) return true;
    if (fill_with_cuts()) return true;
    refuse("S259", SectionItem::area, area,
           name_of(section_, SectionItem::area, area) +
               ": without Gmsh an area needs four sides and as many pieces on opposite sides, or all lines "
               "must be "
               "horizontal or vertical" +
               (reason.empty() ? "" : "; Gmsh can't be loaded: " + reason));
  }

  bool fill_as_blocks(int& area) {
    const SizeField sizes = sizes_now();
    const std::vector<int> edges = edges_of_blocks(arrangement_, edges_by_size(arrangement_, sizes, 1.0), area);
    if (edges.empty()) return false;
    mesh_ = divide(arrangement_, sizes, edges, true);
    fill_blocks(arrangement_, mesh_, !quadrilaterals());
    return true;
  }

  bool fill_with_cuts() {
    const std::vector<Curve> cuts = cuts_through(arrangement_);
    if (cuts.empty()) return false;
    Faults faults;
    Arrangement cut = arrange(section_, cuts, faults);
    if (!faults.empty()) return false;
    std::swap(arrangement_, cut);
    edges_of_circle_.assign(arrangement_.pieces.size(), kEdgesOfCircle);
    int area = 0;
    return fill_as_blocks(area);
  }

  void fill_with_gmsh() {
    const double factor = quadrilaterals() ? 2.0 : 1.0;
    SizeField sizes = sizes_now();
    do {
      sizes = sizes_now();
      mesh_ = divide(arrangement_, sizes, edges_by_size(arrangement_, sizes, factor), false);
    } while (refine(crossed_arcs(arrangement_, mesh_)));
    fill_by_gmsh(section_, arrangement_, sizes, factor, mesh_);
    if (!quadrilaterals()) return;
    join_triangles(arrangement_, mesh_);
    mesh_ = into_quadrilaterals(arrangement_, mesh_);
    smooth(mesh_, arrangement_.vertices.size());
  }

  SizeField sizes_now() const {
    SizeField sizes(section_, arrangement_, settings_, edges_of_circle_);
    const double elements = sizes.elements(arrangement_);
    if (!(elements < kMostElements))
      refuse("S262", SectionItem::section, 0,
             fmt::format("the sizes ask for about {:.2g} elements; at most {:.0g} are made", elements,
                         kMostElements));
    return sizes;
  }

  std::vector<const Cell*> bad_cells() const {
    std::vector<const Cell*> bad;
    for (const Cell& cell : mesh_.cells)
      if (worst_corner(mesh_, cell) <= 1e-3) bad.push_back(&cell);
    return bad;
  }

  // Where a line passes closer to an arc than its edges bulge, shorter edges find their place between them.
  bool refine_arcs_at(const std::vector<const Cell*>& cells) {
    std::vector<char> among(mesh_.x.size(), 0);
    for (const Cell* cell : cells)
      for (const int node : cell->nodes)
        if (node >= 0) among[node] = 1;
    std::vector<int> arcs;
    for (std::size_t p = 0; p < arrangement_.pieces.size(); ++p) {
      const std::vector<int>& nodes = mesh_.on_piece[p];
      const auto is_among = [&](int node) { return among[node] != 0; };
      if (arrangement_.pieces[p].curve.arc && std::any_of(nodes.begin(), nodes.end(), is_among))
        arcs.push_back(static_cast<int>(p));
    }
    return refine(arcs);
  }

  // False where they are short enough already.
  bool refine(const std::vector<int>& arcs) {
    bool any = false;
    for (const int p : arcs) {
      double& edges = edges_of_circle_[p];
      if (edges > kMostEdgesOfCircle) continue;
      edges *= 2.0;
      any = true;
    }
    return any;
  }

  [[noreturn]] void refuse_cell(const Cell& cell) const {
    refuse("S263", SectionItem::area, cell.area,
           name_of(section_, SectionItem::area, cell.area) + " can't be meshed around " +
               text_of(mesh_.x[cell.nodes[0]]) +
               ": an element there has no area or is turned inside out; smaller sizes there may help");
  }

  const Section& section_;
  const MeshSettings& settings_;
  Arrangement arrangement_;
  FlatMesh mesh_;
  std::vector<double> edges_of_circle_;  // by piece
};

}  // namespace

}  // namespace section

SectionMesh mesh_section(const Section& section, const MeshSettings& settings) {
  return section::Making(section, settings).make();
}

}  // namespace sage
