// Walks a layout's sequence of cards over a deck.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sage/deck/layout.hpp"
#include "sage/deck/plain_card.hpp"
#include "sage/deck/read_log.hpp"
#include "sage/deck/seams.hpp"

namespace sage {

class DeckReader : private ExpressionScope {
 public:
  DeckReader(const SourceText& source, const Layout& layout, const ReadOptions& options);

  // Throws InputError with all errors; with `problems` it goes there instead, and what could be read comes back.
  Deck read(Diagnostics* problems = nullptr);

 private:
  // How a card comes to be read: for messages about counts.
  struct RunState {
    const LayoutEntry* entry = nullptr;
    int wanted = 0;  // 0 = not counted
    int done = 0;
  };

  struct CardFields {  // values that expressions ask for, with their places
    int card = -1;
    std::vector<FieldValue> values;
  };

  // Line and values read so far: what doesn't move them would be read for ever.
  using Place = std::pair<int, std::size_t>;
  Place place() const { return {records_.line(), deck_.numbers.size() - made_values_}; }

  void find_entries(const std::vector<LayoutEntry>& entries);
  void read_entries(const std::vector<LayoutEntry>& entries, int owner);
  void read_entry(const LayoutEntry& entry, int owner);
  void read_counted(const LayoutEntry& entry, int owner);
  void read_named(const LayoutEntry& entry, int owner);
  void read_until(const LayoutEntry& entry, int owner);
  void read_one(const LayoutEntry& entry, int owner);
  void drop_cards(std::size_t cards);
  // Whether anything of it stands in records.
  bool is_read(const LayoutEntry& entry) const;

  // Cards that stand in no record, and fields that stand on no card (computed.cpp).
  void make_cards(const LayoutEntry& entry, int owner, int line);
  void make_card(const LayoutEntry& entry, int owner, int line);
  void make_followers(int rule, int card);
  int owner_of_followers(int card) const;
  void compute_fields(const CardRule& rule, int line);
  void compute_list(const CardRule& rule, std::size_t field, int line);
  bool copies_blank(const Expression& expression) const;
  void compute(const CardRule& rule, std::size_t field, const Expression& expression, FieldValue& value);
  void set_number(const CardRule& rule, std::size_t field, const Expression& expression, double number,
                  FieldValue& value);
  void take_place(const Expression& expression, FieldValue& value) const;
  bool may_make(std::size_t values, int line);
  void fault(const SourcePosition& where, const std::string& what, const Expression& expression,
             const ExpressionResult& result);
  void count_card(const Card& card, int sign);
  bool ends_run(const Card& card);

  // One card.
  void read_card(int rule, int owner);
  bool read_formatted(const CardRule& rule, Card& card);
  bool read_plainly(Card card);
  bool ends_plainly(std::size_t last_field_end) const;
  bool read_listed(const CardRule& rule, Card& card);
  bool read_items(const CardRule& rule, ListRead& read);
  template <class Read>
  bool read_fields(Read& read, const CardRule& rule);
  template <class Read>
  bool read_list(Read& read, const CardRule& rule, std::size_t field);
  void close_card(const CardRule& rule, const Card& card, bool complete);
  void store_card(const CardRule& rule, const Card& card, bool complete);
  void check_values(const CardRule& rule, const Card& card);
  void note_blanks();
  void note_list_rest();
  Severity unread_number() const { return whole_ && !layout_.draft ? Severity::error : Severity::warning; }
  void apply_map(const CardRule& rule, std::size_t field, FieldValue& value);
  void check_allowed(const CardRule& rule, std::size_t field, std::size_t value);
  void report_flaws(const CardRule& rule);
  // A card that reads well once it, or what follows a gap in it, is moved back into its columns.
  struct MovedCard {
    std::string line;      // as it reads then
    std::size_t word = 0;  // first character that is moved, of the line as it is
    int columns = 0;       // that it stands too far to the right; negative: to the left
    bool whole = true;     // the card as a whole
  };
  bool is_doubtful_line(const CardRule& rule, int line) const;
  std::optional<MovedCard> moved_back(const CardRule& rule, int line) const;
  bool reads_in_columns(const CardRule& rule, int line, std::string_view text) const;
  bool reads_as_neighbour(const CardRule& rule, int line) const;
  bool take_moved(const CardRule& rule, int line);
  // Values of a line that is off its columns, for `sagefe align` (align_card.cpp).
  bool is_beside_columns(const CardRule& rule, int line, std::size_t last_field_end);
  bool align_line(const CardRule& rule, int line);
  bool take_aligned(const CardRule& rule, AlignedLine line);
  // Numbers that the end of a field cuts, or that a shift moved into the next field.
  bool check_seams(const CardRule& rule);
  void check_rest(const CardRule& rule, std::size_t last_field_end, bool slip_found);
  bool begins_with_number(std::string_view text) const;
  bool all_numbers(std::string_view text) const;
  void check_sequence_number(const CardRule& rule);
  // Is this line a card of another kind?  Then the counts are wrong; reading goes on where it can.
  enum class Misplaced { no, left_over, belongs_later };
  bool is_doubtful(const CardRule& rule) const;
  bool has_a_gap(const CardRule& rule) const;
  int closing_card(int line) const;
  std::string expected_card(const CardRule& rule) const;
  Misplaced check_place(const CardRule& rule, const Card& card);
  bool cut_list(const CardRule& rule, const Card& card);
  std::string announced(int rule);
  bool reads_well(const CardRule& rule, int line) const;
  bool name_matches(const CardRule& rule);

  // Expressions.
  ExpressionValue value_of(const ExpressionNode& node, double operand) const override;
  ExpressionValue value_of(int card, int field) const;
  ExpressionValue previous_value(const ExpressionNode& node) const;
  // The values of a list: those of the last field of a card.
  std::span<const FieldValue> list_of(int card, int field) const;
  ExpressionValue item_of(const ExpressionNode& node, double place) const;
  double sum_of(const ExpressionNode& node) const;
  double sum_of_first(const ExpressionNode& node, double count) const;
  SourcePosition where_of(const Expression& expression) const;
  double number_of(const Expression& expression);
  bool truth(const Expression& expression) { return number_of(expression) != 0.0; }
  bool count_of(const Expression& expression, const std::string& what, int& count);
  static std::string a_card(const std::string& name);  // "a node card", "an element card"
  std::string count_source(const Expression& expression) const;
  std::string unmet(const LayoutEntry& entry) const;
  // A value of the card being read.
  void mark_faulty(std::size_t value) { faulty_.emplace_back(deck_.cards.size(), value); }
  bool is_faulty(std::size_t card, std::size_t value) const;
  bool is_faulty(const ExpressionNode& node) const;
  bool is_faulty(const Expression& expression) const;
  const FieldValue* field_value(int card, int field) const;
  // The values of a card of this rule; of the last, where it is wanted, or of the one before.
  const std::vector<FieldValue>& fields_of(std::vector<CardFields>& kept, int rule, int card) const;
  bool is_own(int rule) const { return rule == own_rule_; }  // it is being read

  void truncated(const LayoutEntry& entry);
  void stop(const std::string& why, int line);  // a note below an error that was reported
  void fail_and_stop(const SourcePosition& where, const std::string& message);
  bool fits_the_file(int count, bool repeats) const;
  void check_after_end();
  std::string card_name(const LayoutEntry& entry) const;
  const CardRule& rule_of(int index) const { return layout_.cards[index]; }

  const SourceText& source_;
  const Layout& layout_;
  Deck deck_;
  RecordSource records_;
  ReadLog log_;
  bool whole_ = true;
  std::vector<AlignedLine>* aligned_ = nullptr;  // lines are moved into their columns and go here
  std::shared_ptr<std::deque<std::string>> texts_;
  std::vector<FieldValue> fields_;  // of the card being read
  std::vector<FieldFlaw> flaws_;    // of these
  std::vector<Seam> seams_;         // of the card being read
  std::vector<int> latest_;         // last card of each rule, -1 = none
  std::vector<int> previous_;       // the card of the rule before that, -1 = none
  mutable std::vector<CardFields> latest_fields_, previous_fields_;  // one a rule
  std::vector<std::pair<std::size_t, std::size_t>> faulty_;          // values with errors: card, place on it
  std::vector<const LayoutEntry*> entry_of_;                         // the entry that counts a rule's cards
  std::vector<char> plain_;     // rules whose fields need no map, list and comparison
  std::vector<char> computes_;  // rules with computed fields
  std::vector<char> opens_;     // rules that the cards made from them belong to
  std::vector<std::vector<const LayoutEntry*>> followers_;  // what is made behind every card of a rule
  std::vector<int> counts_;                                 // cards of each rule so far
  std::map<std::pair<int, int>, double> sums_;  // of the fields of rules that expressions sum, so far
  std::vector<std::vector<int>> summed_;        // which fields these are
  struct ListSum {                              // how far a list has been summed
    std::size_t card = 0;
    std::size_t count = 0;
    double sum = 0.0;
  };
  mutable std::map<std::pair<int, int>, ListSum> list_sums_;
  std::map<const char*, std::string_view> kept_texts_;  // texts of expressions, which outlive the layout
  std::size_t made_values_ = 0, made_limit_ = 0;        // values that stand in no record
  int list_index_ = 0;                                  // of the list that is computed
  std::vector<std::optional<PlainCard>> plain_cards_;
  std::optional<ListRead> list_read_;  // the last list-directed READ, for cards that go on in it
  RunState run_;
  int previous_rule_ = -1;  // last rule before the present run
  int own_rule_ = -1;       // of the card being read, for counts that name its own fields
  bool stopped_ = false;
  bool end_run_ = false;  // the present run ends early: the next card is of a later kind
  bool overlong_noted_ = false, sequence_noted_ = false;
};

}  // namespace sage
