#include "sage/drive/curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "sage/math/rounding.hpp"
#include "sage/messages/error.hpp"

namespace sage::drive {

namespace {

constexpr double kRounding =
    rounding::kStrength;  // of the largest stress: such a difference of stresses is none

// Compression + to tension +, and back; 0.0 - : no -0.
double turned(double value) {
  return 0.0 - value;
}

// sigma_1 - sigma_3 of [xx yy zz xy].
double stress_difference(const Vector4& s) {
  const double mean = 0.5 * (s[0] + s[1]), radius = std::hypot(0.5 * (s[0] - s[1]), s[3]);
  return std::max(mean + radius, s[2]) - std::min(mean - radius, s[2]);
}

// q = sqrt(3 J2).
double deviator(const Vector4& s) {
  const double p = s.head<3>().mean();
  const Vector<3> d = s.head<3>().array() - p;
  return std::sqrt(1.5 * (d.squaredNorm() + 2.0 * s[3] * s[3]));
}

// Collects a row a call; the columns are made by the first.
class Rows {
 public:
  Rows(Curve& curve, const UnitSystem& units) : curve_(curve), units_(units) {}
  void begin() { next_ = 0; }
  void put(std::string_view name, Dimension dimension, double value) {
    if (next_ == curve_.columns.size())
      curve_.columns.push_back({std::string(name), unit_text(dimension, units_), {}});
    curve_.columns[next_++].values.push_back(value);
  }

 private:
  Curve& curve_;
  const UnitSystem& units_;
  std::size_t next_ = 0;
};

void put_measures(Rows& rows, const PointDriver<4>& point, const Vector4& start, const Path& path) {
  const Vector4 &sigma = point.sigma(), &eps = point.eps();
  rows.put("volume_strain", Dimension::none, turned(eps.head<3>().sum()));
  rows.put("mean_stress", Dimension::stress, turned(sigma.head<3>().mean()));
  rows.put("deviator", Dimension::stress, deviator(sigma));
  rows.put("axial_deviator", Dimension::stress, sigma[0] - sigma[1]);
  rows.put("stress_difference", Dimension::stress, stress_difference(sigma));
  if (const int i = path.total_stress_stays; i >= 0) {
    const double change = sigma[i] - start[i], rounding = kRounding * sigma.cwiseAbs().maxCoeff();
    rows.put("pore_pressure", Dimension::stress, std::abs(change) <= rounding ? 0.0 : change);
  }
}
void put_measures(Rows&, const PointDriver<2>&, const Vector2&, const Path&) {}

template <int N>
void put_row(Rows& rows, Curve& curve, const Law<N>& law, const PointDriver<N>& point, const Vector<N>& start,
             const Path& path, std::array<int, 2> leg_and_step) {
  const Dimension length = N == 2 ? Dimension::length : Dimension::none;
  rows.begin();
  rows.put("leg", Dimension::none, leg_and_step[0]);
  rows.put("step", Dimension::none, leg_and_step[1]);
  for (int i = 0; i < N; ++i) rows.put(strain_column(N, i), length, turned(point.eps()[i]));
  for (int i = 0; i < N; ++i) rows.put(stress_column(N, i), Dimension::stress, turned(point.sigma()[i]));
  put_measures(rows, point, start, path);
  rows.put("stress_level", Dimension::none, point.stress_level());
  const std::span<const Quantity> history = law.traits().history;
  for (std::size_t i = 0; i < history.size(); ++i)
    rows.put(history[i].name, history[i].dimension, outward(history[i], point.history()[i]));
  curve.status.push_back(point.status());
}

// Where a step ends, share = step/steps of the leg from `eps` and `sigma`.
template <int N>
Vector<N> target_of(const Leg& leg, double share, const Vector<N>& eps, const Vector<N>& sigma,
                    const PointDriver<N>& point) {
  Vector<N> target;
  for (int i = 0; i < N; ++i) {
    const Goal& goal = leg.goals[i];
    const double end = std::isnan(goal.value) ? eps[i] : turned(goal.value);
    target[i] = goal.control == Control::strain ? eps[i] + share * (end - eps[i]) - point.eps()[i]
                                                : sigma[i] + share * (end - sigma[i]);
  }
  return target;
}

template <int N>
std::array<Control, N> controls_of(const Leg& leg) {
  std::array<Control, N> controls{};
  for (std::size_t i = 0; i < N; ++i) controls[i] = leg.goals[i].control;
  return controls;
}

// The stress that the spring gives for its displacement since the start of the path stands in for the target.
template <int N>
void push_spring(const Path& path, const PointDriver<N>& point, Vector<N>& target) {
  if constexpr (N == 2)
    if (path.normal_stiffness > 0.0) target[1] -= path.normal_stiffness * point.eps()[1];
}

// False where a step can't be followed.
template <int N>
bool follow_leg(PointDriver<N>& point, const Law<N>& law, const Path& path, int number, const Vector<N>& start,
                Rows& rows, Curve& curve) {
  const Leg& leg = path.legs[static_cast<std::size_t>(number) - 1];
  const Vector<N> eps = point.eps();
  // A spring's base: what stays when its displacement is taken back.
  Vector<N> sigma = point.sigma(), springs = Vector<N>::Zero();
  if constexpr (N == 2) {
    springs[1] = leg.goals[1].control == Control::stress ? path.normal_stiffness : 0.0;
    sigma[1] += springs[1] * eps[1];
  }
  for (int step = 1; step <= leg.steps; ++step) {
    Vector<N> target = target_of<N>(leg, static_cast<double>(step) / leg.steps, eps, sigma, point);
    if (springs.any()) push_spring<N>(path, point, target);
    const int parts = point.steps();
    try {
      point.advance(controls_of<N>(leg), target, leg.duration / leg.steps, springs);
    } catch (const AnalysisError& error) {
      if (point.steps() > parts) put_row<N>(rows, curve, law, point, start, path, {number, step});
      curve.failure = fmt::format("ends in leg {}, step {} of {}: {}", number, step, leg.steps, error.what());
      return false;
    }
    put_row<N>(rows, curve, law, point, start, path, {number, step});
  }
  return true;
}

// One a quantity of the law; NaN: as the law has it.
template <int N>
std::vector<double> first_history(const Law<N>& law, const std::vector<FirstValue>& given) {
  if (given.empty()) return {};
  const std::span<const Quantity> quantities = law.traits().history;
  std::vector<double> values(quantities.size(), std::nan(""));
  for (const FirstValue& one : given) {
    const auto found =
        std::ranges::find_if(quantities, [&](const Quantity& quantity) { return quantity.name == one.name; });
    if (found == quantities.end()) {
      std::string known;
      for (const Quantity& quantity : quantities)
        known += (known.empty() ? "" : ", ") + std::string(quantity.name);
      throw InputError("S651", {},
                       fmt::format("the law has no history variable {}; it has {}", one.name,
                                   known.empty() ? "none" : known));
    }
    values[found - quantities.begin()] = inward(*found, one.value);
  }
  return values;
}

template <int N>
Curve follow_law(const Law<N>& law, const UnitSystem& units, const Path& path) {
  if (path.start.size() != N)
    throw InputError("S650", {}, fmt::format("the path has {} components, the law {}", path.start.size(), N));
  Vector<N> start;
  for (int i = 0; i < N; ++i) start[i] = turned(path.start[i]);
  Curve curve;
  Rows rows(curve, units);
  const std::vector<double> history = first_history<N>(law, path.history);
  std::unique_ptr<PointDriver<N>> point;
  try {
    point = std::make_unique<PointDriver<N>>(law, start, history);
  } catch (const AnalysisError&) {
    throw InputError(
        "S650", {},
        history.empty()
            ? "the law can't carry the stress at the start of the path (it lies beyond its strength)"
            : "the law can't carry the stress at the start of the path with this history");
  }
  put_row<N>(rows, curve, law, *point, start, path, {0, 0});
  for (int leg = 1; leg <= static_cast<int>(path.legs.size()); ++leg)
    if (!follow_leg<N>(*point, law, path, leg, start, rows, curve)) break;
  return curve;
}

}  // namespace

const Column* Curve::find(std::string_view column) const {
  for (const Column& one : columns)
    if (one.name == column) return &one;
  return nullptr;
}

LawPtr make_law(const Subject& subject) {
  return subject.entry->law_for(subject.values, subject.units, subject.name);
}

namespace {

std::vector<FirstValue> own_history(const Subject& subject, const LawRef& law) {
  if (!subject.entry->own_start) return {};
  const OwnStart start = subject.entry->own_start(subject.values, subject.name);
  if (!start.history) return {};
  std::vector<double> sigma(static_cast<std::size_t>(size_of_law(law)));
  const std::span<const Quantity> quantities = history_of(law);
  std::vector<double> h = initial_values(quantities);
  start.at({.element = 1, .stage = 1, .size = 1.0}, sigma, h);
  std::vector<FirstValue> values;
  for (std::size_t i = 0; i < h.size(); ++i)
    values.push_back({std::string(quantities[i].name), outward(quantities[i], h[i])});
  return values;
}

}  // namespace

Curve follow(const Subject& subject, const LawRef& law, Path path) {
  const std::vector<FirstValue> own = own_history(subject, law);
  path.history.insert(path.history.begin(), own.begin(), own.end());
  return follow(law, subject.units, path);
}

Curve follow(const LawRef& law, const UnitSystem& units, const Path& path) {
  return std::visit(
      [&]<int N>(const Law<N>* held) -> Curve {
        if constexpr (N == 2 || N == 4)
          return follow_law<N>(*held, units, path);
        else
          throw InputError("S651", {}, "laws of structures are not driven, those of solids and interfaces are");
      },
      law);
}

}  // namespace sage::drive
