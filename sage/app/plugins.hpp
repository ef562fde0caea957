// Plug-ins: libraries with pieces of somebody else's, loaded by --plugin (docs/manual/plugins.md).
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "sage/core/catalogue.hpp"
#include "sage/messages/error.hpp"
#include "sage/umat/law.hpp"

namespace sage::app {

class PluginError : public CodedError {
 public:
  using CodedError::CodedError;
  explicit PluginError(const std::string& message) : CodedError("S802", message) {}
};

// Loads the library, which then stays as long as the program, and adds its pieces.  It is tried in a process of
// its own first: a library that crashes harms none but that.  Throws PluginError, and leaves the catalogue as it
// was.  Before threads are started.
void load_plugin(const std::string& file, Catalogue& catalogue);

// Loads the libraries of [MATERIAL=]LIBRARY[:SYMBOL], likewise.  Throws PluginError.
std::vector<umat::Binding> load_umats(const std::vector<std::string>& texts);

// The values of an option on a command line, in order: these are read before the others.
std::vector<std::string> values_on(int argc, char** argv, std::string_view option);
// --plugin and --umat, for the help text and the parser, which has nothing to do for them.
void add_plugin_options(CLI::App& parser);

// The first field that differs, with both values; empty = all are alike.
std::string abi_difference(const std::string& plugin, const std::string& program);

}  // namespace sage::app
