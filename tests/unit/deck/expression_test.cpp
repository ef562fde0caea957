#include "sage/deck/expression.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sage {
namespace {

// Fields: a.n = 3, a.name = "plane", bare x = 7, list = 10 20 30.
class Fields : public ExpressionScope {
 public:
  ExpressionValue value_of(const ExpressionNode& node, double operand) const override {
    using Kind = ExpressionNode::Kind;
    if (node.kind == Kind::item) return {operand >= 1.0 && operand <= 3.0 ? 10.0 * operand : NAN, {}};
    if (node.kind == Kind::sum_first) return {5.0 * operand * (operand + 1.0), {}};
    if (node.kind == Kind::order) return {4.0, {}};
    if (node.kind == Kind::index) return {2.0, {}};
    if (node.kind == Kind::count) return {9.0, {}};
    if (node.field == 1) return {0.0, "plane"};
    return {node.card == 0 ? 3.0 : 7.0, node.card == 0 ? "3" : "7"};
  }
};

Expression compiled(const std::string& text) {
  return compile_expression(text, [](std::string_view card, std::string_view field, ExpressionNode& node) {
    node.card = card == "a" || card == "C-3.L3" ? 0 : 1;
    node.field = field == "name" ? 1 : 0;
    node.words = field == "name";
    if (field == "unknown" || field == "pi" || field == "order" || field == "index")
      throw ExpressionError("no such field");
  });
}

double value(const std::string& text) {
  const Expression expression = compiled(text);
  const ExpressionResult result = evaluate(expression, Fields());
  EXPECT_EQ(result.fault, nullptr) << text;
  return result.value.number;
}

std::string fault(const std::string& text) {
  const Expression expression = compiled(text);
  const ExpressionResult result = evaluate(expression, Fields());
  return result.fault ? result.fault : "";
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

// Values from the C library, or by hand.
TEST(Expression, DivisionAndFunctions) {
  EXPECT_EQ(value("x / 2 / 7"), 0.5);
  EXPECT_EQ(value("6 - x / (a.n + 4) * -2"), 8.0);
  EXPECT_EQ(value("sqrt(a.n * a.n)"), 3.0);
  EXPECT_EQ(value("sin(pi / 6)"), std::sin(std::acos(-1.0) / 6.0));
  EXPECT_EQ(value("cos(1) + tan(1) + asin(.5) + acos(.5) + atan(2)"),
            std::cos(1.0) + std::tan(1.0) + std::asin(0.5) + std::acos(0.5) + std::atan(2.0));
  EXPECT_EQ(value("atan2(1, -1)"), std::atan2(1.0, -1.0));
  EXPECT_EQ(value("exp(2) - log(5)"), std::exp(2.0) - std::log(5.0));
  EXPECT_EQ(value("abs(-4) + min(3, x, 2) + max(1, 2, x)"), 13.0);
  EXPECT_EQ(value("floor(11 / 10) + 100 * mod(11, 10) + 1000 * mod(-1, 4)"), 3101.0);
  EXPECT_EQ(value("1.5e1"), 15.0);
}

TEST(Expression, IfTakesOneOfTwo) {
  EXPECT_EQ(value("if(a.n == 3, 10, 20)"), 10.0);
  EXPECT_EQ(value("if(a.n > 3, 10, if(x == 7, 30, 40)) + 1"), 31.0);
  const Expression text = compiled("if(x == 7, 'seven', 'other')");
  EXPECT_TRUE(text.words);
  EXPECT_EQ(evaluate(text, Fields()).value.text, "seven");
}

TEST(Expression, PlacesAndSums) {
  EXPECT_EQ(value("order"), 4.0);
  EXPECT_EQ(value("index * item(x, 3)"), 60.0);
  EXPECT_EQ(value("sum(x, index)"), 30.0);
  EXPECT_EQ(value("sum(a.n)"), 3.0);
  EXPECT_EQ(value("count(a) + count([C-3.L3])"), 18.0);
}

TEST(Expression, WhatHasNoValueIsAFault) {
  EXPECT_EQ(fault("1 / (x - 7)"), "division by zero");
  EXPECT_EQ(fault("mod(x, 0)"), "division by zero");
  EXPECT_EQ(fault("sqrt(-x)"), "the square root of a negative number");
  EXPECT_EQ(fault("log(0)"), "the logarithm of a number not above zero");
  EXPECT_EQ(fault("asin(2)"), "the arc sine of a number beyond 1");
  EXPECT_EQ(fault("exp(1000)"), "the result is too large for a number");
  EXPECT_EQ(fault("item(x, 4)"), "the list has no such place");
  // What isn't needed can't be at fault.
  EXPECT_EQ(fault("if(x == 7, 1, 1 / 0)"), "");
  EXPECT_EQ(fault("x == 0 and 1 / 0 > 1"), "");
  EXPECT_EQ(fault("x == 7 or 1 / 0 > 1"), "");
  EXPECT_EQ(fault("if(1 / 0, 1, 2)"), "division by zero");
}

TEST(Expression, TextIsNoNumber) {
  for (const char* text : {"a.name + 1", "sqrt(a.name)", "-'x'", "if(a.name, 1, 2)", "if(x, 'a', 1)",
                           "a.name < 3", "sum(a.name)", "item(x, 'a')", "a.name and x"})
    EXPECT_THROW(compiled(text), ExpressionError) << text;
}

TEST(Expression, MistakesAreErrors) {
  for (const char* text : {"sqrt()", "sqrt(1, 2)", "if(1, 2)", "nonsense(1)", "item(x)", "blank(x, 1)", "min(1",
                           "count()", "count(", "x /", "atan2(1)"})
    EXPECT_THROW(value(text), ExpressionError) << text;

  for (const char* text :
       {"", "a.", "a.n +", "(a.n", "a.n a.n", "'open", "1 & 2", "a.unknown", "[x.n", "a.n == "})
    EXPECT_THROW(value(text), ExpressionError) << text;
  EXPECT_THROW(value(std::string(1000, '(') + "1" + std::string(1000, ')')), ExpressionError);
}

}  // namespace
}  // namespace sage
