#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "sage/draw/plot.hpp"
#include "sage/drive/curve_files.hpp"
#include "sage/drive/fit.hpp"

namespace sage::drive {

namespace {

void append_parameters(std::string& text, const FitProblem& problem, const FitResult& result) {
  text += fmt::format("{:<24} {:>12} {:>14} {:>12}   {}\n", "parameter", "start", "value", "std error",
                      "95 % confidence");
  for (std::size_t k = 0; k < problem.free.size(); ++k) {
    const FreeParameter& parameter = problem.free[k];
    const double start = problem.subject.values[parameter.place];
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

// What is measured over what is driven: a panel each.
std::vector<std::pair<std::string, std::string>> panels_of(const FitProblem& problem) {
  std::vector<std::pair<std::string, std::string>> panels;
  for (const Measured& measured : problem.curves)
    for (const Measured::Response& response : measured.responses) {
      const std::pair panel{std::string(driven_column(*measured.test)), response.column};
      if (std::find(panels.begin(), panels.end(), panel) == panels.end()) panels.push_back(panel);
    }
  return panels;
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
  for (const auto& [over, column] : panels_of(problem)) {
    Plot curves, rest;
    for (std::size_t c = 0; c < problem.curves.size(); ++c) {
      const Measured& measured = problem.curves[c];
      if (driven_column(*measured.test) != over) continue;
      for (std::size_t r = 0; r < measured.responses.size(); ++r) {
        if (measured.responses[r].column != column) continue;
        const std::vector<double>& values = measured.responses[r].values;
        const Column &x = *result.curves[c].find(over), &y = *result.curves[c].find(column);
        curves.x_label = rest.x_label = label_of(x);
        curves.y_label = label_of(y);
        rest.y_label = label_of(y) + ", fitted less measured";
        const int style = static_cast<int>(c);
        curves.series.push_back({measured.name, measured.driven, values, false, true, false, style});
        curves.series.push_back({"", x.values, y.values, true, false, false, style});
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
