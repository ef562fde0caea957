// The page's data: numbers are those of the CSV files, texts are never markup, and the size stays within its room.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "sage/app/commands.hpp"
#include "sage/app/run_deck.hpp"
#include "sage/app/run_source.hpp"
#include "sage/record/csv_table.hpp"
#include "sage/report/bundle.hpp"
#include "sage/report/encode.hpp"
#include "sage/report/live_page.hpp"
#include "sage/report/page.hpp"
#include "tests/support/scratch_folder.hpp"

namespace sage::report {
namespace {

namespace fs = std::filesystem;

std::string from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes += static_cast<char>(bits >> count & 255u);
    }
  }
  return bytes;
}

// As the page's script reads them.
std::vector<double> unpacked(const Json& p) {
  const std::string type = p["t"];
  std::vector<double> values(p["n"].get<std::size_t>(), NAN);
  if (type == "c") {
    if (!p["v"].is_null()) values.assign(values.size(), p["v"].get<double>());
    return values;
  }
  const std::string bytes = from_base64(p["b"]);
  if (type == "f8") {
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }
  if (type == "v") {
    const auto stride = p["s"].get<std::size_t>();
    for (std::size_t i = 0, at = 0; i < values.size(); ++i) {
      std::uint64_t all = 0;
      for (int shift = 0;; shift += 7) {
        const auto byte = static_cast<unsigned char>(bytes[at++]);
        all |= std::uint64_t{byte & 127u} << shift;
        if (byte < 128) break;
      }
      const auto half = static_cast<double>((all + 1) / 2);
      values[i] = (all % 2 != 0 ? -half : half) + (i >= stride ? values[i - stride] : 0.0);
    }
    return values;
  }
  const std::size_t width = type == "q3" ? 3 : 2;
  const double none = std::pow(256.0, static_cast<double>(width)) - 1.0, low = p["lo"], high = p["hi"];
  for (std::size_t i = 0; i < values.size(); ++i) {
    double step = 0.0;
    for (std::size_t k = width; k-- > 0;)
      step = 256.0 * step + static_cast<unsigned char>(bytes[i * width + k]);
    if (step != none) values[i] = low + step * (high - low) / (none - 1.0);
  }
  return values;
}

struct Finished {
  fs::path file;
  std::unique_ptr<StoredResult> stored;
  std::unique_ptr<Model> model;

  PageRun run() const { return page_run(file, *stored, *model); }
};

// Of the deck, with all tables beside the result file.
Finished finished(const std::string& name, const std::string& deck, bool tables = true) {
  const fs::path folder = test::scratch_folder("report_" + name);
  std::ofstream(folder / (name + ".dat"), std::ios::binary) << deck;
  app::RunRequest request;
  request.deck = (folder / (name + ".dat")).string();
  request.quiet = true;
  request.output.folder = folder;
  request.output.nodes = request.output.points = request.output.listing = tables;
  request.output.result = true;
  const Catalogue catalogue = app::full_catalogue();
  app::run_deck(request, catalogue);
  Finished made;
  made.file = folder / (name + ".h5");
  made.stored = std::make_unique<StoredResult>(made.file);
  made.model =
      std::make_unique<Model>(app::model_of(made.stored->source(), made.stored->deck_name(), catalogue));
  return made;
}

std::string shipped(const std::string& name) {
  std::ifstream in(SAGE_SOURCE_DIR "/legacy_inputs/" + name, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// The specimen with pinned ends of n x n quadrilaterals.
std::string square(int n) {
  const int row = n + 1, top = n * row + 1, last = row * row;
  const std::pair<std::string, std::string> kLines[] = {
      {"    2    0    4", "    2    0    4    1    1    1    1    2    0    1    1"},
      {"   21                 1.4        0.", fmt::format("{:5}                 1.4        0.", row)},
      {"  421                  0.", fmt::format("{:5}                  0.       1.4", top)},
      {"  441                 1.4", fmt::format("{:5}                 1.4       1.4", last)},
      {"    1   20    1   20   21", fmt::format("    1{0:5}    1{0:5}{1:5}", n, row)},
      {"    1    1    1    2   23",
       fmt::format("    1    1    1    2{:5}{:5}{:20}{:5}{:5}    1{:5}", row + 2, row + 1, "", n, n, row)},
      {"    1   21    1    0    1", fmt::format("    1{:5}    1    0    1", row)},
      {"    1  421   21", fmt::format("    1{0:5}{1:5}    1    0", top, row)},
      {"  421  441", fmt::format("{:5}{:5}    1    1    1        0.     -0.14", top, last)},
      {"    1    1  421  441",
       fmt::format("    1    1{:5}{:5}    1    1       1.4                  0.", top, last)},
      {"   10    0    0", "    1    0    0    0    1"}};
  std::string deck;
  std::istringstream lines(shipped("chapter7/pinned_ld1_nu025/deck.dat"));
  for (std::string line; std::getline(lines, line);) {
    for (const auto& [begin, other] : kLines)
      if (line.starts_with(begin)) line = other;
    deck += line + "\n";
  }
  return deck;
}

Json data_of(const Page& page) {
  const std::string begin = "id=\"data\">";
  const std::size_t at = page.html.find(begin) + begin.size();
  return Json::parse(page.html.substr(at, page.html.find("</script>", at) - at));
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

bool alike(double a, double b) {
  return (std::isnan(a) && std::isnan(b)) ||
         std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b)) + 1e-300;
}

#ifdef SAGE_WITH_RESULT_FILES

// Every number of a field's columns in the table is that of the page, in the order of groups, elements and points.
void expect_points(const Json& run, const CsvTable& table, const std::string& kind,
                   const std::vector<std::string>& fields) {
  std::size_t row = 0, compared = 0;
  for (const Json& state : run["states"])
    for (std::size_t g = 0; g < run["groups"].size(); ++g) {
      const Json& group = run["groups"][g];
      if (group["kind"] != kind || state["active"][g] == 0) continue;
      const std::vector<double> numbers = unpacked(group["numbers"]);
      const std::size_t points = group["points"], rows = numbers.size() * points;
      ASSERT_LE(row + rows, table.lines.size());
      for (std::size_t i = 0; i < rows; ++i) {
        EXPECT_EQ(table.find("element")->values[row + i], numbers[i / points]);
        EXPECT_EQ(table.find("stage")->values[row + i], state["stage"].get<double>());
      }
      for (const Json& field : run["fields"]) {
        const std::string name = field["name"];
        if (std::ranges::find(fields, name) == fields.end()) continue;
        for (std::size_t c = 0; c < field["columns"].size(); ++c) {
          const CsvTable::Column* column = table.find(field["columns"][c]);
          ASSERT_NE(column, nullptr) << field["columns"][c];
          const std::vector<double> values = unpacked(state["values"][name][g][c]);
          ASSERT_EQ(values.size(), rows);
          for (std::size_t i = 0; i < rows; ++i, ++compared)
            EXPECT_TRUE(alike(values[i], column->values[row + i]))
                << name << ' ' << values[i] << ' ' << column->values[row + i];
        }
      }
      row += rows;
    }
  EXPECT_EQ(row, table.lines.size());
  EXPECT_GT(compared, 100u);
}

// Ten digits in the tables, all of them in the page.
TEST(ReportPage, HasTheNumbersOfTheTables) {
  const Finished made = finished("braced_cut", shipped("structures/braced_cut/deck.dat"));
  const Json run = data_of(make_page({made.run()}))["runs"][0];
  const auto table = [&](const std::string& rest) {
    return read_csv_table(fs::path(made.file).replace_extension(rest));
  };
  expect_points(run, table(".points.csv"), "solid", {"stress", "strain", "stress_level"});
  expect_points(run, table(".interfaces.csv"), "interface", {"traction", "relative_displacement"});
  const CsvTable nodes = table(".nodes.csv"), ends = table(".ends.csv");
  std::size_t row = 0;
  const std::vector<double> number = unpacked(run["nodes"]["number"]);
  for (const Json& state : run["states"]) {
    const std::vector<double> u[] = {unpacked(state["values"]["displacement"][0]),
                                     unpacked(state["values"]["displacement"][1])};
    for (std::size_t n = 0; n < number.size(); ++n) {
      if (std::isnan(u[0][n])) continue;
      ASSERT_LT(row, nodes.lines.size());
      EXPECT_EQ(nodes.find("node")->values[row], number[n]);
      EXPECT_TRUE(alike(nodes.find("ux")->values[row], u[0][n]) &&
                  alike(nodes.find("uy")->values[row], u[1][n]));
      ++row;
    }
  }
  EXPECT_EQ(row, nodes.lines.size());
  row = 0;
  for (const Json& state : run["states"])
    for (const Json& group : state["ends"])
      for (std::size_t i = 0; i < group["end"].size(); ++i, ++row)
        for (std::size_t q = 0; q < run["quantities"].size(); ++q)
          EXPECT_TRUE(
              alike(unpacked(group["values"][q])[i], ends.find(run["quantities"][q]["name"])->values[row]));
  EXPECT_EQ(row, ends.lines.size());
}

TEST(ReportPage, HasTablesMessagesAndTheDeck) {
  const std::string deck = shipped("structures/braced_cut/deck.dat");
  const Finished made = finished("papers", deck);
  const Json run = data_of(make_page({made.run()}))["runs"][0];
  EXPECT_EQ(run["deck"], deck);
  ASSERT_EQ(run["tables"].size(), 1u);
  const CsvTable increments = read_csv_table(fs::path(made.file).replace_extension(".increments.csv"));
  for (std::size_t c = 0; c < increments.columns.size(); ++c)
    for (std::size_t i = 0; i < increments.lines.size(); ++i)
      EXPECT_TRUE(
          alike(unpacked(run["tables"][0]["columns"][c]["values"])[i], increments.columns[c].values[i]));
  bool found = false;
  for (const Json& message : run["messages"])
    if (message["code"] == "S523" && message["line"] == 73)  // the card of stage 2
      found = !message["cause"].get<std::string>().empty() && !message["cure"].get<std::string>().empty();
  EXPECT_TRUE(found) << run["messages"].dump(1);
  // The wall's largest moment of all stages, as the summary of the run has it.
  const Json& quantities = run["quantities"];
  double least = 0.0;
  for (std::size_t q = 0; q < quantities.size(); ++q)
    if (quantities[q]["name"] == "bending_moment")
      for (const Json& row : run["envelope"])
        if (!row["low"][q].is_null()) least = std::min(least, row["low"][q].get<double>());
  EXPECT_NEAR(least, -42.406, 0.001);
}

// Two runs of one deck, each in its folder, can be told apart.
TEST(ReportPage, RunsOfOneDeckAreNamedByTheirFolders) {
  const Finished made = finished("named", shipped("chapter7/pinned_ld2_nu025/deck.dat"));
  PageRun one = made.run(), other = made.run();
  one.file = "axisymmetric/footing.h5";
  other.file = "b_bar/footing.h5";
  const Json alone = data_of(make_page({one}))["runs"], both = data_of(make_page({one, other}))["runs"];
  EXPECT_EQ(alone[0]["name"], "footing");
  EXPECT_EQ(both[0]["name"], "axisymmetric/footing");
  EXPECT_EQ(both[1]["name"], "b_bar/footing");
}

// Whatever a deck writes into titles and names stays text.
TEST(ReportPage, NamesOfDecksAreNoMarkup) {
  std::string deck = shipped("chapter7/pinned_ld2_nu025/deck.dat");
  const std::string title = "</script><script>alert(1)</script>&\"'<!--";
  deck = title + deck.substr(deck.find('\n'));
  const Finished made = finished("markup", deck);
  const Page page = make_page({made.run()});
  EXPECT_EQ(count(page.html, "<script"), 2u);
  EXPECT_EQ(count(page.html, "</script"), 2u);
  EXPECT_EQ(count(page.html, "<!--"), 0u);
  EXPECT_EQ(data_of(page)["runs"][0]["title"], title);
  EXPECT_NE(page.html.find("<title>&lt;/script&gt;&lt;script&gt;alert(1)&lt;/script&gt;&amp;"),
            std::string::npos);
}

// After every output increment of a run that goes on; the last of them has the values of the finished run.
TEST(ReportPage, IsWrittenWhileTheRunGoesOn) {
  const fs::path folder = test::scratch_folder("report_live");
  const std::string deck = shipped("structures/braced_cut/deck.dat");
  std::ofstream(folder / "live.dat", std::ios::binary) << deck;
  LivePage live(folder / "live.h5", "live.dat", deck, -1.0);
  app::RunRequest request;
  request.deck = (folder / "live.dat").string();
  request.quiet = true;
  request.output.folder = folder;
  request.watch = &live;
  const Catalogue catalogue = app::full_catalogue();
  ASSERT_EQ(app::run_deck(request, catalogue).exit_code, 0);
  const Json done = data_of(make_page({finished("braced", deck).run()}))["runs"][0];
  EXPECT_EQ(live.written(), static_cast<int>(done["states"].size()));
  std::ifstream in(folder / "live.html", std::ios::binary);
  const Json run = data_of({{std::istreambuf_iterator<char>(in), {}}, {}})["runs"][0];
  ASSERT_TRUE(run["summary"][0][1].get<std::string>().starts_with("being computed: this page is of stage 5"));
  EXPECT_EQ(run["states"].back()["values"], done["states"].back()["values"]);
  EXPECT_EQ(run["deck"], deck);
  // It is no result: no list names it.
  std::ifstream list(folder / "live.files");
  const std::string names{std::istreambuf_iterator<char>(list), {}};
  EXPECT_NE(names.find("live.lst"), std::string::npos);
  EXPECT_EQ(names.find("live.html"), std::string::npos);
}

// What has no room is named.
TEST(ReportPage, StaysWithinItsRoom) {
  const Finished made = finished("size", square(160), false);
  ASSERT_EQ(made.model->groups[0].elements(), 25600);
  const std::size_t code = bundle_script().size() + bundle_style().size();
  EXPECT_LE(code, 250000u);
  // 50 000 quadrilaterals with three fields in 4 MB are 80 bytes each.
  const Page three =
      make_page({made.run()}, {.fields = {"stress_xx", "stress_yy", "stress_level"}, .room = 25600 * 77});
  EXPECT_LE(three.html.size() - code, 25600u * 77u);
  const Json of_three = data_of(three)["runs"][0];
  ASSERT_EQ(of_three["fields"].size(), 3u);
  EXPECT_EQ(of_three["fields"][1]["columns"], Json({"stress_xx", "stress_yy"}));
  EXPECT_EQ(of_three["states"][0]["values"]["stress"][0][1]["t"], "q3");
  const Page smaller = make_page({made.run()}, {.room = 1800000}),
             small = make_page({made.run()}, {.room = 3400000});
  EXPECT_LE(smaller.html.size() - code, 1800000u);
  EXPECT_LE(small.html.size() - code, 3400000u);
  EXPECT_EQ(data_of(smaller)["runs"][0]["states"][0]["values"]["displacement"][1]["t"], "q2");
  EXPECT_FALSE(small.omitted.empty());
  // Rounded to 2^24 - 2 steps between the least and the largest.
  const Json run = data_of(small)["runs"][0];
  const Frame frame = made.stored->frame(*made.model, 0);
  const Json& packed_u = run["states"][0]["values"]["displacement"][1];
  const std::vector<double> u = unpacked(packed_u);
  ASSERT_EQ(packed_u["t"], "q3");
  const double step = (packed_u["hi"].get<double>() - packed_u["lo"].get<double>()) / 16777214.0;
  const Solution now = frame.view();
  for (std::size_t n = 0; n < u.size(); ++n)
    EXPECT_NEAR(u[n], (*now.u)[DofMap::displacement(static_cast<int>(n)) + 1], 0.51 * step);
}

TEST(ReportPage, LargeModelsShowMeansOfElements) {
  const Finished made = finished("means", shipped("chapter7/pinned_ld2_nu025/deck.dat"));
  const Json exact = data_of(make_page({made.run()}))["runs"][0];
  const Json means = data_of(make_page({made.run()}, {.most_points = 100}))["runs"][0];
  EXPECT_TRUE(means["means"].get<bool>());
  EXPECT_FALSE(means["omitted"].empty());
  const std::vector<double> all = unpacked(exact["states"][0]["values"]["stress"][0][1]),
                            one = unpacked(means["states"][0]["values"]["stress"][0][1]);
  const std::size_t points = exact["groups"][0]["points"];
  ASSERT_EQ(one.size() * points, all.size());
  for (std::size_t e = 0; e < one.size(); ++e) {
    double sum = 0.0;
    for (std::size_t p = 0; p < points; ++p) sum += all[e * points + p];
    EXPECT_NEAR(one[e], sum / static_cast<double>(points), 1e-12 * std::abs(sum));
  }
}

#endif

// RFC 4648, section 10.
TEST(ReportEncoding, Base64) {
  const std::pair<std::string, std::string> kVectors[] = {{"", ""},
                                                          {"f", "Zg=="},
                                                          {"fo", "Zm8="},
                                                          {"foo", "Zm9v"},
                                                          {"foob", "Zm9vYg=="},
                                                          {"fooba", "Zm9vYmE="},
                                                          {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : kVectors) EXPECT_EQ(base64(bytes), text);
}

TEST(ReportEncoding, WholeNumbersComeBack) {
  const std::vector<int> values{1, 2, 60, 59, 100000, -3, 2147483647, -2147483647, 0};
  for (const std::size_t stride : {1u, 4u}) {
    const std::vector<double> back = unpacked(packed_integers(values, stride));
    for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(back[i], values[i]);
  }
}

TEST(ReportEncoding, NumbersThatAreNoneStayBlank) {
  for (const Precision precision : {Precision::whole, Precision::fine, Precision::coarse}) {
    const std::vector<double> back = unpacked(packed({1.0, NAN, 3.0, 2.0}, precision));
    EXPECT_EQ(back[0], 1.0);
    EXPECT_TRUE(std::isnan(back[1]));
    EXPECT_EQ(back[2], 3.0);
    EXPECT_NEAR(back[3], 2.0, precision == Precision::whole ? 0.0 : precision == Precision::fine ? 1e-7 : 2e-5);
    EXPECT_EQ(unpacked(packed({-1e308, 1e308, 0.0}, precision))[1], 1e308);  // their difference is no double
    EXPECT_TRUE(std::isnan(unpacked(packed({NAN, NAN}, precision))[1]));
  }
}

TEST(ReportEncoding, NothingEndsTheScript) {
  EXPECT_EQ(text_for_script({{"a", "</script><!--\xe2\x80\xa8\xff"}}).find('<'), std::string::npos);
}

}  // namespace
}  // namespace sage::report
