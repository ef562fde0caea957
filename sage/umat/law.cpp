#include "sage/umat/law.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cctype>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <sstream>
#include <utility>

#include "sage/core/calls_in_order.hpp"
#include "sage/messages/error.hpp"

namespace sage::umat {

namespace {

// COMMON and SAVE are usual, also between the materials of a library: one call at a time.
std::mutex calls;

std::mutex notes_lock;
std::vector<std::string> notes;
std::string where_not_finite;

void note(std::string text) {
  const std::lock_guard lock(notes_lock);
  notes.push_back(std::move(text));
}

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  });
}

std::string place_words(const PointContext& c) {
  std::ostringstream text;
  text << " at element " << c.element << ", point " << c.point + 1 << " (" << c.place.x() << ", " << c.place.y()
       << "), stage " << c.stage << ", increment " << c.increment;
  return text.str();
}

[[noreturn]] void refuse(const std::string& words, const std::string& what, const PointContext& context) {
  throw AnalysisError("S806", words + " " + what + place_words(context));
}

// words: the routine that was called.
void expect_returned(Call& call, const CallEnd& end, const std::string& words, const PointContext& context) {
  const std::string reason = *end.words != '\0' ? std::string(" (") + end.words + ")" : "";
  if (end.ending == Ending::xit) refuse(words, "called XIT" + reason, context);
  if (end.ending == Ending::stop) refuse(words, "executed STOP" + reason, context);
  if (end.ending == Ending::exit)
    refuse(words, "ended the program, by exit() or an error of its library" + reason + ",", context);
  if (end.ending == Ending::crash) refuse(words, "crashed" + reason, context);
  if (end.ending == Ending::exception) refuse(words, "threw an exception" + reason, context);
  if (const std::string damage = call.damage(); !damage.empty()) {
    call.repair();
    refuse(words, damage, context);
  }
}

// Memory for calls that are under way at once.
class Calls {
 public:
  explicit Calls(const Setup& setup) : setup_(&setup) {}
  std::unique_ptr<Call> take() {
    {
      const std::lock_guard lock(lock_);
      if (!free_.empty()) {
        std::unique_ptr<Call> call = std::move(free_.back());
        free_.pop_back();
        return call;
      }
    }
    return std::make_unique<Call>(*setup_);
  }
  void give_back(std::unique_ptr<Call> call) {
    const std::lock_guard lock(lock_);
    free_.push_back(std::move(call));
  }

 private:
  const Setup* setup_;
  std::mutex lock_;
  std::vector<std::unique_ptr<Call>> free_;
};

// A strain that is small beside the increment and large beside what routines leave of their own iterations.
double probe_of(const Vector4& deps) {
  return std::max(1e-3 * deps.cwiseAbs().maxCoeff(), 1e-7);
}

class UmatLaw final : public SolidLaw, public CallsInOrder {
 public:
  explicit UmatLaw(Setup setup) : setup_(std::move(setup)), call_(setup_), calls_(setup_) {
    const auto state = static_cast<std::size_t>(setup_.statev);
    names_.reserve(state);
    for (std::size_t i = 0; i < state; ++i) names_.push_back("SDV" + std::to_string(i + 1));
    for (const std::string& name : names_) quantities_.push_back({name});
    for (const char* energy : {"SSE", "SPD", "SCD"}) quantities_.push_back({energy, Dimension::stress});
  }

  LawTraits traits() const override {
    return {.history = quantities_, .symmetric = setup_.symmetric, .wants_context = true};
  }

  bool needs_order() const override { return !setup_.threads_safe; }

  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override {
    static const PointContext nowhere{};
    const PointContext& context = in.context != nullptr ? *in.context : nowhere;
    if (known_.load(std::memory_order_acquire)) {
      std::unique_ptr<Call> call = calls_.take();
      const Outcome outcome = answer(*call, in, context, out);  // one that throws ends the run: its memory, too
      calls_.give_back(std::move(call));
      return outcome;
    }
    const std::lock_guard lock(calls);
    const bool moves = !in.deps.isZero(0.0);
    if (!width_known_) find_width(in, context);
    if (!answers_strain_ && moves) expect_answer_to_strain(in, context);
    const Outcome outcome = answer(call_, in, context, out);
    if (moves && outcome == Outcome::ok && !setup_.differences && !told_of_tangent_)
      look_at_tangent(in, context, out);
    if (setup_.threads_safe && answers_strain_) known_.store(true, std::memory_order_release);
    return outcome;
  }

 private:
  Outcome answer(Call& call, const PointIn<4>& in, const PointContext& context, PointOut<4>& out) const {
    const bool still = in.deps.isZero(0.0) && context.dt == 0.0;
    call.load(in, context, width_);
    expect_returned(call, call.run(), setup_.routine.words(), context);
    if (still) {
      out.sigma = in.sigma0;
      std::copy(in.h0.begin(), in.h0.end(), out.h1.begin());
    } else {
      if (!(call.pnewdt() >= 1.0)) return Outcome::cut_step;  // a number that is none, too
      out.sigma = call.stress();
      call.history(out.h1);
    }
    if (!call.finite()) return not_finite(still, context);
    out.D = call.tangent();
    if (setup_.symmetric) expect_symmetric(out.D, context);
    if (setup_.differences) put_differences(call, in, context, out.D);
    out.status = PointStatus::elastic;
    return Outcome::ok;
  }

  // What the stress is with `deps`; no number where the routine has no answer there.
  Vector4 stress_for(Call& call, const PointIn<4>& in, const PointContext& context, const Vector4& deps) const {
    PointIn<4> other = in;
    other.deps = deps;
    call.load(other, context, width_);
    const CallEnd end = call.run(Asked::to_find_out);
    const bool answered = end.ending == Ending::returned && call.pnewdt() >= 1.0 && call.finite();
    if (!call.damage().empty()) call.repair();
    return answered ? call.stress() : Vector4::Constant(std::nan(""));
  }

  // Columns without an answer keep what DDSDDE has.  From both sides: where a point is on its yield surface and
  // nothing moves yet, the one side is elastic, and a stiffness of both kinds of columns can be singular.
  void put_differences(Call& call, const PointIn<4>& in, const PointContext& context, Matrix4& D) const {
    const double step = probe_of(in.deps);
    for (int j = 0; j < 4; ++j) {
      const Vector4 change = step * Vector4::Unit(j), ahead = stress_for(call, in, context, in.deps + change),
                    behind = stress_for(call, in, context, in.deps - change);
      const Vector4 column = (ahead - behind) / (2.0 * step);
      if (column.allFinite()) D.col(j) = column;
    }
  }

  // At the 64th call, the 128th, the 256th ...: whether DDSDDE gives the stress that the routine itself gives for a
  // little more of the same strain.  Elastic ones don't beyond the yield surface: allowed, and slow.
  void look_at_tangent(const PointIn<4>& in, const PointContext& context, const PointOut<4>& out) const {
    constexpr unsigned kFirst = 64;
    constexpr int kEnough = 3;
    if (++calls_done_ < kFirst || !std::has_single_bit(calls_done_)) return;
    const Vector4 along = in.deps.normalized();
    const double step = probe_of(in.deps);
    const Vector4 derivative = (stress_for(call_, in, context, in.deps + step * along) - out.sigma) / step;
    const Vector4 given = out.D * along;
    ++tangents_seen_;
    if ((derivative - given).norm() > 0.02 * given.norm()) ++tangents_wrong_;
    if (tangents_wrong_ < kEnough) return;
    told_of_tangent_ = true;
    note(
        setup_.routine.words() + " returned a DDSDDE that is not the derivative of its stress, in " +
        std::to_string(tangents_wrong_) + " of " + std::to_string(tangents_seen_) + " states, the last" +
        place_words(context) +
        ": equilibrium is found slowly, or not. Its card may have symmetric = 2: differences of the stress are "
        "taken instead");
  }

  // A smaller step may have an answer; the state that stands has no other.
  Outcome not_finite(bool still, const PointContext& context) const {
    if (still) refuse(setup_.routine.words(), "returned what is no finite number", context);
    const std::lock_guard lock(notes_lock);
    where_not_finite = setup_.routine.words() + " returned what is no finite number";
    if (!told_of_nan_.exchange(true))
      notes.push_back(where_not_finite + ", first" + place_words(context) + ": the step was cut");
    return Outcome::cut_step;
  }

  void expect_symmetric(Matrix4& D, const PointContext& context) const {
    const double largest = D.cwiseAbs().maxCoeff();
    if (!((D - D.transpose()).cwiseAbs().maxCoeff() <= 1e-9 * largest))
      refuse(setup_.routine.words(), "returned an unsymmetric DDSDDE, though its card says symmetric,",
             context);
    D = (0.5 * (D + D.transpose())).eval();  // what rounding left
  }

  // A routine with integers of 8 bytes sees other numbers, negative ones, where the upper halves hold ones, and
  // answers otherwise.  One that never answers twice alike tells nothing.
  void find_width(const PointIn<4>& in, const PointContext& context) const {
    const auto ask = [&](bool poisoned) {
      call_.load(in, context, Width::four);
      const CallEnd end = call_.run(poisoned ? Asked::with_wide_integers : Asked::in_earnest);
      const bool returned = end.ending == Ending::returned && call_.damage().empty();
      std::optional<std::vector<double>> answer;
      if (returned) answer = call_.answer();
      call_.repair();
      return answer;
    };
    width_known_ = true;
    if (!setup_.routine.not_called.empty())
      note(setup_.routine.file + " has " + setup_.routine.not_called + " too, which sagefe does not call");
    const auto first = ask(false);
    if (!first) return;  // the call itself says why
    const auto second = ask(false), poisoned = ask(true);
    if (!second || !same_bits(*first, *second)) return;
    if (poisoned && same_bits(*first, *poisoned)) return;
    width_ = Width::eight;
    note(setup_.routine.words() + " was built with integers of 8 bytes: it is given such");
  }

  // Without DSTRAN its stress stays; it must not be DFGRD1 that it answers.
  void expect_answer_to_strain(const PointIn<4>& in, const PointContext& context) const {
    answers_strain_ = true;
    const auto stress = [&](const Vector4& deps, const Vector4& gradient) {
      PointIn<4> other = in;
      other.deps = deps;
      call_.load(other, context, width_);
      call_.strain_by_gradient(gradient);
      const CallEnd end = call_.run();
      const Vector4 answer = end.ending == Ending::returned ? call_.stress() : in.sigma0;
      call_.repair();
      return answer;
    };
    const Vector4 zero = Vector4::Zero(), rest = stress(zero, zero);
    if (stress(in.deps, zero) == rest && stress(zero, in.deps) != rest)
      refuse(setup_.routine.words(),
             "answers DFGRD1 and not DSTRAN: it is for large strains, which sagefe has not,", context);
  }

  Setup setup_;
  mutable Call call_;
  mutable Calls calls_;                      // of those that several threads may do at once
  mutable std::atomic<bool> known_ = false;  // what is found out by the first calls, and the routine is safe
  std::vector<std::string> names_;
  std::vector<Quantity> quantities_;
  mutable Width width_ = Width::four;
  mutable bool width_known_ = false, answers_strain_ = false, told_of_tangent_ = false;
  mutable std::atomic<bool> told_of_nan_ = false;
  mutable unsigned calls_done_ = 0;
  mutable int tangents_seen_ = 0, tangents_wrong_ = 0;
};

const std::vector<Parameter>& table() {
  static const std::vector<Parameter> rows = {
      {"components", Dimension::none, "NTENS: 4 (11 22 33 12) or 6 (and 13 23, whose strains are 0)"},
      {"state_variables", Dimension::none, "NSTATV; initial cards of kind 4 give their first values, else 0"},
      {"symmetric", Dimension::none,
       "1: DDSDDE is symmetric in every state; 2: differences of the stress replace it", 0.0, false},
      {"threads_safe", Dimension::none, "1: may be called by several threads at once", 0.0, false}};
  return rows;
}

int whole(std::span<const double> values, int place, int lowest, int highest) {
  const double value = values[place];
  if (!(value >= lowest && value <= highest) || value != static_cast<int>(value))
    throw ParameterError(
        "S805", place,
        "a whole number from " + std::to_string(lowest) + " to " + std::to_string(highest) + " is wanted");
  return static_cast<int>(value);
}

const Routine& routine_of(const std::vector<Binding>& bindings, const std::string& material) {
  const Binding* found = nullptr;
  for (const Binding& binding : bindings) {
    if (binding.material == lower(material)) return binding.routine;
    if (binding.material.empty()) found = &binding;
  }
  if (found == nullptr)
    throw ParameterError("S804", -1,
                         "no routine is given for the material \"" + material + "\": --umat " +
                             (material.empty() ? "LIBRARY" : material + "=LIBRARY") + " loads one");
  return found->routine;
}

// values: of the card.
Setup setup_of(std::span<const double> values, const std::vector<Binding>& bindings,
               const std::string& material) {
  Setup setup;
  setup.material = material;
  setup.components = whole(values, 0, 4, 6);
  if (setup.components == 5) throw ParameterError("S805", 0, "4 or 6 is wanted");
  setup.statev = whole(values, 1, 0, 100000);
  const int tangent = whole(values, 2, 0, 2);
  setup.symmetric = tangent == 1;
  setup.differences = tangent == 2;
  setup.threads_safe = whole(values, 3, 0, 1) == 1;
  setup.props.assign(values.begin() + 4, values.end());
  setup.routine = routine_of(bindings, material);
  return setup;
}

}  // namespace

Binding bind(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) return {"", open_routine(text)};
  return {lower(text.substr(0, equals)), open_routine(text.substr(equals + 1))};
}

MaterialEntry umat_entry(std::vector<Binding> bindings) {
  MaterialEntry entry{
      "umat", "a user material of Abaqus/Standard, loaded by --umat; its properties follow", 4, table(), {}};
  entry.open_ended = true;
  entry.own_start = [bindings](std::span<const double> values, const std::string& material) {
    return own_start(setup_of(values, bindings, material));
  };
  entry.make_for = [bindings = std::move(bindings)](std::span<const double> values, const UnitSystem&,
                                                    const std::string& material) -> LawPtr {
    return umat_law(setup_of(values, bindings, material));
  };
  entry.make = [make = entry.make_for](std::span<const double> values, const UnitSystem& units) {
    return make(values, units, "");
  };
  return entry;
}

OwnStart own_start(Setup setup) {
  OwnStart start{.stress = setup.routine.first_stress != nullptr,
                 .history = setup.routine.first_history != nullptr && setup.statev > 0};
  if (!start.stress && !start.history) return start;
  const auto kept = std::make_shared<const Setup>(std::move(setup));
  const auto call = std::make_shared<Call>(*kept);
  start.at = [kept, call, stress = start.stress, history = start.history](
                 const PointContext& context, std::span<double> sigma, std::span<double> h) {
    const std::lock_guard lock(calls);
    const std::vector<double> zeros(static_cast<std::size_t>(kept->statev) + 3, 0.0);
    call->load({Vector4::Zero(), Vector4::Zero(), Vector4::Zero(), zeros}, context, Width::four);
    const auto ask = [&](First which, const char* name) {
      const std::string words = std::string("routine ") + name + " of " + kept->routine.file;
      expect_returned(*call, call->run(which), words, context);
      if (!call->finite()) refuse(words, "returned what is no finite number", context);
    };
    if (stress) ask(First::stress, "SIGINI");
    if (history) ask(First::history, "SDVINI");
    if (stress) Vector4::Map(sigma.data()) = call->stress();
    std::vector<double> values(zeros.size());
    call->history(values);
    if (history) std::copy_n(values.begin(), kept->statev, h.begin());
  };
  return start;
}

std::unique_ptr<SolidLaw> umat_law(Setup setup) {
  return std::make_unique<UmatLaw>(std::move(setup));
}

std::string take_not_finite() {
  const std::lock_guard lock(notes_lock);
  return std::exchange(where_not_finite, {});
}

std::vector<std::string> take_notes() {
  const std::lock_guard lock(notes_lock);
  return std::exchange(notes, {});
}

}  // namespace sage::umat
