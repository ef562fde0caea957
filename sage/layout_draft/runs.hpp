// Runs of lines that one card of a layout can read: numbers under each other, or texts.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sage/deck/format.hpp"
#include "sage/layout_draft/scan.hpp"

namespace sage::layout_draft {

// Columns in which numbers or words of a run's lines stand under each other.
struct Cluster {
  int first = 0, last = 0;           // all of them
  int left_min = 0, left_max = 0;    // of their left edges
  int right_min = 0, right_max = 0;  // of their right edges
  std::size_t integers = 0, reals = 0, texts = 0;
  int widest = 0;  // characters of the longest

  std::size_t count() const { return integers + reals + texts; }
  Kind kind() const { return texts > 0 ? Kind::text : reals > 0 ? Kind::real : Kind::integer; }
};

// What the values of a column are like.
struct ColumnFacts {
  std::size_t count = 0;
  double low = 0.0, high = 0.0;
  bool integers = true;
  bool ascending = true;  // strictly, from line to line
  bool codes = true;      // 0, 1, 10, 11, -1 only
  bool constant = true;
  double last = 0.0;
};

struct Run {
  bool words = false;
  std::vector<std::size_t> lines;     // of Scan::lines
  std::vector<Cluster> clusters;      // from left to right; none for words
  std::vector<ColumnFacts> columns;   // one a cluster
  int comment = -1;                   // line of Scan::lines that stands as a comment above the first; -1 = none
  int title = -1;                     // line of words right above, which is a card of its own; -1 = none
  std::vector<std::size_t> headings;  // lines above the first that are passed over: words, blanks
  std::size_t blanks_behind = 0;
  std::string format;       // printed in the deck; empty = to be found
  std::size_t records = 1;  // lines that one card takes
  bool open = false;        // a builder's own: nothing ended it yet
};

// The runs of a deck whose numbers stand in columns.  Takes packed numbers of the scan apart.
std::vector<Run> find_runs(Scan& scan);

// The runs of a deck whose cards bear names: one for every stretch of cards with one name.
std::vector<Run> named_runs(const Scan& scan);

// Adds a line's numbers and words to the clusters.
void add_line(Run& run, const Scan& scan, std::size_t line);
void find_column_facts(Run& run, const Scan& scan);

// Could one card read both?
bool alike(const Run& a, const Run& b);

// Index of the cluster that holds the token; -1 = none.  `from` goes up with the tokens of a line.
int cluster_of(const std::vector<Cluster>& clusters, const Token& token, std::size_t& from);

// A FORMAT in parentheses that stands in a text; empty if there is none that reads values.
std::string printed_format(std::string_view text);

}  // namespace sage::layout_draft
