// A plug-in with the fault that the environment names, one at a time; without it a sound one with one law.
#include <array>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include "sage/core/plugin.hpp"

namespace {

bool fault(std::string_view name) {
  const char* wanted = std::getenv("SAGE_TEST_FAULT");
  return wanted != nullptr && name == wanted;
}

// Stands still under any strain.
class Rigid final : public sage::SolidLaw {
 public:
  sage::LawTraits traits() const override { return {.symmetric = true}; }
  sage::Outcome update(const sage::PointIn<4>& in, sage::PointOut<4>& out) const override {
    if (fault("crash in a law")) std::raise(SIGSEGV);
    out.sigma = in.sigma0 + 1e4 * in.deps;
    out.D = 1e4 * sage::Matrix4::Identity();
    out.status = sage::PointStatus::elastic;
    return sage::Outcome::ok;
  }
};

sage::MaterialEntry law(const char* name) {
  sage::MaterialEntry entry{name, "for tests", 4, {}, [](std::span<const double>, const sage::UnitSystem&) {
                              return sage::LawPtr(std::make_unique<Rigid>());
                            }};
  if (!fault("no trials")) entry.trials = {{.values = {}, .knows_directions = true}};
  if (fault("law without a maker")) entry.make = nullptr;
  return entry;
}

void give(sage::Catalogue& catalogue) {
  if (fault("error text")) throw std::runtime_error("no licence today");
  if (fault("code of the program")) return catalogue.materials.add(3, law("rigid"));
  if (fault("code of the other")) return catalogue.materials.add(1000, law("rigid"));
  if (fault("name of the program")) return catalogue.materials.add(1001, law("drucker_prager"));
  if (fault("field of the program"))
    return catalogue.fields.add({.name = "stress", .meaning = "for tests", .value = sage::StressField{}});
  if (fault("field of the other"))
    return catalogue.fields.add({.name = "stress_ratio", .meaning = "for tests", .value = sage::StressField{}});
  catalogue.materials.add(1001, law("rigid"));
  if (fault("the same twice")) catalogue.materials.add(1001, law("rigid_too"));
}

int fill(sage::Catalogue& catalogue, char* error, std::size_t size) {
  if (fault("throws")) throw std::runtime_error("out of fill");
  if (fault("throws a number")) throw 1;
  if (fault("error without a text")) return 7;
  if (fault("crash in fill")) std::raise(SIGSEGV);
  return sage::fill_guarded(give, catalogue, error, size);
}

// Of another compiler.
constexpr std::array<char, 9> kOtherAbi{"C++=1998"};

[[gnu::section(SAGE_PLUGIN_SECTION), gnu::used]] constexpr auto kAbi = sage::plugin_abi.text;

[[gnu::constructor]] void opened() {
  if (fault("crash in a constructor")) std::raise(SIGSEGV);
  if (fault("abort in a constructor")) std::abort();
  if (fault("exit in a constructor")) std::_Exit(4);
  if (fault("throws in a constructor")) throw std::runtime_error("out of a constructor");
}

}  // namespace

extern "C" [[gnu::visibility("default")]] const SagePlugin* sage_plugin_v1() {
  static SagePlugin plugin{sizeof(SagePlugin), SAGE_PLUGIN_API, "wrong", "0.1", "the tests", kAbi.data(), fill};
  if (fault("null")) return nullptr;
  if (fault("throws at once")) throw std::runtime_error("out of the entry point");
  if (fault("throws a number at once")) throw 1;
  if (fault("short")) plugin.struct_size = 16;
  if (fault("other api")) plugin.api = 99;
  if (fault("no name")) plugin.name = nullptr;
  if (fault("empty name")) plugin.name = "";
  if (fault("name of two words")) plugin.name = "two words";
  if (fault("name of the other")) plugin.name = "own";
  if (fault("no version")) plugin.version = nullptr;
  if (fault("no author")) plugin.author = nullptr;
  if (fault("no abi")) plugin.abi = nullptr;
  if (fault("other abi")) plugin.abi = kOtherAbi.data();
  if (fault("no fill")) plugin.fill = nullptr;
  return &plugin;
}
