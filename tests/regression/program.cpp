#include "tests/regression/program.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tests/support/scratch_folder.hpp"

namespace sage::test {

namespace fs = std::filesystem;

namespace {

std::string right(const char* text, std::size_t width) {
  const std::string field(text);
  return field.size() < width ? std::string(width - field.size(), ' ') + field : field;
}

}  // namespace

std::string card(std::initializer_list<const char*> integers, std::initializer_list<const char*> reals) {
  std::string text;
  for (const char* field : integers) text += right(field, 5);
  for (const char* field : reals) text += right(field, 10);
  return text;
}

std::size_t DeckText::index(const std::string& label) const {
  for (std::size_t i = 0; i < cards_.size(); ++i)
    if (cards_[i].first == label) return i;
  ADD_FAILURE() << "the test names a card that its deck has not: " << label;
  return 0;
}

DeckText DeckText::with(const std::string& label, const std::string& text) const {
  DeckText deck = *this;
  deck.cards_[index(label)].second = text;
  return deck;
}

DeckText DeckText::behind(const std::string& label, const std::string& new_label,
                          const std::string& text) const {
  DeckText deck = *this;
  deck.cards_.insert(deck.cards_.begin() + static_cast<std::ptrdiff_t>(index(label)) + 1, {new_label, text});
  return deck;
}

DeckText DeckText::without(const std::string& label) const {
  DeckText deck = *this;
  deck.cards_.erase(deck.cards_.begin() + static_cast<std::ptrdiff_t>(index(label)));
  return deck;
}

DeckText DeckText::cut_before(const std::string& label) const {
  DeckText deck = *this;
  deck.cards_.resize(index(label));
  return deck;
}

int DeckText::line(const std::string& label) const {
  return static_cast<int>(index(label)) + 1;
}

std::vector<std::string> DeckText::labels() const {
  std::vector<std::string> names;
  for (const auto& [label, text] : cards_) names.push_back(label);
  return names;
}

std::string DeckText::text(const std::string& line_end) const {
  std::string all;
  for (const auto& [label, text] : cards_) all += text + line_end;
  return all;
}

DeckText block_deck() {
  return {
      {"title", "A square of 2 x 2 elements"},
      {"units", "in      lbf     psi         14.696  0.036111"},
      // geometry, solver, then nodes fills materials groups elements fixities initials stages reports, totals
      {"control", card({"1", "0", "4", "1", "1", "1", "1", "2", "1", "1", "1", "9", "4"})},
      {"node1", card({"1", "", ""}, {"0.", "0."})},
      {"node3", card({"3", "", ""}, {"1.", "0."})},
      {"node7", card({"7", "", ""}, {"0.", "1."})},
      {"node9", card({"9", "", ""}, {"1.", "1."})},
      {"fill", card({"1", "2", "1", "2", "3"})},
      {"material", card({"1", "1", "2"}, {""}) + "clay"},
      {"parameters", card({}, {"3000.", ".25"})},
      {"group", card({"1", "1", "1", "1"}) + "block"},
      {"element", card({"1", "1", "1", "2", "5", "4", "", "", "", "", "2", "2", "1", "3"})},
      {"fixity_bottom", card({"1", "3", "1", "0", "1"})},
      {"fixity_left", card({"1", "7", "3", "1", "0"})},
      {"initial", card({"1", "0"}, {"10.", "10.", "10."})},
      {"stage_title", "The top goes down, the right side is pressed"},
      // increments method iterations output, fixities loads pressures births deaths
      // initials, gravity, tolerance
      {"stage", card({"2", "0", "0", "0", "1", "1", "1", "0", "0", "0"}, {"", "", ""})},
      {"stage_fixity", card({"7", "9", "1", "0", "1"}, {"", "-0.001"})},
      {"load", card({"3", "", ""}, {"-1.", "0."})},
      {"pressure", card({"2", "2", "4", "2"}, {"10.", "10."})},
      {"report", card({"1", "1", "7", "9", "1", "1"}, {"1.", "", "10."})},
      {"end", "END"},
  };
}

DeckText joint_deck() {
  return {
      {"title", "Two elements and the joint between them"},
      {"units", "m       kN      kPa"},
      {"control", card({"1", "0", "8", "0", "2", "3", "3", "1", "2", "1", "0", "8", "3"})},
      {"node1", card({"1", "", ""}, {"0.", "0."})},
      {"node2", card({"2", "", ""}, {"1.", "0."})},
      {"node3", card({"3", "", ""}, {"0.", "1."})},
      {"node4", card({"4", "", ""}, {"1.", "1."})},
      {"node5", card({"5", "", ""}, {"0.", "1."})},
      {"node6", card({"6", "", ""}, {"1.", "1."})},
      {"node7", card({"7", "", ""}, {"0.", "2."})},
      {"node8", card({"8", "", ""}, {"1.", "2."})},
      {"material_soil", card({"1", "1", "2"}, {""}) + "soil"},
      {"parameters_soil", card({}, {"10000.", ".3"})},
      {"material_joint", card({"2", "21", "2"}, {""}) + "joint"},
      {"parameters_joint", card({}, {"1.E4", "1.E6"})},
      {"group_bottom", card({"1", "1", "0", "1"})},
      {"group_joint", card({"2", "11", "0", "2"})},
      {"group_top", card({"3", "1", "0", "1"})},
      {"element_bottom", card({"1", "1", "1", "2", "4", "3"})},
      {"element_joint", card({"2", "2", "3", "4", "6", "5"})},
      {"element_top", card({"3", "3", "5", "6", "8", "7"})},
      {"fixity", card({"1", "2", "1", "1", "1"})},
      {"initial_bottom", card({"1", "0"}, {"1.", "1.", "1."})},
      {"initial_joint", card({"2", "3"}, {"1."})},
      {"stage_title", "Pressed and pushed"},
      {"stage", card({"1", "0", "0", "0", "0", "1", "1", "0", "0", "0"})},
      {"load", card({"7", "", ""}, {"0.01", "0."})},
      {"pressure", card({"3", "3", "", ""}, {"100.", "100."})},
      {"end", "END"},
  };
}

DeckText collapse_deck() {
  return {
      {"title", "A column loaded beyond its strength"},
      {"units", "m       kN      kPa"},
      {"control", card({"1", "0", "4", "0", "1", "1", "1", "2", "0", "1", "0"})},
      {"node1", card({"1", "", ""}, {"0.", "0."})},
      {"node2", card({"2", "", ""}, {"1.", "0."})},
      {"node3", card({"3", "", ""}, {"0.", "1."})},
      {"node4", card({"4", "", ""}, {"1.", "1."})},
      {"material", card({"1", "4", "4"}, {""}) + "clay"},
      {"parameters", card({}, {"10000.", ".3", "10.", "0."})},
      {"group", card({"1", "1", "", "1"})},
      {"element", card({"1", "1", "1", "2", "4", "3"})},
      {"fixity_bottom", card({"1", "2", "1", "0", "1"})},
      {"fixity_left", card({"1", "3", "2", "1", "0"})},
      {"stage_title", "Pressure on the top"},
      {"stage", card({"10", "0", "0", "0", "0", "0", "1", "0", "0", "0"})},
      {"pressure", card({"1", "3", "", ""}, {"30.", "30."})},
      {"end", "END"},
  };
}

// The 300 s of the usual `under` are for hangs only: the slowest deck takes some 20 s under sanitizers.
Finished sagefe(const fs::path& folder, const std::string& arguments, const std::string& under) {
  const std::string command = "cd '" + folder.string() + "' && " + under + " '" SAGE_EXECUTABLE "' " +
                              arguments + " > stdout.txt 2> stderr.txt";
  const int status = std::system(command.c_str());
  Finished finished;
  finished.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  finished.out = read(folder / "stdout.txt");
  finished.err = read(folder / "stderr.txt");
  return finished;
}

std::string killed_after(double seconds) {
  return R"(sh -c '"$0" "$@" & child=$!; (sleep )" + std::to_string(seconds) +
         R"(; kill -KILL $child) 2>/dev/null & timer=$!; wait $child; code=$?; kill $timer 2>/dev/null; exit $code')";
}

std::string killed_once_there_is(const std::string& file) {
  return R"(sh -c '"$0" "$@" & run=$!; for i in $(seq 30000); do test -e )" + file +
         R"( && break; sleep 0.01; done; kill -KILL $run; wait $run; exit $?')";
}

fs::path empty_folder(const std::string& name) {
  const fs::path folder = scratch_folder(name);
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

void write(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

std::string read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

int count(const std::string& text, const std::string& what) {
  int found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + what.size()))
    ++found;
  return found;
}

}  // namespace sage::test
