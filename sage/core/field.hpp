// One row a quantity that results have: name, unit, where it lives, components, sign and value.  Every output -
// listing, CSV, VTU, result file, pictures, reports of points, comparisons - reads this table and knows no
// quantity of its own.  docs/manual/own_field.md says how to add a row.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "sage/core/element.hpp"
#include "sage/core/law.hpp"
#include "sage/core/units.hpp"
#include "sage/core/unknown.hpp"

namespace sage {

// What an element is to those that lay out, load, draw and report it.
enum class ElementKind {
  solid,      // fills an area; its law relates four stresses to strains
  interface,  // joins two bodies: bottom and top side at one place; its law relates two tractions to slips
  structure,  // a line with stiffness of its own (bar, beam); its law relates 1, 3 or 5 section forces to strains
  flow,       // fills an area that water flows through; its law relates the flow to the slope of the head
};
inline constexpr std::array<ElementKind, 4> kElementKinds{ElementKind::solid, ElementKind::interface,
                                                          ElementKind::structure, ElementKind::flow};

// What the value of a field may be computed from.  Numbers are as people read them: stress and strain
// compression positive, displacements and forces along +x (+r) and +y (+z), full circle in axisymmetry.
// One further unknown of a node; NaN where the node lacks the field, and where nothing holds it for `reaction`.
struct UnknownView {
  double value = 0.0, load = 0.0, reaction = 0.0;
};

struct NodeView {
  int number = 0;  // the deck's
  Vector2 place = Vector2::Zero();
  Vector2 displacement = Vector2::Zero(), load = Vector2::Zero();
  Vector2 reaction = Vector2::Zero();               // what supports do to the mesh; NaN where nothing is held
  std::array<UnknownView, kMostFields> unknowns{};  // by place in Model::unknowns; 0 is not filled in
  // What takes the whole state to find is found when a field asks for it.
  int index = 0;                                                      // within the mesh, from 0
  const std::function<double(int index)>* stream_function = nullptr;  // NaN where the flow has none
};

// An integration point.  This alone is as the law keeps it: tension positive, radians.
struct PointView {
  LawRef law;
  std::span<const double> sigma, eps, history;  // law_size, law_size, one of each Quantity of law and element
  PointStatus status = PointStatus::elastic;
  double pore_pressure = 0.0;  // of solids, compression positive, excess included
  // Of solids: effective stress [xx yy zz xy], compression positive.
  Vector4 effective = Vector4::Zero();
  std::span<const Quantity> element_history = {};  // of its element, behind those of the law
};

struct ElementView {
  int number = 0, group = 0, material = 0;  // the deck's
  const Element& element;
  const Eigen::Matrix2Xd& nodes;  // coordinates, one column a node
};

struct IncrementView {
  int stage = 0, increment = 0;  // from 1
  double load_factor = 0.0;
  bool converged = true;
  int iterations = 0, cuts = 0, substeps = 1;
  double force = 0.0, displacement = 0.0, energy = 0.0;                  // of the last iteration, relative
  std::span<const long> points;                                          // by PointStatus
  double worst_node = 0.0, worst_component = 0.0, worst_residual = 0.0;  // NaN = none
  double pivot_ratio = 0.0;                                              // NaN = not known
  double motion = 0.0;
};

// Where a field lives, and its value: as many numbers as it has components.  Between the points of an element
// stress and strain themselves are carried, and the value is made of what arrives: the deviator of a mean
// stress is no mean of deviators.  PointField's values are carried as they are.  Several threads may call.
struct DisplacementField {  // nodes
  std::function<void(const Vector2& u, double* value)> of;
};
struct NodeField {  // nodes
  std::function<void(const NodeView& node, double* value)> of;
};
struct StressField {  // points of solids; [xx yy zz xy], compression positive
  std::function<void(const Vector4& stress, double* value)> of;
};
struct StrainField {  // points of solids; [xx yy zz xy], compression positive, engineering shear
  std::function<void(const Vector4& strain, double* value)> of;
};
struct PointField {  // points of elements of the row's kind
  std::function<void(const PointView& point, double* value)> of;
};
struct ElementField {
  std::function<void(const ElementView& element, double* value)> of;
};
struct IncrementField {
  std::function<void(const IncrementView& increment, double* value)> of;
};
using FieldSource = std::variant<DisplacementField, NodeField, StressField, StrainField, PointField,
                                 ElementField, IncrementField>;

enum class FieldPlace { node, point, element, increment };
enum class FieldSign { none, compression_positive, along_axes };
// numbers: each component by itself.  vector: x, y (and z); its length is worth a picture.  tensor: xx yy zz xy.
enum class FieldShape { numbers, vector, tensor };
enum class FieldForm { number, integer, word };

struct FieldComponent {
  std::string name;                    // "xx"
  std::array<std::string, 2> label{};  // over a column for people: plane strain, axisymmetry; empty = the name
};

struct FieldEntry {
  std::string name;     // "stress"; of a component "stress_xx"
  std::string meaning;  // "mean stress p": for titles, without unit and sign
  Dimension dimension = Dimension::none;
  FieldSource value;
  std::vector<FieldComponent> components{};  // none: a single number
  FieldShape shape = FieldShape::numbers;
  FieldSign sign = FieldSign::none;
  FieldForm form = FieldForm::number;
  std::optional<ElementKind> kind{};      // PointField: of these elements only
  std::function<bool(LawRef)> has_law{};  // PointField: of these laws only
  std::string element_history{};          // PointField: of elements with this history quantity only
  bool optional = false;    // may be unknown or infinite: blank.  Otherwise such a value is an error of the run
  bool from_start = false;  // reports count it from the start of their stage
  // A mean of its values means nothing (directions): of an element it is made of the mean stress or strain.
  bool of_mean = false;
  double least = -std::numeric_limits<double>::infinity();  // where extrapolation from points to nodes stops
  std::vector<std::string> words{};                         // FieldForm::word: value 0, 1, ...
  std::vector<std::string> columns{};                       // in CSV, where they are not NAME_COMPONENT
  std::vector<std::string> arrays{};  // in VTU: another name, or an array for each component
  std::string symbol{};               // in rows of a comparison, where it is not the name

  std::size_t size() const { return components.empty() ? 1 : components.size(); }
  FieldPlace place() const;
  std::string column(std::size_t component) const;
  // For people, over a column: the component's label, or the meaning.
  const std::string& label(std::size_t component, Geometry geometry) const;
};

// "[psi], compression positive" and so on, behind a name: empty for a pure number.
std::string field_unit(const FieldEntry& entry, const UnitSystem& units);

// A field, or one component of it; of a vector without a component its length.
struct FieldChoice {
  const FieldEntry* entry = nullptr;
  int component = -1;

  bool length() const { return component < 0 && entry->size() > 1; }
};

// The rows that results have: those of the program, then those that were added.  A value: copies share their
// rows until one of them adds.
class FieldTable {
 public:
  // Throws std::logic_error on a row without a name, and on one that clashes.
  void add(FieldEntry entry);
  // The rows that clash with none of it.
  void add_free(std::span<const FieldEntry> rows);
  // The same without some of its rows.
  FieldTable without(const std::function<bool(const FieldEntry&)>& left_out) const;
  // Why results can't have the row too: its name is taken, or some file would have two columns (or tables) of one
  // name.  Empty = they can.
  std::string clash(const FieldEntry& entry) const;
  std::span<const FieldEntry> rows() const;
  // nullptr = there is none.
  const FieldEntry* find(std::string_view name) const;
  // By "stress_yy", "displacement" (its length) or "q"; nothing where there is no such field or it is no number.
  std::optional<FieldChoice> choose(std::string_view name) const;
  // "stress_xx, stress_yy, ...": what choose() takes, of fields at nodes and points.
  std::string known() const;

 private:
  std::shared_ptr<std::vector<FieldEntry>> rows_;  // null: those of the program alone
};

// Pore pressure and total stress: rows of models that have water cards.
std::vector<FieldEntry> water_fields();

// Those of the program itself, made when somebody first asks.
const std::vector<FieldEntry>& program_fields();

}  // namespace sage
