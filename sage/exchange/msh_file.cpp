#include "sage/exchange/msh_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "sage/deck/text.hpp"
#include "sage/messages/error.hpp"

namespace sage::msh {

namespace {

// Gmsh's lines by their number of nodes.
constexpr std::array<int, 12> kLines{0, 0, 1, 8, 26, 27, 28, 62, 63, 64, 65, 66};

// Of Gmsh's element types those that a 2-D mesh of this program can hold; no nodes = not this one.
Shape shape_of(int type, const Registry<ElementEntry>& elements) {
  if (type == kPoint) return {0, 1};
  for (std::size_t nodes = 2; nodes < kLines.size(); ++nodes)
    if (kLines[nodes] == type) return {1, static_cast<int>(nodes)};
  for (const auto& [code, entry] : elements.entries())
    if (entry.solid() && entry.gmsh.type == type && type != 0) return {2, entry.nodes, code, &entry};
  return {};
}

// From Gmsh's order of an element's nodes to this program's.
void reorder(std::vector<int>& nodes, const Shape& shape) {
  if (shape.element == nullptr || shape.element->gmsh.nodes.empty()) return;
  const std::vector<int> read = nodes;
  for (std::size_t i = 0; i < read.size(); ++i)
    nodes[static_cast<std::size_t>(shape.element->gmsh.nodes[i])] = read[i];
}

// Words and numbers of the file with their line.
class Scanner {
 public:
  Scanner(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  std::string_view word() {
    skip();
    const std::size_t begin = at_;
    while (at_ < text_.size() && static_cast<unsigned char>(text_[at_]) > ' ') ++at_;
    return text_.substr(begin, at_ - begin);
  }
  bool end() {
    skip();
    return at_ >= text_.size();
  }
  template <class Number>
  Number number() {
    const std::string_view w = word();
    Number value{};
    const auto [last, error] = std::from_chars(w.data(), w.data() + w.size(), value);
    if (error != std::errc() || last != w.data() + w.size())
      fail("a number was expected, not '" + std::string(w.substr(0, 20)) + "'");
    return value;
  }
  int integer() { return number<int>(); }
  double real() { return number<double>(); }
  // How many entries follow; refuses counts that the rest of the file can't hold.
  int count() {
    const int n = integer();
    if (n < 0 || static_cast<std::size_t>(n) > text_.size())
      fail("a count of " + std::to_string(n) + " can't be");
    return n;
  }
  std::string quoted() {
    skip();
    if (at_ >= text_.size() || text_[at_] != '"') fail("a name in quotes was expected");
    const std::size_t last = text_.find('"', at_ + 1);
    if (last == std::string_view::npos) fail("the quote of a name is not closed");
    std::string name(text_.substr(at_ + 1, last - at_ - 1));
    at_ = last + 1;
    return name;
  }
  void expect(std::string_view wanted) {
    const std::string_view found = word();
    if (found != wanted)
      fail(std::string(wanted) + " was expected, not '" + std::string(found.substr(0, 20)) + "'");
  }
  void pass_section(std::string_view name) {
    const std::string mark = "$End" + std::string(name.substr(1));
    const std::size_t found = text_.find(mark, at_);
    if (found == std::string_view::npos) fail(mark + " is missing");
    while (at_ < found) line_ += text_[at_++] == '\n' ? 1 : 0;
    at_ += mark.size();
  }
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError("S710", {file_, line_, 0, 0}, message);
  }

 private:
  void skip() {
    while (at_ < text_.size() && static_cast<unsigned char>(text_[at_]) <= ' ')
      line_ += text_[at_++] == '\n' ? 1 : 0;
  }
  std::string_view text_;
  std::string file_;
  std::size_t at_ = 0;
  int line_ = 1;
};

void read_names(Scanner& in, MshFile& msh) {
  for (int i = in.count(); i > 0; --i) {
    const int dimension = in.integer(), tag = in.integer();
    msh.names[{dimension, tag}] = in.quoted();
  }
}

void read_entities(Scanner& in, MshFile& msh) {
  int counts[4];
  for (int& count : counts) count = in.count();
  for (int dimension = 0; dimension < 4; ++dimension)
    for (int i = 0; i < counts[dimension]; ++i) {
      const int tag = in.integer();
      for (int c = 0; c < (dimension == 0 ? 3 : 6); ++c) in.real();
      // A tag below zero is that of an entity turned round.
      for (int p = in.count(); p > 0; --p) msh.physical[{dimension, tag}].push_back(std::abs(in.integer()));
      if (dimension > 0)
        for (int b = in.count(); b > 0; --b) in.integer();
    }
}

using Heights = std::map<int, double>;  // z of nodes, by tag

void read_nodes(Scanner& in, MshFile& msh, Heights& heights) {
  const int blocks = in.count();
  for (int i = 0; i < 3; ++i) in.integer();
  for (int b = 0; b < blocks; ++b) {
    const int dimension = in.integer();
    in.integer();
    const int parametric = in.integer();
    std::vector<int> tags(static_cast<std::size_t>(in.count()));
    for (int& tag : tags) tag = in.integer();
    for (int tag : tags) {
      const double x = in.real(), y = in.real();
      heights[tag] = in.real();
      for (int p = 0; p < (parametric ? dimension : 0); ++p) in.real();
      if (!msh.nodes.try_emplace(tag, Vector2(x, y)).second)
        in.fail("node " + std::to_string(tag) + " stands twice");
    }
  }
  int next = 0;
  for (const auto& [tag, x] : msh.nodes) msh.index[tag] = next++;
}

void read_elements(Scanner& in, MshFile& msh, const Registry<ElementEntry>& elements) {
  const int blocks = in.count();
  for (int i = 0; i < 3; ++i) in.integer();
  for (int b = 0; b < blocks; ++b) {
    MshBlock block;
    block.entity.first = in.integer();
    block.entity.second = in.integer();
    const int type = in.integer();
    block.shape = shape_of(type, elements);
    if (block.shape.nodes == 0)
      in.fail("elements of Gmsh type " + std::to_string(type) + " have no counterpart here");
    for (int e = in.count(); e > 0; --e) {
      MshElement element;
      element.number = in.integer();
      for (int i = 0; i < block.shape.nodes; ++i) {
        const int tag = in.integer();
        const auto it = msh.index.find(tag);
        if (it == msh.index.end()) in.fail("node " + std::to_string(tag) + " is not defined");
        element.nodes.push_back(it->second);
      }
      reorder(element.nodes, block.shape);
      block.elements.push_back(std::move(element));
    }
    msh.blocks.push_back(std::move(block));
  }
}

struct Extent {
  double low = 0.0, high = 0.0;
  double size() const { return high - low; }
};

// Nodes of elements that fill an area alone: points of the geometry may lie anywhere.
std::array<Extent, 3> extents(const MshFile& msh, const std::vector<double>& z) {
  std::array<Extent, 3> all;
  bool first = true;
  std::vector<Vector2> x;
  for (const auto& [tag, place] : msh.nodes) x.push_back(place);
  for (const MshBlock& block : msh.blocks) {
    if (block.shape.dimension != 2) continue;
    for (const MshElement& element : block.elements)
      for (const int node : element.nodes) {
        const auto n = static_cast<std::size_t>(node);
        const std::array<double, 3> at{x[n].x(), x[n].y(), z[n]};
        for (std::size_t c = 0; c < 3; ++c)
          all[c] =
              first ? Extent{at[c], at[c]} : Extent{std::min(all[c].low, at[c]), std::max(all[c].high, at[c])};
        first = false;
      }
  }
  return all;
}

// The plane of the mesh must be that of x and y.
void check_plane(const MshFile& msh, const Heights& heights, const std::string& file) {
  constexpr double kFlat = 1e-9;  // of the mesh's size
  std::vector<double> z;
  for (const auto& [tag, height] : heights) z.push_back(height);
  const std::array<Extent, 3> all = extents(msh, z);
  const double size = std::max({all[0].size(), all[1].size(), all[2].size()});
  if (std::max(std::abs(all[2].low), std::abs(all[2].high)) <= kFlat * size) return;
  static constexpr std::array<const char*, 3> kNames{"y-z", "x-z", "x-y"}, kNormals{"x", "y", "z"};
  std::string where =
      "in no plane of two axes: z goes from " + number_text(all[2].low) + " to " + number_text(all[2].high);
  for (std::size_t c = 0; c < 3; ++c)
    if (all[c].size() <= kFlat * size)
      where = std::string("in the ") + kNames[c] + " plane " + kNormals[c] + " = " + rounded_text(all[c].low);
  throw InputError("S251", {file, 0, 0, 0},
                   "the mesh lies " + where + "; it must lie in the x-y plane z = 0, with y upwards");
}

// A surface belongs to one group.
void check_surfaces(const MshFile& msh, const std::string& file) {
  for (const MshBlock& block : msh.blocks) {
    const auto found = msh.physical.find(block.entity);
    if (block.shape.dimension != 2 || found == msh.physical.end() || found->second.size() < 2) continue;
    std::string names;
    for (const int physical : found->second) {
      const auto name = msh.names.find({2, physical});
      names += (names.empty() ? "" : " and ") +
               (name == msh.names.end() ? "physical " + std::to_string(physical) : "'" + name->second + "'");
    }
    throw InputError("S252", {file, 0, 0, 0},
                     "surface " + std::to_string(block.entity.second) + " belongs to " + names +
                         ", and each surface must belong to one physical group");
  }
}

}  // namespace

int line_type(std::size_t nodes) {
  return nodes < kLines.size() ? kLines[nodes] : 0;
}

MshFile read_msh(std::string_view text, const std::string& file, const Registry<ElementEntry>& elements) {
  Scanner in(text, file);
  MshFile msh;
  Heights heights;
  bool format = false;
  while (!in.end()) {
    const std::string section(in.word());
    if (section.size() < 2 || section[0] != '$') in.fail("a section ($...) was expected");
    if (section == "$MeshFormat") {
      const std::string version(in.word());
      if (version != "4.1") in.fail("MSH version " + version + ": save the mesh as version 4.1 ASCII");
      if (in.integer() != 0) in.fail("the file is binary: save the mesh as version 4.1 ASCII");
      format = true;
    } else if (!format) {
      in.fail("$MeshFormat must come first");
    } else if (section == "$PhysicalNames") {
      read_names(in, msh);
    } else if (section == "$Entities") {
      read_entities(in, msh);
    } else if (section == "$Nodes") {
      read_nodes(in, msh, heights);
    } else if (section == "$Elements") {
      read_elements(in, msh, elements);
    }
    in.pass_section(section);
  }
  if (msh.nodes.empty() || msh.blocks.empty()) in.fail("the file holds no mesh");
  check_plane(msh, heights, file);
  check_surfaces(msh, file);
  return msh;
}

}  // namespace sage::msh
