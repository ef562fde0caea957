#include "sage/record/state_time.hpp"

#include <gtest/gtest.h>

namespace sage {
namespace {

// Two nodes on a specimen of height 2; stage 1 is the cell pressure, stages 2 and 3 push the nodes in.
Model specimen() {
  Model model;
  model.mesh.x.resize(2, 2);
  model.mesh.number = {1, 2};
  model.mesh.deck_nodes = 2;
  model.stages.resize(3);
  for (std::size_t s : {1u, 2u})
    for (int node : {0, 1}) {
      Fixity push;
      push.node = node;
      push.code = {FixityCode::unchanged, FixityCode::fixed};
      push.value = {0.0, s == 1 ? -0.1 : -0.04};
      model.stages[s].fixities.push_back(push);
    }
  Report report;
  report.nodes = {0, 1};
  report.height = 2.0;
  report.stage = 1;
  model.reports.push_back(report);
  return model;
}

TEST(StateTime, IsTheStrainOfASpecimenThatIsPushedIn) {
  const StateTime time(specimen());
  EXPECT_EQ(time.meaning(), "axial strain of report 1, its start is 0");
  EXPECT_DOUBLE_EQ(time.at(0, 0.5), -0.5);  // stages before count up to 0
  EXPECT_DOUBLE_EQ(time.at(0, 1.0), 0.0);
  EXPECT_DOUBLE_EQ(time.at(1, 0.5), 0.025);
  EXPECT_DOUBLE_EQ(time.at(2, 1.0), 0.07);
}

// A film must not run backwards.
TEST(StateTime, IsNoStrainWhereThatDoesNotGrow) {
  Model back = specimen();
  for (Fixity& fixity : back.stages[2].fixities) fixity.value[1] = 0.04;
  Model let_go = specimen();
  let_go.stages[2].fixities.pop_back();
  Model other = specimen();
  other.reports[0].kind = ReportKind::nodes;
  for (const Model* model : {&back, &let_go, &other}) {
    const StateTime time(*model);
    EXPECT_EQ(time.meaning(), "stage - 1 + load factor");
    EXPECT_DOUBLE_EQ(time.at(2, 0.25), 2.25);
  }
}

TEST(StateTime, CountsDurationsWhereTheDeckGivesThem) {
  Model model;
  model.stages.resize(2);
  model.stages[0].duration = 10.0;
  model.stages[1].duration = 30.0;
  const StateTime time(model);
  EXPECT_EQ(time.meaning(), "sum of the durations of the stages");
  EXPECT_DOUBLE_EQ(time.at(0, 0.5), 5.0);
  EXPECT_DOUBLE_EQ(time.at(1, 0.5), 25.0);
}

}  // namespace
}  // namespace sage
