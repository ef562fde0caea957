// Build step: writes a C++ source that holds the page's script and style.
//   embed_bundle OUTPUT report.js report.css
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

namespace {

bool write_function(std::ofstream& out, const char* name, const char* path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return false;
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  out << "std::string_view " << name << "() {\n  return std::string_view(\n";
  for (std::size_t at = 0; at < text.size(); at += 1000) {
    out << "      \"";
    for (const char byte : text.substr(at, 1000)) {
      char octal[5];
      std::snprintf(octal, sizeof octal, "\\%03o", static_cast<unsigned>(static_cast<unsigned char>(byte)));
      out << octal;
    }
    out << "\"\n";
  }
  out << "      \"\", " << text.size() << ");\n}\n\n";
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 1;
  std::ofstream out(argv[1], std::ios::binary);
  out << "// Written by embed_bundle from web/report.\n#include \"sage/report/bundle.hpp\"\n\nnamespace "
         "sage::report {\n\n";
  if (!write_function(out, "bundle_script", argv[2]) || !write_function(out, "bundle_style", argv[3])) {
    std::fprintf(stderr, "embed_bundle: %s or %s can't be read\n", argv[2], argv[3]);
    return 1;
  }
  out << "}  // namespace sage::report\n";
  return out.flush() ? 0 : 1;
}
