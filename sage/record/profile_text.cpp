#include "sage/record/profile_text.hpp"

#include <fmt/format.h>

#include <iterator>

namespace sage {

namespace {

constexpr double kGiga = 1e9, kMega = 1e6;

const Profile::Phase& phase_at(const Profile& profile, int i) {
  return profile.phases()[static_cast<std::size_t>(i)];
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

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      (out += '\\') += c;
    else if (static_cast<unsigned char>(c) < 0x20)
      out += fmt::format("\\u{:04x}", static_cast<int>(c));
    else
      out += c;
  }
  return out + '"';
}

std::string json_of(const Profile& profile, int i) {
  const Profile::Phase& phase = phase_at(profile, i);
  std::string text =
      fmt::format(R"({{"phase": {}, "calls": {}, "seconds": {}, "own_seconds": {})",
                  quoted(std::string(phase.name)), phase.calls, profile.seconds_with_all(i), phase.seconds);
  const double operations = profile.operations_with_all(i);
  if (operations > 0.0) text += fmt::format(R"(, "operations": {:.12g})", operations);
  if (profile.with_memory()) text += fmt::format(R"(, "memory_bytes": {})", profile.memory_with_all(i));
  std::string children;
  const std::string indent = "\n" + std::string(static_cast<std::size_t>(2 * depth_of(profile, i) + 4), ' ');
  for_children(profile, i, [&](int child) {
    children += (children.empty() ? "" : ",") + indent + json_of(profile, child);
  });
  if (!children.empty()) text += ", \"phases\": [" + children + "]";
  return text + "}";
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
  return fmt::format(
      "{{\"sagefe\": {}, \"case\": {}, \"threads\": {}, \"kernels\": {}, \"seconds\": {}, \"accounted\": "
      "{:.4f},\n"
      "  \"run\": {}}}\n",
      quoted(SAGE_VERSION), quoted(case_name), threads, quoted(kernels), profile.seconds_with_all(0),
      accounted(profile), json_of(profile, 0));
}

}  // namespace sage
