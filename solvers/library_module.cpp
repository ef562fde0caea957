#include "solvers/library_module.hpp"

#include <algorithm>
#include <thread>

#include "sage/messages/error.hpp"
#include "solvers/address_space.hpp"

namespace sage {

namespace {

Module solver_module() {
  return {"the module of library solvers", "SAGE_SOLVER_MODULE",      SAGE_MODULE_RELATIVE, SAGE_MODULE_NAME,
          SAGE_SOLVER_MODULE_VERSION,      "sage_make_library_solver"};
}

}  // namespace

std::vector<std::string> solver_module_places() {
  return module_places(solver_module());
}

// Solvers made by the module may live as long as the program, and so does it.
MakeLibrarySolver load_solver_module(const std::vector<std::string>& places) {
  return reinterpret_cast<MakeLibrarySolver>(load_module(solver_module(), places));
}

std::unique_ptr<LinearSolver> make_library_solver(std::string_view name) {
  static const MakeLibrarySolver make = [] {
    constexpr std::size_t kLibraries = std::size_t{64} << 20;
    expect_address_space(kBlasBuffer * std::max(1u, std::thread::hardware_concurrency()) + kLibraries);
    return load_solver_module(solver_module_places());
  }();
  std::unique_ptr<LinearSolver> solver(make(std::string(name).c_str()));
  if (!solver) throw AnalysisError("S505", "the module of library solvers has no " + std::string(name));
  return solver;
}

}  // namespace sage
