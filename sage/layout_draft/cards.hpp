// Cards of a guessed layout, before they are written as TOML.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "sage/layout_draft/runs.hpp"
#include "sage/layout_draft/scan.hpp"

namespace sage::layout_draft {

constexpr std::size_t kMostCards = 2000;  // that a guess makes; what follows is one text

struct FieldDraft {
  std::string name;
  std::string label;  // a heading's word
  Kind kind = Kind::integer;
  int first = 0, last = 0;  // columns; 0 = list-directed, or to the end of the record
  int record = 0;           // from 1, of a card of several; 0 = it has one
  int cluster = -1;         // of the run
  bool known = false;       // the name says what it seems to be
  std::string count;        // the field repeats so often: an expression
};

struct CardDraft {
  std::string name, label;
  std::string as;      // what it seems to be, where the name is the deck's own
  std::string format;  // "*" = list-directed
  std::vector<FieldDraft> fields;
  std::vector<CardDraft> items;  // one at most: what the rest of a list-directed READ holds
  std::string items_count;
  std::vector<CardDraft> inner;  // of a block
  std::string repeat;            // a number, an expression, or named
  std::string until;             // the last card
  std::string until_dropped;     // the card behind the last
  int headings = 0;
  std::vector<std::string> reasons;
  int first_line = 0, last_line = 0;  // of the deck, with headings and what ends the block
};

// The layout's cards for a deck.
std::vector<CardDraft> column_cards(Scan& scan);
std::vector<CardDraft> named_cards(const Scan& scan);
std::vector<CardDraft> listed_cards(const Scan& scan);

// FORMAT and fields of a run; reasons go to the card.
void find_format(const Run& run, const Scan& scan, CardDraft& card);

// What the run's numbers look like: gives the card and its fields names.
enum class Role { none, node, element, material, fixity, load };
const char* role_name(Role role);  // "node"; nullptr for none
struct NodeFacts {
  int run = -1;  // that holds the nodes; -1 = none does
  double highest = 0.0;
};
NodeFacts find_nodes(const std::vector<Run>& runs, const Scan& scan);
Role find_role(const std::vector<Run>& runs, std::size_t index, const NodeFacts& nodes, const Scan& scan,
               CardDraft& card);

// A text card for so many lines.
CardDraft text_card(const std::string& name, std::size_t lines);

// Names that no other card bears: "text", "text2".
class CardNames {
 public:
  std::string unique(const std::string& name);

 private:
  std::map<std::string, int> used_;
};

}  // namespace sage::layout_draft
