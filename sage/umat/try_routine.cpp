#include "sage/umat/try_routine.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>
#include <sstream>

#include "sage/messages/error.hpp"
#include "sage/umat/law.hpp"

namespace sage::umat {

namespace {

struct State {
  Vector4 sigma = Vector4::Zero(), eps = Vector4::Zero();
  std::vector<double> h;
};

struct Answer {
  State state;
  Matrix4 D = Matrix4::Zero();
  bool cut = false;
};

class Driver {
 public:
  Driver(const Trial& trial, std::ostream& out)
      : trial_(trial),
        out_(out),
        law_(umat_law(trial.setup)),
        start_{trial.stress, Vector4::Zero(), initial_values(law_->traits().history)} {
    std::copy_n(trial.statev.begin(), std::min(trial.statev.size(), start_.h.size()), start_.h.begin());
  }

  // SIGINI and SDVINI of the library, where the user has not stated the values.
  void own_values() {
    const OwnStart own = own_start(trial_.setup);
    if (!own.at) return;
    State state = start_;
    own.at({.element = 1, .stage = 1, .size = 1.0}, {state.sigma.data(), 4}, state.h);
    if (trial_.stress.isZero(0.0)) start_.sigma = state.sigma;
    if (trial_.statev.empty()) start_.h = state.h;
  }

  bool run() {
    out_ << trial_.setup.routine.words() << ": " << trial_.setup.components << " components, "
         << trial_.setup.statev << " state variables, " << trial_.setup.props.size() << " properties\n";
    try {
      own_values();
      zero_increment();
      for (const auto& [name, direction] : paths()) path(name, direction);
      check("answers twice alike", repeats_);
      check_tangent();
      if (trial_.setup.symmetric) check("DDSDDE is symmetric, as its card says", asymmetry_ <= 1e-9);
    } catch (const AnalysisError& error) {
      check(error.what(), false);
    }
    for (const std::string& note : take_notes()) out_ << "note   " << note << "\n";
    if (states_ > 0 && !trial_.setup.symmetric && asymmetry_ <= 1e-12)
      out_ << "note   DDSDDE was symmetric everywhere: its card may say so (symmetric = 1), if it always is\n";
    out_ << "verdict: " << (holds_ ? "conforms" : "does NOT conform") << "\n";
    return holds_;
  }

 private:
  using Path = std::pair<const char*, Vector4>;
  static std::vector<Path> paths() {
    return {{"compression along yy, sides held", Vector4(0.0, -1.0, 0.0, 0.0)},
            {"simple shear xy", Vector4(0.0, 0.0, 0.0, 1.0)},
            {"compression along yy, extension along xx", Vector4(1.0, -1.0, 0.0, 0.3)}};
  }

  void check(const std::string& what, bool holds) {
    out_ << (holds ? "holds  " : "FAILS  ") << what << "\n";
    holds_ = holds_ && holds;
  }

  Answer answer(const State& from, const Vector4& deps, bool moves = true) const {
    const PointContext context{
        .element = 1, .stage = 1, .increment = 1, .time = 1.0, .dt = moves ? 1.0 : 0.0, .size = 1.0};
    Answer a;
    a.state = from;
    PointOut<4> out;
    out.h1 = a.state.h;
    a.cut = law_->update({from.sigma, from.eps, deps, from.h, &context}, out) == Outcome::cut_step;
    a.state.sigma = out.sigma;
    a.state.eps = from.eps + deps;
    a.D = out.D;
    return a;
  }

  // Of the routine itself; within the program the state stands where nothing moves.
  void zero_increment() {
    Call call(trial_.setup);
    const Answer first = answer(start_, Vector4::Zero(), false);
    check("a state that stands has a stiffness", first.D.cwiseAbs().maxCoeff() > 0.0);
    const PointContext context{.element = 1, .stage = 1, .increment = 1, .time = 1.0, .dt = 1.0, .size = 1.0};
    call.load({start_.sigma, start_.eps, Vector4::Zero(), start_.h, &context}, context, Width::four);
    call.run();
    std::vector<double> h(start_.h.size());
    call.history(h);
    if (!call.stress().isApprox(start_.sigma, 1e-10) &&
        (call.stress() - start_.sigma).norm() > 1e-12 * first.D.norm())
      out_ << "note   stress changes under no strain: by time, or the state is outside of its surface\n";
    else if (h != start_.h)
      out_ << "note   state variables change under no strain\n";
  }

  void path(const char* name, const Vector4& direction) {
    constexpr int kSteps = 10;
    out_ << name << " by " << trial_.strain << " a step; stress, tension +\n";
    out_ << "  step            xx            yy            zz            xy\n";
    State state = start_;
    for (int step = 1; step <= kSteps; ++step) {
      const Vector4 deps = trial_.strain * direction;
      const Answer a = answer(state, deps), again = answer(state, deps);
      if (a.cut) {
        out_ << "  " << std::setw(4) << step << "  the routine asks for a smaller step\n";
        break;
      }
      repeats_ = repeats_ && a.state.sigma == again.state.sigma && a.state.h == again.state.h && a.D == again.D;
      look_at_tangent(state, deps, a);
      state = a.state;
      out_ << "  " << std::setw(4) << step;
      for (int i = 0; i < 4; ++i) out_ << std::setw(14) << state.sigma[i];
      out_ << "\n";
    }
  }

  // Against central differences; at a kink one-sided ones differ, so some states may fail.  A tangent that is near the
  // derivative costs iterations, no answer: kNear of its largest term.
  void look_at_tangent(const State& from, const Vector4& deps, const Answer& a) {
    const double step = 1e-5 * trial_.strain, largest = a.D.cwiseAbs().maxCoeff();
    Matrix4 D;
    for (int j = 0; j < 4; ++j) {
      const Answer up = answer(from, deps + step * Vector4::Unit(j)),
                   down = answer(from, deps - step * Vector4::Unit(j));
      if (up.cut || down.cut) return;
      D.col(j) = (up.state.sigma - down.state.sigma) / (2.0 * step);
    }
    ++states_;
    asymmetry_ = std::max(asymmetry_, (a.D - a.D.transpose()).cwiseAbs().maxCoeff() / largest);
    const double scale = std::max(largest, D.cwiseAbs().maxCoeff());
    Eigen::Index row = 0, column = 0;
    const double error = (a.D - D).cwiseAbs().maxCoeff(&row, &column) / scale;
    errors_.push_back(error);
    if (error <= kExact) return;
    wrong_ += error <= kNear ? 0 : 1;
    if (error > worst_.error)
      worst_ = {error, static_cast<int>(row), static_cast<int>(column), a.D(row, column), D(row, column)};
    const double shear = a.D(3, 3) / D(3, 3);
    twice_ += std::abs(shear - 2.0) < 1e-3 || std::abs(shear - 0.5) < 1e-3 ? 1 : 0;
  }

  void check_tangent() {
    const auto states_within = [&](double most) {
      return static_cast<int>(std::ranges::count_if(errors_, [&](double error) { return error <= most; }));
    };
    const auto of_states = [&](int states) {
      return " (" + std::to_string(states) + " of " + std::to_string(states_) + " states)";
    };
    const int kinks = states_ / 10, exact = states_within(kExact);
    if (states_ == 0 || exact >= states_ - kinks || wrong_ > kinks) {
      check("DDSDDE is the derivative of the stress" + of_states(exact), states_ > 0 && wrong_ <= kinks);
    } else {
      std::ranges::sort(errors_);
      const double most = errors_[errors_.size() - 1 - static_cast<std::size_t>(kinks)];
      std::ostringstream text;
      text << std::setprecision(1) << std::scientific << most;
      check("DDSDDE is near the derivative of the stress: within " + text.str() + " of its largest term" +
                of_states(states_within(most)),
            true);
      out_ << "note   with such a DDSDDE an iteration gains about "
           << std::max(1L, std::lround(-std::log10(most)))
           << " digits of equilibrium, where an exact one doubles them\n";
    }
    if (exact == states_) return;
    out_ << "       worst: DDSDDE(" << worst_.row + 1 << "," << worst_.column + 1 << ") = " << worst_.given
         << ", differences of the stress give " << worst_.found << "\n";
    if (twice_ > states_ / 2)
      out_ << "       its shear term is wrong by a factor of 2: shear strains are engineering ones\n";
    if (wrong_ > states_ / 10)
      out_ << "       symmetric = 2 on its card has differences of the stress taken instead, for five calls a "
              "point\n";
  }

  struct Worst {
    double error = 0.0;
    int row = 0, column = 0;
    double given = 0.0, found = 0.0;
  };
  const Trial& trial_;
  std::ostream& out_;
  std::unique_ptr<SolidLaw> law_;
  State start_;
  bool holds_ = true, repeats_ = true;
  double asymmetry_ = 0.0;
  static constexpr double kExact = 1e-4, kNear = 1e-2;
  std::vector<double> errors_;  // of DDSDDE, a state each
  int states_ = 0, wrong_ = 0, twice_ = 0;
  Worst worst_;
};

}  // namespace

bool try_routine(const Trial& trial, std::ostream& out) {
  return Driver(trial, out).run();
}

}  // namespace sage::umat
