#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <unordered_map>

#include "sage/section/flat_mesh.hpp"
#include "sage/section/gmsh.hpp"

namespace sage::section {

namespace {

struct SizeOfGmsh {
  const SizeField* sizes;
  std::vector<int> area_of_surface;  // by tag
  double factor;
};

double size_for_gmsh(int dimension, int tag, double x, double y, double /*z*/, void* data) {
  const SizeOfGmsh& of = *static_cast<const SizeOfGmsh*>(data);
  const int area = dimension == 2 ? of.area_of_surface[tag] : -1;
  const Vector2 place(x, y);
  return of.factor * (area >= 0 ? of.sizes->at(place, area) : of.sizes->at(place));
}

// One run of Gmsh, from a new model to its elements.
class GmshRun {
 public:
  GmshRun(const Gmsh& gmsh, const Section& section, const Arrangement& arrangement, FlatMesh& mesh)
      : g_(gmsh), section_(section), a_(arrangement), mesh_(mesh) {
    g_.Initialize(0, nullptr, 0, &error_);
    option("General.Terminal", 0);
    option("General.NumThreads", 1);
    option("Mesh.Algorithm", 6);  // Frontal-Delaunay; 8 crashes on embedded lines
    option("Mesh.RandomSeed", 1);
    option("Mesh.ElementOrder", 1);
    option("Mesh.Optimize", 1);
    option("Mesh.MeshSizeExtendFromBoundary", 0);
    option("Mesh.MeshSizeFromPoints", 0);
    g_.ModelAdd("section", &error_);
  }
  GmshRun(const GmshRun&) = delete;
  GmshRun& operator=(const GmshRun&) = delete;
  ~GmshRun() { g_.Finalize(&error_); }

  void run(SizeOfGmsh sizes) {
    add_geometry();
    sizes.area_of_surface = area_of_surface_;
    g_.ModelMeshSetSizeCallback(size_for_gmsh, &sizes, &error_);
    g_.ModelMeshGenerate(2, &error_);
    const int failed = error_;
    g_.ModelMeshRemoveSizeCallback(&error_);
    take_nodes();
    for (std::size_t f = 0; f < a_.faces.size(); ++f)
      if (a_.faces[f].area >= 0) take_cells(f, failed != 0);
  }

 private:
  static int tag(std::size_t index) { return static_cast<int>(index) + 1; }

  void option(const char* name, double value) { g_.OptionSetNumber(name, value, &error_); }

  [[noreturn]] void fail(int area, const std::string& what) {
    char* text = nullptr;
    g_.LoggerGetLastError(&text, &error_);
    std::string reason = text != nullptr ? text : "";
    if (text != nullptr) g_.Free(text);
    throw SectionError({{"S261", SectionItem::area, area,
                         name_of(section_, SectionItem::area, area) + ": Gmsh " + what +
                             (reason.empty() ? "" : " (" + reason + ")")}});
  }

  void add_point(int node) {
    if (!points_.insert(node).second) return;
    const Vector2& x = mesh_.x[node];
    g_.ModelGeoAddPoint(x.x(), x.y(), 0.0, 0.0, tag(static_cast<std::size_t>(node)), &error_);
  }

  // Each edge on a piece is a line of Gmsh; first_line_ is the tag of a piece's first.
  void add_lines(std::size_t piece) {
    first_line_[piece] = next_line_;
    const std::vector<int>& nodes = mesh_.on_piece[piece];
    for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
      add_point(nodes[k]);
      add_point(nodes[k + 1]);
      g_.ModelGeoAddLine(tag(static_cast<std::size_t>(nodes[k])), tag(static_cast<std::size_t>(nodes[k + 1])),
                         next_line_++, &error_);
    }
  }

  std::vector<int> lines_of(Way way) const {
    const auto piece = static_cast<std::size_t>(way.piece);
    const int n = static_cast<int>(mesh_.on_piece[piece].size()) - 1;
    std::vector<int> tags;
    for (int k = 0; k < n; ++k)
      tags.push_back(way.back ? -(first_line_[piece] + n - 1 - k) : first_line_[piece] + k);
    return tags;
  }

  bool dangles(Way way) const { return a_.face_left_of(way) == a_.face_left_of({way.piece, !way.back}); }

  // The parts of a cycle that go around and come back to where they began, each passing its vertices once.
  std::vector<Cycle> simple_loops(const Cycle& cycle) const {
    std::map<int, std::vector<Way>> leaving;
    std::size_t left = 0;
    for (auto way = cycle.rbegin(); way != cycle.rend(); ++way)
      if (!dangles(*way)) leaving[a_.first_of(*way)].push_back(*way), ++left;
    std::vector<Cycle> loops;
    Cycle path;
    while (left > 0) {
      int at = -1;
      if (path.empty()) {
        for (const auto& [vertex, ways] : leaving)
          if (!ways.empty()) at = vertex;
      } else {
        at = a_.last_of(path.back());
      }
      path.push_back(leaving[at].back());
      leaving[at].pop_back();
      --left;
      const int end = a_.last_of(path.back());
      const auto begin =
          std::find_if(path.begin(), path.end(), [&](Way way) { return a_.first_of(way) == end; });
      if (begin == path.end()) continue;
      loops.emplace_back(begin, path.end());
      path.erase(begin, path.end());
    }
    return loops;
  }

  double area_of(const Cycle& loop) const {
    double twice = 0.0;
    for (const Way& way : loop) {
      const std::vector<int>& nodes = mesh_.on_piece[way.piece];
      for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
        const Vector2& origin = mesh_.x[a_.first_of(loop.front())];
        const double part = cross(mesh_.x[nodes[k]] - origin, mesh_.x[nodes[k + 1]] - origin);
        twice += way.back ? -part : part;
      }
    }
    return 0.5 * twice;
  }

  void add_face(std::size_t f) {
    const Face& face = a_.faces[f];
    std::vector<std::pair<double, int>> loops;
    std::vector<const Cycle*> cycles{&face.outer};
    for (const Cycle& cycle : face.inner) cycles.push_back(&cycle);
    std::set<int> embedded;
    for (const Cycle* cycle : cycles) {
      for (const Way& way : *cycle)
        if (dangles(way)) embedded.insert(way.piece);
      for (const Cycle& loop : simple_loops(*cycle)) {
        std::vector<int> lines;
        for (const Way& way : loop)
          for (const int line : lines_of(way)) lines.push_back(line);
        loops.emplace_back(area_of(loop), next_loop_);
        g_.ModelGeoAddCurveLoop(lines.data(), lines.size(), next_loop_++, 0, &error_);
      }
    }
    std::stable_sort(loops.begin(), loops.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<int> wires;
    face_area_.resize(a_.faces.size(), 0.0);
    for (const auto& [area, wire] : loops) {
      wires.push_back(wire);
      face_area_[f] += area;
    }
    g_.ModelGeoAddPlaneSurface(wires.data(), wires.size(), tag(f), &error_);
    embedded_.emplace_back(embedded.begin(), embedded.end());
  }

  void add_geometry() {
    first_line_.assign(a_.pieces.size(), 0);
    area_of_surface_.assign(a_.faces.size() + 1, -1);
    for (std::size_t p = 0; p < a_.pieces.size(); ++p)
      if (a_.area_left_of({static_cast<int>(p), false}) >= 0 ||
          a_.area_left_of({static_cast<int>(p), true}) >= 0)
        add_lines(p);
    std::vector<std::size_t> meshed;
    for (std::size_t f = 0; f < a_.faces.size(); ++f) {
      if (a_.faces[f].area < 0) continue;
      meshed.push_back(f);
      area_of_surface_[tag(f)] = a_.faces[f].area;
      add_face(f);
      for (const int v : a_.faces[f].vertices) add_point(v);
    }
    g_.ModelGeoSynchronize(&error_);
    for (int line = 1; line < next_line_; ++line)
      g_.ModelMeshSetTransfiniteCurve(line, 2, "Progression", 1.0, &error_);
    for (std::size_t i = 0; i < meshed.size(); ++i) embed(meshed[i], embedded_[i]);
  }

  void embed(std::size_t f, const std::vector<int>& pieces) {
    std::vector<int> lines, points;
    for (const int piece : pieces)
      for (const int line : lines_of({piece, false})) lines.push_back(line);
    for (const int v : a_.faces[f].vertices) points.push_back(tag(static_cast<std::size_t>(v)));
    if (!lines.empty()) g_.ModelMeshEmbed(1, lines.data(), lines.size(), 2, tag(f), &error_);
    if (!points.empty()) g_.ModelMeshEmbed(0, points.data(), points.size(), 2, tag(f), &error_);
  }

  void take_nodes() {
    for (const int node : points_) {
      for (const auto& [number, x] : nodes_of(0, tag(static_cast<std::size_t>(node))))
        node_of_tag_[number] = node;
    }
    for (const auto& [number, x] : nodes_of(-1, -1)) {
      if (!node_of_tag_.try_emplace(number, static_cast<int>(mesh_.x.size())).second) continue;
      mesh_.x.push_back(x);
    }
  }

  std::vector<std::pair<std::size_t, Vector2>> nodes_of(int dimension, int entity) {
    std::size_t *tags = nullptr, count = 0, coordinates = 0, parameters = 0;
    double *x = nullptr, *parameter = nullptr;
    g_.ModelMeshGetNodes(&tags, &count, &x, &coordinates, &parameter, &parameters, dimension, entity, 0, 0,
                         &error_);
    std::vector<std::pair<std::size_t, Vector2>> nodes;
    for (std::size_t i = 0; i < count; ++i) nodes.emplace_back(tags[i], Vector2(x[3 * i], x[3 * i + 1]));
    for (void* memory : {static_cast<void*>(tags), static_cast<void*>(x), static_cast<void*>(parameter)})
      if (memory != nullptr) g_.Free(memory);
    return nodes;
  }

  void take_cells(std::size_t f, bool failed) {
    int* types = nullptr;
    std::size_t kinds = 0, **elements = nullptr, *elements_n = nullptr, elements_nn = 0;
    std::size_t **nodes = nullptr, *nodes_n = nullptr, nodes_nn = 0;
    g_.ModelMeshGetElements(&types, &kinds, &elements, &elements_n, &elements_nn, &nodes, &nodes_n, &nodes_nn,
                            2, tag(f), &error_);
    double sum = 0.0;
    for (std::size_t k = 0; k < kinds; ++k)
      for (std::size_t i = 0; i + 2 < nodes_n[k]; i += 3) {
        Cell cell;
        for (std::size_t c = 0; c < 3; ++c) cell.nodes[c] = node_of_tag_.at(nodes[k][i + c]);
        cell.area = a_.faces[f].area;
        const auto x = [&](std::size_t c) { return mesh_.x[cell.nodes[c]]; };
        const double twice = cross(x(1) - x(0), x(2) - x(0));
        if (twice < 0.0) std::swap(cell.nodes[1], cell.nodes[2]);
        sum += 0.5 * std::abs(twice);
        mesh_.cells.push_back(cell);
      }
    for (std::size_t k = 0; k < elements_nn; ++k) g_.Free(elements[k]);
    for (std::size_t k = 0; k < nodes_nn; ++k) g_.Free(nodes[k]);
    for (void* memory :
         {static_cast<void*>(types), static_cast<void*>(elements), static_cast<void*>(elements_n),
          static_cast<void*>(nodes), static_cast<void*>(nodes_n)})
      if (memory != nullptr) g_.Free(memory);
    if (failed || std::abs(sum - face_area_[f]) > 1e-9 * face_area_[f])
      fail(a_.faces[f].area,
           failed ? "made no mesh" : "did not fill the area; lines may lie too close to each other");
  }

  const Gmsh& g_;
  const Section& section_;
  const Arrangement& a_;
  FlatMesh& mesh_;
  int error_ = 0;
  int next_line_ = 1, next_loop_ = 1;
  std::set<int> points_;
  std::vector<int> first_line_, area_of_surface_;
  std::vector<double> face_area_;
  std::vector<std::vector<int>> embedded_;
  std::unordered_map<std::size_t, int> node_of_tag_;
};

}  // namespace

void fill_by_gmsh(const Section& section, const Arrangement& arrangement, const SizeField& sizes, double factor,
                  FlatMesh& mesh) {
  std::string reason;
  const Gmsh* const functions = gmsh(reason);
  if (functions == nullptr)
    throw SectionError({{"S259", SectionItem::section, 0, "Gmsh can't be loaded: " + reason}});
  GmshRun(*functions, section, arrangement, mesh).run({&sizes, {}, factor});
}

}  // namespace sage::section
