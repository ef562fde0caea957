#include "materials/section.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sage {

namespace {

constexpr double kShearShare = 5.0 / 6.0;  // of a rectangle

const std::vector<Parameter>& plate_rows() {
  static const std::vector<Parameter> rows{
      required("youngs_modulus", Dimension::stress, "Young's modulus E", ParameterRole::youngs_modulus),
      required("poissons_ratio", Dimension::none, "Poisson's ratio nu", ParameterRole::poissons_ratio),
      required("thickness", Dimension::length, "thickness t", ParameterRole::thickness),
      optional(
          "across", Dimension::none,
          "1 plate that goes on across the section: E/(1-nu^2), and hoop stiffness in axisymmetry; 0 strips "
          "side by side: E, nothing across",
          1.0),
      optional("shear_share", Dimension::none, "part of the thickness that carries shear", kShearShare)};
  return rows;
}

std::vector<Parameter> stiffness_rows() {
  return {required("axial_stiffness", Dimension::force, "EA for each unit of width"),
          required("bending_stiffness", Dimension::bending_stiffness, "EI for each unit of width")};
}
void add_other_rows(std::vector<Parameter>& rows) {
  rows.push_back(optional("shear_stiffness", Dimension::force,
                          "GA for each unit of width; 0: 5/12 EA, a rectangle of nu = 0", 0.0));
  rows.push_back(optional("hoop_stiffness", Dimension::force, "EA around the axis of symmetry", 0.0));
  rows.push_back(
      optional("hoop_bending_stiffness", Dimension::bending_stiffness, "EI around the axis of symmetry", 0.0));
}

const std::vector<Parameter>& section_rows() {
  static const std::vector<Parameter> rows = [] {
    std::vector<Parameter> all = stiffness_rows();
    add_other_rows(all);
    return all;
  }();
  return rows;
}

const std::vector<Parameter>& plastic_section_rows() {
  static const std::vector<Parameter> rows = [] {
    std::vector<Parameter> all = stiffness_rows();
    all.push_back(required("axial_strength", Dimension::force, "N_p for each unit of width; 0: no limit",
                           ParameterRole::strength));
    all.push_back(
        required("moment_strength", Dimension::moment, "M_p for each unit of width", ParameterRole::strength));
    add_other_rows(all);
    return all;
  }();
  return rows;
}

LawPtr make_plate(std::span<const double> values, const UnitSystem& units) {
  const Parameters p(plate_rows(), values, units);
  const double E = p.positive("youngs_modulus"), nu = p.number("poissons_ratio"), t = p.positive("thickness");
  if (!(nu > -1.0 && nu <= 0.5)) p.refuse("poissons_ratio", "must lie between -1 and 0.5");
  const bool plate = p.code("across", {0, 1}) == 1;
  const double modulus = plate ? E / (1.0 - nu * nu) : E;
  SectionStiffness s;
  s.EA = modulus * t;
  s.EI = modulus * t * t * t / 12.0;
  s.GA = p.positive("shear_share") * E / (2.0 * (1.0 + nu)) * t;
  if (plate) {
    s.EA_around = s.EA;
    s.EI_around = s.EI;
    s.coupling = nu;
  }
  return std::make_unique<SectionElastic>(s);
}

SectionStiffness stiffness_of(const Parameters& p) {
  SectionStiffness s;
  s.EA = p.positive("axial_stiffness");
  s.EI = p.positive("bending_stiffness");
  s.GA = p.not_negative("shear_stiffness");
  if (s.GA == 0.0) s.GA = 0.5 * kShearShare * s.EA;
  s.EA_around = p.not_negative("hoop_stiffness");
  s.EI_around = p.not_negative("hoop_bending_stiffness");
  return s;
}

LawPtr make_section(std::span<const double> values, const UnitSystem& units) {
  return std::make_unique<SectionElastic>(stiffness_of(Parameters(section_rows(), values, units)));
}

LawPtr make_plastic_section(std::span<const double> values, const UnitSystem& units) {
  const Parameters p(plastic_section_rows(), values, units);
  const double axial = p.not_negative("axial_strength");
  return std::make_unique<SectionPlastic>(stiffness_of(p),
                                          axial > 0.0 ? axial : std::numeric_limits<double>::infinity(),
                                          p.positive("moment_strength"));
}

}  // namespace

Matrix<5> SectionStiffness::matrix() const {
  Matrix<5> D = Matrix<5>::Zero();
  D(0, 0) = EA;
  D(1, 1) = EA_around;
  D(2, 2) = GA;
  D(3, 3) = EI;
  D(4, 4) = EI_around;
  D(0, 1) = D(1, 0) = coupling * EA;
  D(3, 4) = D(4, 3) = coupling * EI;
  return D;
}

bool SectionPlastic::initialise(const Vector<5>& sigma, std::span<double> h) const {
  std::fill(h.begin(), h.end(), 0.0);
  return stress_level(sigma, h) <= 1.0 + 1e-12;
}

double SectionPlastic::stress_level(const Vector<5>& sigma, std::span<const double> /*h*/) const {
  const double n = n_ * sigma[kAxial];
  return m_ * std::abs(sigma[kBending]) + n * n;
}

// lambda with m - EI m_^2 lambda + (n/(1 + 2 EA n_^2 lambda))^2 = 1 for the trial m and n.  The left side falls and
// is convex, so that Newton climbs to the answer from 0.
double SectionPlastic::multiplier(double N, double M) const {
  constexpr int kMostSteps = 100;
  const double n = n_ * std::abs(N), m = m_ * std::abs(M);
  const double a = 2.0 * s_.EA * n_ * n_, b = s_.EI * m_ * m_;
  double lambda = 0.0;
  for (int step = 0; step < kMostSteps; ++step) {
    const double share = 1.0 / (1.0 + a * lambda), left = n * share;
    const double over = m - b * lambda + left * left - 1.0;
    const double change = over / (b + 2.0 * a * share * left * left);
    lambda += change;
    if (!(change > 1e-16 * lambda)) break;
  }
  return lambda;
}

Outcome SectionPlastic::update(const PointIn<5>& in, PointOut<5>& out) const {
  out.sigma = in.sigma0 + D_ * in.deps;
  out.D = D_;
  std::copy(in.h0.begin(), in.h0.end(), out.h1.begin());
  out.status = PointStatus::elastic;
  const double N = out.sigma[kAxial], M = out.sigma[kBending];
  if (stress_level(out.sigma, in.h0) <= 1.0) return Outcome::ok;
  out.status = PointStatus::yielded;
  const double lambda = multiplier(N, M), h = s_.EA / (1.0 + 2.0 * s_.EA * n_ * n_ * lambda);
  const double sign = M < 0.0 ? -1.0 : 1.0, M1 = M - sign * s_.EI * m_ * lambda;
  if (sign * M1 < 0.0) {  // the tip: all force, no moment
    out.sigma[kAxial] = std::copysign(1.0 / n_, N);
    out.sigma[kBending] = 0.0;
    out.D(kAxial, kAxial) = out.D(kBending, kBending) = 0.0;
  } else {
    out.sigma[kAxial] = h / s_.EA * N;
    out.sigma[kBending] = M1;
    const Vector2 g(2.0 * n_ * n_ * out.sigma[kAxial], sign * m_), Dg(h * g.x(), s_.EI * g.y());
    const double along = g.dot(Dg);
    out.D(kAxial, kAxial) = h - Dg.x() * Dg.x() / along;
    out.D(kBending, kBending) = s_.EI - Dg.y() * Dg.y() / along;
    out.D(kAxial, kBending) = out.D(kBending, kAxial) = -Dg.x() * Dg.y() / along;
  }
  out.h1[0] += (N - out.sigma[kAxial]) / s_.EA;
  out.h1[1] += (M - out.sigma[kBending]) / s_.EI;
  return Outcome::ok;
}

MaterialEntry section_plastic_entry() {
  return {"section_plastic",
          "beam or shell, elastic until axial force and moment together reach the strength of its section",
          5,
          plastic_section_rows(),
          make_plastic_section,
          SectionPlastic::kHistory};
}

MaterialEntry plate_entry() {
  return {"plate", "elastic beam or shell of one thickness, from E and nu", 5, plate_rows(), make_plate};
}

MaterialEntry section_elastic_entry() {
  return {"section_elastic", "elastic beam or shell from the stiffnesses of its section", 5, section_rows(),
          make_section};
}

}  // namespace sage
