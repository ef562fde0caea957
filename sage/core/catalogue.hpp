// What exists: values filled by the register_* functions and owned by the application.  An entry carries code
// number, name and parameters with units, so that parser, manual and error text come from one place.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "sage/core/element.hpp"
#include "sage/core/error.hpp"
#include "sage/core/law.hpp"
#include "sage/core/linear_solver.hpp"
#include "sage/core/units.hpp"

namespace sage {

struct Parameter {
  std::string name;  // "friction_angle"
  Dimension dimension = Dimension::none;
  std::string meaning;    // one line for the manual
  double fallback = 0.0;  // used where the deck gives fewer parameters
  bool required = true;
};

// Parameters arrive as the deck writes them: degrees, compression-positive stress.
struct MaterialEntry {
  std::string name;
  std::string summary;
  int law_size = 4;
  std::vector<Parameter> parameters;
  // Throws ParameterError.
  std::function<LawPtr(std::span<const double> values, const UnitSystem& units)> make;
};

struct Formulation {
  int code = 0;
  std::string name;  // "b-bar"
  std::string summary;
};

struct ElementEntry {
  std::string name;
  std::string summary;
  int nodes = 0;
  int corners = 0;  // nodes beyond these are mid-side nodes on straight or curved edges
  int law_size = 4;
  std::vector<Formulation> formulations;  // the first is the default (deck code 0)
  // Throws ParameterError for an unknown formulation code.
  std::function<std::unique_ptr<Element>(Geometry geometry, int formulation)> make;
};

struct SolverEntry {
  std::string name;
  std::string summary;
  bool symmetric = false;
  std::function<std::unique_ptr<LinearSolver>()> make;
};

template <class Entry>
class Registry {
 public:
  // Throws std::logic_error on a code or name that is taken: a mistake of the programmer, not of the user.
  void add(int code, Entry entry) {
    for (const auto& [other_code, other] : entries_)
      if (other_code == code || other.name == entry.name)
        throw std::logic_error("catalogue: code " + std::to_string(code) + " or name " + entry.name +
                               " is taken");
    entries_.emplace(code, std::move(entry));
  }
  const Entry* find(int code) const {
    const auto it = entries_.find(code);
    return it == entries_.end() ? nullptr : &it->second;
  }
  const std::map<int, Entry>& entries() const { return entries_; }
  // "1 linear_elastic, 2 duncan_chang": what an error message lists.
  std::string known() const {
    std::string text;
    for (const auto& [code, entry] : entries_) {
      if (!text.empty()) text += ", ";
      text += std::to_string(code) + " " + entry.name;
    }
    return text;
  }

 private:
  std::map<int, Entry> entries_;
};

struct Catalogue {
  Registry<ElementEntry> elements;
  Registry<MaterialEntry> materials;
  Registry<SolverEntry> solvers;
};

}  // namespace sage
