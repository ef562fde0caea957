#include "sage/layout_draft/runs.hpp"

#include <algorithm>
#include <cmath>

#include "sage/deck/text.hpp"

namespace sage::layout_draft {

namespace {

constexpr std::size_t kMostClusters = 400;  // of a card: more are no columns

bool overlaps(const Cluster& cluster, const Token& token) {
  return token.first <= cluster.last && token.last >= cluster.first;
}

// Can this number or word stand in that field?
bool suits(const Cluster& cluster, const Token& token) {
  const bool right = token.last >= cluster.right_min && token.last <= cluster.right_max;
  const bool edges = (cluster.right_min == cluster.right_max && token.last == cluster.right_max) ||
                     (cluster.left_min == cluster.left_max && token.first == cluster.left_min);
  switch (token.kind) {
    case Kind::text:
      return cluster.texts > 0;
    case Kind::integer:
      return cluster.texts > 0 ? token.first > 1 : cluster.reals > 0 ? right : edges;
    case Kind::real:
      return cluster.texts > 0 ? token.first > 1 : cluster.reals > 0 || (edges && cluster.first > 5);
  }
  return false;
}

void widen(Cluster& cluster, const Token& token) {
  const bool fresh = cluster.count() == 0;
  cluster.first = fresh ? token.first : std::min(cluster.first, token.first);
  cluster.last = fresh ? token.last : std::max(cluster.last, token.last);
  cluster.left_min = cluster.first;
  cluster.left_max = fresh ? token.first : std::max(cluster.left_max, token.first);
  cluster.right_min = fresh ? token.last : std::min(cluster.right_min, token.last);
  cluster.right_max = cluster.last;
  cluster.widest = std::max(cluster.widest, token.last - token.first + 1);
  ++(token.kind == Kind::integer ? cluster.integers : token.kind == Kind::real ? cluster.reals : cluster.texts);
}

// Every number stands in a field of its own, most of them in fields that other lines fill.
bool fits(const Run& run, const Line& line) {
  std::size_t from = 0, shared = 0;
  int last = -1;
  for (const Token& token : line.tokens) {
    const int at = cluster_of(run.clusters, token, from);
    if (at < 0) continue;
    const auto next = static_cast<std::size_t>(at) + 1;
    if (at == last || !suits(run.clusters[next - 1], token)) return false;
    if (next < run.clusters.size() && overlaps(run.clusters[next], token)) return false;
    last = at;
    ++shared;
  }
  const bool from_the_left =
      !line.tokens.empty() && !run.clusters.empty() && overlaps(run.clusters.front(), line.tokens.front());
  return 2 * shared >= line.tokens.size() && (from_the_left || 2 * shared >= run.clusters.size());
}

double first_integer(const Line& line) {
  for (const Token& token : line.tokens)
    if (is_number(token)) return token.kind == Kind::integer ? token.value : NAN;
  return NAN;
}

bool same_pattern(const Line& a, const Line& b) {
  return a.tokens.size() == b.tokens.size() &&
         std::equal(a.tokens.begin(), a.tokens.end(), b.tokens.begin(),
                    [](const Token& s, const Token& t) { return s.kind == t.kind; });
}

class RunBuilder {
 public:
  explicit RunBuilder(Scan& scan) : scan_(scan) { count_formats(); }

  std::vector<Run> build() {
    for (std::size_t i = 0; i < scan_.lines.size(); ++i) take(i);
    close();
    for (Run& run : runs_) find_column_facts(run, scan_);
    return std::move(runs_);
  }

 private:
  // One text with "(A)" in it is prose; decks that print their FORMATs print several.
  void count_formats() {
    int formats = 0, with_numbers = 0;
    for (const Line& line : scan_.lines) {
      if (line.sort != Sort::words && line.sort != Sort::comment) continue;
      const std::string format = printed_format(line.record);
      if (format.empty()) continue;
      ++formats;
      if (format.find_first_of("IFEGifeg") != std::string::npos) ++with_numbers;
    }
    prints_formats_ = formats >= 3 && with_numbers >= 2;
  }

  // Full fields side by side: the run before tells where they end.
  void split(Line& line) const {
    const Run& run = runs_.back();
    const auto bridges = [&](const Token& token) {
      const auto over = [&](const Cluster& cluster) { return overlaps(cluster, token); };
      return token.kind == Kind::text || std::count_if(run.clusters.begin(), run.clusters.end(), over) > 1;
    };
    if (run.words || run.clusters.size() > 40 || std::none_of(line.tokens.begin(), line.tokens.end(), bridges))
      return;
    std::vector<Columns> fields;
    for (const Cluster& cluster : run.clusters) fields.push_back({cluster.first, cluster.right_max});
    Line apart = line;
    split_packed(apart, fields);
    if (same_pattern(apart, scan_.lines[run.lines.back()]) && fits(run, apart)) line = std::move(apart);
  }

  void take(std::size_t i) {
    Line& line = scan_.lines[i];
    if ((line.sort == Sort::words || line.sort == Sort::numbers) && open()) split(line);
    switch (line.sort) {
      case Sort::comment:
        soft_ = true;
        comment_ = static_cast<int>(i);
        if (const std::string format = prints_formats_ ? printed_format(line.record) : ""; !format.empty())
          begin_block(format);
        return;
      case Sort::blank:
        if (open() && runs_.back().blanks_behind == 0 && headings_.empty()) {
          ++runs_.back().blanks_behind;
          close();
        } else {
          headings_.push_back(i);
        }
        return;
      case Sort::words:
        return take_words(i);
      case Sort::numbers:
        return take_numbers(i);
    }
  }

  void begin_block(const std::string& format) {
    close();
    format_ = format;
  }

  void take_words(std::size_t i) {
    if (prints_formats_)
      if (const std::string format = printed_format(scan_.lines[i].record); !format.empty()) {
        begin_block(format);
        headings_.push_back(i);
        return;
      }
    if (!open() || !runs_.back().words || soft_) begin_run(i, true);
    add(i);
  }

  void take_numbers(std::size_t i) {
    if (!format_.empty() || !open() || !belongs(runs_.back(), i)) {
      // Where a block has a FORMAT, its lines of words are cards too.
      if (!(open() && !runs_.back().format.empty() && runs_.back().words)) begin_run(i, false);
    }
    add(i);
  }

  bool belongs(const Run& run, std::size_t i) const {
    if (run.words) return !run.format.empty();
    const Line &line = scan_.lines[i], &last = scan_.lines[run.lines.back()];
    if (!fits(run, line)) return false;
    const double first = first_integer(line), before = first_integer(last);
    const bool pattern = same_pattern(line, last);
    if (!pattern && (alternates(run, i) || begins_reals(run, line, last))) return false;
    if (std::isnan(first) || std::isnan(before)) return true;
    if (soft_ && !(first > before)) return false;
    if (first > before) return pattern || run.lines.size() > 1 || soft_ || shares_most(line, last);
    if (!pattern) return false;
    return !restarts(run, i, first, before);
  }

  // Two kinds of cards take turns, here and on the next lines or on those before.
  bool alternates(const Run& run, std::size_t i) const {
    const Line &line = scan_.lines[i], &last = scan_.lines[run.lines.back()];
    if (i + 3 < scan_.lines.size() && same_pattern(scan_.lines[i + 1], last) &&
        same_pattern(scan_.lines[i + 2], line) && same_pattern(scan_.lines[i + 3], last))
      return true;
    if (run.lines.size() > 1 || runs_.size() < 2) return false;
    const Run& before = runs_[runs_.size() - 2];
    return before.lines.size() == 1 && same_pattern(scan_.lines[before.lines[0]], line);
  }

  // A single card of integers, then one with reals.
  static bool begins_reals(const Run& run, const Line& line, const Line& last) {
    const auto is_real = [](const Token& t) { return t.kind == Kind::real; };
    return run.lines.size() == 1 && std::any_of(line.tokens.begin(), line.tokens.end(), is_real) &&
           std::none_of(last.tokens.begin(), last.tokens.end(), is_real);
  }

  static bool shares_most(const Line& a, const Line& b) {
    const std::size_t small = std::min(a.tokens.size(), b.tokens.size()),
                      large = std::max(a.tokens.size(), b.tokens.size());
    return 3 * small >= 2 * large;
  }

  // A list that counts from 1 begins anew behind one that ascended.
  bool restarts(const Run& run, std::size_t i, double first, double before) const {
    if (first != 1.0 || before <= 1.0 || run.lines.size() < 2) return false;
    const double second = first_integer(scan_.lines[run.lines[run.lines.size() - 2]]);
    return before > second && i + 1 < scan_.lines.size() && first_integer(scan_.lines[i + 1]) > first;
  }

  bool open() const { return !runs_.empty() && runs_.back().open; }
  void close() {
    if (open()) runs_.back().open = false;
  }

  void begin_run(std::size_t i, bool words) {
    close();
    Run run;
    run.words = words;
    run.open = true;
    run.comment = comment_ >= 0 && comment_ + 1 == static_cast<int>(i) ? comment_ : -1;
    run.format = std::move(format_);
    run.headings = std::move(headings_);
    headings_.clear();
    format_.clear();
    runs_.push_back(std::move(run));
  }

  void add(std::size_t i) {
    add_line(runs_.back(), scan_, i);
    soft_ = false;
    comment_ = -1;
  }

  Scan& scan_;
  std::vector<Run> runs_;
  std::vector<std::size_t> headings_;
  std::string format_;
  int comment_ = -1;
  bool soft_ = false;  // a comment stands before this line
  bool prints_formats_ = false;
};

// The words of a heading stand over the columns, or end where they do.
bool heads(const Line& words, const Run& run) {
  std::size_t from = 0, over = 0, count = 0;
  const std::string_view text = words.record;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == ' ' || text[at] == '\t') {
      ++at;
      continue;
    }
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const Token word{static_cast<int>(at) + 1, static_cast<int>(end), Kind::text, false, 0.0};
    ++count;
    if (cluster_of(run.clusters, word, from) >= 0) ++over;
    at = end;
  }
  return count >= 2 && 10 * over >= 7 * count && 10 * over >= 7 * run.clusters.size();
}

// Where a FORMAT is printed the builder knows the headings; elsewhere they show by their columns.
void find_headings(std::vector<Run>& runs, const Scan& scan) {
  for (std::size_t i = 1; i < runs.size(); ++i) {
    Run &words = runs[i - 1], &run = runs[i];
    const bool candidate = words.words && !run.words && words.format.empty() && words.blanks_behind == 0 &&
                           run.headings.empty() && run.comment < 0 && !words.lines.empty();
    if (!candidate || (i == 1 && words.lines.size() == 1)) continue;
    if (!heads(scan.lines[words.lines.back()], run)) continue;
    run.headings.push_back(words.lines.back());
    words.lines.pop_back();
    if (words.lines.empty())
      run.headings.insert(run.headings.begin(), words.headings.begin(), words.headings.end());
  }
  for (std::size_t i = 1; i < runs.size(); ++i)
    if (runs[i - 1].words && runs[i - 1].blanks_behind == 0 && !runs[i - 1].lines.empty() &&
        runs[i].headings.empty())
      runs[i].title = static_cast<int>(runs[i - 1].lines.back());
  std::erase_if(runs, [](const Run& run) { return run.lines.empty(); });
}

}  // namespace

int cluster_of(const std::vector<Cluster>& clusters, const Token& token, std::size_t& from) {
  while (from < clusters.size() && clusters[from].last < token.first) ++from;
  if (from == clusters.size() || !overlaps(clusters[from], token)) return -1;
  return static_cast<int>(from);
}

void add_line(Run& run, const Scan& scan, std::size_t line) {
  run.lines.push_back(line);
  if (run.words) return;
  std::size_t from = 0;
  for (const Token& token : scan.lines[line].tokens) {
    const int at = cluster_of(run.clusters, token, from);
    if (at < 0 && run.clusters.size() >= kMostClusters) return;
    if (at < 0) run.clusters.insert(run.clusters.begin() + static_cast<std::ptrdiff_t>(from), Cluster{});
    widen(run.clusters[at < 0 ? from : static_cast<std::size_t>(at)], token);
  }
}

void find_column_facts(Run& run, const Scan& scan) {
  run.columns.assign(run.clusters.size(), {});
  for (const std::size_t i : run.lines) {
    std::size_t from = 0;
    for (const Token& token : scan.lines[i].tokens) {
      const int at = cluster_of(run.clusters, token, from);
      if (at < 0 || !is_number(token)) continue;
      ColumnFacts& column = run.columns[at];
      const double v = token.value;
      if (column.count > 0) {
        column.ascending = column.ascending && v > column.last;
        column.constant = column.constant && v == column.low;
      }
      column.low = column.count == 0 ? v : std::min(column.low, v);
      column.high = column.count == 0 ? v : std::max(column.high, v);
      column.last = v;
      column.integers = column.integers && token.kind == Kind::integer;
      column.codes = column.codes && token.kind == Kind::integer &&
                     (v == 0.0 || v == 1.0 || v == 10.0 || v == 11.0 || v == -1.0);
      ++column.count;
    }
  }
}

bool alike(const Run& a, const Run& b) {
  if (a.words != b.words || a.format != b.format) return false;
  if (a.words) return a.lines.size() == b.lines.size();
  if (a.clusters.empty() || b.clusters.empty()) return false;
  std::size_t from = 0, shared = 0;
  for (const Cluster& cluster : b.clusters) {
    const Token extent{cluster.first, cluster.last, cluster.kind(), false, 0.0};
    const int at = cluster_of(a.clusters, extent, from);
    if (at < 0) continue;
    const Cluster& other = a.clusters[at];
    if (other.kind() != cluster.kind()) return false;
    const bool integers = cluster.kind() == Kind::integer;
    if (integers && other.right_max != cluster.right_max && other.left_min != cluster.left_min) return false;
    ++shared;
  }
  const bool first = a.clusters[0].kind() == b.clusters[0].kind() &&
                     a.clusters[0].first <= b.clusters[0].last && b.clusters[0].first <= a.clusters[0].last;
  return first && 2 * shared >= std::min(a.clusters.size(), b.clusters.size());
}

std::string printed_format(std::string_view text) {
  for (std::size_t open = text.find('('); open != std::string_view::npos; open = text.find('(', open + 1)) {
    int depth = 0;
    std::size_t close = open;
    const std::size_t limit = std::min(text.size(), open + 61);
    for (; close < limit; ++close) {
      depth += text[close] == '(' ? 1 : text[close] == ')' ? -1 : 0;
      if (depth == 0) break;
    }
    if (close == limit) continue;
    const std::string inside(text.substr(open, close + 1 - open));
    try {
      const Format format = compile_format(inside);
      if (std::any_of(format.steps.begin(), format.steps.end(), [](auto& s) { return is_data(s.edit); }))
        return inside;
    } catch (const FormatError&) {
    }
  }
  return {};
}

std::vector<Run> find_runs(Scan& scan) {
  std::vector<Run> runs = RunBuilder(scan).build();
  find_headings(runs, scan);
  return runs;
}

std::vector<Run> named_runs(const Scan& scan) {
  std::vector<Run> runs;
  std::string_view name = "\n";
  for (std::size_t i = 0; i < scan.lines.size(); ++i) {
    const Line& line = scan.lines[i];
    if (runs.empty() || line.name != name) runs.emplace_back();
    name = line.name;
    runs.back().lines.push_back(i);
  }
  return runs;
}

}  // namespace sage::layout_draft
