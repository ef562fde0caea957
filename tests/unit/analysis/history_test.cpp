// Initial history from the deck (initial card of kind 4).
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "sage/analysis/initial_balance.hpp"
#include "sage/app/commands.hpp"
#include "sage/exchange/convert.hpp"
#include "sage/model/fingerprint.hpp"
#include "tests/studies/workbench.hpp"
#include "tests/support/run_text.hpp"

namespace sage::test {
namespace {

RunSettings by_skyline() {
  RunSettings settings;
  settings.solver = 1;
  return settings;
}

// An axisymmetric element, 1 x 1, of Duncan-Chang soil that starts at sigma_r = 100 and `vertical`, on smooth ends:
// its stress follows from the loads alone.
DeckWriter sample(double vertical, const std::vector<std::string>& more = {}) {
  DeckWriter deck(2);
  const Block block{.place = rectangle(0.0, 1.0, 0.0, 1.0)};
  block.write_nodes(deck);
  deck.material(1, 5, {600.0, 0.5, 0.8, 1200.0, 0.3, 0.0, 0.0, 20.0, 35.0});
  deck.group(1, 1, 0, 1);
  block.write_elements(deck, 1);
  for (const int node : block.bottom()) deck.fix(node, 0, 1);
  deck.initial(1, 0, 100.0, vertical, 100.0);
  deck.initials.insert(deck.initials.end(), more.begin(), more.end());
  return deck;
}

std::string history_card(double value) {
  return "    1    4        1." + ten_columns(value);
}

// The stage brings the vertical stress from where it is by so much.
void press(DeckWriter& deck, double radial, double vertical, int increments = 10) {
  StageCards& stage = deck.stage(increments);
  stage.tolerance = 1e-12;
  if (radial > 0.0) stage.pressure(1, 2, radial, radial);
  stage.pressure(1, 3, vertical, vertical);
}

struct Watched {
  RunResult result;
  std::vector<double> sink;    // of the top over each stage
  std::vector<double> memory;  // at the end of each stage
};

Watched watch(const DeckWriter& deck) {
  struct Watch final : Observer {
    Watched seen;
    double before = 0.0;
    void on_stage_end(const Model&, int, const EquilibriumAudit&, const Solution& now) override {
      const double u = (*now.u)[7];
      seen.sink.push_back(before - u);
      before = u;
      seen.memory.push_back(now.groups()[0].state.committed.h[0]);
    }
  } watch;
  const Workbench bench = app::make_workbench();
  const Model model = bench.build(deck.text());
  Observer* observers[] = {&watch};
  watch.seen.result = sage::run(model, bench.catalogue(), by_skyline(), observers);
  EXPECT_EQ(watch.seen.result.status, RunStatus::completed) << watch.seen.result.reason;
  return watch.seen;
}

// From 100 to 300 and back to 150, then to 250 on the reload branch and to 350, past what the soil remembers.  A deck
// that starts at 150 with that memory goes the same way.  1e-6: the card holds the memory to eight digits.
TEST(History, ADeckGoesOnFromWhereARunGotTo) {
  DeckWriter whole = sample(100.0);
  press(whole, 100.0, 300.0, 40);
  press(whole, 0.0, -150.0);
  press(whole, 0.0, 100.0);
  press(whole, 0.0, 100.0, 20);
  const Watched all = watch(whole);
  ASSERT_EQ(all.sink.size(), 4u);
  const auto rest = [&](const std::vector<std::string>& cards) {
    DeckWriter deck = sample(150.0, cards);
    press(deck, 100.0, 250.0);
    press(deck, 0.0, 100.0, 20);
    return watch(deck);
  };
  const Watched stated = rest({history_card(all.memory[1])});
  EXPECT_NEAR(stated.sink[0], all.sink[2], 1e-6 * all.sink[2]);
  EXPECT_NEAR(stated.sink[1], all.sink[3], 1e-6 * all.sink[3]);
  EXPECT_NEAR(stated.memory[1], all.memory[3], 1e-6 * all.memory[3]);
  EXPECT_GT(rest({}).sink[0], 1.5 * all.sink[2]) << "without it the soil is loaded for the first time";
}

// The order of the cards is nothing: the history comes after the stress of its group.
TEST(History, ComesAfterTheStressOfItsGroup) {
  const double memory = 3.0;
  DeckWriter behind = sample(150.0, {history_card(memory)}), before = sample(150.0);
  before.initials.insert(before.initials.begin(), history_card(memory));
  for (DeckWriter* deck : {&behind, &before}) press(*deck, 100.0, 250.0);
  EXPECT_EQ(watch(behind).sink, watch(before).sink);
  EXPECT_EQ(watch(behind).memory[0], memory);
}

// A joint that stands open by 0.01 and is closed by 0.03 (k_n = 1000): it carries what is left, 20.
TEST(History, AnOpenJointHasItsGap) {
  DeckWriter deck(1);
  for (int i = 0; i < 4; ++i) deck.node(i + 1, i % 2, 0.0);
  deck.material(1, 21, {100.0, 1000.0, 0.0});
  deck.group(1, 11, 0, 1);
  deck.element(1, 1, {1, 2, 4, 3});
  for (const int node : {1, 2}) deck.fix(node, 1, 1);
  for (const int node : {3, 4}) deck.fix(node, 1, 0);
  deck.initials.push_back("    1    4        1.       .01");
  StageCards& close = deck.stage(3);
  for (const int node : {3, 4}) close.fix(node, 0, 1, 0.0, -0.03);
  const WholeRun run = run_text(deck.text());
  ASSERT_TRUE(run.completed()) << run.failure;
  for (int p = 0; p < 2; ++p) EXPECT_NEAR(run.stress[0](1, p), -20.0, 1e-10);
}

std::string refusal(const std::vector<std::string>& cards) {
  DeckWriter deck = sample(150.0, cards);
  press(deck, 100.0, 250.0);
  try {
    app::make_workbench().build(deck.text());
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(History, CardsThatCannotBeAreRefusedInTheirPlace) {
  const auto expect = [](const std::vector<std::string>& cards, const std::string& words) {
    const std::string text = refusal(cards);
    EXPECT_NE(text.find(words), std::string::npos) << text;
  };
  EXPECT_EQ(refusal({history_card(3.0)}), "accepted");
  expect({"    1    4        2.        3."},
         ":21-30: error: group 1: duncan_chang_1970 has the history 1 "
         "largest_stress_state: there is no quantity 2");
  expect({"    1    4        1.        3.        4."}, ":31-40: error: group 1");
  expect({"    1    4        0.        3."}, ":11-20: error: value 1 of a history card (kind 4) is the number");
  expect({"    1    4       1.5        3."}, ":11-20: error: value 1 of a history card");
  expect({"    1    4        1."}, "states at least one value");
  expect({"    1    4        1.    1.E200"}, ":21-30: error");
  expect({"    1    4        1.       NaN"}, ":21-30: error");
  expect({history_card(3.0), history_card(4.0)}, ":21-30: error: group 1: the card in line");
  expect({"    1    9        1."}, "4 history of the law");
  expect({"    7    4        1.        3."}, "group 7");
}

// Less than the state itself is beyond: the law refuses it, for check as for run.
TEST(History, ALawMayRefuse) {
  DeckWriter deck = sample(150.0, {history_card(0.01)});
  press(deck, 100.0, 250.0);
  const Workbench bench = app::make_workbench();
  const Model model = bench.build(deck.text());
  const std::string words = "can't go on from this history at its initial stress, at point 1 of element 1";
  for (const auto& act : {std::function<void()>([&] { sage::run(model, bench.catalogue(), by_skyline(), {}); }),
                          std::function<void()>([&] { initial_imbalance(model); })})
    try {
      act();
      ADD_FAILURE() << "accepted";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
      EXPECT_GT(error.diagnostics().list()[0].where.line, 0);
    }
}

TEST(History, IsInConvertedDecksAndFingerprints) {
  const Workbench bench = app::make_workbench();
  DeckWriter deck = sample(150.0, {history_card(3.0)}), other = sample(150.0, {history_card(3.5)});
  for (DeckWriter* one : {&deck, &other}) press(*one, 100.0, 250.0);
  const Model model = bench.build(deck.text());
  EXPECT_NE(fingerprint(model), fingerprint(bench.build(other.text())));
  Diagnostics none;
  const Model back = bench.build(sage1_text(model, none));
  EXPECT_EQ(none.warnings(), 0);
  ASSERT_EQ(back.initials.size(), 2u);
  EXPECT_EQ(back.initials[1].kind, InitialKind::history);
  EXPECT_EQ(back.initials[1].value[1], 3.0);
  for (std::size_t i = 2; i < 6; ++i) EXPECT_TRUE(std::isnan(back.initials[1].value[i]));
}

}  // namespace
}  // namespace sage::test
