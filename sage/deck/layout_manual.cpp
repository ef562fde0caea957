// Writes the manual of a layout from the layout itself.
#include <algorithm>

#include "sage/deck/layout.hpp"
#include "sage/deck/text.hpp"
#include "sage/page/page.hpp"

namespace sage {

namespace {

const char* kind_text(FieldKind kind) {
  switch (kind) {
    case FieldKind::integer:
      return "integer";
    case FieldKind::real:
      return "real";
    case FieldKind::text:
      return "text";
    case FieldKind::logical:
      return "T or F";
  }
  return "";
}

// "1-5", "6-10", ... of a FORMAT's fields; a card behind the first is named.
std::vector<std::string> field_columns(const CardRule& card) {
  std::vector<std::string> columns;
  FormatWalker walker(card.format);
  int at = 1, record = 1;
  while (columns.size() < card.spec.fields.size()) {
    if (card.spec.fields[columns.size()].computed) {
      columns.emplace_back("-");
      continue;
    }
    const FormatStep& step = walker.next();
    if (step.edit == Edit::tab_to) at = step.width;
    if (step.edit == Edit::tab_by) at = std::max(1, at + step.width);
    if (step.edit == Edit::next_record || step.edit == Edit::end) {
      record += step.edit == Edit::end ? 1 : step.width;
      at = 1;
    }
    if (step.edit == Edit::end) walker.revert();
    if (!is_data(step.edit)) continue;
    const std::string last = step.width == 0 ? std::string("end") : std::to_string(at + step.width - 1);
    std::string place = step.width == 1 ? std::to_string(at) : std::to_string(at) + "-" + last;
    if (record > 1) place += " (line " + std::to_string(record) + ")";
    columns.push_back(place);
    at += step.width;
  }
  return columns;
}

std::string values_text(const FieldRule& rule) {
  std::string text;
  for (const Expression& one : rule.values) text += (text.empty() ? "`" : ", `") + one.source + "`";
  return text;
}

void add_field(const FieldSpec& spec, const FieldRule& rule, const std::string& place, Page& page) {
  std::string notes = rule.codes;
  const auto note = [&](const std::string& text) { notes += (notes.empty() ? "" : "; ") + text; };
  if (spec.required) note("required");
  if (spec.blank_note == BlankNote::always) note("note if blank");
  if (spec.blank_note == BlankNote::compared) note("note if blank and another of these cards has a value");
  if (spec.has_fallback) note("blank = " + number_text(spec.fallback));
  if (rule.bounded()) note("between " + number_text(rule.least) + " and " + number_text(rule.most));
  if (!rule.must_equal.empty()) note("must read " + rule.must_equal);
  if (spec.computed) note("computed: " + values_text(rule));
  if (!rule.count.empty()) note("list of `" + rule.count.source + "` values");
  if (!spec.use.empty()) note(spec.use);
  page.row({place, "`" + spec.name + "`", kind_text(spec.kind), Page::cell(spec.label), Page::cell(spec.unit),
            Page::cell(notes)});
}

void add_fields(const CardRule& card, Page& page) {
  const bool columns = !card.list_directed && !card.is_item && !card.spec.made;
  page.table({columns ? "Columns" : "Value", "Field", "Kind", "Meaning", "Unit", "Codes and defaults"});
  const std::vector<std::string> places = columns ? field_columns(card) : std::vector<std::string>();
  for (std::size_t i = 0; i < card.spec.fields.size(); ++i)
    add_field(card.spec.fields[i], card.rules[i], columns ? places[i] : std::to_string(i + 1), page);
}

std::string run_text(const LayoutEntry& entry) {
  std::string text;
  switch (entry.run) {
    case LayoutEntry::Run::once:
      text = "once";
      break;
    case LayoutEntry::Run::counted:
      text = "`" + entry.count.source + "` times";
      break;
    case LayoutEntry::Run::named:
      text = "as often as its name occurs";
      break;
    case LayoutEntry::Run::until:
      text = "repeats";
      break;
  }
  if (!entry.until.empty()) text += " until `" + entry.until.source + "`";
  if (!entry.when.empty()) text = "if `" + entry.when.source + "`" + (text == "once" ? "" : ": " + text);
  return text;
}

void add_overview(const Layout& layout, const std::vector<LayoutEntry>& entries, int depth, Page& page) {
  for (const LayoutEntry& entry : entries) {
    if (entry.card < 0) {
      page.item("the following cards, " + run_text(entry) + ":", depth);
      add_overview(layout, entry.entries, depth + 1, page);
      continue;
    }
    const CardRule& card = layout.cards[entry.card];
    page.item("`" + card.key + "`, " + run_text(entry) +
                  (entry.headings > 0 ? ", below " + std::to_string(entry.headings) + " heading line(s)" : ""),
              depth);
  }
}

void add_cards(const Layout& layout, const std::vector<LayoutEntry>& entries, Page& page) {
  for (const LayoutEntry& entry : entries) {
    add_cards(layout, entry.entries, page);
    if (entry.card < 0) continue;
    const CardRule& card = layout.cards[entry.card];
    page.heading(3, card.key + (card.spec.name != card.key ? " (`" + card.spec.name + "`)" : ""));
    if (!card.about.empty()) page.paragraph(card.about);
    page.paragraph((card.list_directed ? std::string("Free format (list-directed)")
                    : card.spec.made   ? std::string("Not in the deck: its values are computed")
                                       : "FORMAT `" + card.spec.format + "`") +
                   ", " + run_text(entry) + ".");
    if (!card.spec.fields.empty()) add_fields(card, page);
    if (card.items_card < 0) continue;
    const CardRule& item = layout.cards[card.items_card];
    page.paragraph("Then, in the same READ, `" + card.items_count.source + "` times (`" + item.spec.name +
                   "`):");
    add_fields(item, page);
  }
}

}  // namespace

std::string layout_manual(const Layout& layout) {
  Page page(layout.title);
  page.note("Written from legacy_inputs/layouts/" + layout.name + ".toml: change that file, not this one.");
  // Texts of a layout end in a newline.
  const auto words = [](std::string text) {
    if (text.ends_with('\n')) text.pop_back();
    return text;
  };
  if (!layout.introduction.empty()) page.paragraph(words(layout.introduction));
  page.heading(2, "The cards in order");
  add_overview(layout, layout.entries, 0, page);
  page.heading(2, "Card by card");
  add_cards(layout, layout.entries, page);
  if (!layout.example.empty()) {
    page.heading(2, "An example");
    page.code(layout.example);
  }
  if (!layout.closing.empty()) page.paragraph(words(layout.closing));
  return page.text();
}

}  // namespace sage
