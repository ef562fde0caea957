#include "sage/layout_draft/write_toml.hpp"

#include <algorithm>

#include "sage/deck/text.hpp"

namespace sage::layout_draft {

namespace {

// A text between quotes, as TOML wants it: plain ASCII, nothing that ends it.
std::string quote(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c >= ' ' && c < 127 ? c : '?';
  }
  return quoted + '"';
}

std::string comment_text(std::string_view text) {
  std::string clean(text);
  for (char& c : clean)
    if (c < ' ' || c == 127) c = '?';
  return clean;
}

// Comments of at most about a hundred columns.
void add_comment(std::string& out, const std::string& indent, const std::string& text) {
  constexpr std::size_t kWidth = 100;
  std::string rest = comment_text(text);
  std::string mark = "# ";
  while (rest.size() > kWidth) {
    std::size_t cut = rest.rfind(' ', kWidth);
    if (cut == std::string::npos || cut == 0) cut = kWidth;
    out += indent + mark + rest.substr(0, cut) + '\n';
    rest.erase(0, rest[cut] == ' ' ? cut + 1 : cut);
    mark = "#   ";
  }
  out += indent + mark + rest + '\n';
}

const char* kind_text(Kind kind) {
  return kind == Kind::integer ? "integer" : kind == Kind::real ? "real" : "text";
}

std::string field_text(const FieldDraft& field, bool listed) {
  std::string text = "{ name = " + quote(field.name);
  if (!field.label.empty()) text += ", label = " + quote(field.label);
  if (listed) text += std::string(", kind = \"") + kind_text(field.kind) + '"';
  if (!field.count.empty()) text += ", count = " + field.count;
  return text + " },";
}

std::string columns_text(const FieldDraft& field) {
  if (field.first == 0) return {};
  if (field.last == 0) return "columns " + std::to_string(field.first) + " to the end";
  if (field.first == field.last) return "column " + std::to_string(field.first);
  return "columns " + std::to_string(field.first) + "-" + std::to_string(field.last);
}

std::string place_text(const FieldDraft& field) {
  return (field.record > 0 ? "line " + std::to_string(field.record) + ", " : "") + columns_text(field);
}

void add_fields(std::string& out, const std::string& indent, const std::vector<FieldDraft>& fields,
                bool listed) {
  out += indent + "fields = [\n";
  for (const FieldDraft& field : fields) {
    std::string line = indent + "  " + field_text(field, listed);
    std::string behind = place_text(field);
    if (!field.known) behind += behind.empty() ? "what is it?" : ": what is it?";
    if (!behind.empty()) line += "  # " + behind;
    out += line + '\n';
  }
  out += indent + "]\n";
}

void add_items(std::string& out, const std::string& indent, const CardDraft& card) {
  const CardDraft& item = card.items.front();
  for (const std::string& reason : item.reasons) add_comment(out, indent, reason);
  out += indent + "items = { name = " + quote(item.name) + ", count = " + card.items_count + ", fields = [";
  for (const FieldDraft& field : item.fields) out += field_text(field, true) + ' ';
  out.pop_back();
  out += "] }\n";
}

void add_card(std::string& out, const CardDraft& card, int depth) {
  const std::string indent(static_cast<std::size_t>(2 * depth), ' ');
  out += '\n';
  if (card.first_line > 0)
    add_comment(out, indent,
                card.first_line == card.last_line ? "Line " + std::to_string(card.first_line) + "."
                                                  : "Lines " + std::to_string(card.first_line) + " to " +
                                                        std::to_string(card.last_line) + ".");
  for (const std::string& reason : card.reasons) add_comment(out, indent, reason + ".");
  out += indent + (depth == 0 ? "[[card]]\n" : "[[card.card]]\n");
  out += indent + (card.inner.empty() ? "name = " : "block = ") + quote(card.name) + '\n';
  if (!card.as.empty()) out += indent + "as = " + quote(card.as) + '\n';
  if (card.headings > 0) out += indent + "headings = " + std::to_string(card.headings) + '\n';
  if (!card.label.empty()) out += indent + "label = " + quote(card.label) + '\n';
  if (!card.repeat.empty()) out += indent + "repeat = " + card.repeat + '\n';
  if (!card.until.empty()) out += indent + "until = " + card.until + '\n';
  if (!card.until_dropped.empty()) out += indent + "until_dropped = " + card.until_dropped + '\n';
  for (const CardDraft& inner : card.inner) add_card(out, inner, depth + 1);
  if (!card.inner.empty()) return;
  out += indent + "format = " + quote(card.format) + '\n';
  if (!card.fields.empty()) add_fields(out, indent, card.fields, card.format == "*");
  if (!card.items.empty()) add_items(out, indent, card);
}

}  // namespace

std::string toml_text(const std::vector<CardDraft>& cards, const Facts& facts, const std::string& layout_name,
                      const std::string& deck_name) {
  std::string out;
  add_comment(out, "",
              "A first layout of " + deck_name + ", guessed by sagefe layout guess: a draft to finish.");
  add_comment(
      out, "",
      "Every guess says why. Names that say nothing (card, field3) are questions: give them their meaning,");
  add_comment(
      out, "",
      "or mark what the program needs not know: ignored = true.  sagefe layout check shows what is read;");
  add_comment(
      out, "",
      "without the line `draft = true` names are checked, and sagefe check and run take decks under it.");
  out += "name = " + quote(layout_name) + '\n';
  out += "title = " + quote("guessed from " + deck_name) + '\n';
  out += "draft = true\n";
  out +=
      "blanks = \"null\"  # blanks inside and behind numbers are skipped; \"zero\" if the program takes them "
      "as zeros\n";
  for (const std::string& reason : facts.reasons) add_comment(out, "", reason + ".");
  if (facts.comment != '\0') out += "comment = " + quote(std::string(1, facts.comment)) + '\n';
  if (facts.sequence) out += "sequence_columns = [73, 80]\n";
  if (!facts.separator.empty()) {
    out += "card_separator = " + quote(facts.separator) + '\n';
    out += "card_name_columns = " + std::to_string(facts.name_columns) + '\n';
  }
  for (const CardDraft& card : cards) add_card(out, card, 0);
  return out;
}

}  // namespace sage::layout_draft
