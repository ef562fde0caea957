#include "sage/bounds/cone_program.hpp"

#include <algorithm>
#include <cmath>

#include "sage/math/dense.hpp"
#include "sage/math/rounding.hpp"

namespace sage::bounds {

namespace {

// ---- second-order cones of three components

double bend(const Vector3& u) {
  return std::sqrt(u[1] * u[1] + u[2] * u[2]);
}
double determinant(const Vector3& u) {
  const double r = bend(u);
  return (u[0] - r) * (u[0] + r);
}
Vector3 product(const Vector3& u, const Vector3& v) {
  return {u.dot(v), u[0] * v[1] + v[0] * u[1], u[0] * v[2] + v[0] * u[2]};
}
// x with product(u, x) = v.
Vector3 quotient(const Vector3& u, const Vector3& v) {
  const double x0 = (u[0] * v[0] - u[1] * v[1] - u[2] * v[2]) / determinant(u);
  return {x0, (v[1] - x0 * u[1]) / u[0], (v[2] - x0 * u[2]) / u[0]};
}
// Largest step from u along d that stays in the cone.
double largest_step(const Vector3& u, const Vector3& d) {
  const double a = d[0] * d[0] - d[1] * d[1] - d[2] * d[2];
  const double b = u[0] * d[0] - u[1] * d[1] - u[2] * d[2];
  const double c = determinant(u), under = b * b - a * c;
  if (under < 0.0) return 1e30;
  const double below = -b + std::sqrt(under);
  return below > 0.0 ? c / below : 1e30;
}

// Nesterov-Todd scaling: W z = W^-1 s = lambda.
struct Scaling {
  Matrix3 W, inverse, square;  // inverse: of W; square: W^2
  Matrix3 flat;                // inverse of the lower right part of W^-2, without cancellation
  Vector3 lambda;

  void make(const Vector3& s, const Vector3& z) {
    const double ds = std::sqrt(determinant(s)), dz = std::sqrt(determinant(z));
    const Vector3 a = s / ds, b = z / dz;
    const double gamma = std::sqrt(0.5 * (1.0 + a.dot(b)));
    Vector3 w{a[0] + b[0], a[1] - b[1], a[2] - b[2]};
    w /= 2.0 * gamma;
    w[0] = std::sqrt(1.0 + w[1] * w[1] + w[2] * w[2]);
    const double eta = std::sqrt(ds / dz);
    Matrix3 inner;
    inner << w[0], w[1], w[2], w[1], 1.0 + w[1] * w[1] / (1.0 + w[0]), w[1] * w[2] / (1.0 + w[0]), w[2],
        w[1] * w[2] / (1.0 + w[0]), 1.0 + w[2] * w[2] / (1.0 + w[0]);
    W = eta * inner;
    inner(0, 1) = inner(1, 0) = -w[1];
    inner(0, 2) = inner(2, 0) = -w[2];
    inverse = inner / eta;
    square = W * W;
    lambda = W * z;
    const double r = bend(w), c = r > 0.0 ? w[1] / r : 1.0, d = r > 0.0 ? w[2] / r : 0.0;
    const double along = 1.0 / (1.0 + 2.0 * r * r), e2 = eta * eta;
    flat << 0.0, 0.0, 0.0, 0.0, e2 * (d * d + along * c * c), e2 * c * d * (along - 1.0), 0.0,
        e2 * c * d * (along - 1.0), e2 * (c * c + along * d * d);
  }
};

// ---- the interior point method

using Stresses = Eigen::Matrix3Xd;

struct Direction {
  Stresses sigma, s, z;
  Eigen::VectorXd y;
  double tau = 0.0;
};

struct Residuals {
  Stresses sigma, s;  // of the dual equations by point, of the yield conditions by cone
  Eigen::VectorXd y;  // of equilibrium
  double tau = 0.0;
};

// G^T x by point.
Stresses weighed(const ConeProgram& program, const Stresses& x) {
  Stresses sum(3, program.points());
  for (Eigen::Index c = 0; c < x.cols(); ++c) sum.col(c) = program.cones[c].G.transpose() * x.col(c);
  return sum;
}

std::vector<Coupling> couplings_of(const ConeProgram& program) {
  std::vector<Coupling> all;
  all.reserve(program.parts.size());
  for (const Part& part : program.parts) all.push_back({part.equations, part.place});
  return all;
}

class InteriorPoint {
 public:
  InteriorPoint(const ConeProgram& program, const ConeOptions& options)
      : p_(program), options_(options), factor_(program.equations(), couplings_of(program), program.dependent) {
    start();
  }

  ConeSolution run();

 private:
  static constexpr double kNegligible = rounding::kStrength;  // pivots

  void start();
  void scale_cones();
  void weigh_points(double soft);
  Vector3 moved(std::size_t c, Vector3 q) const;
  void factorise(double soft, double enough);
  Residuals residuals() const;
  // Residuals of systems of equations, relative.
  static constexpr double kExact = 1e-15;
  static constexpr double kRough = 1e-6;  // of steps that only guide others, or are far from the optimum

  // The Newton step to the residuals' end with the complementarity product(lambda, W dz + W^-1 ds) = target.
  Direction direction(const Residuals& r, const Stresses& target, double enough) const;
  void solve_refined(const Eigen::VectorXd& right, Eigen::VectorXd& x, double enough) const;
  Eigen::VectorXd multiply(const Eigen::VectorXd& x) const;
  double step_of(const Stresses& from, const Stresses& along) const;
  void advance(const Direction& d, double primal, double dual);
  void advance_velocities(const Direction& d);
  void settle_strains();
  double centre() const;
  void iterate_once(bool keep_centre = false);
  void correct(const Direction& affine, double mu, Stresses& target) const;
  void mend();
  void measure(ConeSolution& solution) const;
  void fill(ConeSolution& solution) const;
  void restore(const ConeSolution& solution);
  ConeSolution without_end(ConeSolution last);
  ConeSolution strict_one(std::vector<ConeSolution>& kept);
  bool good(const ConeSolution& solution) const;
  double size_of_loads() const {
    return 1e-300 + std::max(p_.b0.cwiseAbs().maxCoeff(), std::abs(tau_) * p_.b1.cwiseAbs().maxCoeff());
  }

  const ConeProgram& p_;
  const ConeOptions& options_;
  SparseFactor factor_;
  Stresses sigma_, s_, z_;
  Eigen::VectorXd y_;
  double tau_ = 0.0;
  std::vector<Scaling> scaling_;
  std::vector<Matrix3> inverse_;       // H^-1, H = G^T W^-2 G
  std::vector<Matrix3> left_inverse_;  // G^-1, or the pseudoinverse
  std::vector<char> flat_;             // no pressure in the yield condition
  std::vector<Matrix3> kernel_;        // projection on what G makes zero: stress without influence on yield
  Eigen::VectorXd column_, column_answer_;  // of tau in the reduced equations, and K^-1 of it
  Stresses h1_moved_;                       // H^-1 G^T W^-2 h1 by point
  double kappa_ = 0.0;
  double last_step_ = 0.0;
  bool far_ = true;  // from the optimum
};

void InteriorPoint::start() {
  const auto cones = static_cast<Eigen::Index>(p_.cones.size());
  sigma_.setZero(3, p_.points());
  s_.setZero(3, cones);
  z_.setZero(3, cones);
  y_.setZero(p_.equations());
  scaling_.resize(p_.cones.size());
  for (auto* list : {&inverse_, &left_inverse_, &kernel_}) list->assign(p_.cones.size(), Matrix3::Zero());
  flat_.resize(p_.cones.size());
  for (std::size_t c = 0; c < p_.cones.size(); ++c) {
    const Matrix3& G = p_.cones[c].G;
    flat_[c] = G.row(0).isZero();
    left_inverse_[c] = dense_matrix::pseudo_inverse(G);
    kernel_[c] = Matrix3::Identity() - left_inverse_[c] * G;
    if (kernel_[c].norm() < 1e-8) kernel_[c].setZero();
  }
  double size = 0.0;
  for (const Cone& cone : p_.cones) size = std::max(size, cone.h0[0]);
  if (size <= 0.0) size = 1.0;
  for (Eigen::Index c = 0; c < cones; ++c) {
    s_(0, c) = std::max(p_.cones[c].h0[0], size);
    z_(0, c) = 1.0 / (static_cast<double>(cones) * s_(0, c));
  }
}

void InteriorPoint::scale_cones() {
  for (std::size_t c = 0; c < scaling_.size(); ++c)
    scaling_[c].make(s_.col(static_cast<Eigen::Index>(c)), z_.col(static_cast<Eigen::Index>(c)));
}

// H^-1 and what comes with it, all by W^2: products with W^-2 and H, which grow without bound as a point comes to
// yield, would cancel each other.
void InteriorPoint::weigh_points(double soft) {
  kappa_ = 0.0;
  h1_moved_.resize(3, p_.points());
  for (std::size_t c = 0; c < scaling_.size(); ++c) {
    const Scaling& scaling = scaling_[c];
    const Matrix3& back = left_inverse_[c];
    const Vector3& h1 = p_.cones[c].h1;
    inverse_[c].noalias() = back * (flat_[c] ? scaling.flat : scaling.square) * back.transpose();
    inverse_[c] = (0.5 * (inverse_[c] + inverse_[c].transpose())).eval() + kernel_[c] / soft;
    h1_moved_.col(static_cast<Eigen::Index>(c)) = moved(c, h1);
    if (flat_[c]) kappa_ += h1[0] * h1[0] / scaling.square(0, 0);
  }
}

// H^-1 G^T W^-2 q.
Vector3 InteriorPoint::moved(std::size_t c, Vector3 q) const {
  if (flat_[c]) {
    const Vector3& column = scaling_[c].square.col(0);
    const double share = q[0] / column[0];
    q[1] -= column[1] * share;
    q[2] -= column[2] * share;
    q[0] = 0.0;
  }
  return left_inverse_[c] * q;
}

void InteriorPoint::factorise(double soft, double enough) {
  weigh_points(soft);
  Eigen::MatrixXd AH, K;
  factor_.factorise(
      [&](int i) -> const Eigen::MatrixXd& {
        const Part& part = p_.parts[i];
        AH.resize(part.A.rows(), part.A.cols());
        for (int k = 0; k < part.points; ++k)
          AH.middleCols<3>(3 * k).noalias() = part.A.middleCols<3>(3 * k) * inverse_[part.first_point + k];
        K.noalias() = AH * part.A.transpose();
        return K;
      },
      kNegligible);
  column_ = p_.b1 - forces(p_, h1_moved_);
  solve_refined(column_, column_answer_, enough);
}

Eigen::VectorXd InteriorPoint::multiply(const Eigen::VectorXd& x) const {
  Stresses e = strains(p_, x);
  for (int k = 0; k < p_.points(); ++k) e.col(k) = (inverse_[static_cast<std::size_t>(k)] * e.col(k)).eval();
  return forces(p_, e);
}

void InteriorPoint::solve_refined(const Eigen::VectorXd& right, Eigen::VectorXd& x, double enough) const {
  x = right;
  factor_.solve(x);
  Eigen::VectorXd rest = right - multiply(x);
  double last = rest.norm();
  for (int step = 0; step < 3 && last > enough * right.norm(); ++step) {
    Eigen::VectorXd correction = rest;
    factor_.solve(correction);
    const Eigen::VectorXd next = x + correction;
    rest = right - multiply(next);
    const double size = rest.norm();
    if (!(size < last)) break;
    x = next;
    if (size > 0.3 * last) break;
    last = size;
  }
}

Residuals InteriorPoint::residuals() const {
  Residuals r;
  r.y = p_.b0 + tau_ * p_.b1 - forces(p_, sigma_);
  r.sigma = -strains(p_, y_) - weighed(p_, z_);
  r.s.resize(3, s_.cols());
  r.tau = 1.0 + p_.b1.dot(y_);
  for (std::size_t c = 0; c < p_.cones.size(); ++c) {
    const Cone& cone = p_.cones[c];
    const auto k = static_cast<Eigen::Index>(c);
    r.s.col(k) = cone.h0 + tau_ * cone.h1 - cone.G * sigma_.col(k) - s_.col(k);
    r.tau += cone.h1.dot(z_.col(k));
  }
  return r;
}

Direction InteriorPoint::direction(const Residuals& r, const Stresses& target, double enough) const {
  Direction d;
  const auto cones = static_cast<Eigen::Index>(p_.cones.size());
  Stresses q(3, cones), start(3, cones);  // start: the stresses without dy and d.tau
  double R2 = r.tau;
  for (Eigen::Index c = 0; c < cones; ++c) {
    const auto i = static_cast<std::size_t>(c);
    const Scaling& scaling = scaling_[i];
    q.col(c) = r.s.col(c) - scaling.W * quotient(scaling.lambda, target.col(c));
    start.col(c) = inverse_[i] * r.sigma.col(c) + moved(i, q.col(c));
    R2 += h1_moved_.col(c).dot(r.sigma.col(c));
    if (flat_[i]) R2 -= p_.cones[i].h1[0] * q(0, c) / scaling.square(0, 0);
  }
  const Eigen::VectorXd right = forces(p_, start) - r.y;
  Eigen::VectorXd answer;
  solve_refined(right, answer, enough);
  d.tau = (R2 + column_.dot(answer)) / (kappa_ + column_.dot(column_answer_));
  d.y = answer - d.tau * column_answer_;
  const Stresses e = strains(p_, d.y);
  d.sigma.resize(3, p_.points());
  for (int k = 0; k < p_.points(); ++k)
    d.sigma.col(k) = start.col(k) - inverse_[static_cast<std::size_t>(k)] * e.col(k) + d.tau * h1_moved_.col(k);
  d.s.resize(3, cones);
  d.z.resize(3, cones);
  for (Eigen::Index c = 0; c < cones; ++c) {
    const Cone& cone = p_.cones[c];
    const Scaling& scaling = scaling_[c];
    const Vector3 move = cone.G * d.sigma.col(c) - d.tau * cone.h1;
    d.s.col(c) = r.s.col(c) - move;
    // From the dual equations, not by W^-2, which would magnify the rounding of the stresses.
    d.z.col(c) = left_inverse_[c].transpose() * (r.sigma.col(c) - e.col(c));
    if (flat_[c]) {
      const Vector3 last = scaling.square.col(0);
      d.z(0, c) = (move[0] - q(0, c) - last[1] * d.z(1, c) - last[2] * d.z(2, c)) / last[0];
    }
  }
  return d;
}

double InteriorPoint::step_of(const Stresses& from, const Stresses& along) const {
  double step = 1e30;
  for (Eigen::Index c = 0; c < from.cols(); ++c) step = std::min(step, largest_step(from.col(c), along.col(c)));
  return step;
}

void InteriorPoint::advance(const Direction& d, double primal, double dual) {
  sigma_ += primal * d.sigma;
  s_ += primal * d.s;
  tau_ += primal * d.tau;
  y_ += dual * d.y;
  z_ += dual * d.z;
}

double InteriorPoint::centre() const {
  return s_.cwiseProduct(z_).sum() / static_cast<double>(std::max<Eigen::Index>(s_.cols(), 1));
}

// keep_centre: a step to the point of the central path with the same mu, which ends residuals and leaves room.
void InteriorPoint::iterate_once(bool keep_centre) {
  scale_cones();
  // Weight of a change of stress without influence on yield.  Small: the velocities are exact after fewer steps;
  // large: the stresses are.
  const double proximal = options_.side == Side::primal ? 1e-4 : 1e-6;
  const double enough = far_ ? kRough : kExact;
  factorise(proximal * z_.row(0).sum() / (1e-300 + s_.row(0).sum()), enough);
  const Residuals r = residuals();
  const Eigen::Index cones = s_.cols();
  const double mu = centre();
  Stresses target(3, cones);
  for (Eigen::Index c = 0; c < cones; ++c) {
    const Vector3& lambda = scaling_[c].lambda;
    target.col(c) = -product(lambda, lambda);
  }
  if (keep_centre)
    target.row(0).array() += mu;
  else
    correct(direction(r, target, kRough), mu, target);
  const Direction d = direction(r, target, enough);
  const double keep = 0.98;
  const double primal = std::min(1.0, keep * step_of(s_, d.s)), dual = std::min(1.0, keep * step_of(z_, d.z));
  last_step_ = std::min(primal, dual);
  advance(d, primal, dual);
  settle_strains();
}

// Mehrotra's second order and centring, from the step that ignores both.
void InteriorPoint::correct(const Direction& affine, double mu, Stresses& target) const {
  const double ap = std::min(1.0, step_of(s_, affine.s)), ad = std::min(1.0, step_of(z_, affine.z));
  const double after = (s_ + ap * affine.s).cwiseProduct(z_ + ad * affine.z).sum() /
                       static_cast<double>(std::max<Eigen::Index>(s_.cols(), 1));
  const double share = std::clamp(std::pow(std::max(after, 0.0) / mu, 3.0), 1e-6, 1.0);
  for (Eigen::Index c = 0; c < target.cols(); ++c) {
    const Scaling& scaling = scaling_[c];
    target.col(c) -= product(scaling.inverse * affine.s.col(c), scaling.W * affine.z.col(c));
    target(0, c) += share * mu;
  }
}

// Removes the rounding that steps have left between velocities and strain rates, before a rate is as small as it.
void InteriorPoint::settle_strains() {
  const Stresses e = strains(p_, y_);
  for (std::size_t c = 0; c < scaling_.size(); ++c) {
    if (flat_[c]) continue;
    const auto k = static_cast<Eigen::Index>(c);
    const Vector3 now = z_.col(k), exact = -left_inverse_[c].transpose() * e.col(k);
    if ((exact - now).norm() <= 1e-3 * (now[0] - bend(now)) && exact[0] > bend(exact)) z_.col(k) = exact;
  }
}

// Where pressure has no influence on yield, z0 follows from the strains: least is their size.
void InteriorPoint::advance_velocities(const Direction& d) {
  double step = 1.0;
  for (std::size_t c = 0; c < scaling_.size(); ++c) {
    const auto k = static_cast<Eigen::Index>(c);
    if (!flat_[c]) step = std::min(step, 0.9 * largest_step(z_.col(k), d.z.col(k)));
  }
  advance(d, 0.0, step);
  for (std::size_t c = 0; c < scaling_.size(); ++c) {
    const auto k = static_cast<Eigen::Index>(c);
    if (flat_[c]) z_(0, k) = bend(z_.col(k)) * (1.0 + 1e-12) + 1e-300;
  }
}

// Corrections that end the residuals of one side, least where the yield condition leaves least room.  The scaling is
// that of a point farther inside the cones, for which the equations are far better conditioned.
void InteriorPoint::mend() {
  const bool primal = options_.side == Side::primal;
  const auto size = [&] {
    ConeSolution now;
    measure(now);
    return primal ? now.primal_residual : now.dual_residual;
  };
  const double mean = s_.row(0).mean();
  for (std::size_t c = 0; c < scaling_.size(); ++c) {
    Vector3 inside{1.0, 0.0, 0.0};
    if (primal) {
      inside = s_.col(static_cast<Eigen::Index>(c));
      inside[0] += 1e-4 * inside[0] + 1e-5 * mean;
    }
    scaling_[c].make(inside, Vector3(inside[0], -inside[1], -inside[2]) / determinant(inside));
  }
  factorise(primal ? 1.0 / (mean * mean) : 1e-6, kExact);
  double last = size();
  for (int turn = 0; turn < 20 && last > 1e-15; ++turn) {
    const Stresses sigma = sigma_, s = s_, z = z_;
    const Eigen::VectorXd y = y_;
    const double tau = tau_;
    Residuals r = residuals();
    if (primal) {
      r.sigma.setZero();
      r.tau = 0.0;
    } else {
      r.y.setZero();
      r.s.setZero();
    }
    const Direction d = direction(r, Stresses::Zero(3, s_.cols()), kExact);
    if (primal)
      advance(d, std::min(1.0, 0.9 * step_of(s_, d.s)), 0.0);
    else
      advance_velocities(d);
    const double now = size();
    if (!(now < last)) {
      sigma_ = sigma;
      s_ = s;
      z_ = z;
      y_ = y;
      tau_ = tau;
      break;
    }
    if (now > 0.8 * last) break;
    last = now;
  }
}

void InteriorPoint::measure(ConeSolution& solution) const {
  solution.tau = tau_;
  const Residuals r = residuals();
  solution.dual = p_.b0.dot(y_);
  for (std::size_t c = 0; c < p_.cones.size(); ++c)
    solution.dual += p_.cones[c].h0.dot(z_.col(static_cast<Eigen::Index>(c)));
  // A tau that reduces the strengths may be zero: a small part of them is what it is compared with.
  const bool strengths = std::ranges::any_of(p_.cones, [](const Cone& cone) { return cone.h1[0] != 0.0; });
  solution.scale = strengths ? 0.3 * s_.row(0).mean() : 0.0;
  solution.primal_residual = std::max(r.y.cwiseAbs().maxCoeff() / size_of_loads(),
                                      r.s.cwiseAbs().maxCoeff() / s_.cwiseAbs().maxCoeff());
  solution.dual_residual = r.sigma.cwiseAbs().maxCoeff() / z_.cwiseAbs().maxCoeff();
  solution.power_residual = std::abs(r.tau);
}

void InteriorPoint::fill(ConeSolution& solution) const {
  solution.sigma = sigma_;
  solution.s = s_;
  solution.z = z_;
  solution.u = -y_;
}

bool InteriorPoint::good(const ConeSolution& solution) const {
  // What the other side lacks moves the optimum a little, not the validity of a bound.
  return solution.primal_residual < 1e-4 && solution.dual_residual < 1e-4 && solution.power_residual < 1e-5 &&
         (options_.side == Side::primal ? solution.primal_residual < 1e-6 : solution.dual_residual < 1e-5);
}

ConeSolution InteriorPoint::run() {
  constexpr double kFar = 0.01;  // relative gap
  ConeSolution now;
  std::vector<ConeSolution> kept;  // good ones, by falling gap
  int short_steps = 0;
  for (now.iterations = 1; now.iterations <= options_.iterations; ++now.iterations) {
    if (options_.stop_asked && options_.stop_asked()) {
      now.status = ConeStatus::stopped;
      return now;
    }
    iterate_once();
    measure(now);
    far_ = now.relative_gap() > kFar;
    if (!std::isfinite(now.tau) || !std::isfinite(now.dual) || !z_.allFinite() || !s_.allFinite()) break;
    // Further iterations of a program that is solved as well as rounding lets it be only add rounding.
    if (good(now) && now.relative_gap() < (kept.empty() ? 1e-2 : kept.back().relative_gap())) {
      kept.push_back(now);
      fill(kept.back());
      if (now.relative_gap() <= options_.gap) break;
    }
    short_steps = last_step_ < 1e-2 ? short_steps + 1 : 0;
    if (short_steps > (kept.empty() ? 12 : 1)) break;
    if (!kept.empty() && now.iterations > kept.back().iterations + 6) break;
  }
  return kept.empty() ? without_end(now) : strict_one(kept);
}

// What the last iterate says where none was good.
ConeSolution InteriorPoint::without_end(ConeSolution last) {
  measure(last);
  fill(last);
  if (last.dual < -1e3) last.status = ConeStatus::infeasible;
  if (last.tau > 1e6) last.status = ConeStatus::unbounded;
  return last;
}

// The best solution that can be mended to rounding.  One closer to the optimum has less room for that.
ConeSolution InteriorPoint::strict_one(std::vector<ConeSolution>& kept) {
  constexpr double kRounding = rounding::kResult;
  ConeSolution best;
  const int iterations = kept.back().iterations;
  double smallest = 1e300;
  // Where there is no room at once, steps along the central path make some.
  for (int centred = 0; !kept.empty() && smallest > kRounding; centred = centred == 2 ? 0 : centred + 1) {
    restore(kept.back());
    if (centred == 2) kept.pop_back();
    for (int step = 0; step < 2 * centred; ++step) iterate_once(true);
    mend();
    ConeSolution mended;
    measure(mended);
    const double residual = options_.side == Side::primal ? mended.primal_residual : mended.dual_residual;
    if (!(residual < smallest)) continue;
    smallest = residual;
    fill(mended);
    best = std::move(mended);
    best.status = ConeStatus::solved;
    best.iterations = iterations;
  }
  return best;
}

void InteriorPoint::restore(const ConeSolution& solution) {
  sigma_ = solution.sigma;
  s_ = solution.s;
  z_ = solution.z;
  y_ = -solution.u;
  tau_ = solution.tau;
}

}  // namespace

Eigen::VectorXd forces(const ConeProgram& program, const Eigen::Matrix3Xd& sigma) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(program.equations()), local;
  for (const Part& part : program.parts) {
    const Eigen::Map<const Eigen::VectorXd> stress(sigma.data() + 3 * part.first_point, 3 * part.points);
    local.noalias() = part.A * stress;
    for (std::size_t i = 0; i < part.equations.size(); ++i) sum[part.equations[i]] += local[i];
  }
  return sum;
}

Eigen::Matrix3Xd strains(const ConeProgram& program, const Eigen::VectorXd& u) {
  Eigen::Matrix3Xd sum = Eigen::Matrix3Xd::Zero(3, program.points());
  Eigen::VectorXd local;
  for (const Part& part : program.parts) {
    local.resize(part.equations.size());
    for (std::size_t i = 0; i < part.equations.size(); ++i) local[i] = u[part.equations[i]];
    Eigen::Map<Eigen::VectorXd>(sum.data() + 3 * part.first_point, 3 * part.points).noalias() =
        part.A.transpose() * local;
  }
  return sum;
}

double ConeSolution::relative_gap() const {
  return std::abs(dual - tau) / std::max({1e-3, std::abs(tau), std::abs(dual), scale});
}

ConeSolution solve(const ConeProgram& program, const ConeOptions& options) {
  return InteriorPoint(program, options).run();
}

}  // namespace sage::bounds
