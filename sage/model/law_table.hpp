// Several laws for the points of a group, of which each point has one in force: parameters that vary with the place, other
// materials in later stages, bars whose force is held.  docs/decisions/0085-laws-by-point-and-stage.md
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "sage/core/calls_in_order.hpp"
#include "sage/core/law.hpp"
#include "sage/core/law_remark.hpp"
#include "sage/core/spaced_members.hpp"
#include "sage/core/start_adjustment.hpp"
#include "sage/model/model.hpp"

namespace sage {

// Optional interface of laws that hold several.
template <int N>
class ChoosesLaw {
 public:
  // From here on the law of that number (from 0) is in force at the point.  anew: its history begins with this stress
  // (tension +), which stays; else it stays as it is.  Returns false where that law cannot carry the stress.
  virtual bool choose(int law, bool anew, const Vector<N>& sigma, std::span<double> h) const = 0;

 protected:
  ~ChoosesLaw() = default;
};

template <int N>
struct NoSpacing {};
// Bars alone stand apart; all laws of a table have the spacing of the first.
struct SpacingOfFirst : SpacedMembers {
  double spacing() const override { return spacing_of_first; }
  double spacing_of_first = 1.0;
};
template <int N>
using TableSpacing = std::conditional_t<N == 1, SpacingOfFirst, NoSpacing<N>>;

// The history of a point: the quantities of all its laws, each name once; the parameters that differ between the laws,
// with their values at the point; last the number of the law in force, from 0.
template <int N>
class LawTable final : public Law<N>,
                       public PathError<N>,
                       public StartAdjustment<N>,
                       public LawRemark,
                       public CallsInOrder,
                       public ChoosesLaw<N>,
                       public TableSpacing<N> {
 public:
  // At least one variant.  Throws ParameterError of the first that its law rejects.
  LawTable(const std::vector<LawVariant>& variants, const UnitSystem& units);

  LawTraits traits() const override {
    return {.history = quantities_, .symmetric = symmetric_, .wants_context = wants_context_};
  }
  bool initialise(const Vector<N>& sigma, std::span<double> h) const override;
  bool accepts_history(const Vector<N>& sigma, std::span<const double> h) const override;
  Outcome update(const PointIn<N>& in, PointOut<N>& out) const override;
  double path_error(const PointIn<N>& in, const Vector<N>& sigma, std::span<const double> h) const override;
  std::string caution() const override { return laws_.front().law->caution(); }
  std::string remark() const override { return remark_of(*laws_.front().law); }
  bool needs_order() const override {
    return std::ranges::any_of(laws_, [](const One& one) { return sage::needs_order(*one.law); });
  }
  bool adjusts_start(const Vector<N>& sigma) const override {
    return sage::adjusts_start(*laws_.front().law, sigma);
  }
  double stress_level(const Vector<N>& sigma, std::span<const double> h) const override;
  bool choose(int law, bool anew, const Vector<N>& sigma, std::span<double> h) const override;

  // Quantities of one law at most, where they do not come first in the table's.
  static constexpr std::size_t kMostScattered = 64;

 private:
  struct One {
    std::unique_ptr<Law<N>> law;
    bool held = false;          // the stress stays whatever the strain does
    std::vector<int> places;    // of its quantities in the table's history
    bool in_order = true;       // they are the first ones
    std::vector<double> shown;  // values of the parameters that differ, as histories hold them
  };

  void add_quantities(One& one);
  void show_parameters(const std::vector<LawVariant>& variants);
  const One& in_force(std::span<const double> h) const;
  // The own part of a point's history, of which the places are given.
  static void gather(const One& one, std::span<const double> h, double* own);
  static void scatter(const One& one, const double* own, std::span<double> h);
  // call(own part of h): where that does not come first, on a copy.
  template <class Call>
  auto with_own(const One& one, std::span<const double> h, const Call& call) const;

  std::vector<One> laws_;
  std::vector<std::unique_ptr<std::string>> names_;  // of the parameters that are shown
  std::vector<Quantity> quantities_;
  std::size_t first_shown_ = 0;
  bool symmetric_ = true, wants_context_ = false;
};

// The law of a material with all that its stages, places and pore water make of it.  Throws ParameterError.
LawPtr make_law(const Material& material, const UnitSystem& units);

// The same number, name and parameters, and a law of its own.
Material twin_of(const Material& material, const UnitSystem& units);

}  // namespace sage
