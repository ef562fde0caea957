#include "elements/log_strain.hpp"

#include <cmath>

#include "sage/math/exp_and_log.hpp"

namespace sage {

PlaneGradient followed_by(const PlaneGradient& first, const PlaneGradient& next) {
  const PlaneGradient &a = first, &b = next;
  return {a.xx + b.xx + b.xx * a.xx + b.xy * a.yx, a.xy + b.xy + b.xx * a.xy + b.xy * a.yy,
          a.yx + b.yx + b.yx * a.xx + b.yy * a.yx, a.yy + b.yy + b.yx * a.xy + b.yy * a.yy,
          a.zz + b.zz + a.zz * b.zz};
}

Vector4 pushed_forward(const Vector4& c, const PlaneGradient& h) {
  // h b, b = 1 + c
  const double b_xx = 1.0 + c[0], b_yy = 1.0 + c[1], b_xy = c[3];
  const double xx = h.xx * b_xx + h.xy * b_xy, xy = h.xx * b_xy + h.xy * b_yy;
  const double yx = h.yx * b_xx + h.yy * b_xy, yy = h.yx * b_xy + h.yy * b_yy;
  return {c[0] + 2.0 * xx + xx * h.xx + xy * h.xy, c[1] + 2.0 * yy + yx * h.yx + yy * h.yy,
          c[2] + (1.0 + c[2]) * h.zz * (2.0 + h.zz), c[3] + xy + yx + xx * h.yx + xy * h.yy};
}

Vector4 stretch_of(const Vector4& e) {
  const double across = e[0] - e[1], shear = 2.0 * e[3], x = std::sqrt(across * across + shear * shear);
  const double low = exp_less_1(e[0] + e[1] - x);
  const double slope = (1.0 + low) * (x > 0.0 ? exp_less_1(2.0 * x) / (2.0 * x) : 1.0);
  const double mean = low + slope * x;
  return {mean + slope * across, mean - slope * across, exp_less_1(2.0 * e[2]), slope * shear};
}

bool half_log(const Vector4& c, Vector4& e) {
  const double across = 0.5 * (c[0] - c[1]), r = std::sqrt(across * across + c[3] * c[3]),
               low = 0.5 * (c[0] + c[1]) - r;
  if (!(low > -1.0) || !(c[2] > -1.0)) return false;
  const double slope = r > 0.0 ? log_1_plus(2.0 * r / (1.0 + low)) / (2.0 * r) : 1.0 / (1.0 + low);
  const double mean = log_1_plus(low) + slope * r;
  e = Vector4(0.5 * (mean + slope * across), 0.5 * (mean - slope * across), 0.5 * log_1_plus(c[2]),
              0.5 * slope * c[3]);
  return true;
}

LogRate::LogRate(const Vector4& e) {
  const double across = e[0] - e[1], shear = 2.0 * e[3], x2 = across * across + shear * shear;
  turn << -shear, shear, 0.0, 2.0 * across;
  const double x = std::sqrt(x2);
  curve = x2 < 1e-4 ? 1.0 / 3.0 - x2 * (1.0 / 45.0 - x2 * (2.0 / 945.0)) : (x / std::tanh(x) - 1.0) / x2;
}

}  // namespace sage
