// A law along a path: a row a step, as the laboratory would write it down.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sage/core/catalogue.hpp"
#include "sage/drive/lab_test.hpp"

namespace sage::drive {

// Of a history variable, at the start: its name in outputs, the law's own sign, angles in degrees.
struct FirstValue {
  std::string name;
  double value = 0.0;
};

// A law with what its curve is called and was made of.
struct Subject {
  std::string name;
  std::string words;  // "drucker_prager: youngs_modulus = 3000, ...", for files and legends
  int code = 0;       // of the catalogue
  std::shared_ptr<const MaterialEntry> entry;
  std::vector<double> values;  // parameters as decks write them, all of them
  UnitSystem units;
  double pressure = 0.0;  // stress at the start, all round; across a joint
  std::vector<FirstValue> history{};
};

// Compression positive.
struct Path {
  std::vector<double> start;  // stresses, one a component
  std::vector<Leg> legs;
  std::vector<FirstValue> history{};
  double normal_stiffness = 0.0;  // of a spring that a joint's normal stress pushes [stress/length]
  // Component whose total stress stays while the volume does, for the pore pressure; -1 = none.
  int total_stress_stays = -1;
};

struct Column {
  std::string name, unit;  // "-": a pure number
  std::vector<double> values;
};

struct Curve {
  std::string name;
  std::vector<Column> columns;  // leg and step first; history of the law last
  std::vector<PointStatus> status;
  // Empty, or where and why the path ends before its end; the last row is the last state in equilibrium.
  std::string failure;

  std::size_t rows() const { return status.size(); }
  const Column* find(std::string_view column) const;  // nullptr = there is none
};

// The law of a subject.  Throws ParameterError.
LawPtr make_law(const Subject& subject);

// Throws InputError where the law can't carry the start, or has no such path (size of the law); a path that
// can't be followed is no exception but Curve::failure.
Curve follow(const LawRef& law, const UnitSystem& units, const Path& path);
// The same of a subject: what it states of its own history (MaterialEntry::own_start) comes before that of the path.
Curve follow(const Subject& subject, const LawRef& law, Path path);

}  // namespace sage::drive
