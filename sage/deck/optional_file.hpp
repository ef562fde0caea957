// Files whose absence is no mistake.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "sage/deck/source.hpp"
#include "sage/messages/error.hpp"

namespace sage {

// The whole file; nothing where it does not exist or can't be read.
inline std::optional<std::string> read_file_if_any(const std::filesystem::path& file) {
  try {
    return read_file(file.string());
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace sage
