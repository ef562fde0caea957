#include "elements/register_elements.hpp"
#include "materials/register_materials.hpp"
#include "sage/app/commands.hpp"
#include "sage/app/input.hpp"
#include "sage/messages/near_names.hpp"
#include "solvers/register_solvers.hpp"

namespace sage::app {

Catalogue full_catalogue(std::vector<umat::Binding> umats) {
  Catalogue catalogue;
  register_elements(catalogue);
  register_materials(catalogue);
  register_solvers(catalogue);
  catalogue.materials.add(umat::kUmatCode, umat::umat_entry(std::move(umats)));
  return catalogue;
}

int solver_code(const Catalogue& catalogue, const std::string& name) {
  if (name.empty()) return -1;
  if (const int code = catalogue.solvers.code_of(name); code != 0) return code;
  throw InputError("S213", {},
                   "unknown solver " + name + "; known: " + catalogue.solvers.known() +
                       did_you_mean(name, names_of(catalogue.solvers)));
}

std::function<std::string(const std::string&)> known_solver(const Catalogue& catalogue) {
  return [&catalogue](const std::string& name) {
    try {
      solver_code(catalogue, name);
    } catch (const InputError& error) {
      return error.diagnostics().list().front().message;
    }
    return std::string();
  };
}

}  // namespace sage::app
