#include "sage/python/python_catalogue.hpp"

#include <pybind11/numpy.h>

#include <exception>
#include <mutex>
#include <utility>

#include "elements/register_elements.hpp"
#include "materials/register_materials.hpp"
#include "sage/app/plugins.hpp"
#include "sage/core/calls_in_order.hpp"
#include "sage/umat/law.hpp"
#include "solvers/register_solvers.hpp"

namespace sage::python {

namespace {

constexpr int kFirstPythonCode = 900000;

std::mutex& catalogue_lock() {
  static std::mutex lock;
  return lock;
}

// Lives as long as the process: what it holds of Python must not outlive the interpreter by a static destructor.
std::shared_ptr<const Catalogue>& held_catalogue() {
  static auto* const held = new std::shared_ptr<const Catalogue>([] {
    auto made = std::make_shared<Catalogue>();
    register_elements(*made);
    register_materials(*made);
    register_solvers(*made);
    made->materials.add(umat::kUmatCode, umat::umat_entry({}));
    return made;
  }());
  return *held;
}

// An object of Python that threads without the interpreter's lock may let go.
using SharedObject = std::shared_ptr<py::object>;
SharedObject shared(py::object object) {
  return {new py::object(std::move(object)), [](py::object* held) {
            if (!Py_IsInitialized()) return;  // the interpreter has gone, and the object with it
            const py::gil_scoped_acquire lock;
            delete held;
          }};
}

struct PythonEntry {
  std::string name;
  SharedObject function;
  std::vector<std::string> parameters;
  std::vector<std::string> history_names;  // that the quantities' names point into
  std::vector<Quantity> history;
  bool symmetric = false;
};

// Of laws of any size: what the function raised.
class RaisedError {
 public:
  virtual ~RaisedError() = default;
  void rethrow() const {
    const std::exception_ptr raised = std::exchange(raised_, nullptr);
    if (raised) std::rethrow_exception(raised);
  }

 protected:
  mutable std::exception_ptr raised_;  // changed under the interpreter's lock alone
};

// Python sees compression positive stresses and strains; the tangent has the same sign in both worlds.
template <int N>
class PythonLaw final : public Law<N>, public RaisedError, public CallsInOrder {
 public:
  PythonLaw(std::shared_ptr<const PythonEntry> entry, std::span<const double> values)
      : entry_(std::move(entry)) {
    py::dict parameters;
    for (std::size_t i = 0; i < entry_->parameters.size(); ++i)
      parameters[py::str(entry_->parameters[i])] = py::float_(values[i]);
    const py::object space = py::module_::import("types").attr("SimpleNamespace");
    parameters_ = shared(space(**parameters));
  }

  LawTraits traits() const override { return {.history = entry_->history, .symmetric = entry_->symmetric}; }
  bool needs_order() const override { return true; }

  Outcome update(const PointIn<N>& in, PointOut<N>& out) const override {
    const py::gil_scoped_acquire lock;
    try {
      return ask(in, out);
    } catch (py::error_already_set& error) {
      const std::string words = std::string(py::str(error.value()));
      const std::string kind = py::str(error.type().attr("__name__"));
      raised_ = std::current_exception();
      throw AnalysisError("S733", "the law " + entry_->name + " raised " + kind + ": " + words);
    }
  }

 private:
  static py::array_t<double> turned(const Vector<N>& values) {
    py::array_t<double> array(N);
    for (int i = 0; i < N; ++i) array.mutable_at(i) = 0.0 - values[i];
    return array;
  }
  // Doubles of a shape; Python hears of any other.
  py::array_t<double> numbers(const py::handle& object, const char* what,
                              const std::vector<py::ssize_t>& shape) const {
    using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
    Array array = Array::ensure(object);
    if (!array) throw py::error_already_set();
    if (std::vector<py::ssize_t>(array.shape(), array.shape() + array.ndim()) != shape) {
      std::string words = "the " + std::string(what) + " of " + entry_->name + " must have the shape (";
      for (const py::ssize_t length : shape) words += std::to_string(length) + ",";
      throw_value_error(words + ")");
    }
    for (py::ssize_t i = 0; i < array.size(); ++i)
      if (!std::isfinite(array.data()[i]))
        throw_value_error("the " + std::string(what) + " of " + entry_->name + " is no finite number");
    return array;
  }
  [[noreturn]] static void throw_value_error(const std::string& words) {
    PyErr_SetString(PyExc_ValueError, words.c_str());
    throw py::error_already_set();
  }

  Outcome ask(const PointIn<N>& in, PointOut<N>& out) const {
    const auto memory = static_cast<py::ssize_t>(in.h0.size());
    py::array_t<double> history(memory);
    std::copy(in.h0.begin(), in.h0.end(), history.mutable_data());
    const py::object answer =
        (*entry_->function)(*parameters_, turned(in.sigma0), turned(in.eps0), turned(in.deps), history);
    if (answer.is_none()) return Outcome::cut_step;
    if (!py::isinstance<py::tuple>(answer) || py::len(answer) < 2 || py::len(answer) > 3)
      throw_value_error("the law " + entry_->name +
                        " must return (stress, tangent) or (stress, tangent, history)");
    const py::tuple parts(answer);
    const py::array_t<double> stress = numbers(parts[0], "stress", {N});
    const py::array_t<double> tangent = numbers(parts[1], "tangent", {N, N});
    for (int i = 0; i < N; ++i) {
      out.sigma[i] = 0.0 - stress.at(i);
      for (int j = 0; j < N; ++j) out.D(i, j) = tangent.at(i, j);
    }
    if (parts.size() == 3) history = numbers(parts[2], "history", {memory});
    std::copy_n(history.data(), in.h0.size(), out.h1.begin());
    out.status = PointStatus::elastic;
    return Outcome::ok;
  }

  std::shared_ptr<const PythonEntry> entry_;
  SharedObject parameters_;
};

template <int N>
MaterialEntry material_entry(const std::shared_ptr<const PythonEntry>& law) {
  MaterialEntry entry;
  entry.law_size = N;
  entry.make = [law](std::span<const double> values, const UnitSystem&) -> LawPtr {
    const py::gil_scoped_acquire lock;
    return std::unique_ptr<Law<N>>(std::make_unique<PythonLaw<N>>(law, values));
  };
  return entry;
}

}  // namespace

std::shared_ptr<const Catalogue> catalogue() {
  const std::lock_guard<std::mutex> held(catalogue_lock());
  return held_catalogue();
}

void load_plugin(const std::string& file) {
  const std::lock_guard<std::mutex> held(catalogue_lock());
  auto more = std::make_shared<Catalogue>(*held_catalogue());
  app::load_plugin(file, *more);
  held_catalogue() = std::move(more);
}

int add_law(const std::string& name, const py::function& function, const py::list& parameters,
            const py::list& history, int size, bool symmetric, const std::string& summary) {
  auto law = std::make_shared<PythonEntry>();
  law->name = name;
  law->function = shared(function);
  law->symmetric = symmetric;
  for (const py::handle& one : history) {
    const auto pair = one.cast<std::pair<std::string, double>>();
    law->history_names.push_back(pair.first);
    law->history.push_back({{}, Dimension::none, pair.second});
  }
  for (std::size_t i = 0; i < law->history.size(); ++i) law->history[i].name = law->history_names[i];
  MaterialEntry entry = size == 2 ? material_entry<2>(law) : material_entry<4>(law);
  for (const py::handle& one : parameters) {
    const auto pair = one.cast<std::pair<std::string, py::object>>();
    law->parameters.push_back(pair.first);
    Parameter parameter{pair.first, Dimension::none, "of a law written in Python"};
    parameter.required = pair.second.is_none();
    if (!parameter.required) parameter.fallback = pair.second.cast<double>();
    entry.parameters.push_back(parameter);
  }
  entry.name = name;
  entry.summary = summary;
  entry.history = law->history;
  const std::lock_guard<std::mutex> held(catalogue_lock());
  auto more = std::make_shared<Catalogue>(*held_catalogue());
  const int code = std::max(kFirstPythonCode, more->materials.entries().rbegin()->first + 1);
  try {
    more->materials.add(code, std::move(entry));
  } catch (const std::logic_error&) {
    throw py::value_error("there is a law of the name " + name + " already");
  }
  held_catalogue() = std::move(more);
  return code;
}

void raise_error_of_law(const LawRef& law) {
  std::visit(
      [](const auto* held) {
        if (const auto* raised = dynamic_cast<const RaisedError*>(held)) raised->rethrow();
      },
      law);
}

void raise_error_of_laws(const Model& model) {
  for (const Material& material : model.materials) raise_error_of_law(material.law_ref());
}

}  // namespace sage::python
