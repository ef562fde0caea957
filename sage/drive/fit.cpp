#include "sage/drive/fit.hpp"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/NonLinearOptimization>

#include "sage/drive/subject.hpp"
#include "sage/messages/error.hpp"
#include "sage/record/csv_table.hpp"

namespace sage::drive {

namespace {

constexpr double kDifference = 1e-5;    // of a parameter's size, on either side
constexpr double kUndetermined = 1e-5;  // singular values below this share of the largest are rounding
constexpr double kNamed = 0.1;          // share of a combination from which a parameter is named
constexpr double kHeld = 1e-9;          // weight of the way from the start, far below kUndetermined
constexpr double kRefused = 1e3;        // residual where the law refuses the parameters
constexpr double kAtBound = 1e-6;       // of the way between the bounds
constexpr double kHighestAngle = 89.0, kHighestRatio = 0.4999;

// Parameter k as a function of a free variable: within its bounds whatever the variable is.
class Variable {
 public:
  Variable(const FreeParameter& parameter, double start) : p_(parameter), start_(start) {
    scale_ = start != 0.0 ? std::abs(start) : bounded() ? 0.5 * (p_.high - p_.low) : 1.0;
  }
  double start() const {
    if (bounded())
      return std::asin(std::clamp(2.0 * (start_ - p_.low) / (p_.high - p_.low) - 1.0, -0.99, 0.99));
    if (!bounded_below()) return start_ / scale_;
    const double root = (start_ - p_.low) / scale_ + 1.0;
    return std::sqrt(std::max(root * root - 1.0, 0.01));
  }
  double value(double x) const {
    if (bounded()) return p_.low + 0.5 * (p_.high - p_.low) * (1.0 + std::sin(x));
    return bounded_below() ? p_.low + scale_ * (std::hypot(x, 1.0) - 1.0) : scale_ * x;
  }
  // A change that shows, at a value.
  double size(double value) const { return std::max(std::abs(value), 0.3 * scale_); }
  bool at_bound(double value) const {
    const double way = bounded() ? kAtBound * (p_.high - p_.low) : kAtBound * scale_;
    return value - p_.low <= way || p_.high - value <= way;
  }

 private:
  bool bounded_below() const { return std::isfinite(p_.low); }
  bool bounded() const { return bounded_below() && std::isfinite(p_.high); }

  const FreeParameter& p_;
  double start_, scale_ = 1.0;
};

// The curves of a law beside the measured ones.
class Comparison {
 public:
  explicit Comparison(const FitProblem& problem) : problem_(problem) {
    for (const Measured& curve : problem.curves)
      for (const Measured::Response& response : curve.responses)
        for (const double value : response.values) {
          if (std::isnan(value)) continue;
          double& scale = scale_of(response.column);
          scale = std::max(scale, std::abs(value));
          ++points_;
        }
    for (auto& [column, scale] : scales_)
      if (scale == 0.0) scale = 1.0;
  }
  int points() const { return points_; }
  int evaluations() const { return evaluations_; }

  // Throws ParameterError and InputError.
  std::vector<Curve> curves(const Subject& subject) const {
    const LawPtr law = make_law(subject);
    std::vector<Curve> all;
    for (const Measured& measured : problem_.curves)
      all.push_back(follow(subject, reference(law), path_of(measured)));
    return all;
  }

  // (model - measured)/scale; where the path ends early its last row stands for the rest.
  Eigen::VectorXd residuals(const Subject& subject) const {
    ++evaluations_;
    std::vector<Curve> all;
    try {
      all = curves(subject);
    } catch (const ParameterError&) {
      return Eigen::VectorXd::Constant(points_, kRefused);
    } catch (const InputError&) {  // such as a start beyond the strength
      return Eigen::VectorXd::Constant(points_, kRefused);
    }
    const auto at_points = model(all, true);
    Eigen::VectorXd left(points_);
    Eigen::Index next = 0;
    for (std::size_t c = 0; c < all.size(); ++c)
      for (std::size_t r = 0; r < at_points[c].size(); ++r) {
        const Measured::Response& response = problem_.curves[c].responses[r];
        for (std::size_t i = 0; i < response.values.size(); ++i)
          if (!std::isnan(response.values[i]))
            left[next++] = (at_points[c][r][i] - response.values[i]) / scale_of(response.column);
      }
    return left;
  }

  // Values at the measured points: curve, response, point.  Beyond the end of a path NaN, or its last value.
  std::vector<std::vector<std::vector<double>>> model(const std::vector<Curve>& all, bool go_on) const {
    std::vector<std::vector<std::vector<double>>> values(all.size());
    for (std::size_t c = 0; c < all.size(); ++c)
      for (const Measured::Response& response : problem_.curves[c].responses) {
        const std::vector<double>& column = all[c].find(response.column)->values;
        std::vector<double>& own = values[c].emplace_back();
        for (std::size_t i = 1; i <= response.values.size(); ++i) {
          const std::size_t row = i * steps_of(problem_.curves[c]);
          own.push_back(row < column.size() ? column[row]
                        : go_on             ? column.back()
                                            : std::numeric_limits<double>::quiet_NaN());
        }
      }
    return values;
  }
  double scale_of(const std::string& column) const {
    return std::ranges::find(scales_, column, &std::pair<std::string, double>::first)->second;
  }

 private:
  double& scale_of(const std::string& column) {
    const auto at = std::ranges::find(scales_, column, &std::pair<std::string, double>::first);
    return at != scales_.end() ? at->second : scales_.emplace_back(column, 0.0).second;
  }
  std::size_t steps_of(const Measured& measured) const {
    const auto points = measured.driven.size();
    return (static_cast<std::size_t>(problem_.steps) + points - 1) / points;
  }
  Path path_of(const Measured& measured) const {
    const LabTest& test = *measured.test;
    Path path;
    path.history = problem_.subject.history;
    path.start = test.law_size == 4
                     ? std::vector<double>{measured.pressure, measured.pressure, measured.pressure, 0.0}
                     : std::vector<double>{0.0, measured.pressure};
    std::vector<double> turns = measured.driven;
    for (double& turn : turns) turn *= test.sense;
    path.legs = legs_of(test, measured.undrained, path.start, turns, static_cast<int>(steps_of(measured)));
    path.normal_stiffness = problem_.normal_stiffness;
    if (measured.undrained && test.law_size == 4) path.total_stress_stays = test.total_stress_stays;
    return path;
  }

  const FitProblem& problem_;
  std::vector<std::pair<std::string, double>> scales_;
  int points_ = 0;
  mutable int evaluations_ = 0;
};

Subject with_values(const FitProblem& problem, const Eigen::VectorXd& values) {
  Subject subject = problem.subject;
  for (std::size_t k = 0; k < problem.free.size(); ++k)
    subject.values[problem.free[k].place] = values[static_cast<Eigen::Index>(k)];
  return subject;
}

// What Eigen's Levenberg-Marquardt asks for.  The residuals and, below them, the way from the start with a weight that
// holds combinations without influence at the start; without it rounding alone would move them, anywhere.
class Functor {
 public:
  Functor(const FitProblem& problem, const Comparison& comparison, const std::vector<Variable>& variables)
      : problem_(problem), comparison_(comparison), variables_(variables), start_(variables.size()) {
    for (std::size_t k = 0; k < variables.size(); ++k)
      start_[static_cast<Eigen::Index>(k)] = variables[k].start();
  }
  const Eigen::VectorXd& start() const { return start_; }
  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& left) const {
    left.resize(values());
    left << comparison_.residuals(with_values(problem_, values(x))), kHeld * (x - start_);
    return 0;
  }
  int df(const Eigen::VectorXd& x, Eigen::MatrixXd& J) const {
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      Eigen::VectorXd up = x, down = x, high, low;
      const double step = kDifference * std::max(std::abs(x[k]), 1e-2);
      up[k] += step;
      down[k] -= step;
      (*this)(up, high);
      (*this)(down, low);
      J.col(k) = (high - low) / (2.0 * step);
    }
    return 0;
  }
  Eigen::VectorXd values(const Eigen::VectorXd& x) const {
    Eigen::VectorXd all(x.size());
    for (Eigen::Index k = 0; k < x.size(); ++k) all[k] = variables_[static_cast<std::size_t>(k)].value(x[k]);
    return all;
  }
  int inputs() const { return static_cast<int>(variables_.size()); }
  int values() const { return comparison_.points() + inputs(); }

 private:
  const FitProblem& problem_;
  const Comparison& comparison_;
  const std::vector<Variable>& variables_;
  Eigen::VectorXd start_;
};

// d(residuals)/d(parameter), each parameter in units of its size.
Eigen::MatrixXd scaled_jacobian(const FitProblem& problem, const Comparison& comparison,
                                const std::vector<Variable>& variables, const Eigen::VectorXd& values) {
  Eigen::MatrixXd J(comparison.points(), values.size());
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    const FreeParameter& parameter = problem.free[static_cast<std::size_t>(k)];
    const double size = variables[static_cast<std::size_t>(k)].size(values[k]);
    Eigen::VectorXd up = values, down = values;
    up[k] = std::min(values[k] + kDifference * size, parameter.high);
    down[k] = std::max(values[k] - kDifference * size, parameter.low);
    J.col(k) =
        size / (up[k] - down[k]) *
        (comparison.residuals(with_values(problem, up)) - comparison.residuals(with_values(problem, down)));
  }
  return J;
}

// Of Student's distribution, 97.5 %: Cornish and Fisher's series, right to 1 % from three degrees of freedom on.
double student(int freedom) {
  const double z = 1.959963985, n = freedom;
  return z + (z * z * z + z) / (4.0 * n) + (5.0 * std::pow(z, 5) + 16.0 * z * z * z + 3.0 * z) / (96.0 * n * n);
}

// Errors, correlation and combinations without influence, from the singular values of J.
void estimate_errors(const FitProblem& problem, const Eigen::MatrixXd& J,
                     const std::vector<Variable>& variables, FitResult& result) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(J, Eigen::ComputeThinV);
  const Eigen::VectorXd& size = svd.singularValues();
  const Eigen::MatrixXd& V = svd.matrixV();
  const Eigen::Index n = size.size();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n, n);
  std::vector<bool> unknown(static_cast<std::size_t>(n), false);
  for (Eigen::Index k = 0; k < n; ++k) {
    if (size[k] > kUndetermined * size[0]) {
      covariance += V.col(k) * V.col(k).transpose() / (size[k] * size[k]);
      continue;
    }
    Undetermined combination{size[0] > 0.0 ? size[k] / size[0] : 0.0, {}, {}};
    for (Eigen::Index i = 0; i < n; ++i) {
      // A small share takes part too where its own influence is no rounding: others make up for it.
      const bool takes_part = std::abs(V(i, k)) * J.col(i).norm() > kUndetermined * size[0];
      if (std::abs(V(i, k)) < kNamed && !takes_part) continue;
      unknown[i] = true;
      combination.names.push_back(problem.free[i].name);
      combination.shares.push_back(V(i, k));
    }
    result.undetermined.push_back(combination);
  }
  const int freedom = result.points - static_cast<int>(n);
  const double variance = result.points * result.rms * result.rms / freedom;
  result.correlation = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const bool known = !unknown[at] && !result.at_bound[at];
    const double error = known ? variables[at].size(result.values[at]) * std::sqrt(variance * covariance(i, i))
                               : std::numeric_limits<double>::quiet_NaN();
    result.standard_errors.push_back(error);
    result.low.push_back(result.values[at] - student(freedom) * error);
    result.high.push_back(result.values[at] + student(freedom) * error);
    for (Eigen::Index j = 0; j < n; ++j) {
      if (i == j) continue;
      const bool both = !unknown[at] && !unknown[j];
      result.correlation(i, j) = both ? covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j))
                                      : std::numeric_limits<double>::quiet_NaN();
    }
  }
}

void expect_answer(const FitProblem& problem, const Comparison& comparison) {
  if (problem.free.empty()) throw InputError("S660", {}, "which parameters are free? --free NAME,...");
  for (std::size_t i = 0; i < problem.free.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (problem.free[i].place == problem.free[j].place)
        throw InputError("S660", {}, problem.free[i].name + " is free twice");
  const auto free = static_cast<int>(problem.free.size());
  if (comparison.points() <= free)
    throw InputError(
        "S660", {},
        fmt::format("{} measured values can't give {} parameters and their errors", comparison.points(), free));
  const std::vector<Curve> start = comparison.curves(problem.subject);
  for (std::size_t c = 0; c < start.size(); ++c)
    for (const Measured::Response& response : problem.curves[c].responses)
      if (start[c].find(response.column) == nullptr) {
        std::string known;
        for (const Column& column : start[c].columns) known += (known.empty() ? "" : ", ") + column.name;
        throw InputError("S660", {problem.curves[c].name},
                         fmt::format("column {}: the law's curve has {}", response.column, known));
      }
}

}  // namespace

FreeParameter free_parameter_from(const Subject& subject, std::string_view text) {
  const std::size_t equals = std::min(text.find('='), text.size());
  FreeParameter parameter;
  const std::string key(text.substr(0, equals));
  parameter.place = parameter_place(*subject.entry, key);
  if (parameter.place < 0)
    throw InputError("S660", {}, fmt::format("{} has no parameter {}", subject.entry->name, key));
  const Parameter& row = subject.entry->parameters[parameter.place];
  parameter.name = row.name;
  if (row.dimension == Dimension::angle) parameter.low = 0.0, parameter.high = kHighestAngle;
  if (row.role == ParameterRole::poissons_ratio) parameter.low = 0.0, parameter.high = kHighestRatio;
  const bool stress = row.dimension == Dimension::stress || row.dimension == Dimension::stress_per_length;
  const double value = subject.values[parameter.place];
  if (stress && value >= 0.0) parameter.low = 0.0;
  if (equals < text.size()) {
    const std::string bounds(text.substr(equals + 1));
    const std::size_t colon = bounds.find(':');
    char *end_low = nullptr, *end_high = nullptr;
    parameter.low = std::strtod(bounds.c_str(), &end_low);
    parameter.high = colon == std::string::npos ? 0.0 : std::strtod(bounds.c_str() + colon + 1, &end_high);
    const bool read = colon != std::string::npos && colon > 0 && end_low == bounds.c_str() + colon &&
                      colon + 1 < bounds.size() && *end_high == '\0';
    if (!read || !(parameter.low < parameter.high) || !std::isfinite(parameter.low) ||
        !std::isfinite(parameter.high))
      throw InputError("S660", {}, fmt::format("{}: wanted NAME=LOW:HIGH", text));
  }
  if (!(value >= parameter.low && value <= parameter.high))
    throw InputError("S660", {},
                     fmt::format("{} starts at {:g}, outside {:g} to {:g}", parameter.name, value,
                                 parameter.low, parameter.high));
  return parameter;
}

Measured read_measured(const std::filesystem::path& file, const LabTest& test, bool undrained,
                       double pressure) {
  const CsvTable table = read_csv_table(file);
  const SourcePosition where{file.string()};
  if (!table.words.empty()) {
    const CsvTable::Word& word = table.words.front();
    throw InputError("S660", {file.string(), word.line, 0, 0},
                     fmt::format("column {}: {} is no number", table.columns[word.column].name, word.text));
  }
  if (table.columns.front().name != driven_column(test) || table.columns.size() < 2)
    throw InputError("S660", where,
                     fmt::format("the first column is to be {}, which {} drives, and others what was measured "
                                 "there (columns of `sagefe drive --csv`)",
                                 driven_column(test), test.name));
  Measured measured{file.stem().string(), &test, undrained, pressure, table.columns.front().values, {}};
  if (measured.driven.empty()) throw InputError("S660", where, "holds no point");
  for (std::size_t i = 0; i < measured.driven.size(); ++i)
    if (!std::isfinite(measured.driven[i]))
      throw InputError("S660", {file.string(), table.lines[i], 0, 0},
                       fmt::format("{} is missing", driven_column(test)));
  for (std::size_t c = 1; c < table.columns.size(); ++c)
    measured.responses.push_back({table.columns[c].name, table.columns[c].values});
  return measured;
}

FitResult fit(const FitProblem& problem) {
  const Comparison comparison(problem);
  expect_answer(problem, comparison);
  std::vector<Variable> variables;
  for (const FreeParameter& parameter : problem.free)
    variables.emplace_back(parameter, problem.subject.values[parameter.place]);
  Functor functor(problem, comparison, variables);
  Eigen::VectorXd x = functor.start();
  Eigen::LevenbergMarquardt<Functor> search(functor);
  search.parameters.xtol = search.parameters.ftol = 1e-14;
  search.parameters.gtol = 0.0;
  search.parameters.factor = 1.0;
  search.parameters.maxfev = 400;
  const auto status = search.minimize(x);

  const Eigen::VectorXd values = functor.values(x);
  FitResult result;
  result.converged = status != Eigen::LevenbergMarquardtSpace::ImproperInputParameters &&
                     status != Eigen::LevenbergMarquardtSpace::TooManyFunctionEvaluation &&
                     search.fvec.cwiseAbs().maxCoeff() < kRefused;
  result.fitted = with_values(problem, values);
  result.points = comparison.points();
  result.rms = std::sqrt(comparison.residuals(result.fitted).squaredNorm() / result.points);
  for (std::size_t k = 0; k < variables.size(); ++k) {
    result.values.push_back(values[static_cast<Eigen::Index>(k)]);
    result.at_bound.push_back(variables[k].at_bound(result.values.back()));
  }
  estimate_errors(problem, scaled_jacobian(problem, comparison, variables, values), variables, result);
  result.evaluations = comparison.evaluations();
  result.curves = comparison.curves(result.fitted);
  result.model = comparison.model(result.curves, false);
  for (std::size_t c = 0; c < result.curves.size(); ++c) result.curves[c].name = problem.curves[c].name;
  return result;
}

}  // namespace sage::drive
