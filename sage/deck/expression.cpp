#include "sage/deck/expression.hpp"

#include <array>
#include <charconv>

#include "sage/deck/text.hpp"

namespace sage {

namespace {

using Kind = ExpressionNode::Kind;

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
constexpr int max_depth = 50;

// Precedence from weak to strong: or, and, comparison, + -, *, operand.
class ExpressionParser {
 public:
  ExpressionParser(std::string_view text, const FieldResolver& resolve) : text_(text), resolve_(resolve) {}

  Expression parse() {
    either();
    skip();
    if (at_ != text_.size()) fail("unexpected \"" + std::string(text_.substr(at_, 1)) + "\"");
    expression_.source = std::string(text_);
    return std::move(expression_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw ExpressionError(message + " in \"" + std::string(text_) + "\"");
  }
  void skip() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }
  bool take(std::string_view token) {
    skip();
    if (text_.substr(at_, token.size()) != token) return false;
    at_ += token.size();
    return true;
  }
  bool take_word(std::string_view word) {
    skip();
    const std::size_t end = at_ + word.size();
    if (text_.substr(at_, word.size()) != word || (end < text_.size() && is_letter(text_[end]))) return false;
    at_ = end;
    return true;
  }
  ExpressionNode& add(Kind kind) {
    expression_.nodes.push_back({});
    expression_.nodes.back().kind = kind;
    return expression_.nodes.back();
  }

  void either() {
    both();
    while (take_word("or")) {
      both();
      add(Kind::either);
    }
  }
  void both() {
    comparison();
    while (take_word("and")) {
      comparison();
      add(Kind::both);
    }
  }
  void comparison() {
    sum();
    static constexpr std::array<std::pair<std::string_view, Kind>, 6> operators{{{"==", Kind::equal},
                                                                                 {"!=", Kind::unequal},
                                                                                 {"<=", Kind::less_equal},
                                                                                 {">=", Kind::greater_equal},
                                                                                 {"<", Kind::less},
                                                                                 {">", Kind::greater}}};
    for (const auto& [token, kind] : operators)
      if (take(token)) {
        sum();
        add(kind);
        return;
      }
  }
  void sum() {
    product();
    for (;;) {
      if (take("+")) {
        product();
        add(Kind::add);
      } else if (take("-")) {
        product();
        add(Kind::subtract);
      } else {
        return;
      }
    }
  }
  void product() {
    operand();
    while (take("*")) {
      operand();
      add(Kind::multiply);
    }
  }
  void operand() {
    if (++depth_ > max_depth) fail("nested too deeply");
    skip();
    const char c = at_ < text_.size() ? text_[at_] : '\0';
    if (take("(")) {
      either();
      if (!take(")")) fail("\")\" is missing");
    } else if (take("-")) {
      operand();
      add(Kind::negate);
    } else if (is_digit(c)) {
      number();
    } else if (c == '\'') {
      quoted();
    } else if (is_letter(c) || c == '[') {
      field();
    } else {
      fail("a number or a field was expected");
    }
    --depth_;
  }
  void number() {
    double value = 0.0;
    const auto outcome = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    at_ = static_cast<std::size_t>(outcome.ptr - text_.data());
    add(Kind::number).number = value;
  }
  void quoted() {
    const std::size_t end = text_.find('\'', at_ + 1);
    if (end == std::string_view::npos) fail("the closing quote is missing");
    add(Kind::text).text = std::string(text_.substr(at_ + 1, end - at_ - 1));
    at_ = end + 1;
  }
  std::string_view name() {
    const std::size_t first = at_;
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]))) ++at_;
    return text_.substr(first, at_ - first);
  }
  void field() {
    std::string_view card, field;
    if (text_[at_] == '[') {
      const std::size_t end = text_.find(']', at_);
      if (end == std::string_view::npos) fail("\"]\" is missing");
      card = text_.substr(at_ + 1, end - at_ - 1);
      at_ = end + 1;
      if (!take(".")) fail("\".\" and a field are missing after the card");
      field = name();
    } else {
      field = name();
      if (at_ < text_.size() && text_[at_] == '.') {
        card = field;
        ++at_;
        field = name();
      }
    }
    if (field.empty()) fail("a field's name is missing");
    resolve_(card, field, add(Kind::field));
  }

  std::string_view text_;
  const FieldResolver& resolve_;
  std::size_t at_ = 0;
  int depth_ = 0;
  Expression expression_;
};

struct Operand {
  ExpressionValue value;
  bool quoted = false;
};

bool same(const Operand& a, const Operand& b) {
  return a.quoted || b.quoted ? a.value.text == b.value.text : a.value.number == b.value.number;
}

double combine(Kind kind, const Operand& a, const Operand& b) {
  const double x = a.value.number, y = b.value.number;
  // clang-format off
  switch (kind) {
    case Kind::add: return x + y;
    case Kind::subtract: return x - y;
    case Kind::multiply: return x * y;
    case Kind::equal: return same(a, b);
    case Kind::unequal: return !same(a, b);
    case Kind::less: return x < y;
    case Kind::less_equal: return x <= y;
    case Kind::greater: return x > y;
    case Kind::greater_equal: return x >= y;
    case Kind::both: return x != 0.0 && y != 0.0;
    case Kind::either: return x != 0.0 || y != 0.0;
    default: return 0.0;
  }
  // clang-format on
}

}  // namespace

Expression compile_expression(std::string_view text, const FieldResolver& resolve) {
  return ExpressionParser(text, resolve).parse();
}

double evaluate(const Expression& expression,
                const std::function<ExpressionValue(int card, int field)>& value_of) {
  std::vector<Operand> stack;
  for (const ExpressionNode& node : expression.nodes) {
    if (node.kind == Kind::number) {
      stack.push_back({{node.number, {}}, false});
    } else if (node.kind == Kind::text) {
      stack.push_back({{0.0, node.text}, true});
    } else if (node.kind == Kind::field) {
      stack.push_back({value_of(node.card, node.field), false});
    } else if (node.kind == Kind::negate) {
      stack.back().value.number = -stack.back().value.number;
    } else {
      const Operand b = stack.back();
      stack.pop_back();
      stack.back() = {{combine(node.kind, stack.back(), b), {}}, false};
    }
  }
  return stack.empty() ? 0.0 : stack.back().value.number;
}

}  // namespace sage
