// What a deck file says, card by card, with positions and without meaning.  The model builder gives it meaning.
#pragma once

#include <bit>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sage/deck/source.hpp"
#include "sage/deck/text.hpp"
#include "sage/messages/error.hpp"

namespace sage {

struct CardFormats;

enum class FieldKind : std::uint8_t { integer, real, text, logical };

// One field as read.  `number` holds integers and logicals (0/1) too; text points into the deck's own copy of
// the file.
struct FieldValue {
  double number = 0.0;
  std::string_view text;  // the characters as they stand on the card (whole field, blanks kept)
  int line = 0;           // 1-based
  std::uint16_t first_column = 0, last_column = 0;  // 1-based, inclusive; 0 = beyond the end of the record
  FieldKind kind = FieldKind::real;
  bool blank = true;  // nothing but blanks (or a short record, or a list-directed null)
};

// Whether a field that is left blank is worth a note, though it has a meaning.
enum class BlankNote : std::uint8_t {
  never,
  always,
  compared,  // where another card of the kind has something else than the blank gives
};

// A field's definition, from the layout.
struct FieldSpec {
  std::string name;   // canonical name that the model builder asks for: "x", "number"
  std::string label;  // for messages: "x coordinate"
  std::string unit;   // for messages and the manual: "length", "degrees"; may be empty
  FieldKind kind = FieldKind::real;
  bool required = false;      // blank is an error
  bool has_fallback = false;  // blank gives `fallback` instead of 0
  double fallback = 0.0;
  BlankNote blank_note = BlankNote::never;
  std::string use;        // what the value is used for, where its name may promise more; for echo and manual
  bool computed = false;  // stands on no card: the layout gives its value by an expression
};

// A card's definition, from the layout.
struct CardSpec {
  std::string name;               // canonical name: "node", "element"
  std::string label;              // the layout's own name for it: "C-3.L3"; same as name where it has none
  std::string format;             // "(2I5,3F10.0)"; empty = list-directed
  std::vector<FieldSpec> fields;  // one a value; the last may repeat (lists)
  bool made = false;              // stands in no record: all of its fields are computed
};

struct Card {
  int spec = 0;                   // index into Deck::specs
  int line = 0;                   // first line of the card
  std::int32_t first_value = 0;   // index into Deck::numbers
  std::int32_t value_count = 0;   // without the blanks at the end of a card that can be read again
  int owner = -1;                 // index of the card that opened the enclosing repeated block, -1 = none
  std::int32_t first_place = -1;  // index into Deck::places; -1 = the card's line is read again for them
};

// Where a value stands, and its characters, for cards that can't be read again: list-directed ones, and those
// that are made from other cards.
struct ValuePlace {
  std::string_view text;
  int line = 0;
  std::uint16_t first_column = 0, last_column = 0;
  FieldKind kind = FieldKind::real;
};

// What a deck asks for and the model lacks.
struct LeftOut {
  std::string what;    // for the line that says how a run ended: "36 beam elements (the pipe)"
  Diagnostic message;  // an error: the deck is refused unless BuildOptions::partial; else it is only reported
};

// Values of a list.  No view of the deck: not contiguous, so that no span of it can outlive it by mistake.
using ValueList = std::deque<FieldValue>;

// Reads one card's values by canonical field name.
class CardView;

// A part of a circle that sides of elements follow in a drawing.  No card says this.
struct DeckArc {
  double x = 0.0, y = 0.0;                // of the centre
  std::vector<std::pair<int, int>> ends;  // numbers of the nodes at the ends of each side
};

class Deck {
 public:
  std::string file;                                      // as given, for messages
  std::string layout;                                    // name of the layout that read it
  bool draft = false;                                    // that layout is a draft: no model is made of this
  SourceText source;                                     // the file's characters; keeps FieldValue::text alive
  std::shared_ptr<const std::deque<std::string>> texts;  // free-format texts whose quotes had to be undoubled
  std::shared_ptr<const CardFormats> formats;            // how cards without places are read again
  std::vector<CardSpec> specs;
  std::vector<Card> cards;         // in file order
  std::vector<double> numbers;     // of all cards; blank_number() where a field is blank
  std::vector<ValuePlace> places;  // of the cards that have them
  Diagnostics diagnostics;         // warnings and notes of reading (errors throw InputError)
  std::vector<DeckArc> arcs;
  std::vector<LeftOut> left_out;  // of a foreign deck, when it was given the meaning of this program's cards

  // A number of no deck, which stands for a blank field.
  static double blank_number() { return std::bit_cast<double>(blank_bits); }
  static bool is_blank(double number) { return std::bit_cast<std::uint64_t>(number) == blank_bits; }

  // Stores the card with its values.  `again`: reading its line again under its FORMAT gives the same values, so
  // that their places need not be kept, nor blanks at its end.
  void add(Card card, std::span<const FieldValue> fields, bool again = false);
  // Takes the last cards away, those from `card` on.
  void cut_back(std::size_t card);
  // A value of a card by its place there; blank_number() where it is blank or there is none.
  double number(const Card& card, int place) const {
    if (place < 0 || place >= card.value_count) return blank_number();
    return numbers[card.first_value + place];
  }
  // The values of a card with their places; the line is read again where they are not kept.
  std::vector<FieldValue> values(const Card& card) const;

  // All cards of a canonical name, in file order (several specs may share a name).
  std::vector<CardView> all(std::string_view name) const;
  // Cards of a name that belong to one owner card.
  std::vector<CardView> all(std::string_view name, const CardView& owner) const;
  // The only card of that name; throws InputError if there is none.
  CardView one(std::string_view name) const;
  bool has(std::string_view name) const { return first_of(name) >= 0; }

  // The characters of a line (without its end), for showing a card under a message.
  std::string_view line_text(int line) const { return source.line(line); }

 private:
  int first_of(std::string_view name) const;  // index of the first card of that name, -1 = none
  static constexpr std::uint64_t blank_bits = 0x7ff8'0000'00b1'a7cd;  // a NaN: no card holds one
};

// A field's name for loops over many cards: where it stands is found once for each kind of card.
class FieldName {
 public:
  explicit FieldName(const char* name) : name_(name) {}
  const char* name() const { return name_; }

 private:
  friend class CardView;
  const char* name_;  // a literal
  const CardSpec* spec_ = nullptr;
  int place_ = -1;
};

class CardView {
 public:
  CardView(const Deck& deck, int card) : deck_(&deck), card_(card) {}

  int index() const { return card_; }
  const Card& card() const { return deck_->cards[card_]; }
  const CardSpec& spec() const { return deck_->specs[card().spec]; }

  // The field's value; `fallback` where the layout has no such field or the card leaves it blank.
  double real(std::string_view field, double fallback = 0.0) const;
  int integer(std::string_view field, int fallback = 0) const;
  double real(FieldName& field, double fallback = 0.0) const { return real_at(place(field), fallback); }
  int integer(FieldName& field, int fallback = 0) const;
  // Trimmed of blanks at both ends, well-formed.
  std::string text(std::string_view field, std::string_view fallback = "") const;
  // The same with what was changed to make it so; empty where blank.
  WellFormed text_with_flaws(std::string_view field) const;
  bool blank(std::string_view field) const;  // absent or blank
  bool blank(FieldName& field) const { return Deck::is_blank(number_at(place(field))); }
  // The values of the last, repeating field.
  ValueList list(std::string_view field) const;

  SourcePosition where() const;                        // the whole card
  SourcePosition where(std::string_view field) const;  // the field's columns; the card if absent
  SourcePosition where(const FieldValue& value) const;
  // "element 12, node 3": label of a field for messages, with its unit.
  std::string label(std::string_view field) const;

 private:
  // Index of the field in the spec; -1 = the layout has none of this name.
  int place(std::string_view field) const;
  int place(FieldName& field) const;
  double real_at(int place, double fallback) const;
  double number_at(int place) const { return deck_->number(card(), place); }
  std::optional<FieldValue> find(std::string_view field) const;
  const Deck* deck_;
  int card_;
};

// An error at a field, shown with the card and a caret line below it and the column ruler above it.
Diagnostic card_diagnostic(const Deck& deck, Severity severity, Code code, const SourcePosition& where,
                           std::string message);

}  // namespace sage
