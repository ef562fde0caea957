// Small expressions of a layout: "control.nodes", "yield / sqrt(3)", "if(type == 'plane', 1, 2)".
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace sage {

struct ExpressionNode {
  enum class Kind {
    number,
    text,
    // What a scope gives: of the field, of the card, or of the card whose expression it is.
    field,      // the field of the latest card of this kind
    blank,      // 1 where that field is left blank
    previous,   // the field on the card of this kind before the latest
    sum,        // the field summed over all cards of this kind so far, lists and all
    count,      // cards of this kind so far
    order,      // number of the card whose expression it is among its kind, from 1
    index,      // place in the list whose values are computed, from 1
    item,       // one value of a list; takes its place
    sum_first,  // the sum of so many first values of a list; takes their number
    // What needs only its operands.
    negate,
    add,
    subtract,
    multiply,
    divide,
    equal,
    unequal,
    less,
    less_equal,
    greater,
    greater_equal,
    both,
    either,
    choose,  // if(condition, a, b)
    square_root,
    sine,
    cosine,
    tangent,
    arc_sine,
    arc_cosine,
    arc_tangent,
    arc_tangent2,
    absolute,
    smaller,
    larger,
    exponential,
    logarithm,
    round_down,
    remainder
  };
  Kind kind = Kind::number;
  double number = 0.0;
  std::string text;  // of a quoted text
  int card = -1;     // of a field: index into the layout's cards
  int field = -1;
  bool words = false;  // the field holds characters and no number
};

// What an operand gives: a number, and the trimmed characters if it was a field or a quoted text.
struct ExpressionValue {
  double number = 0.0;
  std::string_view text;
};

class ExpressionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Expression {
  std::string source;
  std::vector<ExpressionNode> nodes;  // reverse Polish
  int line = 0;                       // of the layout file
  bool words = false;                 // gives characters and no number
  bool empty() const { return nodes.empty(); }
};

// Finds "card.field" or a bare "field"; fills card, field and words of the node or throws ExpressionError.
// Without a field the card alone is meant, without both the one whose expression it is.
using FieldResolver = std::function<void(std::string_view card, std::string_view field, ExpressionNode& node)>;

// Names may hold letters, digits, "_" and "-" inside the card part when written as [C-3.L3].limit.
// Throws ExpressionError, also for characters where a number is needed.
Expression compile_expression(std::string_view text, const FieldResolver& resolve);

// Where the values of fields and cards come from.
class ExpressionScope {
 public:
  virtual ~ExpressionScope() = default;
  // Of a node up to Kind::sum_first; `operand`: what an item or sum_first takes.
  virtual ExpressionValue value_of(const ExpressionNode& node, double operand) const = 0;
};

struct ExpressionResult {
  ExpressionValue value;
  const char* fault = nullptr;  // "division by zero": there is no value; nullptr = there is one
  double fault_number = 0.0;    // the operand to blame
};

// Allocates nothing.  What `if`, `and` and `or` don't need can't be at fault.
ExpressionResult evaluate(const Expression& expression, const ExpressionScope& scope);

}  // namespace sage
