// sagefe-verify: the program behind `sagefe verify`, the verification book.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "sage/app/answer.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/program.hpp"
#include "sage/app/progress.hpp"
#include "sage/app/screen.hpp"
#include "sage/app/studies.hpp"
#include "sage/messages/error.hpp"
#include "sage/record/out_file.hpp"
#include "tests/studies/verify/book.hpp"
#include "tests/studies/workbench.hpp"

namespace sage::app {

namespace {

using namespace verify;

bool chosen(const VerifyOptions& options, const Section& section, const Case& one) {
  if (one.takes_minutes && !options.list) return !options.write.empty() || options.only == one.name;
  return options.only.empty() || one.name.find(options.only) != std::string::npos ||
         section.title.find(options.only) != std::string::npos;
}

int count_chosen(const VerifyOptions& options, const std::vector<Section>& sections) {
  int count = 0;
  for (const Section& section : sections)
    for (const Case& one : section.cases) count += chosen(options, section, one) ? 1 : 0;
  return count;
}

Json case_json(const Section& section, const Case& one) {
  return {{"section", json_text(section.title)},
          {"name", one.name},
          {"title", json_text(one.title)},
          {"source", json_text(one.source)},
          {"grade", name_of(one.grade)}};
}

// NaN where a row has no such number.
Json result_json(const Section& section, const CaseResult& result) {
  Json rows = Json::array();
  for (const Row& row : result.rows)
    rows.push_back({{"what", json_text(row.what)},
                    {"where", name_of(row.where)},
                    {"computed", row.computed},
                    {"reference", row.reference},
                    {"error", row.error},
                    {"gate", row.gate},
                    {"order", row.order},
                    {"theory", row.theory},
                    {"relative", row.relative},
                    {"pass", row.pass}});
  Json json = case_json(section, *result.of);
  json["pass"] = result.pass();
  json["seconds"] = result.seconds;
  json["rows"] = std::move(rows);
  return json;
}

void answer_case(Json one) {
  if (Json* json = answer()) (*json)["cases"].push_back(std::move(one));
}

int list_cases(const VerifyOptions& options, const std::vector<Section>& sections) {
  for (const Section& section : sections) {
    fmt::print("{}\n", section.title);
    for (const Case& one : section.cases)
      if (chosen(options, section, one)) {
        if (screen().json) answer_case(case_json(section, one));
        fmt::print("  {:<26} {}; {} ({}){}\n", one.name, one.title, one.source, name_of(one.grade),
                   one.takes_minutes ? "; minutes: only by its whole name, or with --write" : "");
      }
  }
  return kOk;
}

void write_book(OutFile& book, const std::vector<Chapter>& chapters) {
  const std::string folder = book.path().stem().string();
  for (const NamedPicture& picture : pictures(chapters))
    write_file(book.path().parent_path() / folder / picture.file, picture.svg);
  book.text() = markdown_text(chapters, folder);
  book.finish();
}

int run_book(const VerifyOptions& options, const Catalogue& catalogue) {
  const std::vector<Section> sections = book();
  if (options.list) return list_cases(options, sections);
  if (!options.write.empty() && !options.only.empty()) {
    say_error("sagefe verify", "--write writes the whole book; leave --only away", "S905");
    return kUsage;
  }
  OutFile csv, written;  // opened first: an unwritable folder shows before anything is computed
  if (!options.csv.empty()) csv = OutFile(options.csv);
  if (!options.write.empty()) written = OutFile(options.write);
  const scenes::Workbench bench = make_workbench(catalogue);
  std::vector<Chapter> chapters;
  int cases = 0, rows = 0, failing = 0;
  double seconds = 0.0;
  Task task("verify");
  const int count = count_chosen(options, sections);
  for (const Section& section : sections) {
    Chapter& chapter = chapters.emplace_back();
    chapter.title = section.title;
    for (const Case& one : section.cases) {
      if (!chosen(options, section, one)) continue;
      task.part(one.name, cases + 1, count);
      chapter.outcomes.push_back(run_case(one, bench));
      const CaseResult& outcome = chapter.outcomes.back();
      if (screen().json) answer_case(result_json(section, outcome));
      if (cases++ == 0) fmt::print("{}", table_header());
      rows += static_cast<int>(outcome.rows.size());
      failing += outcome.pass() ? 0 : 1;
      seconds += outcome.seconds;
      const ProgressPause pause;
      fmt::print("{}", table_text({section.title, {outcome}}, options.rows));
      std::fflush(stdout);
    }
  }
  if (cases == 0) {
    say_error("sagefe verify", "no case matches " + options.only + "; see sagefe verify --list", "S904");
    return kUsage;
  }
  if (Json* json = answer())
    json->update({{"case_count", cases}, {"row_count", rows}, {"failing", failing}, {"seconds", seconds}});
  fmt::print(
      "{} cases, {} rows, {} failing; {:.1f} s. Signs: pressures and loads compression positive; forces per "
      "unit "
      "thickness or full circle; consistent units\n",
      cases, rows, failing, seconds);
  if (csv.open()) {
    csv.text() = csv_text(chapters);
    csv.finish();
  }
  if (written.open()) write_book(written, chapters);
  return failing > 0 ? kNotConverged : kOk;
}

}  // namespace

}  // namespace sage::app

int main(int argc, char** argv) {
  sage::app::studies().verify = sage::app::run_book;
  return sage::sagefe(argc, argv);
}
