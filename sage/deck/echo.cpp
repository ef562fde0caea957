// What `sagefe echo` prints.
#include <algorithm>
#include <ostream>
#include <sstream>

#include "sage/deck/read_deck.hpp"
#include "sage/deck/text.hpp"

namespace sage {

namespace {

std::string value_text(const FieldValue& value) {
  if (value.kind == FieldKind::text) return '"' + std::string(trimmed(value.text)) + '"';
  if (value.kind == FieldKind::logical) return value.number != 0.0 ? "true" : "false";
  return number_text(value.number);
}

void echo_values(const CardSpec& spec, const std::vector<FieldValue>& values, std::ostream& out) {
  std::string line = "      ";
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t field = std::min(i, spec.fields.size() - 1);
    const FieldValue& value = values[i];
    if (value.blank) continue;
    std::string item = "  " + spec.fields[field].name;
    if (values.size() > spec.fields.size() && field + 1 == spec.fields.size())
      item += "(" + std::to_string(i - field + 1) + ")";
    item += (spec.fields[field].computed ? " := " : " = ") + value_text(value);
    if (line.size() + item.size() > 110) {
      out << line << '\n';
      line = "      ";
    }
    line += item;
  }
  out << line << '\n';
}

// What the fields of a card are for, where a name may promise more.
void echo_uses(const CardSpec& spec, std::ostream& out) {
  for (const FieldSpec& field : spec.fields)
    if (!field.use.empty()) out << "        (" << field.name << ": " << field.use << ")\n";
}

std::string line_number(int line) {
  std::string text = std::to_string(line);
  if (text.size() < 5) text.insert(0, 5 - text.size(), ' ');
  return text + " | ";
}

// Lines of a card: from its own to that of its last value.
int last_line(const Card& card, const std::vector<FieldValue>& values) {
  int line = card.line;
  for (const FieldValue& value : values) line = std::max(line, value.line);
  return line;
}

}  // namespace

void echo(const Deck& deck, std::ostream& out) {
  static constexpr std::string_view ruler =
      "....+....1....+....2....+....3....+....4....+....5....+....6....+....7....+....8";
  out << deck.file << ", layout " << deck.layout << '\n';
  int shown_line = 0, shown_spec = -1;
  for (const Card& card : deck.cards) {
    const CardSpec& spec = deck.specs[card.spec];
    if (spec.made) {
      out << "    + " << spec.name << (spec.label != spec.name ? " [" + spec.label + "]" : "") << ", made:\n";
      echo_values(spec, deck.values(card), out);
      continue;
    }
    const bool first = card.spec != shown_spec;
    if (first) {
      out << '\n' << spec.name;
      if (spec.label != spec.name) out << " [" << spec.label << "]";
      out << "  " << (spec.format.empty() ? "list-directed" : spec.format) << '\n'
          << "      | " << ruler << '\n';
      shown_spec = card.spec;
    }
    const std::vector<FieldValue> values = deck.values(card);
    for (int line = std::max(card.line, shown_line + 1); line <= last_line(card, values); ++line) {
      out << line_number(line) << deck.line_text(line) << '\n';
      shown_line = line;
    }
    echo_values(spec, values, out);
    if (first) echo_uses(spec, out);
  }
}

std::string echo(const Deck& deck) {
  std::ostringstream out;
  echo(deck, out);
  return out.str();
}

}  // namespace sage
