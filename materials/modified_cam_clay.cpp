#include "materials/modified_cam_clay.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "materials/stress_measures.hpp"

namespace sage {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kOnSurface = 1e-12;  // of p_c: what rounding leaves outside
constexpr double kIsotropic = 1e-13;  // of p_c: a deviator below has no direction
constexpr double kSamePlace = 1e-13;
constexpr double kPlaceDigits = 1e-7;  // a last correction of Newton's method for the place on the surface
constexpr double kRoughDigits = 1e-4;  // and where only an estimate is wanted
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

// The mean of exp over [0, x], (exp(x) - 1)/x, and its derivative; exponential is exp(x).
struct MeanExp {
  double value, slope;
};
inline MeanExp mean_exp(double x, double exponential) {
  if (std::abs(x) < 0.01)
    return {1.0 + x * (1.0 / 2 + x * (1.0 / 6 + x * (1.0 / 24 + x * (1.0 / 120 + x / 720)))),
            1.0 / 2 + x * (1.0 / 3 + x * (1.0 / 8 + x * (1.0 / 30 + x * (1.0 / 144 + x / 840))))};
  const double mean = (exponential - 1.0) / x;
  return {mean, (exponential - mean) / x};
}

// q = sqrt(3 J2) of a deviator.
double q_of(const Vector4& s) {
  return std::sqrt(1.5 * contract(s, s));
}
// sin(3 theta) of a deviator, tension +: 1 in triaxial compression, -1 in extension.
double lode_of(const Vector4& s, double q) {
  return std::clamp(-13.5 * s[2] * (s[0] * s[1] - s[3] * s[3]) / (q * q * q), -1.0, 1.0);
}
// Its derivative with respect to the deviator, in tensor components; the mean may be anything.
Vector4 lode_gradient(const Vector4& s, double q) {
  const Vector4 square(s[0] * s[0] + s[3] * s[3], s[1] * s[1] + s[3] * s[3], s[2] * s[2], s[3] * (s[0] + s[1]));
  const double determinant = s[2] * (s[0] * s[1] - s[3] * s[3]);
  return -13.5 / (q * q * q) * (square - 4.5 * determinant / (q * q) * s);
}

// Square of the difference of ln p and s/p; over kFar^2 it is what extrapolation is weighted by.
double square_difference(double log_p, const Vector4& ratio) {
  return log_p * log_p + contract(ratio, ratio);
}
double weight_of(double square) {
  return 1.0 / (1.0 + square / (kFar * kFar));
}

constexpr double kCritical = 0.5;
constexpr double kLastPlace = 1.0 - 1e-15;
// Of a place on the surface, from ln(p/p_c).
double place_at(double log_share) {
  const double t = std::sqrt(std::expm1(-std::min(log_share, 0.0)));
  return std::min(1.0 - 1.0 / (1.0 + t), kLastPlace);
}

const Vector4 kVolumeRate(-1.0, -1.0, -1.0, 0.0);  // of the volume, compression positive, by the strain

}  // namespace

// What a whole update starts from and adds.  Every deviator on its way is a sum a s + b e of these two.
struct ModifiedCamClay::Increment {
  Vector4 s;      // deviator at the start
  Vector4 e;      // deviator of the strains, tensor components
  double volume;  // compression positive
  bool rates;     // are wanted
};

// A deviator a s + b e, and how it changes with the strains of the update.
struct ModifiedCamClay::Deviator {
  Vector4 value;
  double a = 1.0, b = 0.0;
  Vector4 a_rate = Vector4::Zero(), b_rate = Vector4::Zero();

  // The rate of w:value.
  Vector4 rate_along(const Vector4& w, const Increment& of) const {
    return contract(w, of.s) * a_rate + contract(w, of.e) * b_rate + b * deviator(w);
  }
};

// A state, and how it changes with the strains of the update (rates).  Logarithms are of pressures over the first p_c.
struct ModifiedCamClay::Point {
  Deviator s;
  double p = 0.0, p_c = 0.0, log_p = 0.0, log_c = 0.0;
  double v = 0.0;  // specific volume
  Vector4 log_p_rate = Vector4::Zero(), log_c_rate = Vector4::Zero(), log_v_rate = Vector4::Zero();
  double log_least = 0.0;  // of the least p
  double shear = 0.0, plastic_volume = 0.0;
  PointStatus status = PointStatus::elastic;
  bool at_floor = false;
  double place = kCritical;  // on the surface, for the first guess of the next one
  double kappa = 0.0;        // of the step that led here
};

// Which share of the update's increment a step takes, and how that changes with the increment.
struct ModifiedCamClay::Part {
  double share = 1.0;
  Vector4 rate = Vector4::Zero();
};

// A step from a point on.  Volume is compression positive.
struct ModifiedCamClay::Step {
  const Increment& of;
  const Point& from;
  const Part& part;
  double volume;
  double kappa, harden;   // kappa/v and (lambda - kappa)/v, v the mean over the step
  double elastic_growth;  // ln(p/p0) of an elastic step, without the floor
  Vector4 volume_rate = Vector4::Zero(), stiffer = Vector4::Zero();  // stiffer: rate of ln v
  Vector4 elastic_growth_rate = Vector4::Zero();
};

// The elastic deviator of a step in which ln(p/p0) grows, and the M that belongs to it.
struct ModifiedCamClay::Trial {
  double growth, G, G_by_growth;
  double b;  // its deviator is a s + b e, a that of the step's start
  Vector4 deviator;
  double q;
  Slope slope;
  bool has_direction;  // the deviator is no rounding
};

// A place on the surface: p = p_c cos^2(alpha/2), q = M p_c sin(alpha)/2, and what the flow rule lacks there.
// Rates are by the angle alpha.  The number of a place is u, tan(alpha/2) = u/(1 - u): that takes no trigonometry.
struct ModifiedCamClay::OnSurface {
  double place, angle_rate;  // of the angle, by the place
  double sine, cosine;
  double log_share, log_share_rate;  // ln(p/p_c)
  double hardening, hardening_rate;  // ln(p_c/p_c0)
  double x;                          // plastic change of volume
  double p, p_c, q;
  Trial trial;
  double lack, lack_rate;  // 3 G x sin(alpha) - M cos(alpha) (q_trial - q)
  double lack_by_G;
  bool at_floor;

  // Rate by the trial deviator, tensor components.
  Vector4 lack_by_trial() const;
};

struct ModifiedCamClay::ElasticEnd {
  Trial trial;
  double p, log_share;  // ln(p/p_c)
  double level;         // as stress_level()
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

// Of a deviator; q = 0 where it has no direction.
ModifiedCamClay::Slope ModifiedCamClay::slope_of(const Vector4& s, double q) const {
  if (clay_.shape == DeviatoricShape::circle) return {clay_.M, 0.0};
  return slope(q > 0.0 ? lode_of(s, q) : 1.0);
}

// p_c of the surface through a stress; infinite where its mean is no compression.
double ModifiedCamClay::size_through(const Vector4& sigma) const {
  const double p = -mean_stress(sigma);
  if (!(p > 0.0)) return kInfinite;
  const Vector4 s = deviator(sigma);
  const double q = q_of(s);
  if (q == 0.0) return p;
  const double M = slope_of(s, q).M;
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

ModifiedCamClay::Step ModifiedCamClay::step_from(const Increment& of, const Point& point,
                                                 const Part& part) const {
  Step step{of, point, part, part.share * of.volume, 0.0, 0.0, 0.0};
  if (of.rates) step.volume_rate = part.share * kVolumeRate + of.volume * part.rate;
  double v = point.v;
  if (clay_.current_volume) {
    const MeanExp mean = mean_exp(-step.volume, std::exp(-step.volume));
    v *= mean.value;
    step.stiffer = point.log_v_rate - mean.slope / mean.value * step.volume_rate;
  }
  step.kappa = clay_.kappa / v;
  step.harden = (clay_.lambda - clay_.kappa) / v;
  step.elastic_growth = step.volume / step.kappa;
  step.elastic_growth_rate = step.volume_rate / step.kappa + step.elastic_growth * step.stiffer;
  return step;
}

// The elastic deviator where p is exp(growth) times that of the start.  Secant moduli over the step: K is
// (p - p0)/(elastic strain), and G in proportion.
ModifiedCamClay::Trial ModifiedCamClay::trial_of(const Step& step, double growth, double exponential) const {
  const Point& from = step.from;
  Trial trial;
  trial.growth = growth;
  trial.G = clay_.G;
  trial.G_by_growth = 0.0;
  if (clay_.G == 0.0) {
    const MeanExp mean = mean_exp(growth, exponential);
    const double first = by_bulk_ * from.p / step.kappa;
    trial.G = first * mean.value;
    trial.G_by_growth = first * mean.slope;
  }
  const double more = 2.0 * trial.G * step.part.share;
  trial.b = from.s.b + more;
  trial.deviator = from.s.value + more * step.of.e;
  trial.q = q_of(trial.deviator);
  trial.has_direction = trial.q > kIsotropic * from.p_c;
  trial.slope = slope_of(trial.deviator, trial.has_direction ? trial.q : 0.0);
  return trial;
}

Vector4 ModifiedCamClay::OnSurface::lack_by_trial() const {
  if (!trial.has_direction) return Vector4::Zero();
  const auto& [M, M_by_lode] = trial.slope;
  Vector4 by = -1.5 * M * cosine / trial.q * trial.deviator;
  if (M_by_lode != 0.0) by -= cosine * (trial.q - 2.0 * q) * M_by_lode * lode_gradient(trial.deviator, trial.q);
  return by;
}

ModifiedCamClay::OnSurface ModifiedCamClay::on_surface(const Step& step, double place) const {
  const Point& from = step.from;
  OnSurface at;
  at.place = place;
  const double u = place, w = 1.0 - u, inverse = 1.0 / (w * w + u * u), share = w * w * inverse;
  at.angle_rate = 2.0 * inverse;
  at.sine = 2.0 * u * w * inverse;
  at.cosine = (w - u) * inverse;
  at.log_share = std::log(share);
  at.log_share_rate = -u / w;
  const double ratio = clay_.kappa / clay_.lambda;
  at.hardening = ratio * (from.log_p + step.elastic_growth - from.log_c - at.log_share);
  const double hardening_at_floor = from.log_least - from.log_c - at.log_share;
  at.at_floor = hardening_at_floor > at.hardening;
  if (at.at_floor) at.hardening = hardening_at_floor;
  at.hardening_rate = -(at.at_floor ? 1.0 : ratio) * at.log_share_rate;
  at.x = step.harden * at.hardening;
  at.p_c = from.p_c * std::exp(at.hardening);
  at.p = share * at.p_c;
  at.trial = trial_of(step, at.log_share + at.hardening + from.log_c - from.log_p, at.p / from.p);
  const double M = at.trial.slope.M;
  at.q = 0.5 * M * at.p_c * at.sine;
  const double G = at.trial.G, beyond = at.trial.q - at.q;
  at.lack = 3.0 * G * at.x * at.sine - M * at.cosine * beyond;
  at.lack_by_G = 3.0 * at.x * at.sine + 2.0 * step.part.share * contract(at.lack_by_trial(), step.of.e);
  const double G_rate = at.trial.G_by_growth * (at.log_share_rate + at.hardening_rate);
  const double q_rate = 0.5 * M * at.p_c * at.cosine + at.q * at.hardening_rate;
  at.lack_rate = 3.0 * G * (at.x * at.cosine + step.harden * at.hardening_rate * at.sine) +
                 M * at.sine * beyond + M * at.cosine * q_rate + at.lack_by_G * G_rate;
  return at;
}

// The place to which a trial stress outside the surface returns; log_trial: ln(p/p_c0) of the trial.  On the wet side it
// lies between the trial's own mean stress and the critical state, on the dry side between the critical state and the
// trial's: what the flow rule lacks changes its sign between, so there is an answer to every increment.
ModifiedCamClay::OnSurface ModifiedCamClay::return_to_surface(const Step& step, double log_trial,
                                                              double guess) const {
  const double to_critical = std::max(step.from.log_p + step.elastic_growth, step.from.log_least) -
                             step.from.log_c +
                             std::numbers::ln2;  // in its sign: of the plastic change of volume on the way
  const double own = place_at(log_trial);
  double low = to_critical >= 0.0 ? std::min(own, kCritical) : kCritical;
  double high = to_critical <= 0.0 ? std::max(own, kCritical) : kCritical;
  const double digits = step.of.rates ? kPlaceDigits : kRoughDigits;
  OnSurface at;
  double next = std::clamp(guess, low, high), before = high - low;
  for (int round = 0; round < kRounds; ++round) {
    at = on_surface(step, next);
    (at.lack < 0.0 ? low : high) = next;
    next = at.lack_rate > 0.0 ? at.place - at.lack / (at.lack_rate * at.angle_rate) : kInfinite;
    const double way = std::abs(next - at.place);
    if (way <= kSamePlace) return at;
    // Newton's method doubles the digits.
    if (way <= digits) return on_surface(step, std::clamp(next, low, high));
    const bool slow = round % 3 == 2 && high - low > 0.5 * before;
    if (round % 3 == 2) before = high - low;
    if (slow || !(next > low && next < high)) next = 0.5 * (low + high);
    if (next == low || next == high) return on_surface(step, next);
  }
  return at;
}

// How G changes at a constant growth of p.
Vector4 ModifiedCamClay::direct_G_rate(const Step& step, double G) const {
  if (clay_.G > 0.0) return Vector4::Zero();
  return G * (step.from.log_p_rate + step.stiffer);
}

ModifiedCamClay::Point ModifiedCamClay::elastic_end(const Step& step, const ElasticEnd& elastic) const {
  const Trial& trial = elastic.trial;
  Point end = step.from;
  end.at_floor = trial.growth > step.elastic_growth;
  end.s.value = trial.deviator;
  end.s.b = trial.b;
  end.p = elastic.p;
  end.log_p += trial.growth;
  end.status = end.at_floor ? PointStatus::cut_off : PointStatus::elastic;
  if (!step.of.rates) return end;
  const Vector4 growth_rate = end.at_floor ? Vector4(-step.from.log_p_rate) : step.elastic_growth_rate;
  const Vector4 G_rate = trial.G_by_growth * growth_rate + direct_G_rate(step, trial.G);
  end.s.b_rate += 2.0 * (trial.G * step.part.rate + step.part.share * G_rate);
  end.log_p_rate += growth_rate;
  return end;
}

// What the return leaves of the trial deviator.
double ModifiedCamClay::left_of_trial(const OnSurface& at) {
  if (at.trial.has_direction) return at.q / at.trial.q;
  const double M = at.trial.slope.M;
  return M * M * at.p_c / (6.0 * at.trial.G * at.x + M * M * at.p_c);
}

ModifiedCamClay::Point ModifiedCamClay::plastic_end(const Step& step, const OnSurface& at) const {
  const double left = left_of_trial(at);
  Point end = step.from;
  end.log_c += at.hardening;
  end.log_p = end.log_c + at.log_share;
  end.p_c = at.p_c;
  end.p = at.p;
  end.s.value = left * at.trial.deviator;
  end.s.a *= left;
  end.s.b = left * at.trial.b;
  end.status = PointStatus::yielded;
  end.at_floor = at.at_floor;
  end.place = at.place;
  end.shear += (1.0 - left) * at.trial.q / (std::sqrt(3.0) * at.trial.G);
  end.plastic_volume -= at.x;
  if (step.of.rates) set_plastic_rates(step, at, left, end);
  return end;
}

// First the rates at a constant angle, then that of the angle at which nothing is lacking, and with it all others.
void ModifiedCamClay::set_plastic_rates(const Step& step, const OnSurface& at, double left, Point& end) const {
  const Point& from = step.from;
  const double ratio = clay_.kappa / clay_.lambda, G = at.trial.G;
  const auto& [M, M_by_lode] = at.trial.slope;
  const Vector4 G_direct = direct_G_rate(step, G);
  Vector4 hardening = -from.log_c_rate;
  if (!at.at_floor) hardening = ratio * (hardening + from.log_p_rate + step.elastic_growth_rate);
  const Vector4 growth = hardening + from.log_c_rate - from.log_p_rate;
  Deviator trial = from.s;
  trial.b = at.trial.b;
  trial.b_rate += 2.0 * G * step.part.rate;  // at a constant G
  const Vector4 lack = 3.0 * G * at.sine * step.harden * (hardening - at.hardening * step.stiffer) +
                       M * at.cosine * at.q * (hardening + from.log_c_rate) +
                       at.lack_by_G * (G_direct + at.trial.G_by_growth * growth) +
                       trial.rate_along(at.lack_by_trial(), step.of);
  const Vector4 angle = -lack / at.lack_rate;

  end.log_c_rate += hardening + at.hardening_rate * angle;
  end.log_p_rate = end.log_c_rate + at.log_share_rate * angle;
  trial.b_rate +=
      2.0 * step.part.share * (G_direct + at.trial.G_by_growth * (end.log_p_rate - from.log_p_rate));
  Vector4 left_rate = Vector4::Zero();
  if (at.trial.has_direction) {
    Vector4 by_trial = -1.5 * left / (at.trial.q * at.trial.q) * at.trial.deviator;
    if (M_by_lode != 0.0) by_trial += left * M_by_lode / M * lode_gradient(at.trial.deviator, at.trial.q);
    left_rate = left * end.log_c_rate + 0.5 * M * at.p_c * at.cosine / at.trial.q * angle +
                trial.rate_along(by_trial, step.of);
  }
  end.s.a_rate = left * trial.a_rate + trial.a * left_rate;
  end.s.b_rate = left * trial.b_rate + trial.b * left_rate;
}

// Elastic to the end of the step, whether that is inside the surface or not.
ModifiedCamClay::ElasticEnd ModifiedCamClay::stay_elastic(const Step& step) const {
  const Point& from = step.from;
  ElasticEnd end;
  const double growth = std::max(step.elastic_growth, from.log_least - from.log_p);
  end.trial.growth = growth;
  end.log_share = growth + from.log_p - from.log_c;
  end.level = kInfinite;
  if (step.elastic_growth > kMostGrowth) return end;
  const double exponential = std::exp(growth);
  end.p = exponential * from.p;
  end.trial = trial_of(step, growth, exponential);
  const double height = end.trial.q / (end.trial.slope.M * end.p);
  end.level = end.p / from.p_c * (1.0 + height * height);
  return end;
}

// One step of backward Euler.
ModifiedCamClay::Point ModifiedCamClay::advance(const Increment& of, const Point& point, const Part& part,
                                                double guess) const {
  const Step step = step_from(of, point, part);
  const ElasticEnd elastic = stay_elastic(step);
  Point end = elastic.level <= 1.0 + kOnSurface
                  ? elastic_end(step, elastic)
                  : plastic_end(step, return_to_surface(step, elastic.log_share, guess));
  end.kappa = step.kappa;
  if (clay_.current_volume) {
    end.v *= std::exp(-step.volume);
    end.log_v_rate -= step.volume_rate;
  }
  return end;
}

// Rate of ln(level) at an elastic state.
Vector4 ModifiedCamClay::log_level_rate(const Increment& of, const Point& point) const {
  const double q = q_of(point.s.value);
  if (q <= kIsotropic * point.p_c) return point.log_p_rate;
  const Slope M = slope_of(point.s.value, q);
  const double height = q / (M.M * point.p), share = 2.0 * height * height / (1.0 + height * height);
  Vector4 by_s = 1.5 / (q * q) * point.s.value;
  if (M.by_lode != 0.0) by_s -= M.by_lode / M.M * lode_gradient(point.s.value, q);
  return (1.0 - share) * point.log_p_rate + share * point.s.rate_along(by_s, of);
}

// Whether a point is on the surface and leaves it at once.
bool ModifiedCamClay::yields_at_once(const Increment& of, const Point& start, const Vector4& deps) const {
  const Increment still{of.s, Vector4::Zero(), 0.0, true};
  const Part whole;
  const Step step = step_from(still, start, whole);
  const ElasticEnd end = stay_elastic(step);
  return end.level > 1.0 - kNearSurface && log_level_rate(still, elastic_end(step, end)).dot(deps) >= 0.0;
}

// The part of an increment that is elastic, where all of it is not: up to the surface, without an error of its own.
ModifiedCamClay::Part ModifiedCamClay::elastic_part(const Increment& of, const Point& start,
                                                    const Vector4& deps) const {
  if (yields_at_once(of, start, deps)) return {0.0};
  const Increment with_rates{of.s, of.e, of.volume, true};
  double low = 0.0, high = 1.0, share = 0.5;
  for (int round = 0; round < kRounds; ++round) {
    const Part part{share};
    const Step step = step_from(with_rates, start, part);
    const ElasticEnd end = stay_elastic(step);
    const double log_level = std::log(end.level);
    (log_level <= 0.0 ? low : high) = share;
    double next = 0.5 * (low + high);
    if (std::isfinite(log_level)) {
      // By the strains of the increment.
      const Vector4 rate = log_level_rate(with_rates, elastic_end(step, end));
      const double slope = rate.dot(deps) / share, newton = share - log_level / slope;
      if (std::abs(log_level) <= kOnSurface || high - low <= kOnSurface)
        return slope > 0.0 ? Part{share, -rate / slope} : Part{share};
      if (newton > low && newton < high) next = newton;
    }
    share = next;
  }
  return {low};
}

// The deviator over the mean stress.
ModifiedCamClay::Deviator ModifiedCamClay::ratio_of(const Point& point) {
  const double by_p = 1.0 / point.p;
  const Deviator& s = point.s;
  return {by_p * s.value, by_p * s.a, by_p * s.b, by_p * (s.a_rate - s.a * point.log_p_rate),
          by_p * (s.b_rate - s.b * point.log_p_rate)};
}

// Richardson's extrapolation from one step and two of half the size: of second order.  It works on ln p and s/p, and
// p_c follows, so that the answer is a stress on a surface.  Where the two differ much it is left out by degrees.
ModifiedCamClay::Point ModifiedCamClay::extrapolated(const Increment& of, const Point& once,
                                                     const Point& twice) const {
  const Deviator r1 = ratio_of(once), r2 = ratio_of(twice);
  const Deviator dr{r2.value - r1.value, r2.a - r1.a, r2.b - r1.b, r2.a_rate - r1.a_rate,
                    r2.b_rate - r1.b_rate};
  const double dp = twice.log_p - once.log_p;
  const Vector4 dp_rate = twice.log_p_rate - once.log_p_rate;
  const double share = weight_of(square_difference(dp, dr.value));
  const Vector4 share_rate =
      -2.0 * share * share / (kFar * kFar) * (dp * dp_rate + dr.rate_along(dr.value, of));
  Point end = twice;
  end.log_p += share * dp;
  end.log_p_rate += share * dp_rate + dp * share_rate;
  const double p = end.p = twice.p * std::exp(share * dp);
  end.s.value = p * (r2.value + share * dr.value);
  end.s.a = p * (r2.a + share * dr.a);
  end.s.b = p * (r2.b + share * dr.b);
  end.s.a_rate = p * (r2.a_rate + share * dr.a_rate + dr.a * share_rate) + end.s.a * end.log_p_rate;
  end.s.b_rate = p * (r2.b_rate + share * dr.b_rate + dr.b * share_rate) + end.s.b * end.log_p_rate;
  end.p_c = size_through(end.s.value - p * unit_tensor());
  end.shear += share * (twice.shear - once.shear);
  end.plastic_volume += share * (twice.plastic_volume - once.plastic_volume);
  return end;
}

// Elastic up to the surface; the rest once in one step, once in two.
ModifiedCamClay::PlasticIncrement ModifiedCamClay::plastic_increment(const Increment& of, const Point& start,
                                                                     const Vector4& deps) const {
  const Part elastic = elastic_part(of, start, deps), rest{1.0 - elastic.share, -elastic.rate};
  const Part half{0.5 * rest.share, 0.5 * rest.rate};
  Point yield = elastic.share > 0.0 ? advance(of, start, elastic, kCritical) : start;
  yield.place = place_at(yield.log_p - yield.log_c);
  PlasticIncrement increment{{}, advance(of, yield, half, yield.place), {}, false};
  const auto& [once, middle, twice, smooth] = increment;
  increment.twice = advance(of, middle, half, 2.0 * middle.place - yield.place);
  increment.once = advance(of, yield, rest, twice.place);
  increment.smooth = once.status == PointStatus::yielded && twice.status == PointStatus::yielded &&
                     !(once.at_floor || middle.at_floor || twice.at_floor);
  return increment;
}

ModifiedCamClay::Increment ModifiedCamClay::increment_of(const PointIn<4>& in, bool rates) {
  Vector4 e = deviator(in.deps);
  e[3] *= 0.5;
  return {deviator(in.sigma0), e, kVolumeRate.dot(in.deps), rates};
}

ModifiedCamClay::Point ModifiedCamClay::start_of(const PointIn<4>& in, const Increment& of) {
  Point start;
  start.s.value = of.s;
  start.p = std::max(-mean_stress(in.sigma0), in.h0[kLeast]);
  start.p_c = in.h0[kPressure];
  start.log_p = std::log(start.p / start.p_c);
  start.log_least = std::min(std::log(in.h0[kLeast] / start.p_c), start.log_p);
  start.v = in.h0[kVolume];
  return start;
}

// Two errors.  Of the steps: what extrapolation leaves is less than the square of what it takes away, but for what it was
// not allowed to.  Of the path: where stresses are held, the strains bend, and their straight line leads the stress off
// its chord by about as much as the end is wrong.
double ModifiedCamClay::path_error(const PointIn<4>& in, const Vector4& sigma,
                                   std::span<const double> h) const {
  if (h[kShear] == in.h0[kShear] && h[kPlasticVolume] == in.h0[kPlasticVolume]) return 0.0;
  const Increment of = increment_of(in, false);
  const PlasticIncrement increment = plastic_increment(of, start_of(in, of), in.deps);
  const auto& [once, middle, twice, smooth] = increment;
  const double square =
      square_difference(twice.log_p - once.log_p, twice.s.value / twice.p - once.s.value / once.p);
  const double left = smooth ? 1.0 - weight_of(square) : 1.0, steps = left * std::sqrt(square) + square;
  const Vector4 chord = sigma - in.sigma0, halfway = middle.s.value - middle.p * unit_tensor() - in.sigma0;
  const double length = contract(chord, chord);
  const Vector4 off = length > 0.0 ? Vector4(halfway - contract(halfway, chord) / length * chord) : halfway;
  const double path = std::sqrt(contract(off, off) / contract(sigma, sigma));
  return std::isfinite(steps) && std::isfinite(path) ? std::max(steps, path) : 0.0;
}

Outcome ModifiedCamClay::update(const PointIn<4>& in, PointOut<4>& out) const {
  std::copy(in.h0.begin(), in.h0.end(), out.h1.begin());
  out.sigma = in.sigma0;
  out.D.setZero();
  out.status = PointStatus::elastic;
  const Increment of = increment_of(in, true);
  const bool small = !clay_.current_volume || std::abs(of.volume) < kMostStrain;
  if (!(in.h0[kPressure] > 0.0 && in.h0[kLeast] > 0.0 && small)) return Outcome::cut_step;
  const Point start = start_of(in, of);
  const Part whole;
  Point end;
  if (stay_elastic(step_from(of, start, whole)).level <= 1.0 + kOnSurface) {
    end = advance(of, start, whole, kCritical);
  } else {
    const PlasticIncrement increment = plastic_increment(of, start, in.deps);
    end = increment.smooth ? extrapolated(of, increment.once, increment.twice) : increment.twice;
    out.h1[kPressure] = end.p_c;
    out.h1[kShear] = std::max(in.h0[kShear] + end.shear, in.h0[kShear]);
    out.h1[kPlasticVolume] += end.plastic_volume;
  }
  if (!(end.log_p < kMostGrowth && std::isfinite(end.p_c) && end.s.value.allFinite() &&
        std::isfinite(end.s.b) && end.s.a_rate.allFinite() && end.s.b_rate.allFinite() &&
        end.log_p_rate.allFinite())) {
    std::copy(in.h0.begin(), in.h0.end(), out.h1.begin());
    return Outcome::cut_step;
  }
  out.h1[kVolume] = end.v;
  if (!in.deps.isZero(0.0)) out.sigma = end.s.value - end.p * unit_tensor();
  out.D = of.s * end.s.a_rate.transpose() + of.e * end.s.b_rate.transpose() -
          end.p * unit_tensor() * end.log_p_rate.transpose() + end.s.b * deviatoric_projection();
  if (end.at_floor) out.D.topLeftCorner<3, 3>().array() += kFloorStiffness * end.p / end.kappa;
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
