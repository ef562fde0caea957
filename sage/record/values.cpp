#include "sage/record/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace sage {

std::string_view status_name(PointStatus status) {
  static const FieldEntry* const row = FieldTable().find("status");
  return row->words[static_cast<std::size_t>(status)];
}

std::string_view method_name(Method method) {
  switch (method) {
    case Method::newton:
      return "Newton";
    case Method::modified_newton:
      return "modified Newton";
    case Method::initial_stiffness:
      return "initial stiffness";
    case Method::dogleg:
      return "Newton with dogleg";
  }
  return "?";
}

std::string left_out_words(const Model& model) {
  std::string text;
  for (const std::string& what : model.left_out) text += (text.empty() ? "left out " : "; ") + what;
  return text;
}

std::string motion_words(const Model& model, double motion) {
  return motion > kLargeMotion && !model.large_strain
             ? fmt::format("displacements reach {:.3g} times the model's size, beyond small strains", motion)
             : std::string();
}

std::string completed_words(const Model& model, double motion) {
  const std::string beyond = motion_words(model, motion);
  if (!model.left_out.empty())
    return "completed, but PARTIAL: " + left_out_words(model) + (beyond.empty() ? "" : "; " + beyond);
  return beyond.empty() ? "completed: every increment in equilibrium" : "completed, BUT " + beyond;
}

std::string one_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

// Bytes of the character at the beginning; 0 where they are no UTF-8 (too long forms, halves of pairs and what
// lies beyond U+10FFFF included) or a character that XML does not allow.
static std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  unsigned code = first & (0x7fu >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
    code = code << 6 | (byte(i) & 0x3f);
  }
  constexpr unsigned kLeast[] = {0, 0, 0xa0, 0x800, 0x10000};
  const bool pair = code >= 0xd800 && code < 0xe000, none = code == 0xfffe || code == 0xffff;
  return first < 0xc2 || first > 0xf4 || code < kLeast[length] || code > 0x10ffff || pair || none ? 0 : length;
}

std::string xml_text(std::string_view text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8_length(text.substr(at));
    const std::string_view one = text.substr(at, std::max<std::size_t>(length, 1));
    at += one.size();
    if (length == 0)
      result += ' ';
    else if (one == "&")
      result += "&amp;";
    else if (one == "<")
      result += "&lt;";
    else if (one == ">")
      result += "&gt;";
    else if (one == "\"")
      result += "&quot;";
    else
      result += one;
  }
  return result;
}

std::string plain_name(std::string_view name, std::string_view also) {
  std::string text;
  for (std::size_t at = 0; at < name.size();) {
    const std::size_t length = utf8_length(name.substr(at));
    if (length == 0 || also.find(name[at]) != std::string_view::npos)
      text += fmt::format("%{:02X}", static_cast<unsigned char>(name[at]));
    else
      text += name.substr(at, length);
    at += std::max<std::size_t>(length, 1);
  }
  return text;
}

std::optional<std::string> name_from_plain(std::string_view text) {
  std::string name;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] != '%') {
      name += text[at];
      continue;
    }
    unsigned code = 0;
    const char* digits = text.data() + at + 1;
    if (at + 3 > text.size() || std::from_chars(digits, digits + 2, code, 16).ptr != digits + 2)
      return std::nullopt;
    name += static_cast<char>(code);
    at += 2;
  }
  return name;
}

std::string length_word(const std::string& unit) {
  static const std::pair<std::string_view, std::string_view> words[] = {
      {"m", "metre"}, {"mm", "millimetre"}, {"cm", "centimetre"}, {"in", "inch"}, {"ft", "foot"}};
  for (const auto& [letters, word] : words)
    if (unit == letters) return std::string(word);
  return unit.empty() ? "unit thickness" : unit;
}

std::string forces_per(const Model& model) {
  return model.geometry == Geometry::axisymmetric ? "for the full circle (2 pi r)"
                                                  : "per " + length_word(model.units.length);
}

std::string structure_forces_per(const Model& model) {
  const bool ring = model.geometry == Geometry::axisymmetric;
  return "per " + length_word(model.units.length) + (ring ? " of circumference" : "");
}

std::string sign_convention(const Model& model, std::string_view mark) {
  const bool ring = model.geometry == Geometry::axisymmetric;
  const UnitSystem& u = model.units;
  const std::string large =
      model.large_strain ? fmt::format("{}large strain: {}\n", mark, kLargeStrainWords) : std::string();
  return fmt::format(
             "{0}units: length {1}, force {2}, stress {3}; angles in degrees\n"
             "{0}stress and strain: compression positive; shear changes sign with them, so all four components "
             "have\n"
             "{0}  the sign opposite to the mathematical one.  Shear strain is the engineering gamma.\n"
             "{0}interfaces: normal stress and relative displacement positive in compression (closing); shear "
             "likewise reversed\n"
             "{0}displacements, loads and reactions: positive along +{4} and +{5}; reactions are what the "
             "supports do "
             "to the mesh\n"
             "{0}forces: {6}\n",
             mark, u.length, u.force, u.stress, ring ? "r" : "x", ring ? "z" : "y", forces_per(model)) +
         large;
}

}  // namespace sage
