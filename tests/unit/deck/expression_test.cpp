#include "sage/deck/expression.hpp"

#include <gtest/gtest.h>

namespace sage {
namespace {

// Fields: a.n = 3, a.name = "plane", bare x = 7.
double value(const std::string& text) {
  const Expression expression =
      compile_expression(text, [](std::string_view card, std::string_view field, ExpressionNode& node) {
        node.card = card == "a" || card == "C-3.L3" ? 0 : 1;
        node.field = field == "name" ? 1 : 0;
        if (field == "unknown") throw ExpressionError("no such field");
      });
  return evaluate(expression, [](int card, int field) {
    if (field == 1) return ExpressionValue{0.0, "plane"};
    return ExpressionValue{card == 0 ? 3.0 : 7.0, card == 0 ? "3" : "7"};
  });
}

TEST(Expression, Arithmetic) {
  EXPECT_EQ(value("a.n + 1"), 4.0);
  EXPECT_EQ(value("2*a.n - x*(a.n - 1)"), -8.0);
  EXPECT_EQ(value("-a.n + 10"), 7.0);
  EXPECT_EQ(value("[C-3.L3].n"), 3.0);
}

TEST(Expression, ComparisonsAndLogic) {
  EXPECT_EQ(value("a.n == 3 and x > 7"), 0.0);
  EXPECT_EQ(value("a.n == 3 or x > 7"), 1.0);
  EXPECT_EQ(value("a.n != 3"), 0.0);
  EXPECT_EQ(value("x >= 7 and a.n <= 3 and a.n < x"), 1.0);
  EXPECT_EQ(value("a.name == 'plane'"), 1.0);
  EXPECT_EQ(value("'axisymmetric' == a.name"), 0.0);
}

TEST(Expression, MistakesAreErrors) {
  for (const char* text :
       {"", "a.", "a.n +", "(a.n", "a.n a.n", "'open", "1 & 2", "a.unknown", "[x.n", "a.n == "})
    EXPECT_THROW(value(text), ExpressionError) << text;
  EXPECT_THROW(value(std::string(1000, '(') + "1" + std::string(1000, ')')), ExpressionError);
}

}  // namespace
}  // namespace sage
