#include "sage/deck/deck.hpp"

#include <algorithm>

#include "sage/deck/card_formats.hpp"
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
  if (std::find(wanted.begin(), wanted.end(), 1) == wanted.end()) return views;
  const auto is_wanted = [&](const Card& card) { return wanted[card.spec] != 0; };
  views.reserve(std::count_if(cards.begin(), cards.end(), is_wanted));
  for (std::size_t i = 0; i < cards.size(); ++i)
    if (is_wanted(cards[i])) views.emplace_back(*this, static_cast<int>(i));
  return views;
}

// An owner's cards stand between it and the next card of its kind.
std::vector<CardView> Deck::all(std::string_view name, const CardView& owner) const {
  std::vector<CardView> views;
  const int own_spec = owner.card().spec;
  for (std::size_t i = static_cast<std::size_t>(owner.index()) + 1; i < cards.size(); ++i) {
    if (cards[i].spec == own_spec) break;
    if (cards[i].owner == owner.index() && specs[cards[i].spec].name == name)
      views.emplace_back(*this, static_cast<int>(i));
  }
  return views;
}

CardView Deck::one(std::string_view name) const {
  const int card = first_of(name);
  if (card < 0) throw InputError("S110", {file, 0, 0, 0}, "the deck has no " + std::string(name) + " card");
  return {*this, card};
}

// Most cards of a large deck are nodes and elements, behind all that is asked for by name.
int Deck::first_of(std::string_view name) const {
  std::vector<char> wanted(specs.size());
  for (std::size_t i = 0; i < specs.size(); ++i) wanted[i] = specs[i].name == name;
  if (std::find(wanted.begin(), wanted.end(), 1) == wanted.end()) return -1;
  const auto found =
      std::find_if(cards.begin(), cards.end(), [&](const Card& card) { return wanted[card.spec] != 0; });
  return found == cards.end() ? -1 : static_cast<int>(found - cards.begin());
}

void Deck::add(Card card, std::span<const FieldValue> fields, bool again) {
  card.first_value = static_cast<std::int32_t>(numbers.size());
  card.value_count = static_cast<std::int32_t>(fields.size());
  card.first_place = again ? -1 : static_cast<std::int32_t>(places.size());
  for (const FieldValue& value : fields) numbers.push_back(value.blank ? blank_number() : value.number);
  if (!again)
    for (const FieldValue& value : fields)
      places.push_back({value.text, value.line, value.first_column, value.last_column, value.kind});
  cards.push_back(card);
}

void Deck::cut_back(std::size_t card) {
  if (card >= cards.size()) return;
  numbers.resize(cards[card].first_value);
  for (std::size_t i = card; i < cards.size(); ++i)
    if (cards[i].first_place >= 0) {
      places.resize(cards[i].first_place);
      break;
    }
  cards.resize(card);
}

std::vector<FieldValue> Deck::values(const Card& card) const {
  const auto count = static_cast<std::size_t>(card.value_count);
  std::vector<FieldValue> fields;
  if (card.first_place < 0) {
    const auto spec = static_cast<std::size_t>(card.spec);
    fields = read_again(*this, card, formats->lists[spec] ? count : specs[spec].fields.size());
  } else {
    fields.resize(count);
  }
  for (std::size_t i = 0; i < count; ++i) {
    FieldValue& value = fields[i];
    const double number = numbers[static_cast<std::size_t>(card.first_value) + i];
    value.blank = is_blank(number);
    value.number = value.blank ? 0.0 : number;
    if (card.first_place < 0) continue;
    const ValuePlace& place = places[static_cast<std::size_t>(card.first_place) + i];
    value.text = place.text;
    value.line = place.line;
    value.first_column = place.first_column;
    value.last_column = place.last_column;
    value.kind = place.kind;
  }
  return fields;
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

std::optional<FieldValue> CardView::find(std::string_view field) const {
  const int at = place(field);
  if (at < 0) return std::nullopt;
  const std::vector<FieldValue> values = deck_->values(card());
  return static_cast<std::size_t>(at) < values.size() ? std::optional(values[at]) : std::nullopt;
}

double CardView::real(std::string_view field, double fallback) const {
  return real_at(place(field), fallback);
}

double CardView::real_at(int at, double fallback) const {
  const double number = number_at(at);
  if (!Deck::is_blank(number)) return number;
  if (at < 0) return fallback;
  const FieldSpec& field_spec = spec().fields[at];
  return field_spec.has_fallback ? field_spec.fallback : fallback;
}

namespace {

int as_integer(double number) {
  return static_cast<int>(std::clamp(number, -2147483648.0, 2147483647.0));
}

}  // namespace

int CardView::integer(std::string_view field, int fallback) const {
  return as_integer(real(field, fallback));
}

int CardView::integer(FieldName& field, int fallback) const {
  return as_integer(real(field, fallback));
}

int CardView::place(FieldName& field) const {
  if (field.spec_ != &spec()) {
    field.spec_ = &spec();
    field.place_ = place(field.name_);
  }
  return field.place_;
}

std::string CardView::text(std::string_view field, std::string_view fallback) const {
  return blank(field) ? std::string(fallback) : text_with_flaws(field).text;
}

WellFormed CardView::text_with_flaws(std::string_view field) const {
  if (blank(field)) return {};
  const std::optional<FieldValue> value = find(field);
  return well_formed(trimmed(value->text), behind(*deck_, *value));
}

bool CardView::blank(std::string_view field) const {
  return Deck::is_blank(number_at(place(field)));
}

ValueList CardView::list(std::string_view field) const {
  const int at = place(field);
  if (at < 0 || at >= card().value_count) return {};
  const std::vector<FieldValue> values = deck_->values(card());
  const auto first = values.begin() + at;
  const bool last_field = spec().fields.back().name == field;
  return {first, last_field ? values.begin() + card().value_count : first + 1};
}

SourcePosition CardView::where() const {
  return {deck_->file, card().line, 0, 0};
}

SourcePosition CardView::where(std::string_view field) const {
  const std::optional<FieldValue> value = find(field);
  return value ? where(*value) : where();
}

SourcePosition CardView::where(const FieldValue& value) const {
  return {deck_->file, value.line, value.first_column, value.last_column};
}

std::string CardView::label(std::string_view field) const {
  const int at = place(field);
  if (at < 0) return std::string(field);
  const FieldSpec& field_spec = spec().fields[at];
  return field_spec.unit.empty() ? field_spec.label : field_spec.label + ", " + field_spec.unit;
}

Diagnostic card_diagnostic(const Deck& deck, Severity severity, Code code, const SourcePosition& where,
                           std::string message) {
  Diagnostic diagnostic{severity, code, where, std::move(message), {}};
  if (where.line < 1 || where.line > deck.source.line_count()) return diagnostic;
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
