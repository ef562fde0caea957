// Foreign decks: cards with another program's meaning become the cards that the builder knows (those of sage1).
// Every value keeps its place in the file, so that later messages still show the foreign card.
#pragma once

#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sage/core/catalogue.hpp"
#include "sage/deck/deck.hpp"

namespace sage {

// Nothing if the deck's cards are canonical already.  Throws InputError for decks that can't become a model.
std::optional<Deck> translated_deck(const Deck& deck, const Catalogue& catalogue);

namespace translate {

// One field of a new card.  A name that stands again continues the list that it began.
struct NewField {
  std::string name;
  double number = 0.0;
  SourcePosition where = {};  // where the number comes from; line 0: where the card comes from
  std::string text = {};      // text fields only
};

class CardWriter {
 public:
  explicit CardWriter(const Deck& from);

  // Returns the card's index, for `owner` of later cards.
  int add(const std::string& name, const SourcePosition& where, const std::vector<NewField>& fields,
          int owner = -1);
  // A message that shows the foreign card.
  void warning(Code code, const SourcePosition& where, const std::string& message);
  void note(Code code, const SourcePosition& where, const std::string& message);
  // Something that the deck asks for and the model won't have.  `needs_partial`: the answer is another one
  // without it, so that it takes BuildOptions::partial; otherwise the message is a note.
  void left_out(const SourcePosition& where, const std::string& what, const std::string& message,
                bool needs_partial = true);
  void add_arc(DeckArc arc) { deck_.arcs.push_back(std::move(arc)); }
  // The same card again, for those that mean the same in both decks.
  void copy(std::string_view name);
  Deck take();

 private:
  int spec_of(const std::string& name, const std::vector<NewField>& fields);
  std::string_view keep(const std::string& text);

  const Deck* from_;
  Deck deck_;
  std::shared_ptr<std::deque<std::string>> texts_;
  std::map<std::string, int> specs_;
};

// The field of a card, to be put into a new one.
NewField take(const CardView& card, std::string_view field, std::string_view as = {}, double factor = 1.0);
// Code of the solid of this shape with so many nodes; throws std::logic_error where there is none.
int solid_code(const Catalogue& catalogue, ParentShape shape, int nodes);
inline int corner_element(const Catalogue& catalogue, bool triangle) {
  return triangle ? solid_code(catalogue, ParentShape::triangle, 3)
                  : solid_code(catalogue, ParentShape::square, 4);
}
// Catalogue code by name; throws std::logic_error for one that does not exist.
int law_code(const Catalogue& catalogue, std::string_view name);

Deck rectangle_deck(const Deck& deck, const Catalogue& catalogue);   // meshes numbered by rule
Deck slope_deck(const Deck& deck, const Catalogue& catalogue);       // a slope numbered by rule
Deck listed_deck(const Deck& deck, const Catalogue& catalogue);      // meshes listed by order
Deck embankment_deck(const Deck& deck, const Catalogue& catalogue);  // built in lifts
Deck quad4m_deck(const Deck& deck, const Catalogue& catalogue);
Deck cande_deck(const Deck& deck, const Catalogue& catalogue);

}  // namespace translate
}  // namespace sage
