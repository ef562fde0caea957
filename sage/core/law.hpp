// The interface between elements and materials.  A law sees one point: committed state in, trial state out.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "sage/core/types.hpp"
#include "sage/core/units.hpp"

namespace sage {

// What a history variable is to outputs that don't know the law.
enum class QuantityRole : std::uint8_t {
  none,
  plastic_shear_strain,   // sum of sqrt(2 de_p : de_p)
  plastic_volume_strain,  // + dilates
};

// A history variable of a law: listing, CSV, VTU, result file and restart learn its name from here and nowhere
// else.
struct Quantity {
  std::string_view name;
  Dimension dimension = Dimension::none;
  double initial = 0.0;
  QuantityRole role = QuantityRole::none;
};

// A history variable as decks and outputs write it, and back: the law's own sign, angles in degrees.
inline double outward(const Quantity& quantity, double value) {
  return quantity.dimension == Dimension::angle ? value / kRadiansPerDegree : value;
}
inline double inward(const Quantity& quantity, double value) {
  return quantity.dimension == Dimension::angle ? value * kRadiansPerDegree : value;
}

// What points remember before anything has happened.
inline std::vector<double> initial_values(std::span<const Quantity> history) {
  std::vector<double> values;
  for (const Quantity& quantity : history) values.push_back(quantity.initial);
  return values;
}

// What a point is doing; counted per step and shown in every report.
enum class PointStatus : std::uint8_t {
  elastic,    // inside its yield surface (or a law that has none)
  unloading,  // nonlinear elastic, on the unload-reload branch
  yielded,    // on the yield surface, plastic flow in this increment
  slipping,   // interface at its shear strength
  open,       // interface without contact
  apex,       // at the tip of the yield surface
  cut_off,    // at a tension limit short of the tip, or where a law gives up its stiffness in tension
};

// cut_step: no answer for this increment, a smaller one may have one.  Everything else throws.
enum class Outcome : std::uint8_t { ok, cut_step };

// Where and when a law is asked, for laws that want to know (LawTraits::wants_context).  A stage lasts as long as its
// duration says (1 where the deck says nothing); within it time runs in proportion to the load factor.
struct PointContext {
  int element = 0;                  // the deck's number
  int point = 0;                    // integration point of the element, from 0
  Vector2 place = Vector2::Zero();  // of the point: (x, y), or (r, z)
  int stage = 0;                    // from 1
  int increment = 0;                // of the stage, from 1; 0 = its start
  // At the end of the step that is tried: the durations of all stages before and this stage's part up to there.
  double time = 0.0;
  // Length of that step, from the committed state.  A step that is cut or divided is tried again with its own.
  // 0 where the committed state itself is evaluated (start of a stage, after a cut): deps is zero then too, and
  // the answer is sigma0 and h0.
  double dt = 0.0;
  double stage_start = 0.0;  // time at the beginning of the stage
  double size = 0.0;         // of the element: root of its area; of an interface or a structure its length
  // Water alone: how many times wider than it is meant a sharp change is to be taken, on the way to an answer; 1 at
  // every answer.
  double easing = 1.0;
};

// All that a law may see.  Tension positive, radians.  N = 4: [xx yy zz xy], engineering shear.
// N = 2: [shear, normal] traction and relative displacement; normal > 0 opens.
// Structures have section forces and what they do work on, first the axial force and strain: N = 1 [axial];
// N = 3 [axial, shear, bending]; N = 5 [axial, hoop, shear, bending, hoop bending].
// Laws of water in soil (MaterialEntry::flow) have N = 3: slope of the head and the head itself [h,x h,y h], and
// what the flow is against, [-v_x, -v_y, 0].
template <int N>
struct PointIn {
  Vector<N> sigma0;            // committed stress
  Vector<N> eps0;              // committed strain (relative displacement), without deps
  Vector<N> deps;              // increment since the committed state
  std::span<const double> h0;  // committed history
  // nullptr where the law does not want one.
  const PointContext* context = nullptr;
};

// All that a law must produce, every field, on every call.
template <int N>
struct PointOut {
  Vector<N> sigma;       // stress at eps0 + deps
  Matrix<N> D;           // consistent tangent d(sigma)/d(deps); may be unsymmetric
  std::span<double> h1;  // trial history, same length as h0
  PointStatus status = PointStatus::elastic;
};

// What a law is, whatever state a point is in.
struct LawTraits {
  std::span<const Quantity> history = {};  // lives as long as the law
  // D is symmetric in every state.  The choice of solver depends on it, so the default is the safe one.
  bool symmetric = false;
  // sigma = sigma0 + D deps with one constant D for ever: the scene may then skip Newton and reassembly.
  bool linear = false;
  // PointIn::context is there in every update and path_error.  Such a law is never taken for linear.
  bool wants_context = false;
};

// A constitutive law: immutable, shared by all points of a material; `update` is a pure function, which several
// threads may call at once.  Optional interfaces: PathError, and FourPointLaw (four_at_a_time.hpp).
template <int N>
class Law {
 public:
  virtual ~Law() = default;

  virtual LawTraits traits() const { return {}; }

  // Makes a history consistent with an initial stress (tension +).  h arrives with the initial values.
  // Returns false if the law cannot carry that stress (outside its yield surface): the caller reports it.
  virtual bool initialise(const Vector<N>& /*sigma*/, std::span<double> /*h*/) const { return true; }

  // Whether the law can go on from a history that the deck states, at this initial stress.  `h` is what
  // initialise() left, with the stated values in their places.
  virtual bool accepts_history(const Vector<N>& /*sigma*/, std::span<const double> /*h*/) const { return true; }

  // Allocates nothing.  deps = 0 must give back sigma0 and h0 when the state is admissible.
  virtual Outcome update(const PointIn<N>& in, PointOut<N>& out) const = 0;

  // A warning for the user about parameters that are allowed but rarely meant, empty if there is none: e.g. a
  // joint without any shear resistance.
  virtual std::string caution() const { return {}; }

  // Mobilised fraction of strength at a state, 1 = at yield/slip; 0 for laws without strength.
  virtual double stress_level(const Vector<N>& /*sigma*/, std::span<const double> /*h*/) const { return 0.0; }
};

// Optional interface of laws whose stress depends on the size of increments; a law derives from it beside Law<N>.
template <int N>
class PathError {
 public:
  // For an increment that is finished, to stress sigma and history h: about how much its stress would change,
  // relatively, if it were taken in many small ones.  An update follows the straight line of deps; at given stresses
  // the strains bend as the stiffness changes.
  virtual double path_error(const PointIn<N>& in, const Vector<N>& sigma, std::span<const double> h) const = 0;

 protected:
  ~PathError() = default;
};
// Of any law: 0 where it has no estimate.
template <int N>
double path_error(const Law<N>& law, const PointIn<N>& in, const Vector<N>& sigma, std::span<const double> h) {
  const auto* const estimate = dynamic_cast<const PathError<N>*>(&law);
  return estimate != nullptr ? estimate->path_error(in, sigma, h) : 0.0;
}

// An increment with a larger path_error (mean of its points) is taken in parts: 1 increment or 100 then agree
// within 1 %.
inline constexpr double kPathTolerance = 4e-3;
inline constexpr double kSmallestPart = 1.0 / 64.0;  // of an increment, for this reason

// Its stiffness never changes, whenever and wherever it is asked.
template <int N>
bool has_constant_stiffness(const Law<N>& law) {
  const LawTraits traits = law.traits();
  return traits.linear && !traits.wants_context;
}

using SolidLaw = Law<4>;
using InterfaceLaw = Law<2>;
// Laws of 1 to kMostLawSize components; solids and interfaces first.
using LawRef = std::variant<const SolidLaw*, const InterfaceLaw*, const Law<1>*, const Law<3>*, const Law<5>*>;
using LawPtr = std::variant<std::unique_ptr<SolidLaw>, std::unique_ptr<InterfaceLaw>, std::unique_ptr<Law<1>>,
                            std::unique_ptr<Law<3>>, std::unique_ptr<Law<5>>>;
inline constexpr int kMostLawSize = 5;

inline LawRef reference(const LawPtr& law) {
  return std::visit(
      []<class L>(const std::unique_ptr<L>& held) { return LawRef(static_cast<const L*>(held.get())); }, law);
}
// Components of stress and strain.
inline int size_of_law(const LawRef& law) {
  return std::visit([]<int N>(const Law<N>*) { return N; }, law);
}
inline std::span<const Quantity> history_of(const LawRef& law) {
  return std::visit(
      [](const auto* held) { return held == nullptr ? std::span<const Quantity>() : held->traits().history; },
      law);
}
// History of a point: the quantities of its law, then those of its element (ElementTraits::history).
struct PointHistory {
  std::span<const Quantity> law, element = {};
  std::size_t size() const { return law.size() + element.size(); }
  const Quantity& operator[](std::size_t i) const { return i < law.size() ? law[i] : element[i - law.size()]; }
};
inline bool wants_context(const LawRef& law) {
  return std::visit([](const auto* held) { return held->traits().wants_context; }, law);
}
inline bool has_constant_stiffness(const LawRef& law) {
  return std::visit([](const auto* held) { return has_constant_stiffness(*held); }, law);
}

}  // namespace sage
