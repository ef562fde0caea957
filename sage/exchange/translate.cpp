#include "sage/exchange/translate.hpp"

#include <algorithm>
#include <stdexcept>

namespace sage {

namespace translate {

CardWriter::CardWriter(const Deck& from) : from_(&from), texts_(std::make_shared<std::deque<std::string>>()) {
  deck_.file = from.file;
  deck_.layout = from.layout;
  deck_.source = from.source;
  deck_.diagnostics = from.diagnostics;
  deck_.left_out = from.left_out;
}

std::string_view CardWriter::keep(const std::string& text) {
  texts_->push_back(text);
  return texts_->back();
}

int CardWriter::spec_of(const std::string& name, const std::vector<NewField>& fields) {
  std::string key = name;
  CardSpec spec{name, name, "", {}};
  for (const NewField& field : fields) {
    if (!spec.fields.empty() && spec.fields.back().name == field.name) break;
    key += " " + field.name;
    FieldSpec one;
    one.name = field.name;
    one.label = field.name;
    std::replace(one.label.begin(), one.label.end(), '_', ' ');
    spec.fields.push_back(std::move(one));
  }
  const auto [it, added] = specs_.try_emplace(key, static_cast<int>(deck_.specs.size()));
  if (added) deck_.specs.push_back(std::move(spec));
  return it->second;
}

int CardWriter::add(const std::string& name, const SourcePosition& where, const std::vector<NewField>& fields,
                    int owner) {
  Card card;
  card.spec = spec_of(name, fields);
  card.line = where.line;
  card.owner = owner;
  std::vector<FieldValue> values;
  for (const NewField& field : fields) {
    const SourcePosition& place = field.where.line > 0 ? field.where : where;
    FieldValue value;
    value.number = field.number;
    value.line = place.line;
    value.first_column = static_cast<std::uint16_t>(place.first_column);
    value.last_column = static_cast<std::uint16_t>(place.last_column);
    value.blank = false;
    if (!field.text.empty()) {
      value.text = keep(field.text);
      value.kind = FieldKind::text;
    }
    values.push_back(value);
  }
  deck_.add(card, values);
  return static_cast<int>(deck_.cards.size()) - 1;
}

void CardWriter::warning(Code code, const SourcePosition& where, const std::string& message) {
  deck_.diagnostics.add(card_diagnostic(*from_, Severity::warning, code, where, message));
}

void CardWriter::note(Code code, const SourcePosition& where, const std::string& message) {
  deck_.diagnostics.add(card_diagnostic(*from_, Severity::note, code, where, message));
}

void CardWriter::left_out(const SourcePosition& where, const std::string& what, const std::string& message,
                          bool needs_partial) {
  const Severity severity = needs_partial ? Severity::error : Severity::note;
  deck_.left_out.push_back({what, card_diagnostic(*from_, severity, "S229", where, message)});
}

void CardWriter::copy(std::string_view name) {
  for (const CardView& card : from_->all(name)) {
    std::vector<NewField> fields;
    for (const FieldSpec& field : card.spec().fields) {
      if (card.blank(field.name)) continue;
      const bool text = field.kind == FieldKind::text;
      fields.push_back({field.name, text ? 0.0 : card.real(field.name), card.where(field.name),
                        text ? card.text(field.name) : std::string()});
    }
    // The last field may be a list.
    if (!card.spec().fields.empty() && !fields.empty() &&
        fields.back().name == card.spec().fields.back().name) {
      const std::string field = fields.back().name;
      const ValueList list = card.list(field);
      for (std::size_t i = 1; i < list.size(); ++i)
        fields.push_back({field, list[i].number, card.where(list[i]), {}});
    }
    add(std::string(name), card.where(), fields);
  }
}

Deck CardWriter::take() {
  deck_.texts = texts_;
  return std::move(deck_);
}

NewField take(const CardView& card, std::string_view field, std::string_view as, double factor) {
  return {std::string(as.empty() ? field : as), factor * card.real(field), card.where(field), {}};
}

namespace {

bool has_field(const Deck& deck, std::string_view card, std::string_view field) {
  for (const CardSpec& spec : deck.specs)
    if (spec.name == card)
      for (const FieldSpec& one : spec.fields)
        if (one.name == field) return true;
  return false;
}

// The card of a body that is made by rule, not a card of that name in another sense.
bool has_body(const Deck& deck, std::string_view card, std::string_view field, std::string_view other) {
  return deck.has(card) && (has_field(deck, card, field) || has_field(deck, card, other));
}

}  // namespace

int solid_code(const Catalogue& catalogue, ParentShape shape, int nodes) {
  for (const auto& [code, entry] : catalogue.elements.entries())
    if (entry.solid() && entry.shape == shape && entry.nodes == nodes) return code;
  throw std::logic_error("the catalogue has no solid of " + std::to_string(nodes) + " nodes");
}

int law_code(const Catalogue& catalogue, std::string_view name) {
  const int code = catalogue.materials.code_of(name);
  if (code == 0) throw std::logic_error("the catalogue has no " + std::string(name));
  return code;
}

}  // namespace translate

// The cards decide, not the layout's name: a layout file of the user's own gets the same meaning.
std::optional<Deck> translated_deck(const Deck& deck, const Catalogue& catalogue) {
  if (translate::has_body(deck, "foundation", "columns", "rows"))
    return translate::embankment_deck(deck, catalogue);
  if (translate::has_body(deck, "rectangle", "columns", "rows"))
    return translate::rectangle_deck(deck, catalogue);
  if (translate::has_body(deck, "slope", "crest", "toe")) return translate::slope_deck(deck, catalogue);
  if (translate::has_body(deck, "mesh", "nodes", "elements")) return translate::listed_deck(deck, catalogue);
  if (translate::has_field(deck, "element", "shear_modulus")) return translate::quad4m_deck(deck, catalogue);
  if (translate::has_field(deck, "element", "class")) return translate::cande_deck(deck, catalogue);
  return std::nullopt;
}

}  // namespace sage
