#include "materials/modified_cam_clay.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "materials/stress_measures.hpp"
#include "sage/math/exp_and_log.hpp"

namespace sage {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kOnSurface = 1e-12;  // of p_c: what rounding leaves outside
constexpr double kIsotropic = 1e-13;  // of p_c: a deviator below has no direction
// Corrections of the angle that are small enough, beside its sine: near both ends of the surface the deviator or the mean
// stress is as small as the sine.
constexpr double kAngle = 1e-12;
constexpr double kAngleDigits = 1e-7;  // a last correction of Newton's method, which doubles the digits
constexpr int kRounds = 200;
constexpr double kNearSurface = 1e-10;  // of ln(level)
constexpr double kMostStrain = 100.0;   // change of volume that a current v can follow
constexpr double kMostGrowth = 200.0;   // of ln p: a third of what numbers hold
constexpr double kFar = 0.05;  // difference of ln p or s/p where extrapolation loses half of its weight
constexpr double kFloorStiffness =
    1e-3;  // of the bulk modulus, where the mean stress is held at its least value
constexpr double kUsualFloor = 1e-4;
constexpr double kLargestFloor = 0.25;
constexpr double kConvex = 0.6;  // van Eekelen's shape: ratio of M in extension and compression

const std::vector<Parameter>& rows() {
  static const std::vector<Parameter> table{
      required("M", Dimension::none, "q/p at the critical state in triaxial compression"),
      required("lambda", Dimension::none, "slope of the normal compression line, v against ln p"),
      required("kappa", Dimension::none, "slope of unloading lines, v against ln p"),
      required("specific_volume", Dimension::none, "specific volume v = 1 + e at the start"),
      required("poissons_ratio", Dimension::none, "Poisson's ratio; not used where shear_modulus is given",
               ParameterRole::poissons_ratio),
      optional("ocr", Dimension::none,
               "p_c at the start over the p_c of a surface through the initial stress; 0 = not given", 0.0),
      optional("pop", Dimension::stress, "the difference of those two; 0 = not given", 0.0),
      optional("p_c", Dimension::stress, "p_c at the start; 0 = not given; one of ocr, pop, p_c is", 0.0),
      optional("deviatoric_shape", Dimension::none, "0 circle, 1 Matsuoka-Nakai, 2 van Eekelen", 0.0),
      optional("current_volume", Dimension::none,
               "0 stiffness from the first specific volume, 1 from the current one", 0.0),
      optional("shear_modulus", Dimension::stress, "constant shear modulus; 0 = from Poisson's ratio", 0.0,
               ParameterRole::modulus),
      optional("pressure_floor", Dimension::none, "least mean stress as a share of the first p_c", kUsualFloor),
  };
  return table;
}

void expect_one_start(const Parameters& p) {
  int given = 0;
  for (const char* const name : {"ocr", "pop", "p_c"}) given += p.not_negative(name) > 0.0 ? 1 : 0;
  if (given == 0)
    p.refuse("ocr", "must be at least 1, or pop or p_c must be above 0: one says where p_c starts");
  if (given > 1)
    p.refuse(p.number("pop") > 0.0 ? "pop" : "p_c", "must be 0 where another of ocr, pop, p_c is given");
}

CamClay clay_of(const Parameters& p) {
  CamClay clay{};
  clay.M = p.between("M", 0.0, 3.0);
  clay.lambda = p.positive("lambda");
  clay.kappa = p.positive("kappa");
  if (!(clay.kappa < clay.lambda)) p.refuse("kappa", "must be below lambda");
  if (!(p.number("specific_volume") > 1.0)) p.refuse("specific_volume", "must be greater than 1 (it is 1 + e)");
  clay.v0 = p.number("specific_volume");
  clay.G = p.not_negative("shear_modulus");
  clay.nu = p.poissons_ratio("poissons_ratio");
  expect_one_start(p);
  clay.ocr = p.number("ocr");
  if (clay.ocr != 0.0 && clay.ocr < 1.0) p.refuse("ocr", "must be at least 1");
  clay.pop = p.number("pop");
  clay.p_c = p.number("p_c");
  clay.shape = static_cast<DeviatoricShape>(p.code("deviatoric_shape", {0, 1, 2}));
  clay.current_volume = p.code("current_volume", {0, 1}) == 1;
  clay.floor = p.number("pressure_floor");
  if (!(clay.floor > 0.0 && clay.floor <= kLargestFloor))
    p.refuse("pressure_floor", "must be above 0 and at most 0.25");
  if (!(clay.M > 0.0) || clay.M >= 3.0) p.refuse("M", "must be above 0 and below 3 (90 degrees of friction)");
  return clay;
}

LawPtr make(std::span<const double> values, const UnitSystem& units) {
  return std::make_unique<ModifiedCamClay>(clay_of(Parameters(rows(), values, units)));
}

double sine_of_friction(double M) {
  return 3.0 * M / (6.0 + M);
}
double van_eekelen_ratio(double M) {
  const double sine = sine_of_friction(M);
  return (3.0 - sine) / (3.0 + sine);
}

// The mean of exp over [0, x], (exp(x) - 1)/x, and its derivative.
struct MeanExp {
  double value, slope;
};
MeanExp mean_exp(double x) {
  if (std::abs(x) < 0.01)
    return {1.0 + x * (1.0 / 2 + x * (1.0 / 6 + x * (1.0 / 24 + x * (1.0 / 120 + x / 720)))),
            1.0 / 2 + x * (1.0 / 3 + x * (1.0 / 8 + x * (1.0 / 30 + x * (1.0 / 144 + x / 840))))};
  const double less_1 = exp_less_1(x), mean = less_1 / x;
  return {mean, (less_1 - mean + 1.0) / x};
}

// q = sqrt(3 J2) of a deviator.
double q_of(const Vector4& s) {
  return std::sqrt(1.5 * contract(s, s));
}
double J3_of(const Vector4& s) {
  return s[2] * (s[0] * s[1] - s[3] * s[3]);
}
// sin(3 theta) of a deviator, tension +: 1 in triaxial compression, -1 in extension.
double lode_of(double J3, double q) {
  return std::clamp(-13.5 * J3 / (q * q * q), -1.0, 1.0);
}
// Its derivative with respect to the deviator, in tensor components; the mean may be anything.
Vector4 lode_gradient(const Vector4& s, double q) {
  const Vector4 square(s[0] * s[0] + s[3] * s[3], s[1] * s[1] + s[3] * s[3], s[2] * s[2], s[3] * (s[0] + s[1]));
  return -13.5 / (q * q * q) * (square - 4.5 * J3_of(s) / (q * q) * s);
}

// a such that a.b is a:b of two tensors.
Vector4 work_row(const Vector4& a) {
  return {a[0], a[1], a[2], 2.0 * a[3]};
}

// Square of the difference of ln p and s/p; over kFar^2 it is what extrapolation is weighted by.
double square_difference(double log_p, const Vector4& ratio) {
  return log_p * log_p + contract(ratio, ratio);
}
double weight_of(double square) {
  return 1.0 / (1.0 + square / (kFar * kFar));
}

constexpr double kCritical = 1.0;
// q/(M p) of a place on the surface, from p/p_c.
double height_at(double share) {
  return std::sqrt(std::max(1.0 / share - 1.0, 0.0));
}

const Vector4 kVolumeRate(-1.0, -1.0, -1.0, 0.0);  // of the volume, compression positive, by the strain

}  // namespace

// A state, and how it changes with the strain increment of the whole update (rates: a row for each quantity).
struct ModifiedCamClay::Point {
  Vector4 s = Vector4::Zero();  // deviator
  Matrix4 s_rate = Matrix4::Zero();
  double p = 0.0, p_c = 0.0, v = 0.0;  // v: specific volume
  double log_p = 0.0, log_c = 0.0;     // ln of p and p_c over the p at the start of the update
  Vector4 log_p_rate = Vector4::Zero(), log_c_rate = Vector4::Zero(), log_v_rate = Vector4::Zero();
  double log_least = 0.0;  // of the least p, likewise
  double shear = 0.0, plastic_volume = 0.0;
  PointStatus status = PointStatus::elastic;
  bool at_floor = false;
  double height = kCritical;  // q/(M p) of the place on the surface, for the first guess of the next one
  double kappa = 0.0;         // of the step that led here
  bool has_rates = true;      // false: they are left out

  Vector4 ratio() const { return s / p; }
};

// Which share of the update's increment a step takes, and how that changes with the increment.
struct ModifiedCamClay::Part {
  double share = 1.0;
  Vector4 rate = Vector4::Zero();
};

// A step from a point on.  Volume is compression positive.
struct ModifiedCamClay::Step {
  const Point& from;
  Vector4 e;                     // deviator of the strain increment, tensor components
  double length, along, across;  // |e|, and the parts of the deviator s at the start along e and normal to it
  Matrix4 e_rate;
  double volume;
  Vector4 volume_rate;
  double share, log_share,
      square;             // at the start: p/p_c, its ln, and the square of q/(M p) of a surface through there
  double kappa, harden;   // kappa/v and (lambda - kappa)/v, v the mean over the step
  Vector4 stiffer;        // rate of ln v
  double elastic_growth;  // ln(p/p0) of an elastic step, without the floor
  Vector4 elastic_growth_rate;
};

Vector4 ModifiedCamClay::trial_of(const Step& step, double G) {
  return step.from.s + 2.0 * G * step.e;
}

// A place on the surface: p = p_c cos^2(angle/2), q = M p_c sin(angle)/2, and what the flow rule lacks there.
// angle = pi/2 is the critical state.  Of an elastic trial only growth and what set_trial() sets are there.
struct ModifiedCamClay::OnSurface {
  double height, sine, cosine;            // height: q/(M p) = tan(angle/2)
  double share, log_share;                // p/p_c and its ln
  double log_share_rate;                  // this rate and the next are by the angle
  double hardening, hardening_rate;       // ln(p_c/p_c0)
  double x;                               // plastic change of volume
  double p_c, growth, G, G_by_growth, q;  // growth: ln(p/p0)
  double q_trial, q_by_G;                 // of the elastic deviator s + 2 G e
  Slope slope;
  double M_by_G;
  double lack, lack_rate;  // 3 G x sin(angle) - M cos(angle) (q_trial - q)
  double by_G;             // rate of what is lacking by G
  bool at_floor;
  bool has_direction;  // the trial deviator is no rounding
};

struct ModifiedCamClay::ElasticTrial {
  OnSurface at;
  double p, level;
};

// An increment that leaves the surface, in one step and in two.
struct ModifiedCamClay::PlasticIncrement {
  Point once, middle, twice;  // middle: after the first of the two
  bool smooth;                // both are plastic throughout
};

ModifiedCamClay::ModifiedCamClay(const CamClay& clay) : clay_(clay) {
  by_bulk_ = 1.5 * (1.0 - 2.0 * clay.nu) / (1.0 + clay.nu);
  const double sine = sine_of_friction(clay.M), m = van_eekelen_ratio(clay.M);
  const double k = (9.0 - sine * sine) / (1.0 - sine * sine);
  const double a = (k / 3.0 - 1.0) / (k - 9.0);
  width_ = 2.0 * std::sqrt(a / 3.0);
  skew_ = std::min(k / (27.0 * (k - 9.0)) / std::pow(a / 3.0, 1.5), 1.0);
  m4_ = std::pow(m, 4);
}

LawTraits ModifiedCamClay::traits() const {
  return {.history = kHistory};
}

// Matsuoka and Nakai: 1/M is the largest root of w^3 - a w + skew 2 (a/3)^(3/2) sin(3 theta) = 0.
ModifiedCamClay::Slope ModifiedCamClay::slope(double lode) const {
  switch (clay_.shape) {
    case DeviatoricShape::matsuoka_nakai: {
      const double sine = skew_ * lode, third = std::acos(-sine) / 3.0, M = 1.0 / (width_ * std::cos(third));
      const double cosine = std::sqrt(std::max(1.0 - sine * sine, 1e-12));
      return {M, M * std::tan(third) * skew_ / (3.0 * cosine)};
    }
    case DeviatoricShape::van_eekelen: {
      const double below = 1.0 + m4_ - (1.0 - m4_) * lode;
      const double M = clay_.M * std::pow(2.0 * m4_ / below, 0.25);
      return {M, 0.25 * M * (1.0 - m4_) / below};
    }
    case DeviatoricShape::circle:
      break;
  }
  return {clay_.M, 0.0};
}

// p_c of the surface through a stress; infinite where its mean is no compression.
double ModifiedCamClay::size_through(const Vector4& sigma) const {
  const double p = -mean_stress(sigma);
  if (!(p > 0.0)) return kInfinite;
  const Vector4 s = deviator(sigma);
  const double q = q_of(s);
  if (q == 0.0) return p;
  const double M = slope(lode_of(J3_of(s), q)).M;
  return p + q / M * (q / M) / p;
}

double ModifiedCamClay::stress_level(const Vector4& sigma, std::span<const double> h) const {
  const double size = size_through(sigma);
  return h[kPressure] > 0.0 ? size / h[kPressure] : kInfinite;
}

double ModifiedCamClay::shear_modulus(const Vector4& sigma, std::span<const double> h) const {
  if (clay_.G > 0.0) return clay_.G;
  const double v = clay_.current_volume ? h[kVolume] : clay_.v0;
  return by_bulk_ * std::max(-mean_stress(sigma), h[kLeast]) * v / clay_.kappa;
}

bool ModifiedCamClay::initialise(const Vector4& sigma, std::span<double> h) const {
  const double size = size_through(sigma);
  const bool carried = std::isfinite(size);
  const double through = carried ? size : 0.0;
  const double stated = clay_.p_c > 0.0 ? clay_.p_c : std::max(clay_.ocr, 1.0) * through + clay_.pop;
  h[kPressure] = std::max(through, stated);
  h[kVolume] = clay_.v0;
  h[kLeast] = clay_.floor * h[kPressure];
  h[kShear] = h[kPlasticVolume] = 0.0;
  return carried && -mean_stress(sigma) >= h[kLeast];
}

bool ModifiedCamClay::adjusts_start(const Vector4& sigma) const {
  const double size = size_through(sigma);
  return clay_.p_c > 0.0 && std::isfinite(size) && size > clay_.p_c * (1.0 + kOnSurface);
}

bool ModifiedCamClay::accepts_history(const Vector4& sigma, std::span<const double> h) const {
  return h[kPressure] > 0.0 && h[kVolume] > 1.0 && h[kLeast] > 0.0 && h[kShear] >= 0.0 &&
         std::isfinite(h[kPressure]) && h[kLeast] <= h[kPressure] && stress_level(sigma, h) <= 1.0 + 1e-8;
}

std::string ModifiedCamClay::caution() const {
  if (clay_.shape == DeviatoricShape::van_eekelen && van_eekelen_ratio(clay_.M) < kConvex)
    return "van Eekelen's shape is not convex for an M as large as this (above 48 degrees of friction); "
           "Matsuoka and Nakai's (deviatoric_shape 1) always is";
  return {};
}

std::string ModifiedCamClay::remark() const {
  if (clay_.G > 0.0) return {};
  return "the shear modulus follows the mean stress at constant Poisson's ratio, so that closed loops of "
         "elastic stress "
         "can leave a shear strain; a constant shear_modulus does not";
}

ModifiedCamClay::Step ModifiedCamClay::step_from(const Point& point, const Vector4& deps,
                                                 const Part& part) const {
  const double volume = kVolumeRate.dot(deps), mean = -volume / 3.0;
  const Vector4 e(deps[0] - mean, deps[1] - mean, deps[2] - mean, 0.5 * deps[3]);
  Step step{point,
            part.share * e,
            0.0,
            0.0,
            0.0,
            Matrix4::Zero(),
            part.share * volume,
            part.share * kVolumeRate + volume * part.rate,
            point.p / point.p_c,
            point.log_p - point.log_c,
            (point.p_c - point.p) / point.p,
            0.0,
            0.0,
            Vector4::Zero(),
            0.0,
            Vector4::Zero()};
  step.length = std::sqrt(contract(step.e, step.e));
  if (step.length > 0.0) step.along = contract(point.s, step.e) / step.length;
  const Vector4 off = step.length > 0.0 ? Vector4(point.s - step.along / step.length * step.e) : point.s;
  step.across = std::sqrt(contract(off, off));
  if (point.has_rates) {
    step.e_rate = part.share * deviatoric_projection();
    if (!part.rate.isZero(0.0)) step.e_rate += e * part.rate.transpose();
  }
  double v = point.v;
  if (clay_.current_volume) {
    const MeanExp growth = mean_exp(-step.volume);
    v *= growth.value;
    step.stiffer = point.log_v_rate - growth.slope / growth.value * step.volume_rate;
  }
  step.kappa = clay_.kappa / v;
  step.harden = (clay_.lambda - clay_.kappa) / v;
  step.elastic_growth = step.volume / step.kappa;
  step.elastic_growth_rate = step.volume_rate / step.kappa + step.elastic_growth * step.stiffer;
  return step;
}

// The elastic deviator for a growth of p, s + 2 G e, as far as q and M need it.  Secant moduli over the step: K is
// (p - p0)/(elastic strain), and G in proportion.
void ModifiedCamClay::set_trial(const Step& step, OnSurface& at) const {
  at.G = clay_.G;
  at.G_by_growth = 0.0;
  if (clay_.G == 0.0) {
    const MeanExp mean = mean_exp(at.growth);
    const double first = by_bulk_ * step.from.p / step.kappa;
    at.G = first * mean.value;
    at.G_by_growth = first * mean.slope;
  }
  const double along = step.along + 2.0 * at.G * step.length;
  at.q_trial = std::sqrt(1.5 * (step.across * step.across + along * along));
  at.has_direction = at.q_trial > kIsotropic * step.from.p_c;
  at.q_by_G = at.has_direction ? 3.0 * step.length * along / at.q_trial : 0.0;
  at.slope = {clay_.M, 0.0};
  at.M_by_G = 0.0;
  if (clay_.shape == DeviatoricShape::circle) return;
  if (!at.has_direction) {
    at.slope = slope(1.0);
    return;
  }
  const Vector4 s = trial_of(step, at.G);
  const Vector4& e = step.e;
  const double cube = at.q_trial * at.q_trial * at.q_trial, J3 = J3_of(s);
  const double J3_by_G =
      2.0 * (e[2] * (s[0] * s[1] - s[3] * s[3]) + s[2] * (e[0] * s[1] + s[0] * e[1] - 2.0 * s[3] * e[3]));
  at.slope = slope(lode_of(J3, at.q_trial));
  at.M_by_G = -13.5 * at.slope.by_lode * (J3_by_G - 3.0 * J3 * at.q_by_G / at.q_trial) / cube;
}

ModifiedCamClay::OnSurface ModifiedCamClay::on_surface(const Step& step, double height) const {
  const Point& from = step.from;
  OnSurface at{};
  const double square = height * height;
  at.height = height;
  at.share = 1.0 / (1.0 + square);
  at.sine = 2.0 * height * at.share;
  at.cosine = (1.0 - square) * at.share;
  at.log_share = step.log_share - log_1_plus((square - step.square) * step.share);
  at.log_share_rate = -height;
  const double ratio = clay_.kappa / clay_.lambda;
  at.hardening = ratio * (step.elastic_growth + step.log_share - at.log_share);
  const double hardening_at_floor = from.log_least - from.log_c - at.log_share;
  at.at_floor = hardening_at_floor > at.hardening;
  if (at.at_floor) at.hardening = hardening_at_floor;
  at.hardening_rate = -(at.at_floor ? 1.0 : ratio) * at.log_share_rate;
  at.x = step.harden * at.hardening;
  at.p_c = from.p_c + from.p_c * exp_less_1(at.hardening);
  at.growth = at.log_share - step.log_share + at.hardening;
  set_trial(step, at);
  const double M = at.slope.M;
  at.q = 0.5 * M * at.p_c * at.sine;
  const double beyond = at.q_trial - at.q;
  at.lack = 3.0 * at.G * at.x * at.sine - M * at.cosine * beyond;
  at.by_G = 3.0 * at.x * at.sine - at.cosine * (at.M_by_G * (beyond - at.q) + M * at.q_by_G);
  const double G_rate = at.G_by_growth * (at.log_share_rate + at.hardening_rate);
  const double q_rate = 0.5 * M * at.p_c * at.cosine + at.q * at.hardening_rate;
  at.lack_rate = 3.0 * at.G * (at.x * at.cosine + step.harden * at.hardening_rate * at.sine) +
                 M * at.sine * beyond + M * at.cosine * q_rate + at.by_G * G_rate;
  return at;
}

// The place to which a trial stress outside the surface returns.  On the wet side it lies between the trial's own mean stress
// and the critical state, on the dry side between the critical state and the trial's: what the flow rule lacks changes its
// sign between, so there is an answer to every increment.  Corrections are those of the angle.
ModifiedCamClay::OnSurface ModifiedCamClay::return_to_surface(const Step& step, const ElasticTrial& trial,
                                                              double guess) const {
  const double p_c = step.from.p_c, own = height_at(trial.p / p_c);
  double low = 2.0 * trial.p >= p_c ? std::min(own, kCritical) : kCritical;
  double high = 2.0 * trial.p <= p_c ? std::max(own, kCritical) : kCritical;
  const auto width = [&] { return std::atan(high) - std::atan(low); };
  OnSurface at{};
  double next = std::clamp(guess, low, high), before = kInfinite;
  for (int round = 0; round < kRounds; ++round) {
    at = on_surface(step, next);
    (at.lack < 0.0 ? low : high) = next;
    const double turn = at.lack_rate > 0.0 ? -at.lack / at.lack_rate : kInfinite, half = 0.5 * turn;
    next = (at.height + half) / (1.0 - at.height * half);
    const bool within = std::abs(half) < kCritical && at.height * half < 1.0;
    if (std::abs(turn) <= kAngle * at.sine) return at;
    if (within && std::abs(turn) <= kAngleDigits * at.sine)
      return on_surface(step, std::clamp(next, low, high));
    const bool slow = round % 3 == 2 && width() > 0.5 * std::exchange(before, width());
    if (slow || !(within && next > low && next < high))
      next = std::tan(0.5 * (std::atan(low) + std::atan(high)));
    if (!(next > low && next < high)) return on_surface(step, std::clamp(next, low, high));
  }
  return at;
}

ModifiedCamClay::Point ModifiedCamClay::elastic_end(const Step& step, const OnSurface& trial) const {
  Point end = step.from;
  end.at_floor = trial.growth > step.elastic_growth;
  end.s = trial_of(step, trial.G);
  end.p += end.p * exp_less_1(trial.growth);
  end.log_p += trial.growth;
  end.status = end.at_floor ? PointStatus::cut_off : PointStatus::elastic;
  if (!end.has_rates) return end;
  const Vector4 growth_rate = end.at_floor ? Vector4(-step.from.log_p_rate) : step.elastic_growth_rate;
  Vector4 G_rate = trial.G_by_growth * growth_rate;
  if (clay_.G == 0.0) G_rate += trial.G * (step.from.log_p_rate + step.stiffer);
  end.s_rate += 2.0 * trial.G * step.e_rate + 2.0 * step.e * G_rate.transpose();
  end.log_p_rate += growth_rate;
  return end;
}

ModifiedCamClay::Point ModifiedCamClay::plastic_end(const Step& step, const OnSurface& at) const {
  const double M = at.slope.M;
  Point end = step.from;
  end.p_c = at.p_c;
  end.p = at.p_c * at.share;
  end.log_c += at.hardening;
  end.log_p = end.log_c + at.log_share;
  const double left =
      at.has_direction ? at.q / at.q_trial : M * M * at.p_c / (6.0 * at.G * at.x + M * M * at.p_c);
  end.s = left * trial_of(step, at.G);
  if (end.has_rates) set_plastic_rates(step, at, left, end);
  end.status = PointStatus::yielded;
  end.at_floor = at.at_floor;
  end.height = at.height;
  end.shear += (1.0 - left) * at.q_trial / (std::sqrt(3.0) * at.G);
  end.plastic_volume -= at.x;
  return end;
}

// First the rates at a constant angle, then that of the angle at which nothing is lacking, and with it all others.
// left: of the trial's deviator.
void ModifiedCamClay::set_plastic_rates(const Step& step, const OnSurface& at, double left, Point& end) const {
  const Point& from = step.from;
  const double ratio = clay_.kappa / clay_.lambda, M = at.slope.M;
  const Vector4 s_trial = trial_of(step, at.G);
  Vector4 lack_by_trial = Vector4::Zero();  // in tensor components
  if (at.has_direction) lack_by_trial = -1.5 * M * at.cosine / at.q_trial * s_trial;
  if (at.has_direction && at.slope.by_lode != 0.0)
    lack_by_trial -=
        at.cosine * (at.q_trial - 2.0 * at.q) * at.slope.by_lode * lode_gradient(s_trial, at.q_trial);
  const Vector4 G_direct =
      clay_.G > 0.0 ? Vector4(Vector4::Zero()) : Vector4(at.G * (from.log_p_rate + step.stiffer));
  Vector4 hardening = -from.log_c_rate;
  if (!at.at_floor) hardening = ratio * (hardening + from.log_p_rate + step.elastic_growth_rate);
  const Vector4 growth = hardening + from.log_c_rate - from.log_p_rate;
  const Vector4 G = G_direct + at.G_by_growth * growth;
  const Matrix4 trial = from.s_rate + 2.0 * at.G * step.e_rate;  // at a constant G
  const Vector4 lack = 3.0 * at.G * at.sine * step.harden * (hardening - at.hardening * step.stiffer) +
                       M * at.cosine * at.q * (hardening + from.log_c_rate) + at.by_G * G +
                       trial.transpose().lazyProduct(work_row(lack_by_trial));
  const Vector4 angle = -lack / at.lack_rate;

  end.log_c_rate += hardening + at.hardening_rate * angle;
  end.log_p_rate = end.log_c_rate + at.log_share_rate * angle;
  const Vector4 G_rate = G_direct + at.G_by_growth * (end.log_p_rate - from.log_p_rate);
  const Matrix4 trial_rate = trial + 2.0 * step.e * G_rate.transpose();
  Vector4 left_rate = Vector4::Zero();
  if (at.has_direction) {
    Vector4 by_trial = -1.5 * left / (at.q_trial * at.q_trial) * s_trial;
    if (at.slope.by_lode != 0.0) by_trial += left * at.slope.by_lode / M * lode_gradient(s_trial, at.q_trial);
    left_rate = left * end.log_c_rate + 0.5 * M * at.p_c * at.cosine / at.q_trial * angle +
                trial_rate.transpose().lazyProduct(work_row(by_trial));
  }
  end.s_rate = left * trial_rate + s_trial * left_rate.transpose();
}

// Elastic to the end of the step; with the level there.
ModifiedCamClay::ElasticTrial ModifiedCamClay::elastic_trial(const Step& step) const {
  const Point& from = step.from;
  ElasticTrial trial{{}, kInfinite, kInfinite};
  trial.at.growth = std::max(step.elastic_growth, from.log_least - from.log_p);
  if (step.elastic_growth > kMostGrowth) return trial;
  set_trial(step, trial.at);
  trial.p = from.p + from.p * exp_less_1(trial.at.growth);
  const double height = trial.at.q_trial / (trial.at.slope.M * trial.p);
  trial.level = trial.p / from.p_c * (1.0 + height * height);
  return trial;
}

ModifiedCamClay::Point ModifiedCamClay::end_of(const Step& step, const ElasticTrial& trial,
                                               double guess) const {
  Point end = trial.level <= 1.0 + kOnSurface ? elastic_end(step, trial.at)
                                              : plastic_end(step, return_to_surface(step, trial, guess));
  end.kappa = step.kappa;
  if (clay_.current_volume) {
    end.v *= std::exp(-step.volume);
    end.log_v_rate -= step.volume_rate;
  }
  return end;
}

// One step of backward Euler.
ModifiedCamClay::Point ModifiedCamClay::advance(const Point& point, const Vector4& deps, const Part& part,
                                                double guess) const {
  const Step step = step_from(point, deps, part);
  return end_of(step, elastic_trial(step), guess);
}

// How ln(level) changes at a state.
ModifiedCamClay::LevelChange ModifiedCamClay::level_change(const Point& point) const {
  const double q = q_of(point.s);
  if (q <= kIsotropic * point.p_c) return {1.0, Vector4::Zero()};
  const Slope M = slope(clay_.shape == DeviatoricShape::circle ? 1.0 : lode_of(J3_of(point.s), q));
  const double height = q / (M.M * point.p), share = 2.0 * height * height / (1.0 + height * height);
  Vector4 by_s = 1.5 / (q * q) * point.s;
  if (M.by_lode != 0.0) by_s -= M.by_lode / M.M * lode_gradient(point.s, q);
  return {1.0 - share, share * by_s};
}

// A state on the surface that an increment leads along it or out of it, to rounding: then all of it is plastic.
bool ModifiedCamClay::loads(const Step& still, const Step& whole) const {
  const ElasticTrial now = elastic_trial(still);
  if (!(now.level > 1.0 - kNearSurface)) return false;
  const LevelChange level = level_change(still.from);
  const double change =
      level.by_log_p * whole.volume / still.kappa + 2.0 * now.at.G * contract(level.by_s, whole.e);
  return change >= -kOnSurface;
}

// The part of an increment that is elastic, where all of it is not: up to the surface, without an error of its own.
ModifiedCamClay::Part ModifiedCamClay::elastic_part(Point start, const Vector4& deps) const {
  start.has_rates = true;
  if (loads(step_from(start, Vector4::Zero(), {}), step_from(start, deps, {}))) return {0.0};
  double low = 0.0, high = 1.0, share = 0.5;
  for (int round = 0; round < kRounds; ++round) {
    const Step step = step_from(start, deps, {share});
    const ElasticTrial trial = elastic_trial(step);
    const double log_level = std::log(trial.level);
    (log_level <= 0.0 ? low : high) = share;
    double next = 0.5 * (low + high);
    if (std::isfinite(log_level)) {
      const Point end = elastic_end(step, trial.at);
      const LevelChange level = level_change(end);
      // By the strains of the increment.
      const Vector4 rate = level.by_log_p * end.log_p_rate + end.s_rate.transpose() * work_row(level.by_s);
      const double slope = rate.dot(deps) / share, newton = share - log_level / slope;
      if (std::abs(log_level) <= kOnSurface || high - low <= kOnSurface)
        return slope > 0.0 ? Part{share, -rate / slope} : Part{share};
      if (newton > low && newton < high) next = newton;
    }
    share = next;
  }
  return {low};
}

// Richardson's extrapolation from one step and two of half the size: of second order.  It works on ln p and s/p, and
// p_c follows, so that the answer is a stress on a surface.  Where the two differ much it is left out by degrees.
ModifiedCamClay::Point ModifiedCamClay::extrapolated(const Point& once, const Point& twice) const {
  const auto ratio_rate = [](const Point& point) {
    return Matrix4((point.s_rate - point.s * point.log_p_rate.transpose()) / point.p);
  };
  const Vector4 r2 = twice.ratio(), dr = r2 - once.ratio();
  const Matrix4 r2_rate = ratio_rate(twice), dr_rate = r2_rate - ratio_rate(once);
  const double dp = twice.log_p - once.log_p;
  const Vector4 dp_rate = twice.log_p_rate - once.log_p_rate;
  const double share = weight_of(square_difference(dp, dr));
  const Vector4 share_rate =
      -2.0 * share * share / (kFar * kFar) * (dp * dp_rate + dr_rate.transpose().lazyProduct(work_row(dr)));
  Point end = twice;
  end.log_p += share * dp;
  end.log_p_rate += share * dp_rate + dp * share_rate;
  const Vector4 r = r2 + share * dr;
  end.p += end.p * exp_less_1(share * dp);
  const double p = end.p;
  end.s = p * r;
  end.s_rate =
      p * (r2_rate + share * dr_rate + dr * share_rate.transpose()) + end.s * end.log_p_rate.transpose();
  end.p_c = size_through(end.s - p * unit_tensor());
  end.shear += share * (twice.shear - once.shear);
  end.plastic_volume += share * (twice.plastic_volume - once.plastic_volume);
  return end;
}

// Elastic up to the surface; the rest once in one step, once in two.
ModifiedCamClay::PlasticIncrement ModifiedCamClay::plastic_increment(const Point& start,
                                                                     const Vector4& deps) const {
  const Part elastic = elastic_part(start, deps), rest{1.0 - elastic.share, -elastic.rate};
  const Part half{0.5 * rest.share, 0.5 * rest.rate};
  Point yield = elastic.share > 0.0 ? advance(start, deps, elastic, kCritical) : start;
  yield.height = height_at(yield.p / yield.p_c);
  PlasticIncrement increment{{}, advance(yield, deps, half, yield.height), {}, false};
  const auto& [once, middle, twice, smooth] = increment;
  increment.twice = advance(middle, deps, half, 2.0 * middle.height - yield.height);
  increment.once = advance(yield, deps, rest, twice.height);
  increment.smooth = once.status == PointStatus::yielded && twice.status == PointStatus::yielded &&
                     !(once.at_floor || middle.at_floor || twice.at_floor);
  return increment;
}

ModifiedCamClay::Point ModifiedCamClay::start_of(const PointIn<4>& in) const {
  Point start;
  start.s = deviator(in.sigma0);
  start.p = std::max(-mean_stress(in.sigma0), in.h0[kLeast]);
  start.p_c = in.h0[kPressure];
  start.log_c = std::log(start.p_c / start.p);
  start.log_least = std::log(in.h0[kLeast] / start.p);
  start.v = in.h0[kVolume];
  return start;
}

// Two errors.  Of the steps: what extrapolation leaves is less than the square of what it takes away, but for what it was
// not allowed to.  Of the path: where stresses are held, the strains bend, and their straight line leads the stress off
// its chord by about as much as the end is wrong.
double ModifiedCamClay::path_error(const PointIn<4>& in, const Vector4& sigma,
                                   std::span<const double> h) const {
  if (h[kShear] == in.h0[kShear] && h[kPlasticVolume] == in.h0[kPlasticVolume]) return 0.0;
  Point start = start_of(in);
  start.has_rates = false;
  const PlasticIncrement increment = plastic_increment(start, in.deps);
  const double square = square_difference(increment.twice.log_p - increment.once.log_p,
                                          increment.twice.ratio() - increment.once.ratio());
  const double left = increment.smooth ? 1.0 - weight_of(square) : 1.0,
               steps = left * std::sqrt(square) + square;
  const Vector4 chord = sigma - in.sigma0,
                middle = increment.middle.s - increment.middle.p * unit_tensor() - in.sigma0;
  const double length = contract(chord, chord);
  const Vector4 off = length > 0.0 ? Vector4(middle - contract(middle, chord) / length * chord) : middle;
  const double path = std::sqrt(contract(off, off) / contract(sigma, sigma));
  return std::isfinite(steps) && std::isfinite(path) ? std::max(steps, path) : 0.0;
}

Outcome ModifiedCamClay::update(const PointIn<4>& in, PointOut<4>& out) const {
  std::copy(in.h0.begin(), in.h0.end(), out.h1.begin());
  out.sigma = in.sigma0;
  out.D.setZero();
  out.status = PointStatus::elastic;
  const bool small = !clay_.current_volume || std::abs(kVolumeRate.dot(in.deps)) < kMostStrain;
  if (!(in.h0[kPressure] > 0.0 && in.h0[kLeast] > 0.0 && small)) return Outcome::cut_step;
  const Point start = start_of(in);
  const Step whole = step_from(start, in.deps, {});
  const ElasticTrial trial = elastic_trial(whole);
  Point end;
  if (trial.level <= 1.0 + kOnSurface) {
    end = end_of(whole, trial, kCritical);
  } else {
    const PlasticIncrement increment = plastic_increment(start, in.deps);
    end = increment.smooth ? extrapolated(increment.once, increment.twice) : increment.twice;
    out.h1[kPressure] = end.p_c;
    out.h1[kShear] = std::max(in.h0[kShear] + end.shear, in.h0[kShear]);
    out.h1[kPlasticVolume] += end.plastic_volume;
  }
  const double p = end.p;
  if (!(end.log_p < kMostGrowth && std::isfinite(p) && end.s.allFinite() && end.s_rate.allFinite() &&
        end.log_p_rate.allFinite() && std::isfinite(end.p_c))) {
    std::copy(in.h0.begin(), in.h0.end(), out.h1.begin());
    return Outcome::cut_step;
  }
  out.h1[kVolume] = end.v;
  if (!in.deps.isZero(0.0)) out.sigma = end.s - p * unit_tensor();
  out.D = end.s_rate - p * unit_tensor() * end.log_p_rate.transpose();
  if (end.at_floor) out.D.topLeftCorner<3, 3>().array() += kFloorStiffness * p / end.kappa;
  out.status = end.status;
  return Outcome::ok;
}

MaterialEntry modified_cam_clay_entry() {
  MaterialEntry entry{"modified_cam_clay",      "modified Cam clay (Roscoe and Burland 1968)", 4, rows(), make,
                      ModifiedCamClay::kHistory};
  // For a plug-in that is built from this file.
  entry.trials = {{.values = {1.2, 0.2, 0.04, 2.0, 0.3, 4.0}, .bounded = true},
                  {.values = {0.9, 0.15, 0.02, 2.2, 0.2, 0.0, 50.0, 0.0, 1.0, 1.0}, .bounded = true}};
  return entry;
}

}  // namespace sage
