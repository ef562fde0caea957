#include "tests/studies/stress/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "sage/draw/plot.hpp"
#include "sage/page/page.hpp"
#include "sage/record/number.hpp"

namespace sage::stress {

namespace {

constexpr std::size_t kWidth = 100;  // of messages in tables

std::string shortened(const std::string& text, std::size_t width = kWidth) {
  return text.size() <= width ? text : text.substr(0, width - 3) + "...";
}

std::string digits(double lost) {
  return std::isnan(lost) ? "-" : fmt::format("{:.1f}", lost);
}

std::string small(double value) {
  return std::isnan(value) ? "-" : fmt::format("{:.1e}", value);
}

// A bar would end the cell of a table.
std::string cell(const std::string& text) {
  std::string out;
  for (char c : shortened(text, 160)) out += c == '|' ? "/" : std::string(1, c);
  return out;
}

std::string verdict(bool ok) {
  return ok ? "ok" : "**FAIL**";
}

void add_row(Page& page, const Row& row, const RowResult& result) {
  page.heading(3, row.name);
  page.prose(row.title + ". Reference: " + row.reference);
  page.table({"trial", "expected", "outcome", "error", "digits lost", "verdict"});
  for (const Trial& t : result.trials)
    page.row({cell(t.label), cell(t.expected), cell(t.outcome), small(t.error), digits(t.digits_lost()),
              verdict(t.ok)});
  if (!result.thrown.empty()) page.prose("FAIL, threw: " + result.thrown);
}

}  // namespace

std::string heading() {
  return fmt::format("{:<22} {:<58} {:>6} {:>12} {:>8}  {}\n", "row", "what is swept", "trials", "digits lost",
                     "time [s]", "verdict");
}

std::string row_text(const Row& row, const RowResult& result, bool all_trials) {
  std::string text = fmt::format("{:<22} {:<58} {:>6} {:>12} {:>8.2f}  {}\n", row.name,
                                 shortened(row.title, 58), result.trials.size(), digits(result.worst_digits()),
                                 result.seconds, result.ok() ? "ok" : "FAIL");
  for (const Trial& t : result.trials)
    if (all_trials || !t.ok)
      fmt::format_to(std::back_inserter(text), "    {:<4} {:<40} error {:>8} digits lost {:>4}  {} -> {}\n",
                     t.ok ? "ok" : "FAIL", t.label, small(t.error), digits(t.digits_lost()), t.expected,
                     shortened(t.outcome));
  if (!result.thrown.empty()) text += "    FAIL threw: " + result.thrown + "\n";
  return text;
}

std::string to_csv(const std::vector<Row>& rows, const std::vector<RowResult>& results) {
  std::string text =
      "# errors are relative to the row's reference; digits lost = log10(error / 1.1e-16)\n"
      "row,trial,parameter,expected,outcome,error[-],allowed[-],digits_lost[-],verdict\n";
  const auto quoted = [](std::string words) {
    std::replace(words.begin(), words.end(), '"', '\'');
    std::replace(words.begin(), words.end(), '\n', ' ');
    return "\"" + words + "\"";
  };
  const auto number = [&](double value) { append_optional_cell(text, value); };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (const Trial& t : results[i].trials) {
      text += rows[i].name + "," + quoted(t.label);
      number(t.parameter);
      text += "," + quoted(t.expected) + "," + quoted(t.outcome);
      number(t.error);
      number(t.allowed);
      number(t.digits_lost());
      text += t.ok ? ",ok\n" : ",FAIL\n";
    }
    if (!results[i].thrown.empty())
      text += rows[i].name + ",,,," + quoted("threw: " + results[i].thrown) + ",,,,FAIL\n";
  }
  return text;
}

std::string plot(const Row& row, const RowResult& result) {
  if (row.axis.empty()) return {};
  Plot picture;
  picture.title = row.title;
  picture.x_label = row.axis;
  picture.y_label = "digits lost of 16";
  picture.log_x = row.log_axis;
  PlotSeries allowed;
  allowed.name = "allowed";
  allowed.dashed = true;
  for (const Trial& t : result.trials) {
    if (std::isnan(t.parameter) || std::isnan(t.digits_lost())) continue;
    auto series = std::find_if(picture.series.begin(), picture.series.end(),
                               [&](const PlotSeries& s) { return s.name == t.series; });
    if (series == picture.series.end()) {
      picture.series.push_back({t.series, {}, {}, true, true, false});
      series = picture.series.end() - 1;
    }
    series->x.push_back(t.parameter);
    series->y.push_back(t.digits_lost());
  }
  if (picture.series.empty() || picture.series.front().x.size() < 2) return {};
  for (const Trial& t : result.trials)
    if (t.series == picture.series.front().name && !std::isnan(t.parameter) && !std::isnan(t.digits_lost())) {
      Trial limit;
      limit.error = t.allowed;
      allowed.x.push_back(t.parameter);
      allowed.y.push_back(limit.digits_lost());
    }
  picture.series.push_back(std::move(allowed));
  return plot_svg(picture);
}

std::string to_markdown(const std::vector<Row>& rows, const std::vector<RowResult>& results,
                        const std::string& folder) {
  const auto failed = std::count_if(results.begin(), results.end(), [](const RowResult& r) { return !r.ok(); });
  Page page("The stability stress test");
  page.note("Written by `sagefe stress --write`: rerun it instead of editing.");
  page.prose(
      "Every row sweeps one parameter towards its limits. Each trial must be right to a stated error or end "
      "with a "
      "named diagnostic. A number that is not finite, any other exception, and a wrong answer without a "
      "diagnostic "
      "are a FAIL. Digits lost = log10(error / 1.1e-16), of 16. Errors are relative to the reference of the "
      "row.");
  page.prose(
      "The first table gives the largest number of lost digits of each row. It is large, and the row is still "
      "ok, where the error is that of the mesh, or where sagefe must announce a wrong result. [The "
      "manual](manual/stress.md) describes the command.");
  page.prose(
      "u = 1.1e-16 is the unit of rounding. Laws and cones have their numbers on cards: law 3 is "
      "Drucker-Prager, whose [cones](theory/drucker_prager.md) are 1 to 5, and law 4 is Mohr-Coulomb. The "
      "*source chapter* is chapter 7 of a publication on the program SAGE ([figures](manual/figures.md)).");
  page.prose(fmt::format("{} rows, {} failed.", rows.size(), failed));
  page.table({"row", "what is swept", "trials", "digits lost", "verdict"});
  for (std::size_t i = 0; i < rows.size(); ++i)
    page.row({fmt::format("[{0}](#{0})", rows[i].name), rows[i].title, std::to_string(results[i].trials.size()),
              digits(results[i].worst_digits()), verdict(results[i].ok())});
  std::string family;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].family != family) page.heading(2, family = rows[i].family);
    add_row(page, rows[i], results[i]);
    if (!plot(rows[i], results[i]).empty()) page.figure("digits lost", folder + "/" + rows[i].name + ".svg");
  }
  return page.text();
}

}  // namespace sage::stress
