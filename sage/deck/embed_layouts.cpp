// Build step: reads layout files and writes a C++ source that holds them as bytes.
//   embed_layouts OUTPUT NAME=FILE...
#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>

#include "sage/deck/layout_bytes.hpp"

namespace {

void write_layout(std::ofstream& out, const std::string& name, const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw sage::InputError("S101", {path, 0, 0, 0}, "can't be read");
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  sage::Layout layout = sage::load_layout_text(text, name + ".toml");
  sage::Archive archive;
  exchange(archive, layout);
  out << "    {\"" << name << "\", std::string_view(\"";
  for (const char byte : archive.bytes()) {
    char octal[5];
    std::snprintf(octal, sizeof octal, "\\%03o", static_cast<unsigned>(static_cast<unsigned char>(byte)));
    out << octal;
  }
  out << "\", " << archive.bytes().size() << "), " << (layout.marks.empty() ? "false" : "true") << "},\n";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 1;
  std::ofstream out(argv[1], std::ios::binary);
  out << "// Written by embed_layouts from legacy_inputs/layouts.\n#include \"sage/deck/embedded.hpp\"\n\n"
         "namespace sage {\n\nstd::span<const EmbeddedLayout> embedded_layouts() {\n"
         "  static constexpr EmbeddedLayout all[] = {\n";
  try {
    for (int i = 2; i < argc; ++i) {
      const std::string argument = argv[i];
      const std::size_t equals = argument.find('=');
      if (equals == std::string::npos) return 1;
      write_layout(out, argument.substr(0, equals), argument.substr(equals + 1));
    }
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  out << "  };\n  return all;\n}\n\n}  // namespace sage\n";
  return out.flush() ? 0 : 1;
}
