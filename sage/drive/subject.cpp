#include "sage/drive/subject.hpp"
#include "sage/messages/parse_number.hpp"
#include "sage/messages/split_at.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <limits>

namespace sage::drive {

namespace {

constexpr double kUnset = std::numeric_limits<double>::quiet_NaN();

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

double number_from(const Setting& setting, const SourcePosition& where) {
  const std::string& text = setting.value;
  const auto value = parse_number<double>(std::string_view(text).substr(text.starts_with('+') ? 1 : 0));
  if (!value || !std::isfinite(*value))
    throw InputError("S651", where, fmt::format("{}={}: wanted a finite number", setting.key, text));
  return *value;
}

std::string parameter_names(const MaterialEntry& entry) {
  std::string names;
  for (const Parameter& parameter : entry.parameters) names += (names.empty() ? "" : ", ") + parameter.name;
  return names;
}

// Parameters behind those that the entry lists: "prop1", "prop2", ...
std::string open_name(const Subject& subject, std::size_t place) {
  return "prop" + std::to_string(place - subject.entry->parameters.size() + 1);
}

// Room is made up to there.  -1: the key is none of them.
int open_place(Subject& subject, std::string_view key) {
  constexpr std::string_view kKey = "prop";
  constexpr std::size_t kMost = 1000;
  if (!subject.entry->open_ended || !key.starts_with(kKey)) return -1;
  const auto number = parse_number<std::size_t>(key.substr(kKey.size()));
  if (!number || *number < 1 || *number > kMost) return -1;
  const std::size_t place = subject.entry->parameters.size() + *number - 1;
  if (subject.values.size() <= place) subject.values.resize(place + 1, kUnset);
  return static_cast<int>(place);
}

void give_name(Subject& subject, std::string_view name, const SourcePosition& where) {
  subject.name = std::string(trimmed(name));
  if (subject.name.empty() || subject.name.find('"') != std::string::npos)
    throw InputError("S651", where, fmt::format("{}: wanted a name without quotes before the colon", name));
}

}  // namespace

Setting setting_from(std::string_view text, const SourcePosition& where) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos || trimmed(text.substr(0, equals)).empty())
    throw InputError("S651", where, fmt::format("{}: wanted NAME=VALUE", text));
  return {std::string(trimmed(text.substr(0, equals))), std::string(trimmed(text.substr(equals + 1)))};
}

Subject subject_of(const Catalogue& catalogue, std::string_view law, const UnitSystem& units,
                   const SourcePosition& where) {
  for (const auto& [code, entry] : catalogue.materials.entries())
    if (entry.name == law || std::to_string(code) == law) {
      Subject subject;
      subject.name = entry.name;
      subject.code = code;
      subject.entry = catalogue.materials.share(code);
      subject.units = units;
      for (const Parameter& row : entry.parameters)
        subject.values.push_back(row.required ? kUnset : row.fallback);
      return subject;
    }
  throw InputError("S212", where,
                   fmt::format("there is no law {}; known: {}", law, catalogue.materials.known()));
}

Subject named_subject(const Catalogue& catalogue, std::string_view text, const UnitSystem& units,
                      const SourcePosition& where) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return subject_of(catalogue, trimmed(text), units, where);
  Subject subject = subject_of(catalogue, trimmed(text.substr(colon + 1)), units, where);
  give_name(subject, text.substr(0, colon), where);
  return subject;
}

void apply(Subject& subject, const Setting& setting, const SourcePosition& where) {
  const double value = number_from(setting, where);
  if (setting.key == "pressure") {
    subject.pressure = value;
    return;
  }
  if (constexpr std::string_view kHistory = "history."; setting.key.starts_with(kHistory)) {
    subject.history.push_back({setting.key.substr(kHistory.size()), value});
    return;
  }
  int place = parameter_place(*subject.entry, setting.key);
  if (place < 0) place = open_place(subject, setting.key);
  if (place < 0)
    throw InputError("S651", where,
                     fmt::format("{} has no parameter {}; it has {} (and E, nu, c, phi, psi for short; "
                                 "pressure and history.NAME are those of the start)",
                                 subject.entry->name, setting.key, parameter_names(*subject.entry)));
  subject.values[place] = value;
}

void expect_whole(const Subject& subject, const SourcePosition& where) {
  std::string missing;
  for (std::size_t i = 0; i < subject.values.size(); ++i)
    if (std::isnan(subject.values[i]))
      missing +=
          (missing.empty() ? "" : ", ") +
          (i < subject.entry->parameters.size() ? subject.entry->parameters[i].name : open_name(subject, i));
  if (!missing.empty())
    throw InputError("S651", where,
                     fmt::format("{} ({}): not set: {}", subject.name, subject.entry->name, missing));
  try {
    make_law(subject);
  } catch (const ParameterError& error) {
    throw InputError(error.code(), where,
                     fmt::format("{} ({}): {}", subject.name, subject.entry->name, error.what()));
  }
}

Subject subject_from(const Catalogue& catalogue, std::string_view text, const UnitSystem& units,
                     double pressure, const Subject* base, const SourcePosition& where) {
  const std::vector<std::string_view> parts = split_at(',', text);
  const std::string_view head = trimmed(parts.front());
  const std::size_t colon = head.find(':');
  const bool named = colon != std::string_view::npos;
  const std::string_view law = named ? trimmed(head.substr(colon + 1)) : head;
  if (law.empty() && base == nullptr)
    throw InputError("S651", where, fmt::format("{}: wanted NAME:LAW,KEY=VALUE,...", text));
  Subject subject = law.empty() ? *base : subject_of(catalogue, law, units, where);
  if (!law.empty()) subject.pressure = pressure;
  if (named) give_name(subject, head.substr(0, colon), where);
  for (std::size_t i = 1; i < parts.size(); ++i) apply(subject, setting_from(parts[i], where), where);
  expect_whole(subject, where);
  return subject;
}

std::vector<Subject> read_subjects(const Catalogue& catalogue, const std::filesystem::path& file,
                                   const UnitSystem& units, double pressure, const Subject* base) {
  std::ifstream stream(file);
  if (!stream || std::filesystem::is_directory(file))
    throw InputError("S101", {file.string()}, "can't be opened");
  std::vector<Subject> subjects;
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    const std::string_view text = trimmed(std::string_view(line).substr(0, line.find('#')));
    if (!text.empty())
      subjects.push_back(subject_from(catalogue, text, units, pressure, base, {file.string(), number, 0, 0}));
  }
  if (subjects.empty())
    throw InputError("S651", {file.string()}, "holds no case; wanted lines NAME:LAW,KEY=VALUE,...");
  return subjects;
}

std::string words_of(const Subject& subject) {
  std::string words = subject.entry->name;
  for (std::size_t i = 0; i < subject.values.size(); ++i) {
    const bool open = i >= subject.entry->parameters.size();
    Parameter row;
    if (open)
      row.name = open_name(subject, i);
    else
      row = subject.entry->parameters[i];
    const std::string unit = unit_text(row.dimension, subject.units);
    words += fmt::format("{} {} = {:.10g}{}", i == 0 ? ":" : ",", row.name, subject.values[i],
                         unit == "-" ? "" : " " + unit);
  }
  return words;
}

}  // namespace sage::drive
