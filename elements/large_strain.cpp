#include "elements/large_strain.hpp"

namespace sage {

bool find_trial_strain(const ElasticShear& law, const PlaneGradient& step, PointIn<4>& point, Vector4& trial) {
  const Vector4& tau = point.sigma0;
  const double mean = (tau[0] + tau[1] + tau[2]) / 3.0, twice_G = 2.0 * law.shear_modulus(tau, point.h0);
  // An elastic strain without change of volume: that part is the same in the trial strain, whatever it is.
  const Vector4 elastic = (tau - mean * Vector4(1.0, 1.0, 1.0, 0.0)) / twice_G;
  if (!half_log(pushed_forward(stretch_of(elastic), step), trial)) return false;
  point.deps = trial - elastic;
  point.deps[3] *= 2.0;
  return true;
}

Outcome update_stress(const ElasticShear& law, const PointIn<4>& point, std::span<double> h1,
                      LogPoint& answer) {
  PointOut<4> result;
  result.h1 = h1;
  if (law.update(point, result) != Outcome::ok) return Outcome::cut_step;
  answer.tau = result.sigma;
  answer.D = result.D;
  answer.status = result.status;
  return Outcome::ok;
}

Eigen::Matrix<double, 5, 5> log_stiffness(const LogPoint& point) {
  const LogRate rate(point.trial);
  const Vector4 turned = point.D * rate.turn;
  const double across = 0.5 * rate.curve * rate.turn[0], along = 0.25 * rate.curve * rate.turn[3];
  Eigen::Matrix<double, 5, 5> C;
  auto rows = C.topRows<4>();
  rows.col(0) = point.D.col(0) + across * turned;
  rows.col(1) = point.D.col(1) - across * turned;
  rows.col(2) = point.D.col(2);
  rows.col(3) = point.D.col(3) + (along - 0.5) * turned;
  rows.col(4) = point.D.col(3) + (along + 0.5) * turned;
  C.row(4) = C.row(3);
  return C;
}

void add_initial_stress_stiffness(const Vector4& tau, Eigen::Matrix<double, 5, 5>& C) {
  enum { xx, yy, zz, xy, yx };
  C(xx, xx) -= tau[0], C(xx, xy) -= tau[3];
  C(xy, yx) -= tau[0], C(xy, yy) -= tau[3];
  C(yx, xx) -= tau[3], C(yx, xy) -= tau[1];
  C(yy, yx) -= tau[3], C(yy, yy) -= tau[1];
  C(zz, zz) -= tau[2];
}

}  // namespace sage
