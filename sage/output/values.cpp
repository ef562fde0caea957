#include "sage/output/values.hpp"

#include <fmt/format.h>

#include <cmath>

namespace sage {

std::string_view status_name(PointStatus status) {
  switch (status) {
    case PointStatus::elastic:
      return "elastic";
    case PointStatus::unloading:
      return "unloading";
    case PointStatus::yielded:
      return "yielded";
    case PointStatus::slipping:
      return "slipping";
    case PointStatus::open:
      return "open";
    case PointStatus::apex:
      return "apex";
  }
  return "?";
}

std::string_view method_name(Method method) {
  switch (method) {
    case Method::newton:
      return "Newton";
    case Method::modified_newton:
      return "modified Newton";
    case Method::initial_stiffness:
      return "initial stiffness";
    case Method::dogleg:
      return "Newton with dogleg";
  }
  return "?";
}

const AxisNames& axis_names(Geometry geometry) {
  static const AxisNames plane{
      "x", "y", {"sig-x", "sig-y", "sig-z", "tau-xy"}, {"eps-x", "eps-y", "eps-z", "gam-xy"}};
  static const AxisNames ring{
      "r", "z", {"sig-r", "sig-z", "sig-hoop", "tau-rz"}, {"eps-r", "eps-z", "eps-hoop", "gam-rz"}};
  return geometry == Geometry::axisymmetric ? ring : plane;
}

std::span<const Quantity> history_of(const GroupData& data) {
  return std::visit([](const auto* law) { return law->history(); }, data.law);
}

double stress_level(const GroupData& data, std::size_t point) {
  const auto history = static_cast<std::size_t>(data.state.history_size());
  const std::span<const double> h{data.state.committed.h.data() + point * history, history};
  const double* sigma =
      data.state.committed.sigma.data() + point * static_cast<std::size_t>(data.state.law_size());
  if (const auto* solid = std::get_if<const SolidLaw*>(&data.law))
    return (*solid)->stress_level(Vector4::Map(sigma), h);
  return std::get<const InterfaceLaw*>(data.law)->stress_level(Vector2::Map(sigma), h);
}

double outward(const Quantity& quantity, double value) {
  return quantity.dimension == Dimension::angle ? value / kRadiansPerDegree : value;
}

double mean_stress(const double* sigma) {
  return outward((sigma[0] + sigma[1] + sigma[2]) / 3.0);
}

double deviator_stress(const double* sigma) {
  const double a = sigma[0] - sigma[1], b = sigma[1] - sigma[2], c = sigma[2] - sigma[0];
  return std::sqrt(0.5 * (a * a + b * b + c * c) + 3.0 * sigma[3] * sigma[3]);
}

std::string left_out_words(const Model& model) {
  std::string text;
  for (const std::string& what : model.left_out) text += (text.empty() ? "left out " : "; ") + what;
  return text;
}

std::string completed_words(const Model& model) {
  if (model.left_out.empty()) return "completed: every increment in equilibrium";
  return "completed, but PARTIAL: " + left_out_words(model);
}

std::string one_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

std::string xml_text(std::string_view text) {
  std::string result;
  for (char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string forces_per(Geometry geometry) {
  return geometry == Geometry::axisymmetric ? "for the full circle (2 pi r)" : "per unit thickness";
}

std::string sign_convention(const Model& model, std::string_view mark) {
  const bool ring = model.geometry == Geometry::axisymmetric;
  const UnitSystem& u = model.units;
  return fmt::format(
      "{0}units: length {1}, force {2}, stress {3}; angles in degrees\n"
      "{0}stress and strain: compression positive; shear changes sign with them, so all four components have\n"
      "{0}  the sign opposite to the mathematical one.  Shear strain is the engineering gamma.\n"
      "{0}interfaces: normal stress and relative displacement positive in compression (closing); shear "
      "likewise reversed\n"
      "{0}displacements, loads and reactions: positive along +{4} and +{5}; reactions are what the supports do "
      "to the mesh\n"
      "{0}forces: {6}\n",
      mark, u.length, u.force, u.stress, ring ? "r" : "x", ring ? "z" : "y", forces_per(model.geometry));
}

}  // namespace sage
