#include "sage/record/profile_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <iterator>
#include <nlohmann/json.hpp>

namespace sage {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kGiga = 1e9, kMega = 1e6;

const Profile::Phase& phase_at(const Profile& profile, int i) {
  return profile.phases()[i];
}

int depth_of(const Profile& profile, int phase) {
  int depth = 0;
  for (int i = phase; phase_at(profile, i).parent >= 0; i = phase_at(profile, i).parent) ++depth;
  return depth;
}

template <class Visit>
void for_children(const Profile& profile, int parent, Visit visit) {
  for (int i = parent + 1; i < static_cast<int>(profile.phases().size()); ++i)
    if (phase_at(profile, i).parent == parent) visit(i);
}

void add_rows(std::string& text, const Profile& profile, int i) {
  const Profile::Phase& phase = phase_at(profile, i);
  const auto indent = static_cast<std::size_t>(2 * depth_of(profile, i) + 2);
  const double seconds = profile.seconds_with_all(i), whole = profile.seconds_with_all(0);
  const double operations = profile.operations_with_all(i);
  fmt::format_to(std::back_inserter(text), "{:<36} {:>9} {:>11.4g} {:>11.4g} {:>6.1f}",
                 std::string(indent, ' ') + std::string(phase.name), phase.calls, seconds, phase.seconds,
                 whole > 0.0 ? 100.0 * seconds / whole : 0.0);
  if (operations > 0.0 && seconds > 0.0)
    fmt::format_to(std::back_inserter(text), " {:>9.3g} {:>7.2f}", operations / kGiga,
                   operations / kGiga / seconds);
  else
    text += fmt::format(" {:>9} {:>7}", "", "");
  if (profile.with_memory())
    fmt::format_to(std::back_inserter(text), " {:>9.1f}",
                   static_cast<double>(profile.memory_with_all(i)) / kMega);
  text.erase(text.find_last_not_of(' ') + 1);
  text += '\n';
  for_children(profile, i, [&](int child) { add_rows(text, profile, child); });
}

Json tree_of(const Profile& profile, int i) {
  const Profile::Phase& phase = phase_at(profile, i);
  Json json = {{"phase", phase.name},
               {"calls", phase.calls},
               {"seconds", profile.seconds_with_all(i)},
               {"own_seconds", phase.seconds}};
  if (const double operations = profile.operations_with_all(i); operations > 0.0)
    json["operations"] = static_cast<std::uint64_t>(operations);
  if (profile.with_memory()) json["memory_bytes"] = profile.memory_with_all(i);
  Json below = Json::array();
  for_children(profile, i, [&](int child) { below.push_back(tree_of(profile, child)); });
  if (!below.empty()) json["phases"] = std::move(below);
  return json;
}

double accounted(const Profile& profile) {
  const double whole = profile.seconds_with_all(0);
  return whole > 0.0 ? 1.0 - phase_at(profile, 0).seconds / whole : 0.0;
}

}  // namespace

std::string profile_table(const Profile& profile) {
  std::string text =
      fmt::format("  {:<34} {:>9} {:>11} {:>11} {:>6} {:>9} {:>7}{}\n", "phase", "calls", "seconds", "own", "%",
                  "GF", "GF/s", profile.with_memory() ? "        MB" : "");
  add_rows(text, profile, 0);
  text +=
      "  seconds, GF (1e9 floating-point operations, of the solvers) and MB (growth of the process's largest "
      "size)\n"
      "  are those of a phase and all below it; own is without those below.\n";
  return text;
}

std::string profile_json(const Profile& profile, const std::string& case_name, int threads,
                         const std::string& kernels) {
  const Json json = {{"sagefe", SAGE_VERSION},
                     {"case", case_name},
                     {"threads", threads},
                     {"kernels", kernels},
                     {"seconds", profile.seconds_with_all(0)},
                     {"accounted", std::round(1e4 * accounted(profile)) / 1e4},
                     {"run", tree_of(profile, 0)}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace sage
