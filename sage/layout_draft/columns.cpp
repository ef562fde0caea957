// From columns of numbers to a FORMAT.
#include <algorithm>
#include <cstdlib>
#include <limits>

#include "sage/deck/text.hpp"
#include "sage/layout_draft/cards.hpp"

namespace sage::layout_draft {

namespace {

constexpr int kNoLimit = std::numeric_limits<int>::max();

struct Place {
  int first = 0, last = 0;  // last 0: to the end of the record
};

int field_width(const Cluster& cluster, const Facts& facts) {
  return cluster.kind() == Kind::integer ? facts.integer_width : facts.real_width;
}

// Last column of a real's field: where all end, else a usual width or a multiple of five before the next field.
int real_end(const Cluster& cluster, int before, int limit, int width) {
  if (cluster.right_min == cluster.right_max) return cluster.right_max;
  const int usual = before + width, round = (cluster.right_max + 4) / 5 * 5;
  if (usual >= cluster.right_max && usual <= limit) return usual;
  return round <= limit ? round : cluster.right_max;
}

Place place_of(const Run& run, std::size_t k, int before, const Facts& facts) {
  const Cluster& cluster = run.clusters[k];
  const Cluster* next = k + 1 < run.clusters.size() ? &run.clusters[k + 1] : nullptr;
  const int limit = next ? next->first - 1 : kNoLimit;
  const int width = field_width(cluster, facts);
  Place place{before + 1, 0};
  switch (cluster.kind()) {
    case Kind::text: {
      if (!next) return place;
      const bool number = next->kind() != Kind::text && next->right_min == next->right_max;
      const int begins = number ? next->right_max - field_width(*next, facts) : limit;
      place.last = std::min(limit, std::max(cluster.last, begins));
      return place;
    }
    case Kind::integer:
      place.last = cluster.right_min == cluster.right_max ? cluster.right_max
                   : next                                 ? limit
                                                          : cluster.right_max;
      break;
    case Kind::real:
      place.last = real_end(cluster, before, limit, width);
      break;
  }
  const bool narrow = cluster.widest <= width && cluster.first > place.last - width;
  if (place.last - before > width && narrow) place.first = place.last - width + 1;
  return place;
}

std::string edit_of(Kind kind, const Place& place) {
  if (place.last == 0) return "A";
  const std::string width = std::to_string(place.last - place.first + 1);
  return kind == Kind::integer ? "I" + width : kind == Kind::real ? "F" + width + ".0" : "A" + width;
}

// "2I5,10X,3F10.0" from edits one by one.
class FormatText {
 public:
  void add(const std::string& edit) {
    if (edit == edit_) {
      ++count_;
      return;
    }
    flush();
    edit_ = edit;
    count_ = 1;
  }
  void skip(int columns) {
    flush();
    append(std::to_string(columns) + "X");
  }
  std::string finish() {
    flush();
    return "(" + text_ + ")";
  }

 private:
  void flush() {
    if (count_ > 0) append((count_ > 1 ? std::to_string(count_) : "") + edit_);
    count_ = 0;
    edit_.clear();
  }
  void append(const std::string& part) { text_ += (text_.empty() ? "" : ",") + part; }
  std::string text_, edit_;
  int count_ = 0;
};

std::string columns_text(int first, int last) {
  return first == last ? "column " + std::to_string(first)
                       : "columns " + std::to_string(first) + "-" + std::to_string(last);
}

void infer_format(const Run& run, const Facts& facts, CardDraft& card) {
  FormatText format;
  std::string gaps;
  int before = 0;
  for (std::size_t k = 0; k < run.clusters.size(); ++k) {
    const Place place = place_of(run, k, before, facts);
    if (place.first > before + 1) {
      format.skip(place.first - before - 1);
      gaps += (gaps.empty() ? "" : ", ") + columns_text(before + 1, place.first - 1);
    }
    const Kind kind = run.clusters[k].kind();
    format.add(edit_of(kind, place));
    card.fields.push_back({"field" + std::to_string(k + 1), "", kind, place.first, place.last, 0,
                           static_cast<int>(k), false, ""});
    before = place.last;
  }
  card.format = format.finish();
  card.reasons.push_back("FORMAT from the columns where the numbers of " + std::to_string(run.lines.size()) +
                         (run.lines.size() == 1 ? " line end" : " lines end"));
  if (!gaps.empty()) card.reasons.push_back("always blank here, perhaps fields: " + gaps);
  const bool implied = std::any_of(run.clusters.begin(), run.clusters.end(),
                                   [](const Cluster& c) { return c.kind() == Kind::real && c.integers > 0; });
  if (implied)
    card.reasons.push_back(
        "some reals have no point: if the program's FORMAT has decimals (F10.2), write them here");
}

// Fields of a FORMAT that the deck prints.  False where it goes over several records.
bool use_printed(const Run& run, CardDraft& card) {
  const Format format = compile_format(run.format);
  FormatWalker walker(format);
  int column = 1;
  for (int steps = 0; steps < 500; ++steps) {
    const FormatStep& step = walker.next();
    if (step.edit == Edit::end) break;
    if (step.edit == Edit::next_record) return false;
    if (step.edit == Edit::tab_to) column = std::max(1, step.width);
    if (step.edit == Edit::tab_by) column += step.width;
    if (!is_data(step.edit)) continue;
    const Kind kind = step.edit == Edit::integer ? Kind::integer
                      : step.edit == Edit::real  ? Kind::real
                                                 : Kind::text;
    if (step.edit == Edit::general || step.edit == Edit::logical) return false;
    FieldDraft field;
    field.name = "field" + std::to_string(card.fields.size() + 1);
    field.kind = kind;
    field.first = column;
    field.last = step.width > 0 ? column + step.width - 1 : 0;
    for (std::size_t k = 0; k < run.clusters.size(); ++k)
      if (run.clusters[k].last >= column && (field.last == 0 || run.clusters[k].last <= field.last))
        field.cluster = static_cast<int>(k);
    card.fields.push_back(field);
    column += step.width;
  }
  card.format = run.format;
  card.reasons.push_back("FORMAT as the deck prints it above this block");
  return !card.fields.empty();
}

// The field whose columns end where the word does, give or take one; else the one below its middle; -1 = none.
int field_below(const CardDraft& card, int first, int last, bool& aligned) {
  int below = -1;
  for (std::size_t f = 0; f < card.fields.size(); ++f) {
    const FieldDraft& field = card.fields[f];
    aligned = field.last > 0 && std::abs(field.last - last) <= 1;
    if (aligned) return static_cast<int>(f);
    const int middle = (first + last) / 2;
    if (field.first <= middle && (middle <= field.last || field.last == 0)) below = static_cast<int>(f);
  }
  return below;
}

// A heading's words become the labels of the fields below them, if most of them end where fields end; prose
// does not.
void take_labels(std::string_view heading, CardDraft& card) {
  std::vector<std::string> labels(card.fields.size());
  std::size_t words = 0, ends = 0;
  for (std::size_t at = 0; at < heading.size();) {
    if (heading[at] == ' ' || heading[at] == '\t' || heading[at] == '*') {
      ++at;
      continue;
    }
    const std::size_t end = std::min(heading.find_first_of(" \t", at), heading.size());
    bool aligned = false;
    const int f = field_below(card, static_cast<int>(at) + 1, static_cast<int>(end), aligned);
    ++words;
    if (aligned) ++ends;
    if (f >= 0) {
      std::string& label = labels[f];
      label += (label.empty() ? "" : " ") + std::string(heading.substr(at, end - at));
    }
    at = end;
    if (words > 2 * card.fields.size() + 8) return;
  }
  if (2 * ends < words || 2 * ends < card.fields.size()) return;
  for (std::size_t f = 0; f < labels.size(); ++f) card.fields[f].label = labels[f];
}

}  // namespace

void find_format(const Run& run, const Scan& scan, CardDraft& card) {
  bool printed = false;
  if (!run.format.empty()) {
    printed = use_printed(run, card);
    if (!printed) card.fields.clear();
  }
  if (!printed && (run.words || run.clusters.empty())) {
    card.format = "(A)";
    card.fields = {{"text", "", Kind::text, 1, 0, 0, -1, true, ""}};
    return;
  }
  if (!printed) infer_format(run, scan.facts, card);
  const bool named = !scan.facts.separator.empty();
  const int heading = !run.headings.empty() ? static_cast<int>(run.headings.back()) : run.comment;
  if (!named && heading >= 0) take_labels(scan.lines[heading].record, card);
}

CardDraft text_card(const std::string& name, std::size_t lines) {
  CardDraft card;
  card.name = name;
  card.format = "(A)";
  card.fields = {{"text", "", Kind::text, 1, 0, 0, -1, true, ""}};
  if (lines != 1) card.repeat = std::to_string(lines);
  return card;
}

std::string CardNames::unique(const std::string& name) {
  const int count = ++used_[name];
  return count == 1 ? name : name + std::to_string(count);
}

}  // namespace sage::layout_draft
