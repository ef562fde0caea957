#include "sage/report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "sage/record/values.hpp"
#include "sage/report/bundle.hpp"
#include "sage/report/run_data.hpp"

namespace sage::report {

namespace {

Json run_json(const PageRun& run, const PageOptions& options, std::vector<std::string>& omitted) {
  Json json = Json::object();
  add_model(run, json);
  std::vector<std::string> missing = add_papers(run, json);
  for (std::string& words : add_states(run, options, json)) missing.push_back(std::move(words));
  json["omitted"] = Json::array();
  for (const std::string& words : missing) {
    json["omitted"].push_back(clean(words));
    omitted.push_back(run.file.stem().string() + ": " + words);
  }
  return json;
}

// STEM, or FOLDER/STEM where runs of one deck stand in several folders.
std::string name_among(const std::vector<PageRun>& runs, const PageRun& run) {
  const std::string stem = run.file.stem().string();
  const bool alone =
      std::ranges::count_if(runs, [&](const PageRun& other) { return other.file.stem() == stem; }) == 1;
  const std::string folder = run.file.parent_path().filename().string();
  return alone || folder.empty() ? stem : folder + "/" + stem;
}

std::string title_of(const std::vector<PageRun>& runs) {
  std::string title;
  for (const PageRun& run : runs) title += (title.empty() ? "" : " | ") + run.model.title;
  return clean(title);
}

std::string html_of(const std::string& title, const Json& json) {
  // A policy that lets nothing in from outside: scripts and styles of this file alone, pictures that it holds.
  constexpr const char* kPolicy =
      "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:";
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<link rel=\"icon\" href=\"data:,\">\n"
      "<title>{}</title>\n<style>\n{}</style>\n</head>\n<body>\n"
      "<noscript>This page shows results with the help of JavaScript, which is switched off.</noscript>\n"
      "<main id=\"page\"></main>\n<script type=\"application/json\" id=\"data\">",
      kPolicy, xml_text(title), bundle_style());
  html += text_for_script(json);
  html += "</script>\n<script>\n";
  html += bundle_script();
  html += "</script>\n</body>\n</html>\n";
  return html;
}

}  // namespace

PageRun page_run(const std::filesystem::path& file, const StoredResult& stored, const Model& model) {
  PageRun run{file, model, stored.deck_name(), stored.source().deck, stored.failure()};
  for (const StoredResult::State& state : stored.states()) run.states.push_back({state.stage, state.increment});
  run.frame = [&stored, &model](std::size_t state) { return stored.frame(model, state); };
  return run;
}

Page make_page(const std::vector<PageRun>& runs, const PageOptions& options) {
  Page page;
  Json json = {{"sagefe", SAGE_VERSION}, {"format", 1}, {"runs", Json::array()}};
  for (const PageRun& run : runs) {
    json["runs"].push_back(run_json(run, options, page.omitted));
    json["runs"].back()["name"] = clean(name_among(runs, run));
  }
  page.html = html_of(title_of(runs), json);
  return page;
}

Page make_table_page(const std::filesystem::path& table) {
  Page page;
  const std::string name = table.stem().string();
  const Json json = {{"sagefe", SAGE_VERSION},
                     {"format", 1},
                     {"runs", Json::array()},
                     {"name", clean(name)},
                     {"table", table_of_cases(table, page.omitted)}};
  page.html = html_of(clean(name), json);
  return page;
}

}  // namespace sage::report
