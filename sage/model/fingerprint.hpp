// Tells whether two models are the same one: for checkpoints.
#pragma once

#include <cstdint>

#include "sage/model/model.hpp"

namespace sage {

// Depends on everything that an analysis of the model depends on, and on the titles, names and numbers that its
// results show; not on file names and lines.
std::uint64_t fingerprint(const Model& model);

}  // namespace sage
