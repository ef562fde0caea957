#include "materials/axial.hpp"

#include <algorithm>

namespace sage {

namespace {

Parameter stiffness_row() {
  return required("stiffness", Dimension::force, "EA of a bar or ring; of a spring its force per length");
}
Parameter spacing_row() {
  return optional("spacing", Dimension::length,
                  "distance between bars: stiffness and strength are those of one, divided by it", 1.0);
}

const std::vector<Parameter>& elastic_rows_of_bars() {
  static const std::vector<Parameter> rows{stiffness_row(), spacing_row()};
  return rows;
}
const std::vector<Parameter>& one_way_rows() {
  static const std::vector<Parameter> rows{
      stiffness_row(), optional("sense", Dimension::none, "1 carries tension alone, -1 compression alone", 1.0),
      spacing_row()};
  return rows;
}
const std::vector<Parameter>& plastic_rows() {
  static const std::vector<Parameter> rows{
      stiffness_row(), required("tension", Dimension::force, "largest tension", ParameterRole::strength),
      required("compression", Dimension::force, "largest compression, positive", ParameterRole::strength),
      spacing_row()};
  return rows;
}

}  // namespace

Outcome AxialElastic::update(const PointIn<1>& in, PointOut<1>& out) const {
  out.sigma = in.sigma0 + EA_ * in.deps;
  out.D(0, 0) = EA_;
  out.status = PointStatus::elastic;
  return Outcome::ok;
}

bool AxialOneWay::initialise(const Vector<1>& sigma, std::span<double> h) const {
  h[kSlack] = 0.0;
  return sign_ * sigma[0] >= 0.0;
}

bool AxialOneWay::accepts_history(const Vector<1>& sigma, std::span<const double> h) const {
  return h[kSlack] == 0.0 || (sign_ * h[kSlack] < 0.0 && sigma[0] == 0.0);
}

// The slack is the strain, shortening or lengthening, at which nothing is carried.
Outcome AxialOneWay::update(const PointIn<1>& in, PointOut<1>& out) const {
  const double strain = in.h0[kSlack] + in.deps[0];
  const double force = in.sigma0[0] + EA_ * strain;
  if (sign_ * force < 0.0) {
    out.sigma.setZero();
    out.D.setZero();
    out.h1[kSlack] = strain + in.sigma0[0] / EA_;
    out.status = PointStatus::open;
    return Outcome::ok;
  }
  out.sigma[0] = force;
  out.D(0, 0) = EA_;
  out.h1[kSlack] = 0.0;
  out.status = PointStatus::elastic;
  return Outcome::ok;
}

bool AxialPlastic::initialise(const Vector<1>& sigma, std::span<double> h) const {
  h[0] = 0.0;
  return sigma[0] <= tension_ && sigma[0] >= -compression_;
}

Outcome AxialPlastic::update(const PointIn<1>& in, PointOut<1>& out) const {
  const double trial = in.sigma0[0] + EA_ * in.deps[0];
  const double force = std::clamp(trial, -compression_, tension_);
  out.sigma[0] = force;
  out.D(0, 0) = force == trial ? EA_ : 0.0;
  out.h1[0] = in.h0[0] + (trial - force) / EA_;
  // A bar without strength in that sense is slack.
  out.status = force == trial ? PointStatus::elastic : force == 0.0 ? PointStatus::open : PointStatus::yielded;
  return Outcome::ok;
}

double AxialPlastic::stress_level(const Vector<1>& sigma, std::span<const double> /*h*/) const {
  const double limit = sigma[0] >= 0.0 ? tension_ : compression_;
  return limit > 0.0 ? std::abs(sigma[0]) / limit : 0.0;
}

MaterialEntry axial_elastic_entry() {
  return {"axial_elastic", "elastic bar, spring or ring", 1, elastic_rows_of_bars(),
          [](std::span<const double> values, const UnitSystem& units) -> LawPtr {
            const Parameters p(elastic_rows_of_bars(), values, units);
            return std::make_unique<AxialElastic>(p.positive("stiffness"), p.positive("spacing"));
          }};
}

MaterialEntry axial_one_way_entry() {
  return {"axial_one_way",
          "bar or spring that carries tension alone (anchor, geotextile) or compression alone (strut, prop)",
          1,
          one_way_rows(),
          [](std::span<const double> values, const UnitSystem& units) -> LawPtr {
            const Parameters p(one_way_rows(), values, units);
            return std::make_unique<AxialOneWay>(p.positive("stiffness"), p.positive("spacing"),
                                                 p.code("sense", {1, -1}) == 1);
          },
          AxialOneWay::kHistory};
}

MaterialEntry axial_plastic_entry() {
  return {"axial_plastic",
          "bar, spring or ring, elastic up to a largest tension and a largest compression",
          1,
          plastic_rows(),
          [](std::span<const double> values, const UnitSystem& units) -> LawPtr {
            const Parameters p(plastic_rows(), values, units);
            return std::make_unique<AxialPlastic>(p.positive("stiffness"), p.positive("spacing"),
                                                  p.not_negative("tension"), p.not_negative("compression"));
          },
          AxialPlastic::kHistory};
}

}  // namespace sage
