// Gmsh MSH 4.1, text and binary, and MSH 2 as text.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>

#include "sage/exchange/foreign_mesh.hpp"

namespace sage {

namespace {

// Of Gmsh's element types those that a 2-D mesh of this program can hold; no nodes = not this one.
MeshShape shape_of(int type, const Registry<ElementEntry>& elements) {
  if (type == kGmshPoint) return {0, 1};
  for (std::size_t nodes = 2; gmsh_line_type(nodes) != 0; ++nodes)
    if (gmsh_line_type(nodes) == type) return {1, static_cast<int>(nodes)};
  for (const auto& [code, entry] : elements.entries())
    if (entry.solid() && entry.gmsh.type == type && type != 0) return {2, entry.nodes, code, &entry};
  return {};
}

struct Spatial {
  int type, nodes;
  const char* name;
};
// Elements in space: counted and left out.
constexpr std::array<Spatial, 12> kSpatial{{{4, 4, "tetrahedra"},
                                            {5, 8, "hexahedra"},
                                            {6, 6, "prisms"},
                                            {7, 5, "pyramids"},
                                            {11, 10, "10-node tetrahedra"},
                                            {12, 27, "27-node hexahedra"},
                                            {13, 18, "18-node prisms"},
                                            {14, 14, "14-node pyramids"},
                                            {17, 20, "20-node hexahedra"},
                                            {18, 15, "15-node prisms"},
                                            {19, 13, "13-node pyramids"},
                                            {29, 20, "20-node tetrahedra"}}};

const Spatial* spatial(int type) {
  const auto found = std::ranges::find(kSpatial, type, &Spatial::type);
  return found == kSpatial.end() ? nullptr : &*found;
}

// From Gmsh's order of an element's nodes to this program's.
void reorder(std::vector<int>& nodes, const MeshShape& shape) {
  if (shape.element == nullptr || shape.element->gmsh.nodes.empty()) return;
  const std::vector<int> read = nodes;
  for (std::size_t i = 0; i < read.size(); ++i) nodes[shape.element->gmsh.nodes[i]] = read[i];
}

// Words and numbers of the file with their line.  In a binary file numbers are bytes, and lines end with the last word.
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
  // After the word that comes before them numbers are bytes; `on`: of this section.
  void set_binary(bool on) { binary_ = on; }
  void pass_end_of_line() {
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
    if (at_ < text_.size()) ++at_, ++line_;
  }

  int integer() { return binary_ ? bytes<std::int32_t>() : number<int>("a whole number"); }
  double real() {
    const double value = binary_ ? bytes<double>() : number<double>("a number");
    if (!std::isfinite(value)) fail("a coordinate is not finite; a number was expected");
    return value;
  }
  // Counts and the numbers of nodes and elements, 8 bytes in a binary file.
  int large() {
    if (!binary_) return number<int>("a whole number");
    const auto value = bytes<std::uint64_t>();
    if (value > static_cast<std::uint64_t>(std::numeric_limits<int>::max()))
      fail("the number " + std::to_string(value) + " is too large; at most 2147483647 was expected");
    return static_cast<int>(value);
  }
  // How many entries follow; rejects counts that the rest of the file can't hold.
  int count() {
    const int n = large();
    if (n < 0 || static_cast<std::size_t>(n) > text_.size())
      fail("a count of " + std::to_string(n) + " was found, more than the file can hold");
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
  int line() const { return line_; }
  const std::string& file() const { return file_; }

 private:
  template <class Number>
  Number number(const char* wanted) {
    const std::string_view w = word();
    Number value{};
    if (!read_number(w, value))
      fail(std::string(wanted) + " was expected, not '" + std::string(w.substr(0, 20)) + "'");
    return value;
  }
  template <class Number>
  Number bytes() {
    if (text_.size() - at_ < sizeof(Number)) fail("the file ends within binary numbers");
    Number value{};
    std::memcpy(&value, text_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  void skip() {
    while (at_ < text_.size() && static_cast<unsigned char>(text_[at_]) <= ' ')
      line_ += text_[at_++] == '\n' ? 1 : 0;
  }
  std::string_view text_;
  std::string file_;
  std::size_t at_ = 0;
  int line_ = 1;
  bool binary_ = false;
};

class MshReader {
 public:
  MshReader(std::string_view text, const std::string& file, const Registry<ElementEntry>& elements)
      : in_(text, file), elements_(elements) {}

  ForeignMesh read() {
    while (!in_.end()) {
      const std::string section(in_.word());
      if (section.size() < 2 || section[0] != '$') in_.fail("a section ($...) was expected");
      if (section != "$MeshFormat" && version_.empty()) in_.fail("$MeshFormat must come first");
      if (!read_section(section))
        in_.pass_section(section);
      else
        in_.expect("$End" + section.substr(1));
    }
    if (mesh_.nodes.empty() || mesh_.blocks.empty())
      in_.fail("the file holds no mesh: $Nodes and $Elements were expected");
    for (const auto& [type, count] : left_out_)
      mesh_.note(Severity::warning, "S713", in_.file(),
                 std::to_string(count) + " " + spatial(type)->name +
                     " are left out: they lie in space, and the model is plane");
    return std::move(mesh_);
  }

 private:
  bool old() const { return version_[0] == '2'; }

  // False for one that is passed over.
  bool read_section(const std::string& section) {
    if (section == "$MeshFormat") return read_format(), true;
    if (section == "$PhysicalNames") return read_names(), true;
    if (section == "$Nodes" && old()) return read_old_nodes(), true;
    if (section == "$Elements" && old()) return read_old_elements(), true;
    if (section != "$Entities" && section != "$Nodes" && section != "$Elements") return false;
    if (binary_) in_.pass_end_of_line();
    in_.set_binary(binary_);
    if (section == "$Entities")
      read_entities();
    else if (section == "$Nodes")
      read_nodes();
    else
      read_elements();
    in_.set_binary(false);
    return true;
  }

  void read_format() {
    version_ = in_.word();
    const bool known =
        version_ == "4.1" || version_ == "2" || version_ == "2.0" || version_ == "2.1" || version_ == "2.2";
    if (!known)
      in_.fail("MSH version " + version_.substr(0, 20) +
               " is not known; 4.1 or 2.2 was expected (gmsh -2 -format msh41)");
    binary_ = in_.integer() != 0;
    const int size = in_.integer();
    if (!binary_) return;
    if (old())
      in_.fail("the file is binary, of version " + version_ + "; version 4.1, or 2.2 as text, was expected");
    if (size != 8) in_.fail("numbers of " + std::to_string(size) + " bytes were found; 8 were expected");
    in_.pass_end_of_line();
    in_.set_binary(true);
    const int one = in_.integer();
    in_.set_binary(false);
    if (one != 1)
      in_.fail("the binary file comes from a computer with another order of bytes; save it again as text");
  }

  void read_names() {
    for (int i = in_.count(); i > 0; --i) {
      const int dimension = in_.integer(), tag = in_.integer();
      names_[{dimension, tag}] = in_.quoted();
    }
  }

  std::string name_of(int dimension, int physical) const {
    const auto name = names_.find({dimension, physical});
    return name == names_.end() || name->second.empty() ? "physical " + std::to_string(physical) : name->second;
  }

  // A tag below zero is that of an entity turned round.
  int unsigned_tag() {
    const int tag = in_.integer();
    if (tag == std::numeric_limits<int>::min()) in_.fail("a tag below -2147483647 was found");
    return std::abs(tag);
  }

  void read_entities() {
    int counts[4];
    for (int& count : counts) count = in_.count();
    for (int dimension = 0; dimension < 4; ++dimension)
      for (int i = 0; i < counts[dimension]; ++i) {
        const int tag = in_.integer();
        for (int c = 0; c < (dimension == 0 ? 3 : 6); ++c) in_.real();
        for (int p = in_.count(); p > 0; --p) physical_[{dimension, tag}].push_back(unsigned_tag());
        if (dimension > 0)
          for (int b = in_.count(); b > 0; --b) in_.integer();
      }
  }

  void add_node(int number) {
    const double x = in_.real(), y = in_.real();
    mesh_.z[number] = in_.real();
    if (!mesh_.nodes.try_emplace(number, Vector2(x, y)).second)
      in_.fail("node " + std::to_string(number) + " stands twice");
  }

  void read_nodes() {
    const int blocks = in_.count();
    for (int i = 0; i < 3; ++i) in_.large();
    for (int b = 0; b < blocks; ++b) {
      const int dimension = in_.integer();
      in_.integer();
      const int parametric = in_.integer();
      std::vector<int> tags(static_cast<std::size_t>(in_.count()));
      for (int& tag : tags) tag = in_.large();
      for (const int tag : tags) {
        add_node(tag);
        for (int p = 0; p < (parametric != 0 ? dimension : 0); ++p) in_.real();
      }
    }
    mesh_.number_nodes();
  }

  void read_old_nodes() {
    for (int i = in_.count(); i > 0; --i) add_node(in_.integer());
    mesh_.number_nodes();
  }

  // The shape of a type; without nodes for elements in space, which are passed over.
  MeshShape known_shape(int type) {
    const MeshShape shape = shape_of(type, elements_);
    if (shape.nodes == 0 && spatial(type) == nullptr)
      in_.fail("elements of Gmsh type " + std::to_string(type) +
               " have no counterpart here; points, lines, triangles and quadrilaterals were expected");
    return shape;
  }

  ForeignMeshElement read_nodes_of(int number, const MeshShape& shape) {
    ForeignMeshElement element{number, {}, binary_ ? 0 : in_.line()};
    for (int i = 0; i < shape.nodes; ++i) {
      const int tag = in_.large();
      const auto it = mesh_.index.find(tag);
      if (it == mesh_.index.end()) in_.fail("node " + std::to_string(tag) + " is not defined");
      element.nodes.push_back(it->second);
    }
    reorder(element.nodes, shape);
    return element;
  }

  void pass_spatial(int type, int elements) {
    left_out_[type] += elements;
    for (int i = elements; i > 0; --i)
      for (int n = 0; n <= spatial(type)->nodes; ++n) in_.large();
  }

  void read_elements() {
    const int blocks = in_.count();
    for (int i = 0; i < 3; ++i) in_.large();
    for (int b = 0; b < blocks; ++b) {
      const int dimension = in_.integer(), entity = in_.integer(), type = in_.integer();
      MeshBlock block{known_shape(type), {}, "surface " + std::to_string(entity), {}};
      int elements = in_.count();
      if (block.shape.nodes == 0) {
        pass_spatial(type, elements);
        continue;
      }
      if (const auto found = physical_.find({dimension, entity}); found != physical_.end())
        for (const int tag : found->second) block.names.push_back(name_of(dimension, tag));
      for (; elements > 0; --elements) {
        const int number = in_.large();
        block.elements.push_back(read_nodes_of(number, block.shape));
      }
      mesh_.blocks.push_back(std::move(block));
    }
  }

  // An element with several physical groups stands once for each of them, under numbers of its own.
  void read_old_elements() {
    std::map<std::array<int, 3>, std::size_t> place;  // type, physical group and surface -> block
    std::map<std::vector<int>, std::pair<int, int>> physical_of;
    for (int i = in_.count(); i > 0; --i) {
      const int number = in_.integer(), type = in_.integer();
      std::array<int, 2> tags{};  // physical group, surface
      const int given = in_.count();
      for (int t = 0; t < given; ++t) {
        const int tag = unsigned_tag();
        if (t < 2) tags[t] = tag;
      }
      const MeshShape shape = known_shape(type);
      if (shape.nodes == 0) {
        ++left_out_[type];
        for (int n = 0; n < spatial(type)->nodes; ++n) in_.integer();
        continue;
      }
      ForeignMeshElement element = read_nodes_of(number, shape);
      if (shape.dimension == 2) check_once(element, tags[0], physical_of);
      const auto [at, is_new] =
          place.try_emplace({type, tags[0], tags[0] != 0 ? 0 : tags[1]}, mesh_.blocks.size());
      if (is_new) {
        mesh_.blocks.push_back({shape, {}, "surface " + std::to_string(tags[1]), {}});
        if (tags[0] != 0) mesh_.blocks.back().names.push_back(name_of(shape.dimension, tags[0]));
      }
      mesh_.blocks[at->second].elements.push_back(std::move(element));
    }
  }

  void check_once(const ForeignMeshElement& element, int physical,
                  std::map<std::vector<int>, std::pair<int, int>>& physical_of) {
    std::vector<int> nodes = element.nodes;
    std::ranges::sort(nodes);
    const auto [at, is_new] = physical_of.try_emplace(nodes, element.number, physical);
    if (is_new) return;
    const std::string both = "'" + name_of(2, at->second.second) + "' and '" + name_of(2, physical) + "'";
    throw InputError("S252", {in_.file(), in_.line(), 0, 0},
                     "elements " + std::to_string(at->second.first) + " and " + std::to_string(element.number) +
                         " have the same nodes, in " + both + ", and each must belong to one group");
  }

  using EntityKey = std::pair<int, int>;  // dimension, tag
  Scanner in_;
  const Registry<ElementEntry>& elements_;
  ForeignMesh mesh_;
  std::string version_;
  bool binary_ = false;
  std::map<EntityKey, std::string> names_;          // of physical groups
  std::map<EntityKey, std::vector<int>> physical_;  // entity -> physical tags
  std::map<int, int> left_out_;                     // by type
};

}  // namespace

ForeignMesh read_msh(std::string_view text, const std::string& file, const Registry<ElementEntry>& elements) {
  return MshReader(text, file, elements).read();
}

}  // namespace sage
