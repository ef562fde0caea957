#include "sage/umat/law.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <mutex>
#include <optional>
#include <sstream>
#include <utility>

#include "sage/core/error.hpp"

namespace sage::umat {

namespace {

// COMMON and SAVE are usual, also between the materials of a library: one call at a time.
std::mutex calls;
std::vector<std::string> notes;

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

class UmatLaw final : public SolidLaw {
 public:
  explicit UmatLaw(Setup setup) : setup_(std::move(setup)), call_(setup_) {
    const auto state = static_cast<std::size_t>(setup_.statev);
    names_.reserve(state);
    for (std::size_t i = 0; i < state; ++i) names_.push_back("SDV" + std::to_string(i + 1));
    for (const std::string& name : names_) quantities_.push_back({name});
    for (const char* energy : {"SSE", "SPD", "SCD"}) quantities_.push_back({energy, Dimension::stress});
  }

  std::span<const Quantity> history() const override { return quantities_; }
  bool symmetric() const override { return setup_.symmetric; }
  bool wants_context() const override { return true; }

  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override {
    static const PointContext nowhere{};
    const PointContext& context = in.context != nullptr ? *in.context : nowhere;
    const std::lock_guard lock(calls);
    const bool moves = !in.deps.isZero(0.0), still = !moves && context.dt == 0.0;
    if (!width_known_) find_width(in, context);
    if (!answers_strain_ && moves) expect_answer_to_strain(in, context);
    call_.load(in, context, width_);
    expect_returned(call_.run(), context);
    if (still) {
      out.sigma = in.sigma0;
      std::copy(in.h0.begin(), in.h0.end(), out.h1.begin());
    } else {
      if (!(call_.pnewdt() >= 1.0)) return Outcome::cut_step;  // a number that is none, too
      out.sigma = call_.stress();
      call_.history(out.h1);
    }
    if (!call_.finite()) return not_finite(still, context);
    out.D = call_.tangent();
    if (setup_.symmetric) expect_symmetric(out.D, context);
    out.status = PointStatus::elastic;
    return Outcome::ok;
  }

 private:
  [[noreturn]] void refuse(const std::string& what, const PointContext& context) const {
    throw AnalysisError("S806", setup_.routine.words() + " " + what + place_words(context));
  }

  void expect_returned(const CallEnd& end, const PointContext& context) const {
    const std::string words = *end.words != '\0' ? std::string(" (") + end.words + ")" : "";
    if (end.ending == Ending::xit) refuse("called XIT" + words, context);
    if (end.ending == Ending::stop) refuse("executed STOP" + words, context);
    if (end.ending == Ending::exit)
      refuse("ended the program, by exit() or an error of its library" + words + ",", context);
    if (end.ending == Ending::crash) refuse("crashed" + words, context);
    if (end.ending == Ending::exception) refuse("threw an exception" + words, context);
    if (const std::string damage = call_.damage(); !damage.empty()) {
      call_.repair();
      refuse(damage, context);
    }
  }

  // A smaller step may have an answer; the state that stands has no other.
  Outcome not_finite(bool still, const PointContext& context) const {
    if (still) refuse("returned what is no finite number", context);
    if (!told_of_nan_)
      notes.push_back(setup_.routine.words() + " returned what is no finite number, first" +
                      place_words(context) + ": the step was cut");
    told_of_nan_ = true;
    return Outcome::cut_step;
  }

  void expect_symmetric(Matrix4& D, const PointContext& context) const {
    const double largest = D.cwiseAbs().maxCoeff();
    if (!((D - D.transpose()).cwiseAbs().maxCoeff() <= 1e-9 * largest))
      refuse("returned an unsymmetric DDSDDE, though its card says symmetric,", context);
    D = (0.5 * (D + D.transpose())).eval();  // what rounding left
  }

  // A routine with integers of 8 bytes sees other numbers, negative ones, where the upper halves hold ones, and
  // answers otherwise.  One that never answers twice alike tells nothing.
  void find_width(const PointIn<4>& in, const PointContext& context) const {
    const auto ask = [&](bool poisoned) {
      call_.load(in, context, Width::four);
      const CallEnd end = call_.run(poisoned);
      const bool returned = end.ending == Ending::returned && call_.damage().empty();
      std::optional<std::vector<double>> answer;
      if (returned) answer = call_.answer();
      call_.repair();
      return answer;
    };
    width_known_ = true;
    if (!setup_.routine.not_called.empty())
      notes.push_back(setup_.routine.file + " has " + setup_.routine.not_called +
                      " too, which sagefe does not call: first values come from the deck");
    const auto first = ask(false);
    if (!first) return;  // the call itself says why
    const auto second = ask(false), poisoned = ask(true);
    if (!second || !same_bits(*first, *second)) return;
    if (poisoned && same_bits(*first, *poisoned)) return;
    width_ = Width::eight;
    notes.push_back(setup_.routine.words() + " was built with integers of 8 bytes: it is given such");
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
      refuse("answers DFGRD1 and not DSTRAN: it is for large strains, which sagefe has not,", context);
  }

  Setup setup_;
  mutable Call call_;
  std::vector<std::string> names_;
  std::vector<Quantity> quantities_;
  mutable Width width_ = Width::four;
  mutable bool width_known_ = false, answers_strain_ = false, told_of_nan_ = false;
};

const std::vector<Parameter>& table() {
  static const std::vector<Parameter> rows = {
      {"components", Dimension::none, "NTENS: 4 (11 22 33 12) or 6 (and 13 23, whose strains are 0)"},
      {"state_variables", Dimension::none, "NSTATV; initial cards of kind 4 give their first values, else 0"},
      {"symmetric", Dimension::none, "1: DDSDDE is symmetric in every state", 0.0, false},
      {"threads_safe", Dimension::none, "1: may be called by several threads at once", 0.0, false}};
  return rows;
}

int whole(std::span<const double> values, int place, int lowest, int highest) {
  const double value = values[static_cast<std::size_t>(place)];
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
  entry.make_for = [bindings = std::move(bindings)](std::span<const double> values, const UnitSystem&,
                                                    const std::string& material) -> LawPtr {
    Setup setup;
    setup.material = material;
    setup.components = whole(values, 0, 4, 6);
    if (setup.components == 5) throw ParameterError("S805", 0, "4 or 6 is wanted");
    setup.statev = whole(values, 1, 0, 100000);
    setup.symmetric = whole(values, 2, 0, 1) == 1;
    whole(values, 3, 0, 1);
    setup.props.assign(values.begin() + 4, values.end());
    setup.routine = routine_of(bindings, material);
    return umat_law(std::move(setup));
  };
  entry.make = [make = entry.make_for](std::span<const double> values, const UnitSystem& units) {
    return make(values, units, "");
  };
  return entry;
}

std::unique_ptr<SolidLaw> umat_law(Setup setup) {
  return std::make_unique<UmatLaw>(std::move(setup));
}

std::vector<std::string> take_notes() {
  return std::exchange(notes, {});
}

}  // namespace sage::umat
