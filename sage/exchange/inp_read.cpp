// The mesh of an input file for Abaqus or CalculiX: nodes, elements of two dimensions, sets and surfaces.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>

#include "sage/deck/text.hpp"
#include "sage/exchange/foreign_mesh.hpp"

namespace sage {

namespace {

std::string upper(std::string_view text) {
  std::string all = lower_case(text);
  for (char& c : all)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return all;
}

// Without blanks at its ends and quotes around it.
std::string_view bare(std::string_view text) {
  text = trimmed(text);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return text;
}

// Parts between commas; those within quotes hold commas.
std::vector<std::string_view> parts_of(std::string_view line) {
  std::vector<std::string_view> parts;
  std::size_t begin = 0;
  bool quoted = false;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i < line.size() && (line[i] != ',' || quoted)) continue;
    parts.push_back(trimmed(line.substr(begin, i - begin)));
    begin = i + 1;
  }
  if (parts.size() > 1 && parts.back().empty()) parts.pop_back();  // a comma at the end
  return parts;
}

struct Keyword {
  std::string name;                               // "SOLID SECTION"
  std::map<std::string, std::string> parameters;  // upper-case names
  int line = 0;
  const std::string* find(const std::string& parameter) const {
    const auto found = parameters.find(parameter);
    return found == parameters.end() ? nullptr : &found->second;
  }
};

// A member of a set, as it stands in the file.
struct Member {
  int first = 0, last = 0, step = 1;
  std::string set;  // in place of numbers
  int line = 0;
};

struct NamedSet {
  std::string name;  // as it is written first
  std::vector<Member> members;
  bool internal = false;
  bool listed = false;  // by *NSET or *ELSET
};
using Sets = std::map<std::string, NamedSet>;  // by upper-case name

// What an element's type says: "CPE8R" is a plane element of 8 nodes.
struct TypeOfElement {
  MeshShape shape;
  MeshFamily family = MeshFamily::any;
  bool plane_stress = false;
};

std::optional<TypeOfElement> type_of(const std::string& type, const Registry<ElementEntry>& elements) {
  static const std::map<std::string, int> kLineTypes{
      {"B21", 2},  {"B23", 2},  {"B31", 2},  {"B33", 2},  {"B22", 3},  {"B32", 3},  {"T2D2", 2}, {"T3D2", 2},
      {"T2D3", 3}, {"T3D3", 3}, {"R2D2", 2}, {"B21H", 2}, {"B22H", 3}, {"B31R", 2}, {"B32R", 3}};
  if (const auto line = kLineTypes.find(type); line != kLineTypes.end())
    return TypeOfElement{{1, line->second}};
  const std::string family = type.substr(0, 3);
  if (family != "CPS" && family != "CPE" && family != "CAX") return std::nullopt;
  std::size_t end = 3;
  while (end < type.size() && is_digit(type[end])) ++end;
  const std::string nodes = type.substr(3, end - 3);
  for (const auto& [code, entry] : elements.entries())
    if (entry.solid() && !nodes.empty() && entry.calculix.type == nodes)
      return TypeOfElement{{2, entry.nodes, code, &entry},
                           family == "CAX" ? MeshFamily::axisymmetric : MeshFamily::plane,
                           family == "CPS"};
  return std::nullopt;
}

struct ReadElement {
  ForeignMeshElement element;
  TypeOfElement type;
  std::string set;  // of its card; may be empty
};

class InpReader {
 public:
  InpReader(std::string_view text, const std::string& file, const Registry<ElementEntry>& elements)
      : text_(text), file_(file), elements_(elements) {}

  ForeignMesh read() {
    while (next_line()) {
      if (line_.starts_with('*'))
        read_keyword();
      else
        read_data();
    }
    finish_element();
    if (mesh_.nodes.empty() || read_.empty())
      fail(line_number_,
           read_.empty() && !unknown_types_.empty()
               ? "no element of two dimensions was found (CPS, CPE or CAX of 3, 4, 6 or 8 nodes), only " +
                     words(unknown_types_)
               : "the file holds no mesh: *NODE and *ELEMENT were expected");
    mesh_.number_nodes();
    number_elements();
    gather_sets();
    gather_surfaces();
    make_blocks();
    note_what_is_left_out();
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(int line, const std::string& message) const {
    throw InputError("S710", {file_, line, 0, 0}, message);
  }

  // The next line that is neither blank nor a comment.
  bool next_line() {
    while (at_ < text_.size()) {
      const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
      line_ = trimmed(text_.substr(at_, end - at_));
      at_ = end;
      if (at_ < text_.size()) at_ += text_.substr(at_).starts_with("\r\n") ? 2 : 1;
      ++line_number_;
      if (!all_blank(line_) && !line_.starts_with("**")) return true;
    }
    return false;
  }

  void read_keyword() {
    finish_element();
    Keyword keyword;
    keyword.line = line_number_;
    std::string whole(line_.substr(1));
    while (whole.ends_with(',') && next_line()) whole += line_;  // goes on
    bool first = true;
    for (const std::string_view part : parts_of(whole)) {
      const std::size_t equals = part.find('=');
      const std::string name = upper(trimmed(part.substr(0, equals)));
      if (first)
        keyword.name = name;
      else
        keyword.parameters[name] =
            equals == std::string_view::npos ? "" : std::string(bare(part.substr(equals + 1)));
      first = false;
    }
    start(std::move(keyword));
  }

  void start(Keyword keyword) {
    static const std::set<std::string> kMade{"NGEN",   "NFILL",           "NCOPY",  "NMAP",     "ELGEN",
                                             "ELCOPY", "NODE GENERATION", "SYSTEM", "TRANSLATE"};
    keyword_ = std::move(keyword);
    const std::string& name = keyword_.name;
    note_assembly(name);
    if (name == "NODE" && beside_parts_) {
      keyword_.name = "NODE of *ASSEMBLY";
      left_out_.insert(keyword_.name);
      return;
    }
    if (name == "INCLUDE" || ((name == "NODE" || name == "ELEMENT") && keyword_.find("INPUT") != nullptr)) {
      const std::string* of = keyword_.find("INPUT");
      fail(keyword_.line, "*" + name + (name == "INCLUDE" ? "" : ", INPUT=") +
                              " is not supported: put the lines of " +
                              (of == nullptr || of->empty() ? "that file" : *of) + " in its place");
    }
    if (kMade.contains(name))
      fail(keyword_.line, "*" + name + " is not supported: list every node and element in x and y");
    if (name == "NODE")
      start_nodes();
    else if (name == "ELEMENT")
      start_elements();
    else if (name == "NSET" || name == "ELSET")
      start_set();
    else if (name == "SURFACE")
      start_surface();
    else if (name == "SOLID SECTION")
      start_section();
    else if (name == "INSTANCE" && ++instances_ > 1)
      fail(keyword_.line, "a second *INSTANCE is not supported: merge the parts into one mesh");
    else if (!name.empty() && name != "HEADING" && name != "PART" && name != "END PART" && name != "ASSEMBLY" &&
             name != "END ASSEMBLY" && name != "INSTANCE" && name != "END INSTANCE" && name != "PREPRINT" &&
             name != "END STEP")
      left_out_.insert(name);
  }

  // Nodes of an assembly itself are points of reference, with numbers of their own.
  void note_assembly(const std::string& name) {
    if (name == "ASSEMBLY" || name == "END INSTANCE") beside_parts_ = true;
    if (name == "INSTANCE" || name == "END ASSEMBLY") beside_parts_ = false;
  }

  const std::string& needed(const std::string& parameter) const {
    const std::string* value = keyword_.find(parameter);
    if (value == nullptr || value->empty())
      fail(keyword_.line, "*" + keyword_.name + " needs its name: " + parameter + "=NAME was expected");
    return *value;
  }

  NamedSet& set_of(Sets& sets, const std::string& name) {
    NamedSet& set = sets[upper(name)];
    if (set.name.empty()) set.name = name;
    return set;
  }

  void start_nodes() {
    if (const std::string* system = keyword_.find("SYSTEM"); system != nullptr && upper(*system) != "R")
      fail(keyword_.line, "*NODE, SYSTEM=" + *system + " is not supported: coordinates x and y were expected");
    node_set_ = keyword_.find("NSET") != nullptr ? &set_of(node_sets_, needed("NSET")) : nullptr;
  }

  void start_elements() {
    const std::string type = upper(needed("TYPE"));
    type_ = type_of(type, elements_);
    element_set_ = keyword_.find("ELSET") != nullptr ? needed("ELSET") : std::string();
    if (!element_set_.empty()) set_of(element_sets_, element_set_);
    if (!type_) unknown_types_.insert(type);
    if (!type_ || type_->family == MeshFamily::any) return;
    if (mesh_.family != MeshFamily::any && mesh_.family != type_->family)
      fail(keyword_.line,
           type + " stands beside elements of the other kind; either CPS and CPE, or CAX were expected");
    mesh_.family = type_->family;
    plane_stress_ = plane_stress_ || type_->plane_stress;
  }

  void start_set() {
    set_ = &set_of(keyword_.name == "NSET" ? node_sets_ : element_sets_, needed(keyword_.name));
    set_->listed = true;
    set_->internal = set_->internal || keyword_.find("INTERNAL") != nullptr;
    if (keyword_.find("ELSET") != nullptr && keyword_.name == "NSET")
      nodes_of_elements_.emplace_back(set_, needed("ELSET"));
  }

  void start_surface() {
    const std::string* type = keyword_.find("TYPE");
    surface_of_nodes_ = type != nullptr && upper(*type) == "NODE";
    surface_ = needed("NAME");
    surfaces_.try_emplace(surface_);
  }

  void start_section() {
    const std::string set = upper(needed("ELSET"));
    if (std::ranges::find(sections_, set) == sections_.end()) sections_.push_back(set);
  }

  void read_data() {
    const std::string& name = keyword_.name;
    if (name.empty()) fail(line_number_, "a keyword such as *NODE was expected first");
    if (name == "NODE")
      read_node();
    else if (name == "ELEMENT")
      read_element();
    else if (name == "NSET" || name == "ELSET")
      read_members();
    else if (name == "SURFACE")
      read_surface();
    else if (name == "INSTANCE")
      fail(line_number_, "an *INSTANCE that is moved is not supported: move the nodes of the part");
  }

  int whole(std::string_view text, const std::string& what) const {
    int number = 0;
    if (!read_number(text, number))
      fail(line_number_, what + " was expected, not '" + std::string(text.substr(0, 20)) + "'");
    return number;
  }

  void read_node() {
    const std::vector<std::string_view> parts = parts_of(line_);
    const int number = whole(parts[0], "the number of a node");
    if (parts.size() > 4 + 3) fail(line_number_, "a node has its number and up to three coordinates");
    std::array<double, 3> x{};
    for (std::size_t c = 0; c < 3 && c + 1 < parts.size(); ++c)
      if (!parts[c + 1].empty() && !read_number(parts[c + 1], x[c]))
        fail(line_number_, "a coordinate was expected, not '" + std::string(parts[c + 1].substr(0, 20)) + "'");
    if (parts.size() < 3) fail(line_number_, "node " + std::to_string(number) + " needs x and y");
    if (!mesh_.nodes.try_emplace(number, Vector2(x[0], x[1])).second)
      fail(line_number_, "node " + std::to_string(number) + " stands twice");
    mesh_.z[number] = x[2];
    if (node_set_ != nullptr) node_set_->members.push_back({number, number, 1, {}, line_number_});
  }

  // Numbers of an element may go on over several lines.
  void read_element() {
    if (!type_) return;
    for (const std::string_view part : parts_of(line_)) {
      if (numbers_.empty()) element_line_ = line_number_;
      numbers_.push_back(whole(part, numbers_.empty() ? "the number of an element" : "the number of a node"));
    }
    const auto wanted = static_cast<std::size_t>(type_->shape.nodes) + 1;
    // Beams in space may have one more: the node that orients them.
    if (type_->shape.dimension == 1 && numbers_.size() == wanted + 1) numbers_.pop_back();
    if (numbers_.size() < wanted) return;
    if (numbers_.size() > wanted)
      fail(line_number_, "element " + std::to_string(numbers_[0]) + " has " +
                             std::to_string(numbers_.size() - 1) + " nodes; " + std::to_string(wanted - 1) +
                             " were expected");
    read_.push_back(
        {{numbers_[0], {numbers_.begin() + 1, numbers_.end()}, element_line_}, *type_, upper(element_set_)});
    if (!element_set_.empty())
      set_of(element_sets_, element_set_).members.push_back({numbers_[0], numbers_[0], 1, {}, element_line_});
    numbers_.clear();
  }

  void finish_element() {
    if (!numbers_.empty())
      fail(element_line_, "element " + std::to_string(numbers_[0]) + " has " +
                              std::to_string(numbers_.size() - 1) + " nodes; " +
                              std::to_string(type_->shape.nodes) + " were expected");
  }

  // Within an assembly numbers may have the name of their instance before them.
  static std::string_view without_instance(std::string_view text) {
    const std::size_t point = text.rfind('.');
    return point == std::string_view::npos ? text : text.substr(point + 1);
  }

  void read_members() {
    const std::vector<std::string_view> parts = parts_of(line_);
    if (keyword_.find("GENERATE") != nullptr) {
      if (parts.size() < 2 || parts.size() > 3)
        fail(line_number_, "GENERATE needs the first number, the last and, where it is not 1, the step");
      Member range{whole(parts[0], "the first number"),
                   whole(parts[1], "the last number"),
                   parts.size() == 3 ? whole(parts[2], "the step") : 1,
                   {},
                   line_number_};
      if (range.step <= 0 || range.last < range.first)
        fail(line_number_, "the numbers of GENERATE must rise, with a step above 0");
      set_->members.push_back(range);
      return;
    }
    const bool of_part = !beside_parts_ || keyword_.find("INSTANCE") != nullptr;
    for (const std::string_view part : parts) {
      int number = 0;
      if (part.empty() || (!of_part && read_number(bare(part), number))) continue;
      if (read_number(without_instance(bare(part)), number))
        set_->members.push_back({number, number, 1, {}, line_number_});
      else
        set_->members.push_back({0, 0, 1, std::string(bare(part)), line_number_});
    }
  }

  void read_surface() {
    const std::vector<std::string_view> parts = parts_of(line_);
    surfaces_[surface_].push_back({std::string(bare(parts[0])),
                                   parts.size() > 1 ? upper(parts[1]) : std::string(), surface_of_nodes_,
                                   line_number_});
  }

  void number_elements() {
    std::map<int, int> line_of;
    for (std::size_t e = 0; e < read_.size(); ++e) {
      ForeignMeshElement& element = read_[e].element;
      if (!place_of_.try_emplace(element.number, e).second)
        fail(element.line, "element " + std::to_string(element.number) + " stands twice");
      for (int& node : element.nodes) {
        const auto found = mesh_.index.find(node);
        if (found == mesh_.index.end())
          fail(element.line, "element " + std::to_string(element.number) + ": node " + std::to_string(node) +
                                 " is not defined");
        node = found->second;
      }
      if (read_[e].type.shape.dimension == 1 && element.nodes.size() == 3)
        std::swap(element.nodes[1], element.nodes[2]);
      const ElementEntry* entry = read_[e].type.shape.element;
      if (entry == nullptr || entry->calculix.nodes.empty()) continue;
      const std::vector<int> given = element.nodes;
      for (std::size_t i = 0; i < given.size(); ++i) element.nodes[entry->calculix.nodes[i]] = given[i];
    }
  }

  // Numbers of a set and of those that it names.  Numbers that are listed must be there (elements that are left out count
  // as there), those of ranges need not.
  template <class Known>
  void add_members(const Sets& sets, const NamedSet& set, const Known& known, std::set<int>& numbers,
                   std::set<std::string>& visited) const {
    if (!visited.insert(upper(set.name)).second) return;
    for (const Member& member : set.members) {
      if (member.set.empty()) {
        const auto end = known.upper_bound(member.last);
        for (auto at = known.lower_bound(member.first); at != end; ++at)
          if ((static_cast<long>(at->first) - member.first) % member.step == 0) numbers.insert(at->first);
        continue;
      }
      const auto other = sets.find(upper(member.set));
      if (other == sets.end())
        fail(member.line, "set " + set.name + ": a number or the name of a set was expected, not '" +
                              member.set.substr(0, 40) + "'");
      add_members(sets, other->second, known, numbers, visited);
    }
  }

  template <class Known>
  std::set<int> members_of(const Sets& sets, const NamedSet& set, const Known& known) const {
    std::set<int> numbers;
    std::set<std::string> visited;
    add_members(sets, set, known, numbers, visited);
    return numbers;
  }

  void check_listed_nodes() const {
    for (const auto& [name, set] : node_sets_)
      for (const Member& member : set.members)
        if (member.set.empty() && member.first == member.last && !mesh_.index.contains(member.first))
          fail(member.line, "set " + set.name + ": node " + std::to_string(member.first) + " is not defined");
  }

  void gather_sets() {
    check_listed_nodes();
    for (const auto& [name, set] : element_sets_)
      elements_of_[name] = members_of(element_sets_, set, place_of_);
    for (const auto& [name, set] : node_sets_) {
      if (set.internal) continue;
      MeshSet& made = mesh_.sets[set.name];
      for (const int number : members_of(node_sets_, set, mesh_.index))
        made.nodes.push_back(mesh_.index.at(number));
    }
    for (const auto& [set, of] : nodes_of_elements_) {
      std::set<int> nodes;
      for (const int number : elements_of_[upper(of)]) {
        const std::vector<int>& all = read_[place_of_.at(number)].element.nodes;
        nodes.insert(all.begin(), all.end());
      }
      std::vector<int>& made = mesh_.sets[set->name].nodes;
      made.insert(made.end(), nodes.begin(), nodes.end());
    }
  }

  struct SurfacePart {
    std::string of, face;
    bool nodes = false;
    int line = 0;
  };

  void gather_surfaces() {
    for (const auto& [name, parts] : surfaces_)
      for (const SurfacePart& part : parts) {
        if (part.nodes)
          add_surface_nodes(name, part);
        else
          add_surface_edges(name, part);
      }
  }

  void add_surface_nodes(const std::string& name, const SurfacePart& part) {
    int number = 0;
    std::vector<int>& nodes = mesh_.sets[name].nodes;
    if (read_number(without_instance(part.of), number)) {
      if (!mesh_.index.contains(number)) fail(part.line, "node " + std::to_string(number) + " is not defined");
      nodes.push_back(mesh_.index.at(number));
      return;
    }
    const auto set = node_sets_.find(upper(part.of));
    if (set == node_sets_.end()) fail(part.line, "surface " + name + ": no node set " + part.of + " was found");
    for (const int one : members_of(node_sets_, set->second, mesh_.index)) nodes.push_back(mesh_.index.at(one));
  }

  void add_surface_edges(const std::string& name, const SurfacePart& part) {
    int number = 0;
    std::set<int> elements;
    if (read_number(without_instance(part.of), number))
      elements = {number};
    else if (const auto set = elements_of_.find(upper(part.of)); set != elements_of_.end())
      elements = set->second;
    else
      fail(part.line, "surface " + name + ": an element or the name of an element set was expected, not '" +
                          part.of.substr(0, 40) + "'");
    const bool face =
        part.face.size() == 2 && part.face[0] == 'S' && part.face[1] >= '1' && part.face[1] <= '4';
    if (!face)
      fail(part.line,
           "surface " + name + ": a side S1, S2, S3 or S4 was expected, not '" + part.face.substr(0, 20) + "'");
    const int side = part.face[1] - '1';
    for (const int one : elements) {
      const auto at = place_of_.find(one);
      if (at == place_of_.end()) fail(part.line, "element " + std::to_string(one) + " is not defined");
      const MeshShape& shape = read_[at->second].type.shape;
      if (shape.element == nullptr || side >= shape.element->corners)
        fail(part.line, "element " + std::to_string(one) + " has no side " + part.face);
      mesh_.sets[name].edges.emplace_back(one, side);
    }
  }

  void make_blocks() {
    const ByElement groups = groups_of_elements();
    std::map<std::pair<std::string, int>, std::size_t> block_of;  // by names and shape
    for (const ReadElement& one : read_) {
      const MeshShape& shape = one.type.shape;
      const auto found = groups.find(one.element.number);
      const std::vector<std::string> names = shape.dimension != 2    ? sets_with(one.element.number)
                                             : found == groups.end() ? std::vector<std::string>()
                                                                     : found->second;
      std::string key = std::to_string(shape.dimension);
      for (const std::string& name : names) key += "\n" + name;
      const auto [at, is_new] =
          block_of.try_emplace({key, shape.code * 100 + shape.nodes}, mesh_.blocks.size());
      if (is_new)
        mesh_.blocks.push_back({shape,
                                names,
                                names.size() > 1 ? "element " + std::to_string(one.element.number) : "elements",
                                {}});
      mesh_.blocks[at->second].elements.push_back(one.element);
    }
    for (const auto& [name, elements] : elements_of_) add_area_set(name, elements);
  }

  // The nodes of an element set serve supports.
  void add_area_set(const std::string& name, const std::set<int>& elements) {
    const std::string& written = element_sets_.at(name).name;
    if (element_sets_.at(name).internal || mesh_.sets.contains(written)) return;
    std::set<int> nodes;
    for (const int number : elements) {
      const ReadElement& one = read_[place_of_.at(number)];
      if (one.type.shape.dimension != 2) return;
      nodes.insert(one.element.nodes.begin(), one.element.nodes.end());
    }
    if (!nodes.empty()) mesh_.sets[written].nodes.assign(nodes.begin(), nodes.end());
  }

  std::vector<std::string> sets_with(int number) const {
    std::vector<std::string> names;
    for (const auto& [name, elements] : elements_of_)
      if (!element_sets_.at(name).internal && elements.contains(number))
        names.push_back(element_sets_.at(name).name);
    return names;
  }

  using ByElement = std::map<int, std::vector<std::string>>;  // names of sets

  // Which set says what group an element belongs to: that of a section; else *ELSET lists, if they hold all elements that
  // fill an area; else the set of its *ELEMENT card.
  ByElement groups_of_elements() const {
    const std::set<int> areas = area_elements();
    const ByElement by_section = names_of(sections_, areas), by_list = names_of(lists_of_groups(areas), areas);
    const bool whole =
        std::ranges::all_of(areas, [&](int one) { return by_section.contains(one) || by_list.contains(one); });
    ByElement groups;
    for (const ReadElement& one : read_) {
      const int number = one.element.number;
      const auto section = by_section.find(number), list = by_list.find(number);
      if (section != by_section.end())
        groups[number] = section->second;
      else if (list != by_list.end() && (whole || one.set.empty()))
        groups[number] = list->second;
      else if (!one.set.empty())
        groups[number] = {element_sets_.at(one.set).name};
    }
    return groups;
  }

  std::set<int> area_elements() const {
    std::set<int> areas;
    for (const ReadElement& one : read_)
      if (one.type.shape.dimension == 2) areas.insert(one.element.number);
    return areas;
  }

  ByElement names_of(const std::vector<std::string>& sets, const std::set<int>& areas) const {
    ByElement names;
    for (const std::string& set : sets)
      if (const auto found = elements_of_.find(set); found != elements_of_.end())
        for (const int number : found->second)
          if (areas.contains(number)) names[number].push_back(element_sets_.at(set).name);
    return names;
  }

  // Lists that are no part of another one.  One that holds all elements counts only where the others do not.
  std::vector<std::string> lists_of_groups(const std::set<int>& areas) const {
    std::vector<std::string> all, some;
    std::set<int> together;
    for (const auto& [name, elements] : elements_of_) {
      const NamedSet& set = element_sets_.at(name);
      if (set.internal || !set.listed || elements.empty() || !std::ranges::includes(areas, elements)) continue;
      (elements.size() == areas.size() ? all : some).push_back(name);
      if (elements.size() != areas.size()) together.insert(elements.begin(), elements.end());
    }
    if (!all.empty() && together.size() < areas.size()) return {all.front()};
    std::vector<std::string> largest;
    for (const std::string& one : some)
      if (std::ranges::none_of(some, [&](const std::string& other) { return is_part(one, other); }))
        largest.push_back(one);
    return largest;
  }

  // Of two sets with the same elements the later one is a part of the first.
  bool is_part(const std::string& one, const std::string& other) const {
    const std::set<int>&part = elements_of_.at(one), &whole = elements_of_.at(other);
    return one != other && std::ranges::includes(whole, part) && (part.size() < whole.size() || other < one);
  }

  static std::string words(const std::set<std::string>& all) {
    std::string text;
    for (const std::string& one : all) text += (text.empty() ? "" : ", ") + one;
    return text;
  }

  void note_what_is_left_out() {
    if (!unknown_types_.empty())
      mesh_.note(Severity::warning, "S713", file_,
                 "elements of the types " + words(unknown_types_) +
                     " are left out; known are CPS, CPE and CAX of 3, 4, 6 and 8 nodes, and beams and trusses "
                     "as lines");
    if (!left_out_.empty())
      mesh_.note(Severity::note, "S713", file_,
                 "only the mesh, sets and surfaces are read; left out: *" +
                     fmt::format("{}", fmt::join(left_out_, ", *")));
    if (plane_stress_)
      mesh_.note(Severity::note, "S704", file_,
                 "elements of plane stress (CPS) become elements of plane strain");
  }

  std::string_view text_;
  std::string file_;
  const Registry<ElementEntry>& elements_;
  std::size_t at_ = 0;
  std::string_view line_;
  int line_number_ = 0;

  Keyword keyword_;
  std::optional<TypeOfElement> type_;
  std::string element_set_, surface_;
  NamedSet *node_set_ = nullptr, *set_ = nullptr;
  bool surface_of_nodes_ = false, plane_stress_ = false, beside_parts_ = false;
  std::vector<int> numbers_;  // of the element that is being read
  int element_line_ = 0, instances_ = 0;

  ForeignMesh mesh_;
  std::vector<ReadElement> read_;
  std::map<int, std::size_t> place_of_;  // element number -> read_
  Sets node_sets_, element_sets_;
  std::map<std::string, std::set<int>> elements_of_;  // by upper-case name
  std::vector<std::pair<const NamedSet*, std::string>> nodes_of_elements_;
  std::map<std::string, std::vector<SurfacePart>> surfaces_;
  std::vector<std::string> sections_;  // element sets, upper case
  std::set<std::string> left_out_, unknown_types_;
};

}  // namespace

ForeignMesh read_inp(std::string_view text, const std::string& file, const Registry<ElementEntry>& elements) {
  return InpReader(text, file, elements).read();
}

}  // namespace sage
