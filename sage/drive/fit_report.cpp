#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sage/draw/plot.hpp"
#include "sage/drive/fit.hpp"

namespace sage::drive {

namespace {

void append_parameters(std::string& text, const FitProblem& problem, const FitResult& result) {
  text += fmt::format("{:<24} {:>12} {:>14} {:>12}   {}\n", "parameter", "start", "value", "std error",
                      "95 % confidence");
  for (std::size_t k = 0; k < problem.free.size(); ++k) {
    const FreeParameter& parameter = problem.free[k];
    const double start = problem.subject.values[static_cast<std::size_t>(parameter.place)];
    text += fmt::format("{:<24} {:>12.6g} {:>14.8g} ", parameter.name, start, result.values[k]);
    if (result.at_bound[k])
      text += fmt::format("{:>12}   at its bound ({:g} to {:g})\n", "-", parameter.low, parameter.high);
    else if (std::isnan(result.standard_errors[k]))
      text += fmt::format("{:>12}   not determined by these data\n", "-");
    else
      text += fmt::format("{:>12.4g}   {:.6g} to {:.6g}\n", result.standard_errors[k], result.low[k],
                          result.high[k]);
  }
}

void append_correlation(std::string& text, const FitProblem& problem, const FitResult& result) {
  if (problem.free.size() < 2) return;
  text += "correlation\n";
  for (std::size_t i = 0; i < problem.free.size(); ++i) {
    text += fmt::format("  {:<22}", problem.free[i].name);
    for (std::size_t j = 0; j <= i; ++j) {
      const double value = result.correlation(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      text += std::isnan(value) ? fmt::format(" {:>7}", "-") : fmt::format(" {:>7.3f}", value);
    }
    text += "\n";
  }
}

}  // namespace

std::string fit_text(const FitProblem& problem, const FitResult& result) {
  std::string text;
  append_parameters(text, problem, result);
  append_correlation(text, problem, result);
  for (const Undetermined& one : result.undetermined) {
    text += "the data can't tell apart: ";
    for (std::size_t i = 0; i < one.names.size(); ++i)
      text += fmt::format("{}{} ({:+.2f})", i == 0 ? "" : ", ", one.names[i], one.shares[i]);
    text += one.names.size() == 1
                ? ", which has no influence\n"
                : ": changed together in these proportions of their values they change nothing\n";
  }
  text += fmt::format(
      "{} values, {} parameters, {} evaluations; rms residual {:.3g} of the largest value of a column{}\n",
      result.points, problem.free.size(), result.evaluations, result.rms,
      result.converged ? "" : "; NOT CONVERGED");
  for (const Curve& curve : result.curves)
    if (!curve.failure.empty())
      text += fmt::format("{}: the fitted law {}\n", curve.name, with_code(curve.failure, "S607"));
  return text;
}

std::string fit_plot(const FitProblem& problem, const FitResult& result) {
  PlotSheet sheet;
  sheet.title = "fit of " + result.fitted.entry->name;
  sheet.note = "markers: measured; lines: fitted; right: fitted less measured. Compression positive";
  std::vector<std::string> columns;
  for (const Measured& measured : problem.curves)
    for (const Measured::Response& response : measured.responses)
      if (std::find(columns.begin(), columns.end(), response.column) == columns.end())
        columns.push_back(response.column);
  const std::string over(driven_column(*problem.test));
  const auto label = [&](const std::string& column) {
    const std::string& unit = result.curves.front().find(column)->unit;
    return unit == "-" ? column : column + " [" + unit + "]";
  };
  for (const std::string& column : columns) {
    Plot curves, rest;
    curves.x_label = rest.x_label = label(over);
    curves.y_label = label(column);
    rest.y_label = label(column) + ", fitted less measured";
    for (std::size_t c = 0; c < problem.curves.size(); ++c) {
      const Measured& measured = problem.curves[c];
      for (std::size_t r = 0; r < measured.responses.size(); ++r) {
        if (measured.responses[r].column != column) continue;
        const std::vector<double>& values = measured.responses[r].values;
        const Curve& fitted = result.curves[c];
        const int style = static_cast<int>(c);
        curves.series.push_back({measured.name, measured.driven, values, false, true, false, style});
        curves.series.push_back(
            {"", fitted.find(over)->values, fitted.find(column)->values, true, false, false, style});
        std::vector<double> left = result.model[c][r];
        for (std::size_t i = 0; i < left.size(); ++i) left[i] -= values[i];
        rest.series.push_back({measured.name, measured.driven, left, false, true, false, style});
      }
    }
    sheet.panels.push_back(curves);
    sheet.panels.push_back(rest);
  }
  return sheet_svg(sheet);
}

}  // namespace sage::drive
