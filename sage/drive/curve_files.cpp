#include "sage/drive/curve_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sage/draw/plot.hpp"
#include "sage/messages/code.hpp"
#include "sage/messages/error.hpp"
#include "sage/record/number.hpp"
#include "sage/record/values.hpp"

namespace sage::drive {

namespace {

// Those of all curves, in the order of their first appearance.
std::vector<const Column*> columns_of(const std::vector<Curve>& curves) {
  std::vector<const Column*> all;
  for (const Curve& curve : curves)
    for (const Column& column : curve.columns)
      if (std::ranges::none_of(all, [&](const Column* one) { return one->name == column.name; }))
        all.push_back(&column);
  return all;
}

std::string signs(const UnitSystem& units) {
  return fmt::format(
      "compression positive; shear changes sign with the normal components, shear strain is the "
      "engineering gamma; units {}, {}, {}; angles in degrees",
      units.length, units.force, units.stress);
}

void append_rows(std::string& text, const Curve& curve, const std::vector<const Column*>& columns, int digits) {
  std::vector<const Column*> own;
  for (const Column* column : columns) own.push_back(curve.find(column->name));
  for (std::size_t row = 0; row < curve.rows(); ++row) {
    text += curve.name.find(',') == std::string::npos ? curve.name : '"' + curve.name + '"';
    for (const Column* column : own) {
      const double value = column == nullptr ? std::nan("") : column->values[row];
      append_optional_cell(text, value, digits);
    }
    text += ',';
    text += status_name(curve.status[row]);
    text += '\n';
  }
}

std::pair<std::string, std::string> sides_of(const std::string& panel) {
  const std::size_t colon = panel.find(':');
  if (colon == std::string::npos || colon == 0 || colon + 1 == panel.size())
    throw InputError("S642", {}, fmt::format("{}: wanted X:Y, names of columns", panel));
  return {panel.substr(0, colon), panel.substr(colon + 1)};
}

const Column* find_in(const std::vector<Curve>& curves, const std::string& name) {
  for (const Curve& curve : curves)
    if (const Column* column = curve.find(name)) return column;
  return nullptr;
}

Plot panel_of(const std::vector<Curve>& curves, const std::string& panel) {
  const auto [x, y] = sides_of(panel);
  Plot plot;
  plot.x_label = label_of(*find_in(curves, x));
  plot.y_label = label_of(*find_in(curves, y));
  for (const Curve& curve : curves) {
    const Column *over = curve.find(x), *drawn = curve.find(y);
    if (over != nullptr && drawn != nullptr)
      plot.series.push_back({curves.size() > 1 ? curve.name : "", over->values, drawn->values, true, false});
  }
  return plot;
}

std::size_t place_of_largest(const std::vector<double>& values) {
  const auto smaller = [](double a, double b) { return std::abs(a) < std::abs(b); };
  return static_cast<std::size_t>(std::ranges::max_element(values, smaller) - values.begin());
}

}  // namespace

std::string label_of(const Column& column) {
  std::string label = column.name;
  std::ranges::replace(label, '_', ' ');
  return column.unit == "-" ? label : label + " [" + column.unit + "]";
}

std::string csv_text(const Heading& heading, const std::vector<Curve>& curves, int digits) {
  std::string text = "# " + heading.title + "\n# " + signs(heading.units) + "\n";
  for (const std::string& note : heading.notes) text += "# " + note + "\n";
  for (const Curve& curve : curves)
    if (!curve.failure.empty()) text += "# " + curve.name + ": " + with_code(curve.failure, "S607") + "\n";
  const std::vector<const Column*> columns = columns_of(curves);
  text += "case";
  for (const Column* column : columns) text += "," + column->name + "[" + column->unit + "]";
  text += ",status\n";
  for (const Curve& curve : curves) append_rows(text, curve, columns, digits);
  return text;
}

void expect_columns(const std::string& panel, const std::vector<Curve>& curves) {
  const auto [x, y] = sides_of(panel);
  for (const std::string& name : {x, y}) {
    if (find_in(curves, name) != nullptr) continue;
    std::string known;
    for (const Column* column : columns_of(curves)) known += (known.empty() ? "" : ", ") + column->name;
    throw InputError("S642", {}, fmt::format("{}: there is no column {}; there are {}", panel, name, known));
  }
}

std::string plot_text(const Heading& heading, const std::vector<Curve>& curves,
                      const std::vector<std::string>& panels) {
  PlotSheet sheet;
  sheet.title = heading.title;
  sheet.note = "compression positive";
  for (const std::string& panel : panels) sheet.panels.push_back(panel_of(curves, panel));
  sheet.columns = sheet.panels.size() > 1 ? 2 : 1;
  return sheet_svg(sheet);
}

std::vector<std::string> usual_panels(const LabTest* test, int law_size, bool undrained) {
  if (law_size == 2)
    return test != nullptr && test->driven == 1
               ? std::vector<std::string>{"relative_normal:normal"}
               : std::vector<std::string>{"relative_shear:shear", "relative_shear:relative_normal",
                                          "relative_shear:normal", "normal:shear"};
  if (test == nullptr) return {"mean_stress:deviator", "strain_yy:deviator"};
  const std::string over(strain_column(4, test->driven));
  if (test->drained == "0d00" || test->drained == "ppp0")
    return {over + ":" + std::string(stress_column(4, 1)), "stress_yy:volume_strain"};
  const std::string shear = test->driven == 3 ? "stress_xy" : "axial_deviator";
  if (undrained) return {over + ":" + shear, over + ":pore_pressure", "mean_stress:" + shear};
  return {over + ":" + shear, over + ":volume_strain"};
}

std::string summary_text(const std::vector<Curve>& curves, const std::string& panel) {
  const auto [x, y] = sides_of(panel);
  std::string text;
  for (const Curve& curve : curves) {
    text += fmt::format("{}: {} rows\n", curve.name, curve.rows());
    const Column *over = curve.find(x), *drawn = curve.find(y);
    if (over != nullptr && drawn != nullptr) {
      const std::size_t largest = place_of_largest(drawn->values);
      text += fmt::format("  largest  {} = {:.6g} at {} = {:.6g}\n", y, drawn->values[largest], x,
                          over->values[largest]);
      text += fmt::format("  end      {} = {:.6g} at {} = {:.6g}, {}\n", y, drawn->values.back(), x,
                          over->values.back(), status_name(curve.status.back()));
    }
    if (!curve.failure.empty()) text += "  STOPPED  " + with_code(curve.failure, "S607") + "\n";
  }
  return text;
}

}  // namespace sage::drive
