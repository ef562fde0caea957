// Values of a TOML table, with the file's own line in every complaint.
#pragma once

// The parser asserts what a malformed file breaks (it goes on and reports it), or lets clang assume that none
// does.
#pragma push_macro("NDEBUG")
#undef NDEBUG
#define TOML_ASSERT(expr) static_assert(true)
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

#include <algorithm>
#include <string>

#include "sage/core/error.hpp"

namespace sage {

class TomlFile {
 public:
  explicit TomlFile(std::string file) : file_(std::move(file)) {}

  [[noreturn]] void fail(const toml::node& node, const std::string& message) const {
    const toml::source_position at = node.source().begin;
    throw InputError({file_, static_cast<int>(at.line), 0, 0}, message);
  }

  void known_keys(const toml::table& table, std::initializer_list<std::string_view> keys) const {
    for (const auto& [key, value] : table)
      if (std::find(keys.begin(), keys.end(), key.str()) == keys.end())
        fail(value, "unknown key \"" + std::string(key.str()) + "\"");
  }

  std::string text(const toml::table& table, std::string_view key, bool required = false) const {
    const toml::node* node = table.get(key);
    if (!node) {
      if (required) fail(table, "\"" + std::string(key) + "\" is missing");
      return {};
    }
    if (const auto value = node->value_exact<std::string>()) return *value;
    fail(*node, "\"" + std::string(key) + "\" must be a text in quotes");
  }

  int integer(const toml::table& table, std::string_view key, int fallback, int low, int high) const {
    const toml::node* node = table.get(key);
    if (!node) return fallback;
    const auto value = node->value_exact<std::int64_t>();
    if (!value || *value < low || *value > high)
      fail(*node, "\"" + std::string(key) + "\" must be an integer from " + std::to_string(low) + " to " +
                      std::to_string(high));
    return static_cast<int>(*value);
  }

  bool flag(const toml::table& table, std::string_view key) const {
    const toml::node* node = table.get(key);
    if (!node) return false;
    if (const auto value = node->value_exact<bool>()) return *value;
    fail(*node, "\"" + std::string(key) + "\" must be true or false");
  }

 protected:
  std::string file_;
};

}  // namespace sage
