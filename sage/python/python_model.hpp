// A model as Python holds it: its cards with names, the model that was made of them, and runs of it.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "sage/analysis/analysis.hpp"
#include "sage/builder/named_model.hpp"
#include "sage/python/python_catalogue.hpp"
#include "sage/record/report.hpp"
#include "sage/record/result.hpp"

namespace sage::python {

struct RunOptions {
  int threads = 1;
  std::string keep =
      "all";  // states that stay: of every increment ("all"), of the ends of stages ("ends"), "none"
};

// What a run of a model left.
struct Run {
  std::shared_ptr<const Model> model;
  std::shared_ptr<const Catalogue> catalogue;
  std::vector<std::shared_ptr<const Frame>> frames;
  Reports reports;
  RunResult result;
  std::vector<Diagnostic> warnings;
  std::string solver;
  int equations = 0;
};

class PythonModel {
 public:
  PythonModel(NamedModel named, std::shared_ptr<const Catalogue> its_catalogue);

  static PythonModel read(const std::string& file, const std::string& layout, bool partial);
  // Of an object with the attributes of sagefe.ModelInput.
  static PythonModel from_input(const py::object& input);

  PythonModel with_values(const std::vector<NamedValue>& values) const;
  std::shared_ptr<Run> run(const RunOptions& options) const;

  const NamedModel& named() const { return named_; }
  const std::shared_ptr<const Model>& model() const { return model_; }
  const std::shared_ptr<const Catalogue>& its_catalogue() const { return catalogue_; }

 private:
  std::shared_ptr<const Catalogue> catalogue_;
  NamedModel named_;
  std::shared_ptr<const Model> model_;
};

// Ctrl-C while the interpreter's lock is let go: asked in the thread that runs, other threads see what it found.
class Signals {
 public:
  Signals();
  StopAsked stop_asked();
  // The thread that runs is now the one that calls.
  void thread_changed();
  // Throws the KeyboardInterrupt that ended the run, if one did.
  void raise_if_any() const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

// An analysis under the control of Python.
class PythonAnalysis {
 public:
  PythonAnalysis(const PythonModel& model, const RunOptions& options);
  ~PythonAnalysis();

  bool advance();
  std::shared_ptr<const Frame> state();
  // Of all edge loads of the stage (from 1), or of those of the elements.
  void set_pressure(int stage, double normal, double shear, const std::vector<int>& elements);
  // Of the nodes: their forces in that stage.
  void set_load(int stage, const std::vector<int>& nodes, double x, double y);
  void scale_loads(int stage, double factor);
  std::shared_ptr<Run> close();

  // Of the last increment that is complete; stage 1, increment 0 before the first.
  int stage() const;
  int increment() const;
  bool is_complete() const { return analysis_->is_complete(); }
  bool is_closed() const { return closed_; }
  const std::shared_ptr<Run>& run() const { return run_; }

 private:
  class Watch;
  Stage& stage_of(int number);
  void loads_changed(int stage);
  void expect_open() const;

  std::shared_ptr<Model> model_;
  std::shared_ptr<Run> run_;
  std::unique_ptr<Watch> watch_;
  Signals signals_;
  std::unique_ptr<Analysis> analysis_;
  std::mutex in_use_;
  bool closed_ = false, ended_ = false;
};

}  // namespace sage::python
