// Elements taken four at a time against the same elements one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

#include "sage/analysis/run.hpp"
#include "sage/analysis/skips/four_abreast.hpp"
#include "sage/app/commands.hpp"
#include "sage/builder/build_model.hpp"
#include "sage/conformance/sample_laws.hpp"
#include "sage/core/calls_in_order.hpp"
#include "sage/deck/read_deck.hpp"
#include "solvers/choose_solver.hpp"
#include "tests/support/offers_four.hpp"
#include "tests/support/run_text.hpp"

namespace sage {
namespace {

// The law without its own way to take four, and with an error of the path that differs from point to point.
class OneByOne : public SolidLaw, public PathError<4> {
 public:
  explicit OneByOne(LawPtr law) : law_(std::move(std::get<std::unique_ptr<SolidLaw>>(law))) {}
  LawTraits traits() const override { return {.history = law_->traits().history}; }
  bool initialise(const Vector4& sigma, std::span<double> h) const override {
    return law_->initialise(sigma, h);
  }
  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override { return law_->update(in, out); }
  double path_error(const PointIn<4>& in, const Vector4&, std::span<const double>) const override {
    return 1e-3 * in.deps.norm();
  }

 private:
  std::unique_ptr<SolidLaw> law_;
};

enum class How { by_itself, one_by_one, in_fours };

// A disc of columns x rows elements under a punch, in the plastic range.
std::string punch(int columns, int rows, test::Cell cell, int element) {
  test::DeckWriter deck(2);
  test::Block block;
  block.cell = cell;
  block.columns = columns;
  block.rows = rows;
  block.place = test::rectangle(0.0, 2.0, 0.0, 2.0);
  block.write_nodes(deck);
  block.write_elements(deck, 1);
  deck.material(1, 3, {1000.0, 0.3, 10.0, 20.0, 0.0, 1.0, 1.0});
  deck.group(1, element, 1, 1);
  for (int node : block.bottom()) deck.fix(node, 1, 1);
  for (int node : block.left()) deck.fix(node, 1, 0);
  for (int node : block.right()) deck.fix(node, 1, 0);
  test::StageCards& stage = deck.stage(3);
  stage.max_iterations = 400;
  stage.tolerance = 1e-10;
  stage.pressure(block.element(0, rows - 1), 3, 110.0, 110.0);
  return deck.text();
}

struct LastState final : Observer {
  Eigen::VectorXd u;
  PointStates points;
  int iterations = 0;
  double path_error = 0.0;
  void on_increment(const Model&, const StepReport& report, const Solution& solution) override {
    iterations += report.total_iterations;
    u = *solution.u;
    points = solution.groups().front().state.committed;
    path_error = solution.assembly->path_error();
  }
};

LastState solve(const std::string& text, How how, bool keep_matrices, int threads = 1,
                bool offers_four = false) {
  static const Catalogue catalogue = app::full_catalogue();
  Model model = build_model(read_deck_text(text, "punch.dat", load_layout("sage1")), catalogue);
  if (offers_four)
    for (Group& group : model.groups) group.element = std::make_shared<test::OffersFour>(group.element);
  LawPtr& law = model.materials[0].law;
  if (how == How::one_by_one) law = std::make_unique<OneByOne>(std::move(law));
  if (how == How::in_fours) law = std::make_unique<conformance::InFours<OneByOne>>(std::move(law));
  RunSettings settings;
  settings.choose_solver = choose_solver;
  settings.threads = threads;
  settings.skips.factors = keep_matrices;
  settings.skips.prediction = false;  // as many iterations as a step can have
  LastState last;
  Observer* observers[] = {&last};
  EXPECT_EQ(run(model, catalogue, settings, observers).status, RunStatus::completed);
  return last;
}

// The same iterations to the same state, whatever the number of elements leaves for the last four.  Rounding of
// sums is all that may differ, and iterations end at 1e-10: 1e-9 of the largest.
TEST(ByFour, GivesTheStateOfOneByOne) {
  struct Size {
    int columns, rows;
    test::Cell cell;
    int element;
  };
  for (const Size& size : {Size{4, 4, test::Cell::quad4, 1}, Size{5, 5, test::Cell::quad4, 1},
                           Size{3, 2, test::Cell::quad8, 2}, Size{3, 1, test::Cell::quad8, 2}})
    for (const bool keep : {true, false}) {
      SCOPED_TRACE(std::to_string(size.columns * size.rows) + " elements");
      const std::string text = punch(size.columns, size.rows, size.cell, size.element);
      const LastState one = solve(text, How::one_by_one, keep);
      EXPECT_GT(std::ranges::count(one.points.status, PointStatus::yielded), 0);
      ASSERT_GT(one.u.norm(), 0.0);
      ASSERT_GT(one.path_error, 0.0);
      for (const How how : {How::by_itself, How::in_fours}) {
        const LastState four = solve(text, how, keep);
        EXPECT_EQ(four.iterations, one.iterations);
        EXPECT_EQ(four.points.status, one.points.status);
        EXPECT_LE((four.u - one.u).norm(), 1e-9 * one.u.norm());
        for (std::size_t i = 0; i < one.points.sigma.size(); ++i)
          EXPECT_NEAR(four.points.sigma[i], one.points.sigma[i], 110.0 * 1e-9);
        for (std::size_t i = 0; i < one.points.h.size(); ++i)
          EXPECT_NEAR(four.points.h[i], one.points.h[i], 1e-10);
        if (how == How::in_fours) {
          EXPECT_NEAR(four.path_error, one.path_error, 1e-6 * one.path_error);
        }
      }
    }
}

// The law, and the threads that called it.
class Watched : public OneByOne {
 public:
  explicit Watched(LawPtr law) : OneByOne(std::move(law)) {}
  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override {
    {
      const std::lock_guard lock(lock_);
      callers_.insert(std::this_thread::get_id());
    }
    return OneByOne::update(in, out);
  }
  std::size_t callers() const { return callers_.size(); }

 private:
  mutable std::mutex lock_;
  mutable std::set<std::thread::id> callers_;
};

struct WatchedInOrder final : Watched, CallsInOrder {
  using Watched::Watched;
  bool needs_order() const override { return true; }
};

// 2500 points.  A law of which nothing is known is called by all threads, and each of them leaves the bits that one
// thread leaves; a law that needs its calls in order is called by one.
TEST(OneByOne, GoesOnThreadsWithTheSameBits) {
  static const Catalogue catalogue = app::full_catalogue();
  const std::string text = punch(25, 25, test::Cell::quad8, 2);
  struct Ran {
    LastState last;
    std::size_t callers;
  };
  const auto ran = [&]<class WatchedLaw>(std::type_identity<WatchedLaw>, int threads, bool keep_matrices) {
    Model model = build_model(read_deck_text(text, "punch.dat", load_layout("sage1")), catalogue);
    auto watched = std::make_unique<WatchedLaw>(std::move(model.materials[0].law));
    const WatchedLaw& law = *watched;
    model.materials[0].law = std::move(watched);
    RunSettings settings;
    settings.choose_solver = choose_solver;
    settings.threads = threads;
    settings.skips.factors = keep_matrices;
    Ran result;
    Observer* observers[] = {&result.last};
    EXPECT_EQ(run(model, catalogue, settings, observers).status, RunStatus::completed);
    result.callers = law.callers();
    return result;
  };
  const Ran one = ran(std::type_identity<Watched>{}, 1, true);
  EXPECT_EQ(one.callers, 1u);
  EXPECT_GT(std::ranges::count(one.last.points.status, PointStatus::yielded), 0);
  for (const bool keep : {true, false}) {
    const Ran alone = keep ? one : ran(std::type_identity<Watched>{}, 1, false);
    for (const int threads : {2, 3}) {
      const Ran several = ran(std::type_identity<Watched>{}, threads, keep);
      EXPECT_GT(several.callers, 1u) << keep;
      EXPECT_TRUE(several.last.u == alone.last.u) << keep;
      EXPECT_TRUE(several.last.points.sigma == alone.last.points.sigma) << keep;
      EXPECT_TRUE(several.last.points.h == alone.last.points.h) << keep;
    }
  }
  EXPECT_EQ(ran(std::type_identity<WatchedInOrder>{}, 3, true).callers, 1u);
}

// Elements with more dofs or points than there is room for go one by one, although they offer four: quad25 has 50 and
// 25.  The same bits as from elements that offer nothing.
TEST(ByFour, LargeElementsGoOneByOneWhateverTheyOffer) {
  static const Catalogue catalogue = app::full_catalogue();
  const std::string text = punch(2, 2, test::Cell::quad8, 7);
  Model model = build_model(read_deck_text(text, "punch.dat", load_layout("sage1")), catalogue);
  Group& group = model.groups.front();
  group.element = std::make_shared<test::OffersFour>(group.element);
  GroupData data(group);
  data.law = model.materials[0].law_ref();
  EXPECT_EQ(group.element->traits().dofs, 50);
  find_fours(data);
  ASSERT_FALSE(data.four_abreast());
  const LastState own = solve(text, How::by_itself, true);
  const LastState offered = solve(text, How::by_itself, true, 1, true);
  EXPECT_EQ(offered.u, own.u);
  EXPECT_EQ(offered.points.sigma, own.points.sigma);
}

// More elements than one thread takes, and a last four that is not full: the same bits, matrices kept or not.
TEST(ByFour, GivesTheSameBitsOnAnyNumberOfThreads) {
  const std::string text = punch(31, 27, test::Cell::quad4, 1);
  for (const bool keep : {true, false}) {
    const LastState one = solve(text, How::by_itself, keep);
    ASSERT_GT(one.iterations, 6);
    EXPECT_GT(std::ranges::count(one.points.status, PointStatus::yielded), 0);
    EXPECT_GT(std::ranges::count(one.points.status, PointStatus::elastic), 0);
    for (const int threads : {2, 3, 4}) {
      SCOPED_TRACE(std::to_string(threads) + " threads");
      const LastState several = solve(text, How::by_itself, keep, threads);
      EXPECT_EQ(several.iterations, one.iterations);
      EXPECT_EQ(several.u, one.u);
      EXPECT_EQ(several.points.sigma, one.points.sigma);
      EXPECT_EQ(several.points.eps, one.points.eps);
      EXPECT_EQ(several.points.h, one.points.h);
      EXPECT_EQ(several.points.status, one.points.status);
    }
  }
}

}  // namespace
}  // namespace sage
