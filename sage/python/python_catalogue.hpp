// What models of Python are made with: the catalogue of the process, which laws written in Python and plug-ins join.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>

#include "sage/model/model.hpp"

namespace sage::python {

namespace py = pybind11;

// Never changed: whoever adds to it makes another one, and models keep the one that they were made with.
std::shared_ptr<const Catalogue> catalogue();

void load_plugin(const std::string& file);

// A law of solids (size 4) or joints (size 2) that a Python function computes.  parameters: pairs (name, value where it is
// left out or None).  history: pairs (name, first value).  Returns its code.
int add_law(const std::string& name, const py::function& function, const py::list& parameters,
            const py::list& history, int size, bool symmetric, const std::string& summary);

// Throws what a law of the model raised while it ran, if one did.
void raise_error_of_laws(const Model& model);
void raise_error_of_law(const LawRef& law);

}  // namespace sage::python
