# Writes OUTPUT, a C++ source that holds the text of every layout file in LAYOUTS (a list of paths).
set(code "// Written by embed_layouts.cmake from legacy_inputs/layouts.\n#include <array>\n#include <string_view>\n#include <utility>\n\n#include \"sage/deck/embedded.hpp\"\n\nnamespace sage {\n\nstd::span<const EmbeddedLayout> embedded_layouts() {\n  static constexpr EmbeddedLayout all[] = {\n")
foreach(path IN LISTS LAYOUTS)
  get_filename_component(name ${path} NAME_WE)
  file(READ ${path} text)
  # Compilers limit the length of one literal: 64 kB is more than any layout needs.
  string(APPEND code "      {\"${name}\", R\"layout(${text})layout\"},\n")
endforeach()
string(APPEND code "  };\n  return all;\n}\n\n}  // namespace sage\n")
file(WRITE ${OUTPUT} "${code}")
