#include "sage/deck/deck.hpp"

#include <algorithm>

#include "sage/deck/source.hpp"
#include "sage/deck/text.hpp"

namespace sage {

namespace {

// "....+....1....+....2" up to a column.
std::string ruler(std::size_t columns) {
  std::string text;
  for (std::size_t c = 1; c <= columns; ++c)
    text.push_back(c % 10 == 0 ? static_cast<char>('0' + c / 10 % 10) : (c % 5 == 0 ? '+' : '.'));
  return text;
}

// The characters of the line behind a text that its field or the card's end cut off.
std::string_view behind(const Deck& deck, const FieldValue& value) {
  const std::string_view line = deck.line_text(value.line);
  return value.last_column == 0 || trimmed(value.text).end() != value.text.end() ||
                 value.last_column > line.size()
             ? std::string_view()
             : line.substr(value.last_column);
}

}  // namespace

std::vector<CardView> Deck::all(std::string_view name) const {
  std::vector<char> wanted(specs.size());
  for (std::size_t i = 0; i < specs.size(); ++i) wanted[i] = specs[i].name == name;
  std::vector<CardView> views;
  for (std::size_t i = 0; i < cards.size(); ++i)
    if (wanted[static_cast<std::size_t>(cards[i].spec)]) views.emplace_back(*this, static_cast<int>(i));
  return views;
}

// An owner's cards stand between it and the next card of its kind.
std::vector<CardView> Deck::all(std::string_view name, const CardView& owner) const {
  std::vector<CardView> views;
  const int own_spec = owner.card().spec;
  for (std::size_t i = static_cast<std::size_t>(owner.index()) + 1; i < cards.size(); ++i) {
    if (cards[i].spec == own_spec) break;
    if (cards[i].owner == owner.index() && specs[static_cast<std::size_t>(cards[i].spec)].name == name)
      views.emplace_back(*this, static_cast<int>(i));
  }
  return views;
}

CardView Deck::one(std::string_view name) const {
  const std::vector<CardView> views = all(name);
  if (views.empty()) throw InputError({file, 0, 0, 0}, "the deck has no " + std::string(name) + " card");
  return views.front();
}

bool Deck::has(std::string_view name) const {
  return !all(name).empty();
}

std::string_view Deck::line_text(int line) const {
  if (!source || line < 1 || line > static_cast<int>(line_starts.size())) return {};
  return line_at(*source, line_starts[static_cast<std::size_t>(line) - 1]);
}

// A deck of n cards asks for some 20 n fields: names that end alike are compared whole, the others are not.
int CardView::place(std::string_view field) const {
  if (field.empty()) return -1;
  const std::vector<FieldSpec>& fields = spec().fields;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string& name = fields[i].name;
    if (name.size() == field.size() && name.back() == field.back() && name == field) return static_cast<int>(i);
  }
  return -1;
}

const FieldValue* CardView::value_at(int place) const {
  if (place < 0 || place >= card().value_count) return nullptr;
  return &deck_->values[static_cast<std::size_t>(card().first_value + place)];
}

double CardView::real(std::string_view field, double fallback) const {
  const int at = place(field);
  const FieldValue* value = value_at(at);
  if (!value) return fallback;
  if (!value->blank) return value->number;
  const FieldSpec& field_spec = spec().fields[static_cast<std::size_t>(at)];
  return field_spec.has_fallback ? field_spec.fallback : fallback;
}

int CardView::integer(std::string_view field, int fallback) const {
  const double number = real(field, fallback);
  return static_cast<int>(std::clamp(number, -2147483648.0, 2147483647.0));
}

std::string CardView::text(std::string_view field, std::string_view fallback) const {
  const FieldValue* value = find(field);
  return !value || value->blank ? std::string(fallback) : text_with_flaws(field).text;
}

WellFormed CardView::text_with_flaws(std::string_view field) const {
  const FieldValue* value = find(field);
  if (!value || value->blank) return {};
  return well_formed(trimmed(value->text), behind(*deck_, *value));
}

bool CardView::blank(std::string_view field) const {
  const FieldValue* value = find(field);
  return !value || value->blank;
}

std::span<const FieldValue> CardView::list(std::string_view field) const {
  const FieldValue* first = find(field);
  if (!first) return {};
  const bool last_field = spec().fields.back().name == field;
  const FieldValue* end = deck_->values.data() + card().first_value + card().value_count;
  return {first, last_field ? static_cast<std::size_t>(end - first) : 1};
}

SourcePosition CardView::where() const {
  return {deck_->file, card().line, 0, 0};
}

SourcePosition CardView::where(std::string_view field) const {
  const FieldValue* value = find(field);
  return value ? where(*value) : where();
}

SourcePosition CardView::where(const FieldValue& value) const {
  return {deck_->file, value.line, value.first_column, value.last_column};
}

std::string CardView::label(std::string_view field) const {
  const int at = place(field);
  if (at < 0) return std::string(field);
  const FieldSpec& field_spec = spec().fields[static_cast<std::size_t>(at)];
  return field_spec.unit.empty() ? field_spec.label : field_spec.label + ", " + field_spec.unit;
}

Diagnostic card_diagnostic(const Deck& deck, Severity severity, const SourcePosition& where,
                           std::string message) {
  Diagnostic diagnostic{severity, where, std::move(message), {}};
  if (where.line < 1 || where.line > static_cast<int>(deck.line_starts.size())) return diagnostic;
  constexpr std::size_t widest = 200;
  const std::string_view line = deck.line_text(where.line);
  const std::size_t shown = std::min(widest, line.size());
  const std::string card = well_formed(line.substr(0, shown), line.substr(shown)).text;
  const auto first = static_cast<std::size_t>(std::max(where.first_column, 0));
  const auto last = static_cast<std::size_t>(std::max(where.last_column, where.first_column));
  std::string number = std::to_string(where.line);
  if (number.size() < 5) number.insert(0, 5 - number.size(), ' ');
  const std::string gap(number.size(), ' ');
  diagnostic.detail.push_back(gap + " | " + ruler(std::max<std::size_t>(card.size(), 10)));
  diagnostic.detail.push_back(number + " | " + card);
  if (first > 0 && last <= widest)
    diagnostic.detail.push_back(gap + " | " + std::string(first - 1, ' ') + std::string(last - first + 1, '^'));
  return diagnostic;
}

}  // namespace sage
