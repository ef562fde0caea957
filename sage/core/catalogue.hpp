// What exists: values filled by the register_* functions and owned by the application.  An entry carries code
// number, name and parameters with units, so that parser, manual and error text come from one place.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "sage/core/element.hpp"
#include "sage/core/field.hpp"
#include "sage/core/law.hpp"
#include "sage/core/linear_solver.hpp"
#include "sage/core/units.hpp"
#include "sage/core/unknown.hpp"
#include "sage/messages/error.hpp"

namespace sage {

// What a parameter is to those that judge or translate a deck without knowing its laws.
enum class ParameterRole {
  none,
  youngs_modulus,  // stress
  poissons_ratio,
  modulus,         // any other stiffness of a solid, stress
  modulus_number,  // the same as a multiple of the atmospheric pressure
  strength,        // shear or tensile, without confinement, stress; of structures a force or moment
  friction_angle,  // degrees
  unit_weight,     // of a law that has one besides the material card's
  dilation_angle,  // degrees; of the friction angle before it in the table
  tension_limit,   // stress; -1 = none
  friction_loss,   // degrees by which that friction angle falls when the pressure grows tenfold
  thickness,       // of a plate, length
};

struct Parameter {
  std::string name;  // "friction_angle"
  Dimension dimension = Dimension::none;
  std::string meaning;    // one line for the manual
  double fallback = 0.0;  // used where the deck gives fewer parameters
  bool required = true;
  ParameterRole role = ParameterRole::none;
};

// "solid", "interface", "structure of 3 components": what a law of so many components is for.
inline std::string law_words(int law_size) {
  if (law_size == 4) return "solid";
  if (law_size == 2) return "interface";
  return "structure of " + std::to_string(law_size) + (law_size == 1 ? " component" : " components");
}

// Parameters in kPa, m and degrees with which `sagefe conform` tries a law, and what it may expect of it.
struct LawTrial {
  std::vector<double> values;
  double strain = 0.01;           // an increment that takes the law well into its nonlinear range
  bool bounded = false;           // has a strength that stress_level must respect
  bool reaches_strength = true;   // with increments of that size
  bool knows_directions = false;  // as layered soil does: turned axes give another answer
};

// First values of a material that come from code of its own (SDVINI and SIGINI of a UMAT), not from the deck.
struct OwnStart {
  bool stress = false, history = false;  // what it states
  // Writes the stress (tension +) and the history of a point where they are stated; of context element, point, place
  // and size are known.  Empty where nothing is stated.  Throws AnalysisError.
  std::function<void(const PointContext& context, std::span<double> sigma, std::span<double> h)> at{};
};

// Parameters arrive as the deck writes them: degrees, compression-positive stress.
struct MaterialEntry {
  std::string name;
  std::string summary;
  int law_size = 4;  // components of stress, 1 .. kMostLawSize: of the law that `make` gives
  std::vector<Parameter> parameters;
  // Throws ParameterError.  The law has law_size components.
  std::function<LawPtr(std::span<const double> values, const UnitSystem& units)> make;
  std::span<const Quantity> history{};  // of those laws, for people: decks count it from 1
  std::vector<LawTrial> trials{};       // of laws that come in a plug-in
  // The card may give any number of parameters behind those that are listed.
  bool open_ended = false;
  // In place of `make`, for a law that goes by the name of the material.
  std::function<LawPtr(std::span<const double> values, const UnitSystem& units, const std::string& material)>
      make_for{};

  LawPtr law_for(std::span<const double> values, const UnitSystem& units, const std::string& material) const {
    return make_for ? make_for(values, units, material) : make(values, units);
  }
  // First values that a material states itself; initial cards come after them.  Empty: none does.
  std::function<OwnStart(std::span<const double> values, const std::string& material)> own_start{};
  bool flow = false;  // a law of water in soil: for elements of ElementKind::flow alone
  // A law of water in the pores of a solid: the second law of elements that solve for its pressure, of the slope of that
  // pressure and its change in the step.
  bool of_pores = false;

  bool for_solids() const { return law_size == 4; }
  // Place of a parameter on the card, from 0; -1 = there is none.  Of several of a role the first.
  int find(std::string_view parameter) const {
    for (std::size_t i = 0; i < parameters.size(); ++i)
      if (parameters[i].name == parameter) return static_cast<int>(i);
    return -1;
  }
  int find(ParameterRole role) const {
    for (std::size_t i = 0; i < parameters.size(); ++i)
      if (parameters[i].role == role) return static_cast<int>(i);
    return -1;
  }
};

inline std::string law_words(const MaterialEntry& entry) {
  return entry.flow ? "flow of water" : entry.of_pores ? "flow of pore water" : law_words(entry.law_size);
}

struct Formulation {
  int code = 0;
  std::string name;  // "b-bar"
  std::string summary;
  int points = 0;     // integration points
  bool plain = true;  // every point has its own strain; other programs mean such a one by a number of points
  // Of a line: f += what a force at xi, between -1 at its first end and 1 at its second, does to the element's dofs.
  // nullptr: loads between its nodes go to them by the shape functions of its edge.
  void (*force_at)(const NodeCoordinates& x, double xi, const Vector2& force, std::span<double> f) = nullptr;
  // Of a beam: taken for laws that are not linear, whichever the card names.
  bool yields = false;
};

// What an element is the map of.  Its corners come first among its nodes, in this order.
enum class ParentShape {
  triangle,  // (0, 0) (1, 0) (0, 1)
  square,    // (-1, -1) (1, -1) (1, 1) (-1, 1); of an interface the lower side is the bottom, the upper the top
  line,      // (-1, 0) (1, 0)
};

// The element in another program's files.
template <class Type>
struct ForeignElement {
  Type type{};               // empty: it has none; the corners are written, with a warning
  std::vector<int> nodes{};  // local numbers in that program's order; empty: all of them, in our own order
};

struct ElementEntry {
  std::string name;
  std::string summary;
  ElementKind kind = ElementKind::solid;
  ParentShape shape = ParentShape::square;
  int nodes = 0;
  int corners = 0;  // nodes beyond these are mid-side nodes on straight or curved edges, or inside
  int law_size = 4;
  // Most nodes that an element card gives.  Fewer than there are: corners and the middle nodes of the sides,
  // and the others are made.
  int card_nodes = 0;
  std::vector<std::array<double, 2>> parent_nodes{};  // place of each node in the parent shape
  std::string side_interface{};   // name of the interface whose sides fit its own; empty: there is none
  std::string folded{};           // name of what it becomes where a corner repeats the next; empty: an error
  std::string against_locking{};  // what to use in place of a formulation that locks, a clause of a warning
  ForeignElement<int> vtk{}, gmsh{};
  ForeignElement<std::string> calculix{};   // what follows CPE or CAX
  std::string calculix_reduced{};           // the same under reduced integration; empty: no other
  std::vector<Formulation> formulations{};  // the first is the default (deck code 0)
  // What is solved for at its nodes, in the order of the element's dofs: field by field, in a field node by node.
  // Empty: the displacement of every node.
  std::vector<ElementUnknown> unknowns{};
  bool extends = false;  // a structure whose axial strain is no strain but the extension itself, a length
  // Throws ParameterError for an unknown formulation code, or a geometry that it can't be in.
  std::function<std::unique_ptr<Element>(Geometry geometry, int formulation)> make{};
  // The same under large strain; nullptr for a formulation that has no such element.  Empty: none has.
  std::function<std::unique_ptr<Element>(Geometry geometry, int formulation)> make_large{};

  bool solid() const { return kind == ElementKind::solid; }
  bool interface() const { return kind == ElementKind::interface; }
  bool structure() const { return kind == ElementKind::structure; }
  bool flow() const { return kind == ElementKind::flow; }
  bool fills_area() const { return solid() || flow(); }
  // Some of its nodes are displaced; else it has neither weight nor stress.
  bool moves() const {
    return unknowns.empty() ||
           std::ranges::any_of(unknowns, [](const ElementUnknown& one) { return one.field.displacement(); });
  }
  // It solves for the excess pressure of pore water.
  bool has_pores() const {
    return std::ranges::any_of(unknowns, [](const ElementUnknown& one) { return one.field.of_pores; });
  }
  bool triangle() const { return shape == ParentShape::triangle; }
  bool square() const { return shape == ParentShape::square; }
  bool only_corners() const { return nodes == corners; }
  // Nodes beyond those of the card are made where parent_nodes wants them.
  bool makes_nodes() const { return card_nodes < nodes; }
};

// Whether one element can stand in another's place and take its cards as they are, the nodes that they lack
// made: of one of corners alone, or, for one of high degree, of any whose cards give no more than its own.
// wanted: nullptr = an unknown one.
inline bool can_replace(const ElementEntry* wanted, const ElementEntry& other) {
  if (!other.solid() || !other.square()) return false;
  return other.only_corners() || (wanted != nullptr && wanted->makes_nodes() && wanted->square() &&
                                  other.card_nodes <= wanted->card_nodes);
}

using SolverFactory = std::function<std::unique_ptr<LinearSolver>()>;

struct SolverEntry {
  std::string name;
  std::string summary;
  bool symmetric = false;
  SolverFactory make;
  // The same solver, with the same answers to the last bit, which eliminates and stores repeated parts of a matrix once
  // (the skip 'twins'); for a matrix that is factorised once.  Empty: there is none.
  SolverFactory make_with_repeats{};
};

// A value: copies share their entries until one of them adds.
template <class Entry>
class Registry {
 public:
  // Throws std::logic_error on a code or name that is taken: a mistake of the programmer, not of the user.
  void add(int code, Entry entry) {
    for (const auto& [other_code, other] : *entries_)
      if (other_code == code || other.name == entry.name)
        throw std::logic_error("catalogue: " + std::to_string(code) + " " + entry.name + " clashes with " +
                               std::to_string(other_code) + " " + other.name +
                               ": a code and a name can be taken once");
    if (entries_.use_count() > 1) entries_ = std::make_shared<std::map<int, Entry>>(*entries_);
    entries_->emplace(code, std::move(entry));
  }
  const Entry* find(int code) const {
    const auto it = entries_->find(code);
    return it == entries_->end() ? nullptr : &it->second;
  }
  // Code of the entry of that name, 0 = there is none.
  int code_of(std::string_view name) const {
    for (const auto& [code, entry] : *entries_)
      if (entry.name == name) return code;
    return 0;
  }
  // An entry that outlives the catalogue; nullptr = there is none.
  std::shared_ptr<const Entry> share(int code) const {
    const Entry* entry = find(code);
    return entry == nullptr ? nullptr : std::shared_ptr<const Entry>(entries_, entry);
  }
  const std::map<int, Entry>& entries() const { return *entries_; }
  // "1 linear_elastic, 2 duncan_chang": what an error message lists.
  std::string known() const {
    std::string text;
    for (const auto& [code, entry] : *entries_) {
      if (!text.empty()) text += ", ";
      text += std::to_string(code) + " " + entry.name;
    }
    return text;
  }

 private:
  std::shared_ptr<std::map<int, Entry>> entries_ = std::make_shared<std::map<int, Entry>>();
};

// Codes from here on are those of plug-ins.
inline constexpr int kFirstPluginCode = 1000;

// A plug-in (docs/manual/plugins.md) and what it has brought.
struct Plugin {
  std::string name, version, author, file;
  std::vector<int> elements{}, materials{}, solvers{};  // codes
  std::vector<std::string> fields{};
};

struct Catalogue {
  Registry<ElementEntry> elements;
  Registry<MaterialEntry> materials;
  Registry<SolverEntry> solvers;
  FieldTable fields;
  std::vector<Plugin> plugins{};
};

}  // namespace sage
