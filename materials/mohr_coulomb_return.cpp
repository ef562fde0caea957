#include "materials/mohr_coulomb_return.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "materials/stress_measures.hpp"
#include "sage/math/rounding.hpp"

namespace sage {

namespace {

using Vector3 = Vector<3>;
using Matrix3 = Matrix<3>;

constexpr double kRounding = rounding::kResult;
constexpr double kApexStiffness = 1e-7;  // share of D_elastic left where the true tangent is zero

// Planes that can be active when s1 >= s2 >= s3: Mohr-Coulomb in the pairs 13, 12, 23 and tension in 1, 2, 3.
enum Plane { f13, f12, f23, t1, t2, t3, none };
using ActiveSet = std::array<Plane, 3>;
constexpr std::array<ActiveSet, 3> kMohrCoulombSets{{{f13, none, none}, {f13, f12, none}, {f13, f23, none}}};
constexpr std::array<ActiveSet, 12> kTensionSets{{{t1, none, none},
                                                  {f13, none, none},
                                                  {t1, t2, none},
                                                  {f13, t1, none},
                                                  {f13, f12, none},
                                                  {f13, f23, none},
                                                  {t1, t2, t3},
                                                  {f13, f12, t1},
                                                  {f13, t1, t2},
                                                  {f13, f23, t1},
                                                  {f13, f23, t2},
                                                  {f23, t1, t2}}};

// n . s, with slope = N for the plane, M for the flow.
Vector3 normal(Plane plane, double slope) {
  switch (plane) {
    case f13:
      return {slope, 0.0, -1.0};
    case f12:
      return {slope, -1.0, 0.0};
    case f23:
      return {0.0, slope, -1.0};
    case t1:
      return {1.0, 0.0, 0.0};
    case t2:
      return {0.0, 1.0, 0.0};
    case t3:
      return {0.0, 0.0, 1.0};
    case none:
      break;
  }
  return Vector3::Zero();
}

// The n planes of a set: A their normals, D B their plastic stresses, y where they stand.  D is that of the principal
// stresses over its first term, so that no unit of stress can make the inverse overflow.
template <int n>
struct PlaneSet {
  PlaneSet(const MohrCoulombPlanes& planes, const Matrix3& D, const ActiveSet& set) {
    Eigen::Matrix<double, 3, n> B;
    for (int i = 0; i < n; ++i) {
      const Plane plane = set[i];
      A.col(i) = normal(plane, planes.N);
      B.col(i) = normal(plane, planes.M);
      y[i] = plane < t1 ? planes.Y : planes.T;
    }
    DB.noalias() = D * B;
    S_inverse = Matrix<n>(A.transpose() * DB).inverse();
  }
  Vector<n> multipliers(const Vector3& sigma) const { return S_inverse * (A.transpose() * sigma - y); }

  Eigen::Matrix<double, 3, n> A, DB;
  Matrix<n> S_inverse;
  Vector<n> y;
};

int size_of(const ActiveSet& set) {
  return set[2] != none ? 3 : set[1] != none ? 2 : 1;
}

struct Candidate {
  Vector3 sigma;
  Matrix3 R;
  bool vertex;  // three planes: the stress can't move
  ActiveSet set{none, none, none};
  Vector3 lambda = Vector3::Zero();
};

// Order kept and no plane exceeded, to the rounding of the trial stress.
bool acceptable(const MohrCoulombPlanes& planes, const Vector3& s, double cut_off, double rounding) {
  const bool ordered = s[0] >= s[1] - rounding && s[1] >= s[2] - rounding;
  return ordered && s[0] <= cut_off + rounding && planes.N * s[0] - s[2] - planes.Y <= planes.N * rounding;
}

// What every set is tried with.
struct Search {
  const MohrCoulombPlanes& planes;
  const Matrix3& D;
  const Vector3& trial;
  double cut_off, rounding;
};

// Koiter: s = s_tr - D B lambda,  lambda = (A^T D B)^-1 (A^T s_tr - y).  Whether that is the answer; `found` is what it
// gives where lambda >= 0, and for the last set in any case.
template <int n>
bool try_set(const Search& search, const ActiveSet& set, bool last, Candidate& found) {
  const PlaneSet<n> active(search.planes, search.D, set);
  const Vector<n> lambda = active.multipliers(search.trial);
  const bool loaded = lambda.minCoeff() >= -search.rounding;
  if (!loaded && !last) return false;
  found.sigma = search.trial - active.DB * lambda;
  // A trial stress far away leaves its rounding on the planes: take it off again.
  for (int repeat = 0; repeat < 2; ++repeat) found.sigma -= active.DB * active.multipliers(found.sigma);
  const bool answer = loaded && acceptable(search.planes, found.sigma, search.cut_off, search.rounding);
  if (!answer && !last) return false;
  found.R = Matrix3::Identity() - active.DB * active.S_inverse * active.A.transpose();
  found.vertex = n == 3;
  found.set = set;
  found.lambda.setZero();
  found.lambda.template head<n>() = lambda;
  return answer;
}

// The sets are tried from few planes to many; a set with multipliers >= 0 is the answer, and the last one if there is none.
template <std::size_t Count>
bool find_set(const Search& search, const std::array<ActiveSet, Count>& sets, Candidate& found) {
  for (const ActiveSet& set : sets) {
    const bool last = set == sets.back();
    const int planes = size_of(set);
    if (planes == 1   ? try_set<1>(search, set, last, found)
        : planes == 2 ? try_set<2>(search, set, last, found)
                      : try_set<3>(search, set, last, found))
      return true;
  }
  return false;
}

// d sigma of an answer while its planes move: S d(lambda) = dA^T sigma - dy - A^T D dB lambda,
// d sigma = -D (dB lambda + B d(lambda)).
template <int n>
Vector3 rate_of_set(const MovingPlanes& moving, const Matrix3& D, const Candidate& c) {
  const auto& [planes, rates] = moving;
  Vector3 flow = Vector3::Zero();
  Vector<n> right;
  for (int i = 0; i < n; ++i) {
    const Plane plane = c.set[i];
    // d(normal)/d(slope): the slope stands with the larger of the two principals.
    const Vector3 turn = plane < t1 ? Vector3(normal(plane, 1.0) - normal(plane, 0.0)) : Vector3::Zero();
    flow += rates.M * c.lambda[i] * turn;
    right[i] = rates.N * turn.dot(c.sigma) - (plane < t1 ? rates.Y : rates.T);
  }
  const PlaneSet<n> active(planes, D, c.set);
  return -(D * flow + active.DB * (active.S_inverse * (right - active.A.transpose() * (D * flow))));
}

// The apex, which is no set of planes, moves by itself.
Vector3 rate_of(const MovingPlanes& moving, const Matrix3& D, const Candidate& c) {
  const auto& [planes, rates] = moving;
  if (c.set[0] == none) {
    const double above = planes.N - 1.0;
    return Vector3::Constant(planes.T < planes.apex() ? rates.T
                                                      : rates.Y / above - planes.Y * rates.N / (above * above));
  }
  const int n = size_of(c.set);
  return n == 1   ? rate_of_set<1>(moving, D, c)
         : n == 2 ? rate_of_set<2>(moving, D, c)
                  : rate_of_set<3>(moving, D, c);
}

// Sorted trial stress to sorted answer.
Candidate return_sorted(const MohrCoulombPlanes& planes, const Matrix3& D, const Vector3& trial) {
  const double apex = planes.apex();
  Candidate c;
  const Search search{planes, D, trial, std::min(planes.T, apex), kRounding * trial.cwiseAbs().maxCoeff()};
  const bool found =
      planes.T < apex ? find_set(search, kTensionSets, c) : find_set(search, kMohrCoulombSets, c);
  const double tip = std::min(planes.T, apex);
  if (found || !std::isfinite(tip)) return c;  // without a tip the last edge differs by rounding only
  return {Vector3::Constant(tip), Matrix3::Zero(), true, {none, none, none}, Vector3::Zero()};
}

// D of the principal stresses over its first term: no answer depends on its size.
Matrix3 principal_stiffness(const ElasticModuli& elastic) {
  const Matrix3 D = elastic_matrix(elastic).topLeftCorner<3, 3>();
  return D / D(0, 0);
}

// A trial stress in its principal axes, and what it comes back to there.
struct InAxes {
  explicit InAxes(const Principal& trial) : axes(trial), value{axes.a, axes.b, axes.zz} {
    order = axes.zz >= axes.a   ? std::array<int, 3>{2, 0, 1}
            : axes.zz >= axes.b ? std::array<int, 3>{0, 2, 1}
                                : std::array<int, 3>{0, 1, 2};
    for (int i = 0; i < 3; ++i) sorted[i] = value[order[i]];
  }
  // [a b zz ab] of values in the order from largest to smallest.
  Vector4 unsorted(const Vector3& from_largest) const {
    Vector4 all = Vector4::Zero();
    for (int i = 0; i < 3; ++i) all[order[i]] = from_largest[i];
    return all;
  }

  Principal axes;
  Vector3 value;             // [a b zz]
  std::array<int, 3> order;  // of the largest first
  Vector3 sorted;
};

// Back to [xx yy zz xy].
MohrCoulombReturn in_place(const MohrCoulombPlanes& planes, const InAxes& trial, const Candidate& answer) {
  // The shear ab turns with the axes: (sa - sb)/(sa_tr - sb_tr).   [Clausen et al. 2006]
  const Principal& axes = trial.axes;
  const Vector4 sigma = trial.unsorted(answer.sigma);
  Matrix4 R = Matrix4::Zero();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) R(trial.order[i], trial.order[j]) = answer.R(i, j);
  const double apart = axes.a - axes.b;
  const bool distinct = apart > 1e-9 * trial.value.cwiseAbs().maxCoeff();
  R(3, 3) = distinct ? (sigma[0] - sigma[1]) / apart : 0.5 * (R(0, 0) - R(0, 1) - R(1, 0) + R(1, 1));

  const Matrix4 T = stress_from_principal_axes(axes.cos_2, axes.sin_2);
  const Matrix4 T_back = stress_from_principal_axes(axes.cos_2, -axes.sin_2);
  MohrCoulombReturn result;
  result.sigma = T * sigma;
  result.R = T * R * T_back;
  if (answer.vertex) result.R += kApexStiffness * Matrix4::Identity();
  const double apex = planes.apex(), tip = std::min(planes.T, apex);
  const bool at_tip = answer.sigma[0] >= tip - kRounding * trial.value.cwiseAbs().maxCoeff();
  result.status = !answer.vertex && !at_tip ? PointStatus::yielded
                  : planes.T < apex         ? PointStatus::cut_off
                                            : PointStatus::apex;
  return result;
}

}  // namespace

double MohrCoulombPlanes::apex() const {
  return N > 1.0 ? Y / (N - 1.0) : std::numeric_limits<double>::infinity();
}

bool outside(const MohrCoulombPlanes& planes, const Principal& s) {
  const double s1 = std::max(s.a, s.zz), s3 = std::min(s.b, s.zz);
  const double scale = planes.Y + planes.N * std::abs(s1) + std::abs(s3);
  return planes.N * s1 - s3 - planes.Y > kRounding * scale ||
         s1 - std::min(planes.T, planes.apex()) > kRounding * scale;
}

MohrCoulombReturn return_to_planes(const MohrCoulombPlanes& planes, const ElasticModuli& elastic,
                                   const Principal& trial) {
  const InAxes axes(trial);
  return in_place(planes, axes, return_sorted(planes, principal_stiffness(elastic), axes.sorted));
}

MovedReturn return_to_moving_planes(const MovingPlanes& moving, const ElasticModuli& elastic,
                                    const Vector4& trial) {
  const InAxes axes(principal(trial));
  const Matrix3 D = principal_stiffness(elastic);
  const Candidate answer = return_sorted(moving.planes, D, axes.sorted);
  const Matrix4 T = stress_from_principal_axes(axes.axes.cos_2, axes.axes.sin_2);
  const Matrix4 T_back = stress_from_principal_axes(axes.axes.cos_2, -axes.axes.sin_2);
  return {in_place(moving.planes, axes, answer), T * axes.unsorted(rate_of(moving, D, answer)),
          T_back.transpose() * axes.unsorted(Vector3::UnitX())};
}

}  // namespace sage
