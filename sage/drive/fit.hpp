// Parameters of a law from measured curves: least squares, and what the data say about each parameter.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "sage/drive/curve.hpp"

namespace sage::drive {

// A parameter that is looked for, from the value of the subject on.
struct FreeParameter {
  int place = 0;  // among the parameters of the law
  std::string name;
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
};

// "NAME" or "NAME=LOW:HIGH".  Without bounds angles stay in [0, 89] degrees, Poisson's ratio in [0, .4999], stresses
// and stiffnesses above 0; the law refuses what else can't be meant.  Throws InputError, also where the subject's own value lies outside.
FreeParameter free_parameter_from(const Subject& subject, std::string_view text);

// A curve of a test: values of what is driven, and of what was measured there.  Compression positive.
struct Measured {
  std::string name;
  const LabTest* test = nullptr;
  bool undrained = false;
  double pressure = 0.0;  // at the start
  std::vector<double> driven;
  struct Response {
    std::string column;          // as Curve names it
    std::vector<double> values;  // NaN = not measured there
  };
  std::vector<Response> responses;
};

// Reads a table whose first column is what the test drives and whose others are columns of a Curve.  Throws
// InputError with line and column.
Measured read_measured(const std::filesystem::path& file, const LabTest& test, bool undrained, double pressure);

struct FitProblem {
  Subject subject;  // with the starting values
  double normal_stiffness = 0.0;
  int steps = 100;  // of a curve, about; more where it has more points
  std::vector<Measured> curves;
  std::vector<FreeParameter> free;
};

// A combination of parameters that leaves the curves as they are: each with its share, relative to its value.
struct Undetermined {
  double singular_value = 0.0;  // of the scaled Jacobian, as a share of the largest
  std::vector<std::string> names;
  std::vector<double> shares;
};

struct FitResult {
  Subject fitted;
  std::vector<double> values, standard_errors;  // one a free parameter; the error is NaN where there is none
  std::vector<double> low, high;                // 95 % confidence, by Student's t
  std::vector<bool> at_bound;
  Eigen::MatrixXd correlation;  // NaN where a parameter is not determined
  std::vector<Undetermined> undetermined;
  int points = 0, evaluations = 0;
  double rms = 0.0;  // of (model - measured)/(largest measured value of the column)
  bool converged = false;
  std::vector<Curve> curves;  // of the fitted law
  std::vector<std::vector<std::vector<double>>>
      model;  // its values at the measured points: curve, response, point; NaN behind the end of a path
};

// Levenberg and Marquardt's method (Eigen).  Throws InputError for problems without an answer: fewer points than
// parameters, a column that no curve of the law has, a starting law that can't carry the start.
FitResult fit(const FitProblem& problem);

// Values, errors, correlation and what can't be told apart, for the screen.
std::string fit_text(const FitProblem& problem, const FitResult& result);
// Measured points and fitted curves, and below them what is left.
std::string fit_plot(const FitProblem& problem, const FitResult& result);

}  // namespace sage::drive
