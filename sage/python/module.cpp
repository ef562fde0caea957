// The extension module sagefe._sagefe: what the package's Python files build on.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>

#include "sage/drive/subject.hpp"
#include "sage/python/python_sweep.hpp"
#include "sage/python/state_arrays.hpp"

namespace sage::python {

namespace {

const char* severity_word(Severity severity) {
  switch (severity) {
    case Severity::note:
      return "note";
    case Severity::warning:
      return "warning";
    case Severity::error:
      break;
  }
  return "error";
}

py::object errors_module() {
  return py::module_::import("sagefe._errors");
}

py::list diagnostics_of(const std::vector<Diagnostic>& list) {
  const py::object make = errors_module().attr("Diagnostic");
  py::list out;
  for (const Diagnostic& one : list)
    out.append(make(severity_word(one.severity), to_string(one.code), one.where.file, one.where.line,
                    one.where.first_column, one.where.last_column, one.message, one.detail));
  return out;
}

void raise(const char* type, const py::tuple& arguments) {
  const py::object error = errors_module().attr(type)(*arguments);
  PyErr_SetObject(py::type::handle_of(error).ptr(), error.ptr());
}

void translate(std::exception_ptr thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const InputError& error) {
    raise("DeckError", py::make_tuple(diagnostics_of(error.diagnostics().list())));
  } catch (const py::builtin_exception&) {
    throw;
  } catch (const CodedError& error) {
    raise("AnalysisError", py::make_tuple(to_string(error.code()), error.what()));
  } catch (const std::logic_error& error) {
    PyErr_SetString(PyExc_RuntimeError, error.what());
  }
}

std::vector<NamedValue> values_from(const py::list& pairs) {
  std::vector<NamedValue> values;
  for (const py::handle& one : pairs) {
    const auto pair = one.cast<std::pair<std::string, py::object>>();
    if (py::isinstance<py::str>(pair.second))
      values.push_back({pair.first, pair.second.cast<std::string>()});
    else
      values.push_back({pair.first, pair.second.cast<double>()});
  }
  return values;
}

const char* status_text(RunStatus status) {
  switch (status) {
    case RunStatus::completed:
      return "completed";
    case RunStatus::not_converged:
      return "not converged";
    case RunStatus::singular:
      return "singular";
    case RunStatus::failed:
      return "failed";
    case RunStatus::stopped:
      break;
  }
  return "stopped";
}

py::dict units_of(const Model& model) {
  py::dict units;
  units["length"] = model.units.length;
  units["force"] = model.units.force;
  units["stress"] = model.units.stress;
  return units;
}

// A dictionary of columns: stage and increment, then those of the report's file.
py::dict report_columns(const Run& run, std::size_t index) {
  py::dict columns;
  const Reports& reports = run.reports;
  const auto rows = static_cast<py::ssize_t>(reports.rows(index));
  py::array_t<int> stages(rows), increments(rows);
  const std::vector<ReportColumn>& names = reports.columns(index);
  std::vector<py::array_t<double>> numbers;
  for (std::size_t c = 0; c < names.size(); ++c) numbers.emplace_back(rows);
  for (py::ssize_t row = 0; row < rows; ++row) {
    const auto [stage, increment] = reports.step(index, static_cast<std::size_t>(row));
    stages.mutable_at(row) = stage;
    increments.mutable_at(row) = increment;
    const std::vector<double> values = reports.values(index, static_cast<std::size_t>(row));
    for (std::size_t c = 0; c < names.size(); ++c) numbers[c].mutable_at(row) = values[c];
  }
  columns["stage"] = read_only(stages);
  columns["increment"] = read_only(increments);
  for (std::size_t c = 0; c < names.size(); ++c) columns[py::str(names[c].name)] = read_only(numbers[c]);
  return columns;
}

py::dict report_units(const Run& run, std::size_t index) {
  py::dict units;
  for (const ReportColumn& column : run.reports.columns(index)) units[py::str(column.name)] = column.unit;
  return units;
}

py::dict curve_of(const drive::Curve& curve) {
  py::dict columns, units;
  for (const drive::Column& column : curve.columns) {
    py::array_t<double> values(static_cast<py::ssize_t>(column.values.size()));
    std::copy(column.values.begin(), column.values.end(), values.mutable_data());
    columns[py::str(column.name)] = read_only(values);
    units[py::str(column.name)] = column.unit;
  }
  py::dict out;
  out["columns"] = columns;
  out["units"] = units;
  out["failure"] = curve.failure;
  return out;
}

struct DriveRequest {
  std::string law, test;
  std::vector<std::pair<std::string, double>> settings, history;
  UnitSystem units;
  double pressure = 0.0, normal_stiffness = 0.0;
  std::vector<double> start, turns;
  bool undrained = false;
  int steps = 100;
};

drive::Subject subject_of(const DriveRequest& request, const Catalogue& known) {
  drive::Subject subject = drive::subject_of(known, request.law, request.units);
  for (const auto& [name, value] : request.settings) {
    const int place = parameter_place(*subject.entry, name);
    if (place < 0) drive::apply(subject, {name, "0"});  // says which there are
    if (place >= 0) subject.values[place] = value;
  }
  drive::expect_whole(subject);
  return subject;
}

py::dict drive_law(const DriveRequest& request) {
  const std::shared_ptr<const Catalogue> known = catalogue();
  const drive::Subject subject = subject_of(request, *known);
  const int size = subject.entry->law_size;
  const drive::LabTest* test = drive::find_lab_test(request.test, size);
  if (test == nullptr)
    throw py::value_error("no test " + request.test + " for this law; there are " +
                          drive::known_lab_tests(size));
  if (request.undrained && test->undrained.empty())
    throw py::value_error("nothing moves in " + request.test + " without change of volume");
  if (request.steps < 1) throw py::value_error("a path has at least one step");
  drive::Path path;
  for (const auto& [name, value] : request.history) path.history.push_back({name, value});
  path.start.assign(size, 0.0);
  if (request.start.size() > path.start.size())
    throw py::value_error("the law has " + std::to_string(size) + " components of stress");
  if (!request.start.empty())
    std::ranges::copy(request.start, path.start.begin());
  else if (size == 4)
    std::fill_n(path.start.begin(), 3, request.pressure);
  else if (size > 1)
    path.start[1] = request.pressure;
  path.normal_stiffness = request.normal_stiffness;
  path.legs = drive::legs_of(*test, request.undrained, path.start, request.turns, request.steps);
  if (request.undrained && size == 4) path.total_stress_stays = test->total_stress_stays;
  const LawPtr law = drive::make_law(subject);
  drive::Curve curve;
  try {
    const py::gil_scoped_release unlocked;
    curve = drive::follow(subject, reference(law), path);
  } catch (const std::exception&) {
    raise_error_of_law(reference(law));
    throw;
  }
  raise_error_of_law(reference(law));
  return curve_of(curve);
}

py::dict laws_known() {
  const std::shared_ptr<const Catalogue> known = catalogue();
  py::dict laws;
  for (const auto& [code, entry] : known->materials.entries()) {
    py::list parameters;
    for (const Parameter& one : entry.parameters)
      parameters.append(py::make_tuple(
          one.name, one.meaning, one.required ? py::object(py::none()) : py::object(py::float_(one.fallback))));
    laws[py::str(entry.name)] = py::make_tuple(entry.law_size, entry.summary, parameters);
  }
  return laws;
}

void define_model(py::module_& m) {
  py::class_<PythonModel>(m, "Model")
      .def("with_values",
           [](const PythonModel& model, const py::list& pairs) {
             const std::vector<NamedValue> values = values_from(pairs);
             const py::gil_scoped_release unlocked;
             return model.with_values(values);
           })
      .def("value", [](const PythonModel& model, const std::string& name) { return model.named().get(name); })
      .def("names", [](const PythonModel& model) { return model.named().names(); })
      .def("run",
           [](const PythonModel& model, int threads, const std::string& keep) {
             return model.run({threads, keep});
           })
      .def_property_readonly(
          "diagnostics",
          [](const PythonModel& model) { return diagnostics_of(model.model()->diagnostics.list()); })
      .def_property_readonly("file", [](const PythonModel& model) { return model.model()->file; })
      .def_property_readonly("title", [](const PythonModel& model) { return model.model()->title; })
      .def_property_readonly("units", [](const PythonModel& model) { return units_of(*model.model()); })
      .def_property_readonly(
          "axisymmetric",
          [](const PythonModel& model) { return model.model()->geometry == Geometry::axisymmetric; })
      .def_property_readonly("stages",
                             [](const PythonModel& model) {
                               py::list stages;
                               for (const Stage& stage : model.model()->stages)
                                 stages.append(py::make_tuple(stage.title, stage.increments));
                               return stages;
                             })
      .def_property_readonly("materials",
                             [](const PythonModel& model) {
                               py::dict materials;
                               for (const Material& material : model.model()->materials) {
                                 py::dict parameters;
                                 for (std::size_t i = 0; i < material.parameters.size(); ++i)
                                   if (i < material.entry->parameters.size())
                                     parameters[py::str(material.entry->parameters[i].name)] =
                                         material.parameters[i];
                                 materials[py::int_(material.number)] =
                                     py::make_tuple(material.name, material.law_name, parameters);
                               }
                               return materials;
                             })
      .def_property_readonly("groups", [](const PythonModel& model) { return groups_of(*model.model()); })
      .def_property_readonly("node_places",
                             [](const PythonModel& model) { return node_places(*model.model()); })
      .def_property_readonly("node_numbers",
                             [](const PythonModel& model) { return node_numbers(*model.model()); });
}

void define_state(py::module_& m) {
  py::class_<State, std::shared_ptr<State>>(m, "State")
      .def("node_field",
           [](const std::shared_ptr<State>& s, const std::string& name) { return node_field(s, name); })
      .def("point_field", [](const std::shared_ptr<State>& s, const std::string& kind,
                             const std::string& name) { return point_field(s, kind_named(kind), name); })
      .def("node_names",
           [](const State& s) { return field_names(*s.model, FieldPlace::node, ElementKind::solid); })
      .def("point_names",
           [](const State& s, const std::string& kind) {
             return field_names(*s.model, FieldPlace::point, kind_named(kind));
           })
      .def("words", [](const State& s, const std::string& name) { return field_words(*s.model, name); })
      .def("unit", [](const State& s, const std::string& name) { return field_unit_text(*s.model, name); })
      .def("point_places",
           [](const State& s, const std::string& kind) { return point_places(*s.model, kind_named(kind)); })
      .def_property_readonly("units", [](const State& s) { return units_of(*s.model); })
      .def_property_readonly("groups", [](const State& s) { return groups_of(*s.model); })
      .def_property_readonly("active_groups",
                             [](const State& s) {
                               std::vector<bool> active;
                               for (const GroupData& data : s.frame->view().groups())
                                 active.push_back(data.active);
                               return active;
                             })
      .def_property_readonly("node_places", [](const State& s) { return node_places(*s.model); })
      .def_property_readonly("node_numbers", [](const State& s) { return node_numbers(*s.model); })
      .def_property_readonly("stage", [](const State& s) { return s.frame->report().stage + 1; })
      .def_property_readonly("increment", [](const State& s) { return s.frame->report().increment; })
      .def_property_readonly("load_factor", [](const State& s) { return s.frame->report().load_factor; })
      .def_property_readonly("converged", [](const State& s) { return s.frame->report().converged; })
      .def_property_readonly("iterations", [](const State& s) { return s.frame->report().total_iterations; });
}

void define_run(py::module_& m) {
  py::class_<Run, std::shared_ptr<Run>>(m, "Run")
      .def("states",
           [](const std::shared_ptr<Run>& run) {
             py::list states;
             for (const auto& frame : run->frames)
               states.append(std::make_shared<State>(State{run->model, frame}));
             return states;
           })
      .def_property_readonly("report_count", [](const Run& run) { return run.reports.count(); })
      .def("report", &report_columns)
      .def("report_units", &report_units)
      .def("report_messages", [](const Run& run, std::size_t index) { return run.reports.messages(index); })
      .def_property_readonly("report_kinds",
                             [](const Run& run) {
                               py::list kinds;
                               for (const Report& report : run.model->reports)
                                 kinds.append(py::make_tuple(static_cast<int>(report.kind), report.name));
                               return kinds;
                             })
      .def_property_readonly("status", [](const Run& run) { return status_text(run.result.status); })
      .def_property_readonly("reason", [](const Run& run) { return run.result.reason; })
      .def_property_readonly("code",
                             [](const Run& run) {
                               return run.result.code ? py::object(py::str(to_string(*run.result.code)))
                                                      : py::object(py::none());
                             })
      .def_property_readonly("warnings", [](const Run& run) { return diagnostics_of(run.warnings); })
      .def_property_readonly("solver", [](const Run& run) { return run.solver; })
      .def_property_readonly("equations", [](const Run& run) { return run.equations; });
}

void define_analysis(py::module_& m) {
  py::class_<PythonAnalysis>(m, "Analysis")
      .def(py::init([](const PythonModel& model, int threads, const std::string& keep) {
        return std::make_unique<PythonAnalysis>(model, RunOptions{threads, keep});
      }))
      .def("advance", &PythonAnalysis::advance)
      .def("state",
           [](PythonAnalysis& analysis) {
             return std::make_shared<State>(State{analysis.run()->model, analysis.state()});
           })
      .def("set_pressure", &PythonAnalysis::set_pressure)
      .def("set_load", &PythonAnalysis::set_load)
      .def("scale_loads", &PythonAnalysis::scale_loads)
      .def("close", &PythonAnalysis::close)
      .def_property_readonly("run", &PythonAnalysis::run)
      .def_property_readonly("stage", &PythonAnalysis::stage)
      .def_property_readonly("increment", &PythonAnalysis::increment)
      .def_property_readonly("is_complete", &PythonAnalysis::is_complete)
      .def_property_readonly("is_closed", &PythonAnalysis::is_closed);
}

}  // namespace

PYBIND11_MODULE(_sagefe, m) {
  py::register_exception_translator(&translate);
  define_model(m);
  define_state(m);
  define_run(m);
  define_analysis(m);
  m.def("read", &PythonModel::read);
  m.def("build", &PythonModel::from_input);
  m.def("sweep", &run_sweep);
  m.def("load_plugin", &load_plugin);
  m.def("add_law", &add_law);
  m.def("laws", &laws_known);
  m.def("drive", [](const std::string& law, const std::vector<std::pair<std::string, double>>& settings,
                    const std::string& test, double pressure, const std::vector<double>& start,
                    const std::vector<double>& turns, bool undrained, int steps, double normal_stiffness,
                    const std::vector<std::pair<std::string, double>>& history, double atmospheric_pressure,
                    double water_unit_weight) {
    DriveRequest request;
    request.law = law;
    request.test = test;
    request.settings = settings;
    request.history = history;
    request.units.atmospheric_pressure = atmospheric_pressure;
    request.units.water_unit_weight = water_unit_weight;
    request.pressure = pressure;
    request.normal_stiffness = normal_stiffness;
    request.start = start;
    request.turns = turns;
    request.undrained = undrained;
    request.steps = steps;
    return drive_law(request);
  });
  m.attr("version") = SAGE_VERSION;
}

}  // namespace sage::python
