#include "fortran_case.hpp"

#include <array>
#include <cstdio>

namespace sage::test {

namespace {

FieldKind kind_of(char letter) {
  if (letter == 'I') return FieldKind::integer;
  if (letter == 'A') return FieldKind::text;
  if (letter == 'L') return FieldKind::logical;
  return FieldKind::real;
}

std::string trim_right(std::string_view text) {
  return std::string(text.substr(0, text.find_last_not_of(' ') + 1));
}

std::string item_text(char letter, const FieldValue& value) {
  if (letter == 'A') return trim_right(value.text.substr(0, 80));
  if (letter == 'L') return value.number != 0.0 ? "T" : "F";
  if (letter == 'S') return number_text(static_cast<float>(value.number));
  return number_text(value.number);
}

const char* status_text(ReadEnd end) {
  if (end == ReadEnd::end_of_file) return "eof";
  if (end == ReadEnd::end_of_record) return "eor";
  return "error";
}

// A list-directed null leaves its variable as it was.
bool is_null(const FortranCase& given, const FieldValue& value) {
  return given.format == "*" && value.blank && value.text.empty() && value.first_column == value.last_column;
}

ReadEnd read_one(FormattedRead& read, char letter, FortranOutcome& out, std::vector<FieldFlaw>& flaws) {
  return read.read(kind_of(letter), out.values, flaws, letter == 'A' ? 80 : 0);
}
ReadEnd read_one(ListRead& read, char letter, FortranOutcome& out, std::vector<FieldFlaw>& flaws) {
  return read.read(kind_of(letter), out.values, flaws);
}

template <class Read>
void read_all(Read& read, const FortranCase& given, FortranOutcome& out) {
  out.status = "ok";
  if (const ReadEnd end = read.begin(); end != ReadEnd::complete) out.status = status_text(end);
  for (std::size_t i = 0; i < given.kinds.size() && out.status == "ok"; ++i) {
    std::vector<FieldFlaw> flaws;
    const ReadEnd end = read_one(read, given.kinds[i], out, flaws);
    if (end == ReadEnd::ended_by_slash) break;
    // A deck takes a blank logical field as its default; Fortran doesn't.
    const bool blank_logical =
        given.kinds[i] == 'L' && given.format != "*" && !out.values.empty() && out.values.back().blank;
    if (end != ReadEnd::complete) out.status = status_text(end);
    if (blank_logical || (!flaws.empty() && flaws.back().fault != FieldFault::none)) out.status = "error";
    if (out.status != "ok") break;
    out.items.push_back(is_null(given, out.values.back()) ? "unset"
                                                          : item_text(given.kinds[i], out.values.back()));
  }
  if (out.status != "ok") return;
  out.ok = true;
  read.finish();
}

}  // namespace

std::string number_text(double value) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.17g", value);
  const std::string shown = text.data();
  return shown == "-nan" ? "nan" : shown;
}

FortranOutcome run_case(const FortranCase& given) {
  FortranOutcome out;
  const SourceText source(given.text, "case");
  RecordRules rules;
  rules.blanks = given.blanks;
  rules.pad = given.pad;
  RecordSource records(source, rules);
  std::deque<std::string> texts;
  if (given.format == "*") {
    ListRead read(records, texts);
    read_all(read, given, out);
  } else {
    try {
      const Format format = compile_format(given.format);
      FormattedRead read(records, format);
      read_all(read, given, out);
    } catch (const FormatError&) {
      out.status = "error";
    }
  }
  while (out.items.size() < given.kinds.size()) out.items.push_back("unset");
  out.next = records.next() ? trim_right(records.record()) : "EOF";
  return out;
}

}  // namespace sage::test
