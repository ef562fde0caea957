#include "solvers/library_module.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include <dlfcn.h>

#include "sage/core/error.hpp"

namespace sage {

std::vector<std::string> solver_module_places() {
  std::vector<std::string> places;
  if (const char* chosen = std::getenv("SAGE_SOLVER_MODULE")) places.emplace_back(chosen);
  std::error_code error;
  const auto executable = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) places.push_back((executable.parent_path() / SAGE_MODULE_RELATIVE).lexically_normal().string());
  places.emplace_back(SAGE_MODULE_BUILT);
  places.emplace_back(SAGE_MODULE_INSTALLED);
  return places;
}

// The handle is never closed: solvers made by the module may live as long as the program.
MakeLibrarySolver load_solver_module(const std::vector<std::string>& places) {
  using ModuleVersion = const char* (*)();
  std::string tried;
  for (const std::string& place : places) {
    tried += "\n  " + place;
    if (!std::filesystem::exists(place)) continue;
    void* handle = dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!handle) {
      tried += std::string(": ") + dlerror();
      continue;
    }
    const auto version = reinterpret_cast<ModuleVersion>(dlsym(handle, "sage_solver_module_version"));
    const auto make = reinterpret_cast<MakeLibrarySolver>(dlsym(handle, "sage_make_library_solver"));
    if (version && make && std::string_view(version()) == kSolverModuleVersion) return make;
    tried += ": belongs to another version";
    dlclose(handle);
  }
  throw AnalysisError("the module of library solvers can't be loaded; tried:" + tried);
}

std::unique_ptr<LinearSolver> make_library_solver(std::string_view name) {
  static const MakeLibrarySolver make = load_solver_module(solver_module_places());
  std::unique_ptr<LinearSolver> solver(make(std::string(name).c_str()));
  if (!solver) throw AnalysisError("the module of library solvers has no " + std::string(name));
  return solver;
}

}  // namespace sage
