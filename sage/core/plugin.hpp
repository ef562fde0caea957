// What a plug-in, a shared library with laws, elements, solvers or fields of somebody else's, has for the
// program: one C function and one text (docs/manual/plugins.md).  A plug-in of one source ends with
//
//   SAGE_PLUGIN("cam_clay", "1.0", "A. Author", [](sage::Catalogue& catalogue) {
//     catalogue.materials.add(1000, cam_clay());
//   })
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <string_view>

#include "sage/core/catalogue.hpp"
#include "sage/core/four_at_a_time.hpp"

// Written by sage_add_plugin, and by the build of the program, which rejects plug-ins that have another.
#if __has_include("sage/core/header_hash.hpp")
#include "sage/core/header_hash.hpp"
#else
#define SAGE_HEADER_HASH "unknown"
#endif

// Grows when what the functions below mean changes.  Any change of a header shows in its hash.
#define SAGE_PLUGIN_API 1
// Where the text stands in the file: it is read before anything of the library runs.
#define SAGE_PLUGIN_SECTION ".sage_plugin"

extern "C" {

// All texts end with NUL and live as long as the library.
struct SagePlugin {
  std::size_t struct_size;  // sizeof(SagePlugin)
  std::uint32_t api;        // SAGE_PLUGIN_API
  const char* name;         // by which decks ask for it: letters, digits, _ and -
  const char* version;
  const char* author;
  const char* abi;  // sage::plugin_abi
  // Adds to an empty catalogue; codes from 1000.  0 = done; else why not, in `error` of so many bytes.  Throws
  // nothing.
  int (*fill)(sage::Catalogue& catalogue, char* error, std::size_t error_size);
};

}  // extern "C"

namespace sage {

// "field=value;field=value;": all that program and plug-in must have alike for C++ to pass between them.  A
// plug-in's compiler writes its own into the plug-in, the program's compiler the program's.
struct AbiText {
  std::array<char, 1024> text{};
  std::size_t size = 0;

  constexpr void append(std::string_view words) {
    for (const char c : words) text[size++] = c;
  }
  constexpr void field(std::string_view name, std::string_view value) {
    append(name);
    append("=");
    append(value);
    append(";");
  }
  constexpr void field(std::string_view name, unsigned long long value) {
    std::array<char, 20> digits{};
    std::size_t first = digits.size();
    do digits[--first] = static_cast<char>('0' + value % 10);
    while ((value /= 10) > 0);
    field(name, std::string_view(digits.data() + first, digits.size() - first));
  }
};

namespace abi {

constexpr std::string_view sanitizer() {
#if defined(__SANITIZE_ADDRESS__)
  return "address";
#elif defined(__SANITIZE_THREAD__)
  return "thread";
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
  return "address";
#else
  return "none";
#endif
#else
  return "none";
#endif
}

// Vectors of four doubles cross in registers, and Eigen aligns for them.
constexpr std::string_view instructions() {
#if defined(__AVX512F__)
  return "avx512";
#elif defined(__AVX2__) && defined(__FMA__)
  return "avx2";
#elif defined(__AVX__)
  return "avx";
#else
  return "baseline";
#endif
}

constexpr std::string_view checked_containers() {
#ifdef _GLIBCXX_DEBUG
  return "yes";
#else
  return "no";
#endif
}

constexpr std::string_view old_strings() {
#if defined(_GLIBCXX_USE_CXX11_ABI) && _GLIBCXX_USE_CXX11_ABI == 0
  return "before C++11";
#else
  return "C++11";
#endif
}

constexpr AbiText make() {
  AbiText t;
  t.field("compiler ABI", __GXX_ABI_VERSION);
  t.field("strings", old_strings());
  t.field("checked containers", checked_containers());
  t.field("C++", __cplusplus);
  t.field("Eigen", EIGEN_WORLD_VERSION * 10000 + EIGEN_MAJOR_VERSION * 100 + EIGEN_MINOR_VERSION);
  t.field("Eigen's largest alignment", EIGEN_MAX_ALIGN_BYTES);
  t.field("Eigen's static alignment", EIGEN_MAX_STATIC_ALIGN_BYTES);
  t.field("instructions", instructions());
  t.field("sanitizer", sanitizer());
  t.field("size of a point's input", sizeof(PointIn<4>));
  t.field("size of a point's output", sizeof(PointOut<4>));
  t.field("size of a point's context", sizeof(PointContext));
  t.field("size of four points' input", sizeof(FourPointsIn<4>));
  t.field("size of an element's input", sizeof(ElementIn));
  t.field("size of an element's output", sizeof(ElementOut));
  t.field("size of an element's traits", sizeof(ElementTraits));
  t.field("size of a history quantity", sizeof(Quantity));
  t.field("size of a parameter", sizeof(Parameter));
  t.field("size of a unit system", sizeof(UnitSystem));
  t.field("size of a material entry", sizeof(MaterialEntry));
  t.field("size of an element entry", sizeof(ElementEntry));
  t.field("size of a solver entry", sizeof(SolverEntry));
  t.field("size of a field entry", sizeof(FieldEntry));
  t.field("size of a catalogue", sizeof(Catalogue));
  // Last: a compiler that differs is the better reason.
  t.field("hash of the headers in sage/core", SAGE_HEADER_HASH);
  return t;
}

}  // namespace abi

// Each library has its own: nothing of it may be merged with another's by the linker.
static constexpr AbiText plugin_abi = abi::make();

// For SagePlugin::fill: what `fill` throws becomes its text.
template <class Fill>
int fill_guarded(const Fill& fill, Catalogue& catalogue, char* error, std::size_t size) noexcept {
  try {
    fill(catalogue);
    return 0;
  } catch (const std::exception& e) {
    std::snprintf(error, size, "%s", e.what());
  } catch (...) {
    std::snprintf(error, size, "it threw what is no std::exception");
  }
  return 1;
}

}  // namespace sage

// The whole plug-in but its pieces; once in a library, outside of namespaces.  The last argument is a function of
// sage::Catalogue&.
#define SAGE_PLUGIN(plugin_name, plugin_version, plugin_author, ...)                                          \
  [[gnu::section(SAGE_PLUGIN_SECTION), gnu::used]] static constexpr auto sage_plugin_abi_text =               \
      sage::plugin_abi.text;                                                                                  \
  extern "C" [[gnu::visibility("default")]] const SagePlugin* sage_plugin_v1() {                              \
    static const SagePlugin plugin{sizeof(SagePlugin),                                                        \
                                   SAGE_PLUGIN_API,                                                           \
                                   plugin_name,                                                               \
                                   plugin_version,                                                            \
                                   plugin_author,                                                             \
                                   sage_plugin_abi_text.data(),                                               \
                                   [](sage::Catalogue& sage_pieces, char* sage_text, std::size_t sage_room) { \
                                     return sage::fill_guarded(__VA_ARGS__, sage_pieces, sage_text,           \
                                                               sage_room);                                    \
                                   }};                                                                        \
    return &plugin;                                                                                           \
  }
