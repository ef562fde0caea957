// First line: a FORMAT ("*" = list-directed); the first byte says blank mode and padding; then records.
#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>

#include "sage/deck/record.hpp"

namespace {

using namespace sage;

template <class Read>
void read_values(Read& read, std::uint8_t mode) {
  static constexpr FieldKind kinds[] = {FieldKind::integer, FieldKind::real, FieldKind::text,
                                        FieldKind::logical};
  std::vector<FieldValue> values;
  std::vector<FieldFlaw> flaws;
  if (read.begin() != ReadEnd::complete) return;
  for (int i = 0; i < 100; ++i) {
    ReadEnd end = ReadEnd::wrong_edit;
    // Take the kind that the FORMAT wants; list-directed takes what comes.
    const FieldKind wanted = kinds[(mode >> 2) % 4];
    end = read.read(wanted, values, flaws);
    if (end != ReadEnd::complete) return;
  }
  read.finish();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const std::uint8_t mode = data[0];
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::size_t line = std::min(text.find('\n'), text.size());
  const std::string format = text.substr(0, line);
  const SourceText source(line < text.size() ? text.substr(line + 1) : std::string(), "fuzz");
  RecordRules rules;
  rules.blanks = mode & 1 ? BlankMode::zero : BlankMode::null;
  rules.pad = !(mode & 2);
  RecordSource records(source, rules);
  std::deque<std::string> texts;
  if (format == "*") {
    ListRead read(records, texts);
    read_values(read, mode);
    return 0;
  }
  try {
    const Format compiled = compile_format(format);
    FormattedRead read(records, compiled);
    read_values(read, mode);
  } catch (const FormatError&) {
  }
  return 0;
}
