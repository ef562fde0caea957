// Every shipped deck, written as a sage1 deck, is the same model and gives the same listing, byte for byte but
// for what names the file.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>

#include "sage/app/commands.hpp"
#include "sage/app/run_deck.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/exchange/convert.hpp"
#include "sage/model_file/model_file.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/shipped_decks.hpp"

namespace sage::app {
namespace {

namespace fs = std::filesystem;

InputOptions input_of(const fs::path& deck) {
  InputOptions input;
  input.layout = test::layout_of(deck);
  input.build.partial = true;  // CANDE's decks ask for more than there is
  return input;
}

// Without blank lines, the deck's path, and without messages, which name a line of it.
std::string comparable(const std::string& listing) {
  static const std::regex names(
      "^ *$|^ +deck +\\S+$|^ +[0-9]* \\| .*$|^.*: (note|warning): .*$|^ == WARNINGS AND NOTES =*$");
  static const std::regex partial(", BUT PARTIAL: .*$");  // the title says so in the deck that is written
  std::istringstream in(listing);
  std::string all;
  for (std::string line; std::getline(in, line);)
    if (!std::regex_match(line, names)) all += std::regex_replace(line, partial, "") + "\n";
  return all;
}

std::string listing_of(const fs::path& deck, const InputOptions& input, const std::string& folder) {
  RunRequest request;
  request.deck = deck.string();
  request.input = input;
  request.quiet = true;
  request.stem = "run";
  request.output.folder = test::scratch_folder("round_trip") / folder;
  request.output.increments = false;
  run_deck(request, full_catalogue());
  return comparable(test::bytes_of(request.output.folder / "run.lst"));
}

std::string first_difference(const std::string& a, const std::string& b) {
  std::istringstream left(a), right(b);
  std::string one, other;
  while (true) {
    const bool more = static_cast<bool>(std::getline(left, one)),
               too = static_cast<bool>(std::getline(right, other));
    if (!more && !too) return {};
    if (!more) one = "(end)";
    if (!too) other = "(end)";
    if (one != other) return one + "\n" + other;
  }
}

std::optional<Model> model_of(const fs::path& deck, const InputOptions& input, const Catalogue& catalogue) {
  try {
    return build_model(read_input(deck.string(), input), catalogue, input.build);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

class RoundTrip : public testing::TestWithParam<fs::path> {};

TEST_P(RoundTrip, GivesTheSameModelAndListing) {
  const InputOptions input = input_of(GetParam());
  const Catalogue catalogue = full_catalogue();
  const std::optional<Model> model = model_of(GetParam(), input, catalogue);
  if (!model) GTEST_SKIP() << "no model: the deck is refused";
  Diagnostics lost;
  const std::string text = sage1_text(*model, lost);
  EXPECT_TRUE(lost.list().empty()) << lost.list().front().message;
  const fs::path written = test::scratch_folder("round_trip") / "written.dat";
  std::ofstream(written, std::ios::binary) << text;
  const InputOptions as_written;
  const Model back = build_model(read_input(written.string(), as_written), catalogue, as_written.build);
  Diagnostics none;
  EXPECT_TRUE(sage1_text(back, none) == text);
  EXPECT_EQ(first_difference(listing_of(GetParam(), input, "deck"), listing_of(written, as_written, "written")),
            "");
}

// A model file has the numbers of wide cards: none is rounded.
TEST_P(RoundTrip, ModelFileGivesTheSameModel) {
  const InputOptions input = input_of(GetParam());
  const Catalogue catalogue = full_catalogue();
  const std::optional<Model> model = model_of(GetParam(), input, catalogue);
  if (!model) GTEST_SKIP() << "no model: the deck is refused";
  Diagnostics lost;
  const std::string cards = sage1_text(*model, lost, FieldWidth::wide);
  const std::string text = model_file_text(*model, catalogue, lost);
  EXPECT_TRUE(lost.list().empty()) << lost.list().front().message;
  const Model back = build_model(read_model_file_text(text, "model.sage.toml"), catalogue, input.build);
  Diagnostics none;
  EXPECT_EQ(first_difference(cards, sage1_text(back, none, FieldWidth::wide)), "");
}

INSTANTIATE_TEST_SUITE_P(Shipped, RoundTrip, testing::ValuesIn(test::shipped_decks()),
                         [](const auto& one) { return test::name_of(one.param); });

}  // namespace
}  // namespace sage::app
