// Which block looks like nodes, elements, materials, fixities, loads.
#include <algorithm>
#include <array>
#include <optional>

#include "sage/deck/text.hpp"
#include "sage/layout_draft/cards.hpp"

namespace sage::layout_draft {

namespace {

constexpr std::size_t kSample = 500;  // lines that are looked at, pair by pair

std::string heading_of(const Run& run, const Scan& scan) {
  const int line = !run.headings.empty() ? static_cast<int>(run.headings.back())
                   : run.comment >= 0    ? run.comment
                                         : run.title;
  return line < 0 ? "" : lower_case(scan.lines[line].record);
}

// One of the first two words of the heading begins so: those behind them are names of fields.
bool heading_says(const std::string& heading, std::initializer_list<std::string_view> beginnings) {
  const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  int words = 0;
  for (std::size_t at = 0; at < heading.size() && words < 2; ++at) {
    if (!is_letter(heading[at]) || (at > 0 && is_letter(heading[at - 1]))) continue;
    ++words;
    for (const std::string_view beginning : beginnings)
      if (heading.compare(at, beginning.size(), beginning) == 0) return true;
  }
  return false;
}

std::vector<std::size_t> reals_of(const Run& run) {
  std::vector<std::size_t> reals;
  for (std::size_t k = 0; k < run.clusters.size(); ++k)
    if (run.clusters[k].kind() == Kind::real) reals.push_back(k);
  return reals;
}

// The column of the cards' own numbers: the first with integers (a letter may stand before it).
std::optional<std::size_t> number_column(const Run& run) {
  for (std::size_t k = 0; k < std::min<std::size_t>(run.clusters.size(), 2); ++k) {
    if (run.clusters[k].kind() == Kind::integer) return k;
    if (run.clusters[k].kind() == Kind::real) break;
  }
  return std::nullopt;
}

bool varies(const Run& run, std::size_t k) {
  return run.columns[k].count > 0 && !run.columns[k].constant;
}

bool looks_like_nodes(const Run& run) {
  if (run.words || run.lines.size() < 2) return false;
  const auto number = number_column(run);
  const std::vector<std::size_t> reals = reals_of(run);
  if (!number || reals.size() < 2 || reals.front() < *number) return false;
  if (!run.columns[*number].ascending || run.columns[*number].low < 1.0) return false;
  // Integers between the number and the coordinates are increments and codes.
  for (std::size_t k = *number + 1; k < reals.front(); ++k)
    if (run.columns[k].high > std::max(16.0, 0.3 * run.columns[*number].high)) return false;
  return varies(run, reals[0]) || varies(run, reals[1]);
}

// Columns [begin, end) that hold numbers of nodes, different from each other on nearly every line.
struct Range {
  std::size_t begin = 0, end = 0;
  std::size_t size() const { return end - begin; }
};

bool could_be_node(const Run& run, std::size_t k, double highest) {
  const Cluster& cluster = run.clusters[k];
  const ColumnFacts& column = run.columns[k];
  if (cluster.kind() != Kind::integer || column.low < 0.0 || column.high > highest) return false;
  return run.lines.size() < 4 || column.high >= 0.5 * highest;
}

std::vector<std::vector<double>> sample_rows(const Run& run, const Scan& scan) {
  std::vector<std::vector<double>> rows;
  for (std::size_t n = 0; n < std::min(run.lines.size(), kSample); ++n) {
    std::vector<double> row(run.clusters.size(), 0.0);
    std::size_t from = 0;
    for (const Token& token : scan.lines[run.lines[n]].tokens)
      if (const int at = cluster_of(run.clusters, token, from); at >= 0 && is_number(token))
        row[at] = token.value;
    rows.push_back(std::move(row));
  }
  return rows;
}

bool mostly_distinct(const std::vector<std::vector<double>>& rows, std::size_t begin, std::size_t k) {
  if (k >= begin + 3) return true;  // triangles repeat a node
  std::size_t equal = 0;
  for (const auto& row : rows) {
    const auto first = row.begin() + static_cast<std::ptrdiff_t>(begin),
               last = row.begin() + static_cast<std::ptrdiff_t>(k);
    if (row[k] != 0.0 && std::find(first, last, row[k]) != last) ++equal;
  }
  return 10 * equal <= rows.size();
}

// Right behind the column before it: nodes stand side by side.
bool adjoins(const Run& run, std::size_t k, const Facts& facts) {
  return run.clusters[k].right_max - run.clusters[k - 1].right_max < 2 * facts.integer_width;
}

// The longest range of them from a column on.
Range node_columns(const Run& run, const Scan& scan, std::size_t from, double highest) {
  const auto rows = sample_rows(run, scan);
  Range best;
  for (std::size_t begin = from; begin < run.clusters.size(); ++begin) {
    std::size_t end = begin;
    while (end < run.clusters.size() && could_be_node(run, end, highest) && mostly_distinct(rows, begin, end) &&
           end - begin < 27 && (end == begin || adjoins(run, end, scan.facts)))
      ++end;
    if (end - begin > best.size()) best = {begin, end};
    if (end > begin + 27) break;
  }
  return best;
}

FieldDraft* field_of(CardDraft& card, std::size_t cluster) {
  for (FieldDraft& field : card.fields)
    if (field.cluster == static_cast<int>(cluster)) return &field;
  return nullptr;
}

void name_field(CardDraft& card, std::size_t cluster, const std::string& name) {
  FieldDraft* field = field_of(card, cluster);
  if (!field) return;
  field->name = name;
  field->known = true;
}

std::string range_text(const ColumnFacts& column) {
  return number_text(column.low) + " to " + number_text(column.high);
}

void name_nodes(const Run& run, CardDraft& card) {
  const std::size_t number = *number_column(run);
  const std::vector<std::size_t> reals = reals_of(run);
  name_field(card, number, "number");
  name_field(card, reals[0], "x");
  name_field(card, reals[1], "y");
  card.reasons.push_back("looks like nodes: ascending numbers, " + range_text(run.columns[number]) +
                         ", and two reals with spread, " + range_text(run.columns[reals[0]]) + " and " +
                         range_text(run.columns[reals[1]]));
}

// The second card of a pair: nodes alone, where the number stands on the first.
bool try_incidences(const Run& run, const Scan& scan, double highest, CardDraft& card) {
  if (highest < 3.0 || run.lines.size() < 4) return false;
  const Range range = node_columns(run, scan, 0, highest);
  if (range.begin != 0 || range.size() < 3 || range.size() != run.clusters.size()) return false;
  for (std::size_t k = 0; k < range.end; ++k) name_field(card, k, "n" + std::to_string(k + 1));
  card.reasons.push_back(
      "looks like the nodes of elements: integers that differ on a line, all among the node numbers up to " +
      number_text(highest));
  return true;
}

bool try_elements(const Run& run, const Scan& scan, double highest, const std::string& heading,
                  CardDraft& card) {
  const auto number = number_column(run);
  if (!number || highest < 3.0 || !run.columns[*number].ascending) return false;
  const bool headed = heading_says(heading, {"elem", "incid", "connec", "lnods"});
  if (run.lines.size() < 4 && !headed) return false;
  const Range range = node_columns(run, scan, *number + 1, highest);
  if (range.size() < 3) return false;
  name_field(card, *number, "number");
  for (std::size_t k = range.begin; k < range.end; ++k)
    name_field(card, k, "n" + std::to_string(k - range.begin + 1));
  card.reasons.push_back("looks like elements: ascending numbers and " + std::to_string(range.size()) +
                         " integers that differ on a line, all among the node numbers up to " +
                         number_text(highest) + (headed ? "; so says the heading" : ""));
  for (const std::size_t k : {range.end, range.begin - 1})
    if (k < run.clusters.size() && k > *number && run.clusters[k].kind() == Kind::integer &&
        run.columns[k].count == run.lines.size() && run.columns[k].low >= 1.0 && run.columns[k].high <= 50.0) {
      name_field(card, k, "material");
      card.reasons.push_back("material: small integers, " + range_text(run.columns[k]));
      break;
    }
  return true;
}

// Integers 0 and 1 behind all other integers; more than two: without those that are the same on every card.
std::vector<std::size_t> code_columns(const Run& run, std::size_t number) {
  std::vector<std::size_t> codes;
  for (std::size_t k = number + 1; k < run.clusters.size(); ++k) {
    if (run.clusters[k].kind() != Kind::integer) continue;
    if (run.columns[k].codes)
      codes.push_back(k);
    else
      codes.clear();
  }
  if (codes.size() <= 2) return codes;
  std::vector<std::size_t> varying = codes;
  std::erase_if(varying, [&](std::size_t k) { return !varies(run, k); });
  return varying.size() >= 2 ? varying : codes;
}

bool try_fixities(const Run& run, double highest, const std::string& heading, CardDraft& card) {
  const auto number = number_column(run);
  if (!number || run.columns[*number].low < 1.0 || run.columns[*number].high > highest) return false;
  const std::vector<std::size_t> codes = code_columns(run, *number);
  const bool headed = heading_says(heading, {"fix", "bound", "support", "restr", "constr"});
  const bool vary = std::any_of(codes.begin(), codes.end(), [&](std::size_t k) { return varies(run, k); });
  const bool bare = vary && run.lines.size() >= 2 && codes.size() >= 2 && codes.size() <= 4 &&
                    run.clusters.size() <= 8 && !run.columns[*number].constant;
  // 10, 01, 11: both codes in one number.
  const bool pair = run.lines.size() >= 2 && codes.size() == 1 && run.columns[codes[0]].high >= 10.0 &&
                    run.columns[codes[0]].low >= 1.0;
  if (codes.empty() || !(bare || headed || pair)) return false;
  name_field(card, *number, "first");
  if (pair) {
    name_field(card, codes[0], "code");
    card.reasons.push_back(
        "looks like fixities: a node's number and one of the codes 1, 10 and 11 for x and y");
    return true;
  }
  const std::size_t x = codes.size() >= 2 ? codes.size() - 2 : 0;
  name_field(card, codes[x], "x_code");
  if (codes.size() > x + 1) name_field(card, codes[x + 1], "y_code");
  card.reasons.push_back(std::string("looks like fixities: a node's number and codes 0 and 1") +
                         (headed ? "; so says the heading" : "") + " (is 1 fixed or free?)");
  return true;
}

bool try_materials(const Run& run, const std::string& heading, CardDraft& card) {
  const auto number = number_column(run);
  if (!number || run.columns[*number].low != 1.0 || run.columns[*number].high > 100.0) return false;
  bool stiff = false, ratio = false;
  for (const std::size_t k : reals_of(run)) {
    const ColumnFacts& column = run.columns[k];
    if (column.count == 0) continue;
    ratio = ratio || (column.low > 0.0 && column.high <= 0.5);
    stiff = stiff || column.high >= 500.0;
  }
  const bool headed = heading_says(heading, {"mat", "prop"});
  if (!headed && !(stiff && ratio)) return false;
  name_field(card, *number, "number");
  card.reasons.push_back(
      std::string("looks like materials: a small number") +
      (stiff && ratio ? ", a real of a modulus' size and one of a Poisson's ratio's (0 to 0.5)" : "") +
      (headed ? "; so says the heading" : ""));
  return true;
}

bool try_loads(const Run& run, double highest, const std::string& heading, CardDraft& card) {
  const auto number = number_column(run);
  const std::vector<std::size_t> reals = reals_of(run);
  if (!number || reals.size() < 2 || reals.size() > 3) return false;
  if (run.columns[*number].low < 1.0 || run.columns[*number].high > highest) return false;
  const bool headed = heading_says(heading, {"load", "force"});
  if (!headed && run.clusters.size() > *number + 2 + reals.size()) return false;
  if (!varies(run, reals[0]) && !varies(run, reals[1]) && !headed && run.lines.size() > 1) return false;
  name_field(card, *number, "first");
  name_field(card, reals[0], "x_force");
  name_field(card, reals[1], "y_force");
  card.reasons.push_back(std::string("looks like loads: a node's number and two reals") +
                         (headed ? "; so says the heading" : ""));
  return true;
}

}  // namespace

const char* role_name(Role role) {
  switch (role) {
    case Role::node:
      return "node";
    case Role::element:
      return "element";
    case Role::material:
      return "material";
    case Role::fixity:
      return "fixity";
    case Role::load:
      return "load";
    case Role::none:
      break;
  }
  return nullptr;
}

NodeFacts find_nodes(const std::vector<Run>& runs, const Scan& scan) {
  NodeFacts best;
  std::size_t best_score = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (!looks_like_nodes(runs[i])) continue;
    const bool headed = heading_says(heading_of(runs[i], scan), {"node", "coor", "joint"});
    const std::size_t score = runs[i].lines.size() * (headed ? 100 : 1);
    if (score <= best_score) continue;
    best_score = score;
    best = {static_cast<int>(i), runs[i].columns[*number_column(runs[i])].high};
  }
  return best;
}

Role find_role(const std::vector<Run>& runs, std::size_t index, const NodeFacts& nodes, const Scan& scan,
               CardDraft& card) {
  const Run& run = runs[index];
  if (run.words || run.clusters.empty()) return Role::none;
  if (static_cast<int>(index) == nodes.run) {
    name_nodes(run, card);
    return Role::node;
  }
  const std::string heading = heading_of(run, scan);
  const bool second = nodes.run < 0 && index > 0;  // of a block
  if (second && try_incidences(run, scan, nodes.highest, card)) return Role::element;
  if (try_elements(run, scan, nodes.highest, heading, card)) return Role::element;
  if (try_fixities(run, nodes.highest, heading, card)) return Role::fixity;
  if (try_materials(run, heading, card)) return Role::material;
  const bool inner = nodes.run < 0;  // of a block, where pairs of cards are more often materials or elements
  if (!inner && try_loads(run, nodes.highest, heading, card)) return Role::load;
  return Role::none;
}

}  // namespace sage::layout_draft
