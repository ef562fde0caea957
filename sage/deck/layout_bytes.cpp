#include "sage/deck/layout_bytes.hpp"

namespace sage {

namespace {

// The members are taken apart by structured bindings: a new one that is not exchanged does not compile.

template <class... T>
void exchange_all(Archive& archive, T&... values) {
  (archive(values), ...);
}

template <class T, class Exchange>
void exchange_list(Archive& archive, std::vector<T>& list, Exchange exchange_one) {
  std::size_t size = list.size();
  archive(size);
  if (archive.reading()) list.resize(size);
  for (T& one : list) exchange_one(archive, one);
}

void exchange(Archive& archive, ExpressionNode& node) {
  auto& [kind, number, text, card, field, words] = node;
  exchange_all(archive, kind, number, text, card, field, words);
}

void exchange(Archive& archive, Expression& expression) {
  auto& [source, nodes, line, words] = expression;
  exchange_all(archive, source, line, words);
  exchange_list(archive, nodes, [](Archive& a, ExpressionNode& node) { exchange(a, node); });
}

void exchange(Archive& archive, FormatStep& step) {
  auto& [edit, repeat, width, decimals, partner] = step;
  exchange_all(archive, edit, repeat, width, decimals, partner);
}

void exchange(Archive& archive, Format& format) {
  auto& [text, steps, revert_to, reversion_has_data] = format;
  exchange_all(archive, text, revert_to, reversion_has_data);
  exchange_list(archive, steps, [](Archive& a, FormatStep& step) { exchange(a, step); });
}

void exchange(Archive& archive, FieldSpec& field) {
  auto& [name, label, unit, kind, required, has_fallback, fallback, blank_note, use, computed] = field;
  exchange_all(archive, name, label, unit, kind, required, has_fallback, fallback, blank_note, use, computed);
}

void exchange(Archive& archive, FieldRule& rule) {
  auto& [codes, map, allowed, allowed_texts, least, most, must_equal, count, values, ignored, line] = rule;
  exchange_all(archive, codes, least, most, must_equal, ignored, line);
  exchange_list(archive, map, [](Archive& a, auto& code) { exchange_all(a, code.first, code.second); });
  exchange_list(archive, allowed, [](Archive& a, double& code) { a(code); });
  exchange_list(archive, allowed_texts, [](Archive& a, std::string& text) { a(text); });
  exchange(archive, count);
  exchange_list(archive, values, [](Archive& a, Expression& value) { exchange(a, value); });
}

void exchange(Archive& archive, CardRule& card) {
  auto& [spec, key, about, rules, list_directed, same_read, format, items_card, items_count, is_item, ignored,
         line] = card;
  auto& [name, label, format_text, fields, made] = spec;
  exchange_all(archive, name, label, format_text, made, key, about, list_directed, same_read, items_card,
               is_item, ignored, line);
  exchange_list(archive, fields, [](Archive& a, FieldSpec& field) { exchange(a, field); });
  exchange_list(archive, rules, [](Archive& a, FieldRule& rule) { exchange(a, rule); });
  exchange(archive, format);
  exchange(archive, items_count);
}

void exchange(Archive& archive, LayoutEntry& entry) {
  auto& [card, entries, opens, run, when, count, until, drop_last, headings, made_from, line] = entry;
  exchange_all(archive, card, opens, run, drop_last, headings, made_from, line);
  exchange_list(archive, entries, [](Archive& a, LayoutEntry& inner) { exchange(a, inner); });
  exchange(archive, when);
  exchange(archive, count);
  exchange(archive, until);
}

void exchange(Archive& archive, LayoutMark& mark) {
  auto& [line, column, texts] = mark;
  exchange_all(archive, line, column);
  exchange_list(archive, texts, [](Archive& a, std::string& text) { a(text); });
}

void exchange(Archive& archive, RecordRules& records) {
  auto& [comment, skip_columns, separator, record_length, pad, blanks] = records;
  exchange_all(archive, comment, skip_columns, separator, record_length, pad, blanks);
}

}  // namespace

void exchange(Archive& archive, std::vector<LayoutMark>& marks) {
  exchange_list(archive, marks, [](Archive& a, LayoutMark& mark) { exchange(a, mark); });
}

void exchange(Archive& archive, Layout& layout) {
  auto& [name, title, file, draft, records, first_sequence, last_sequence, separator, name_columns,
         introduction, closing, example, marks, cards, entries] = layout;
  exchange(archive, marks);
  exchange_all(archive, name, title, file, draft, first_sequence, last_sequence, separator, name_columns,
               introduction, closing, example);
  exchange(archive, records);
  exchange_list(archive, cards, [](Archive& a, CardRule& card) { exchange(a, card); });
  exchange_list(archive, entries, [](Archive& a, LayoutEntry& entry) { exchange(a, entry); });
}

}  // namespace sage
