// Small expressions of a layout: "control.nodes", "mesh.columns + 1", "type == 'plane'".
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
    field,
    negate,
    add,
    subtract,
    multiply,
    equal,
    unequal,
    less,
    less_equal,
    greater,
    greater_equal,
    both,
    either
  };
  Kind kind = Kind::number;
  double number = 0.0;
  std::string text;  // of a quoted text
  int card = -1;     // of a field: index into the layout's cards
  int field = -1;
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
  bool empty() const { return nodes.empty(); }
};

// Finds "card.field" or a bare "field"; fills card and field of the node or throws ExpressionError.
using FieldResolver = std::function<void(std::string_view card, std::string_view field, ExpressionNode& node)>;

// Names may hold letters, digits, "_" and "-" inside the card part when written as [C-3.L3].limit.
Expression compile_expression(std::string_view text, const FieldResolver& resolve);

// `value_of` gives the value of a field node.
double evaluate(const Expression& expression,
                const std::function<ExpressionValue(int card, int field)>& value_of);

}  // namespace sage
