#include "sage/deck/expression.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "sage/deck/text.hpp"

namespace sage {

namespace {

using Kind = ExpressionNode::Kind;

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
constexpr int max_depth = 50;
constexpr std::size_t most_operands = 64;  // that wait for their operators

struct Function {
  std::string_view name;
  Kind kind;
  int operands;
};
constexpr std::array<Function, 14> functions{{{"if", Kind::choose, 3},
                                              {"sqrt", Kind::square_root, 1},
                                              {"sin", Kind::sine, 1},
                                              {"cos", Kind::cosine, 1},
                                              {"tan", Kind::tangent, 1},
                                              {"asin", Kind::arc_sine, 1},
                                              {"acos", Kind::arc_cosine, 1},
                                              {"atan", Kind::arc_tangent, 1},
                                              {"atan2", Kind::arc_tangent2, 2},
                                              {"abs", Kind::absolute, 1},
                                              {"exp", Kind::exponential, 1},
                                              {"log", Kind::logarithm, 1},
                                              {"floor", Kind::round_down, 1},
                                              {"mod", Kind::remainder, 2}}};

// Precedence from weak to strong: or, and, comparison, + -, * /, operand.
class ExpressionParser {
 public:
  ExpressionParser(std::string_view text, const FieldResolver& resolve) : text_(text), resolve_(resolve) {}

  Expression parse() {
    either();
    skip();
    if (at_ != text_.size()) fail("unexpected \"" + std::string(text_.substr(at_, 1)) + "\"");
    expression_.source = std::string(text_);
    expression_.words = words_.back();
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
  ExpressionNode& push(Kind kind) {
    if (words_.size() == most_operands) fail("too many values at once");
    words_.push_back(false);
    expression_.nodes.push_back({});
    expression_.nodes.back().kind = kind;
    return expression_.nodes.back();
  }
  // The operator of the values read last; all must be numbers unless it compares.
  void add(Kind kind, std::size_t operands = 2) {
    const bool first = words_[words_.size() - operands], last = words_.back();
    const bool compares = kind == Kind::equal || kind == Kind::unequal;
    bool words = false;
    if (kind == Kind::choose) {
      words = last;
      if (first) fail("the condition of if(...) is a text");
      if (words_[words_.size() - 2] != last) fail("if(...) gives a text or a number, not one of each");
    } else if (!compares && (first || last)) {
      fail("a text stands where a number is needed");
    }
    words_.resize(words_.size() - operands);
    push(kind);
    words_.back() = words;
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
    for (;;) {
      if (take("*")) {
        operand();
        add(Kind::multiply);
      } else if (take("/")) {
        operand();
        add(Kind::divide);
      } else {
        return;
      }
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
      add(Kind::negate, 1);
    } else if (is_digit(c) || c == '.') {
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
    if (outcome.ec != std::errc()) fail("a number was expected");
    at_ = static_cast<std::size_t>(outcome.ptr - text_.data());
    push(Kind::number).number = value;
  }
  void quoted() {
    const std::size_t end = text_.find('\'', at_ + 1);
    if (end == std::string_view::npos) fail("the closing quote is missing");
    push(Kind::text).text = std::string(text_.substr(at_ + 1, end - at_ - 1));
    words_.back() = true;
    at_ = end + 1;
  }
  std::string_view name() {
    const std::size_t first = at_;
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]))) ++at_;
    return text_.substr(first, at_ - first);
  }
  // "card.field", "[odd-name].field" or "field".
  std::pair<std::string_view, std::string_view> field_name() {
    std::string_view card, field;
    skip();
    if (at_ < text_.size() && text_[at_] == '[') {
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
    return {card, field};
  }
  void field() {
    const auto [card, field] = field_name();
    if (card.empty() && at_ < text_.size() && text_[at_] == '(') return function(field);
    if (card.empty() && constant(field)) return;
    ExpressionNode& node = push(Kind::field);
    resolve_(card, field, node);
    words_.back() = node.words;
  }
  bool is_field(std::string_view name) const {
    ExpressionNode ignored;
    try {
      resolve_({}, name, ignored);
    } catch (const ExpressionError&) {
      return false;
    }
    return true;
  }
  // Words with a meaning of their own, unless a field has that name.
  bool constant(std::string_view name) {
    if ((name != "pi" && name != "order" && name != "index") || is_field(name)) return false;
    if (name == "pi") push(Kind::number).number = std::numbers::pi;
    if (name == "index") push(Kind::index);
    if (name == "order") resolve_({}, {}, push(Kind::order));
    return true;
  }
  void close() {
    if (!take(")")) fail("\")\" is missing");
  }
  void function(std::string_view name) {
    ++at_;
    if (name == "max" || name == "min") return extreme(name == "max" ? Kind::larger : Kind::smaller);
    if (name == "sum" || name == "item" || name == "blank" || name == "previous") return of_field(name);
    if (name == "count") return count();
    for (const Function& one : functions) {
      if (one.name != name) continue;
      for (int i = 0; i < one.operands; ++i) {
        if (i > 0 && !take(","))
          fail(std::string(name) + "(...) takes " + std::to_string(one.operands) + " values");
        either();
      }
      close();
      return add(one.kind, static_cast<std::size_t>(one.operands));
    }
    fail("there is no function \"" + std::string(name) + "\"");
  }
  void extreme(Kind kind) {
    either();
    while (take(",")) {
      either();
      add(kind);
    }
    close();
  }
  // sum(field), sum(list, n), item(list, n), blank(field), previous(field).
  void of_field(std::string_view name) {
    const auto [card, field] = field_name();
    ExpressionNode node;
    if (name == "previous") node.kind = Kind::previous;
    resolve_(card, field, node);
    const bool operand = take(",");
    if (operand) {
      either();
      if (words_.back()) fail("a text stands where a number is needed");
      words_.pop_back();
    }
    if (operand ? name != "sum" && name != "item" : name == "item")
      fail(std::string(name) + (name == "item" ? "(...) takes a list and a place" : "(...) takes one field"));
    close();
    node.kind = name == "sum"     ? (operand ? Kind::sum_first : Kind::sum)
                : name == "item"  ? Kind::item
                : name == "blank" ? Kind::blank
                                  : Kind::previous;
    const bool gives_words = node.words && (name == "item" || name == "previous");
    if (node.words && name == "sum") fail("a text stands where a number is needed");
    push(node.kind) = node;
    words_.back() = gives_words;
  }
  void count() {
    skip();
    std::string_view card;
    if (at_ < text_.size() && text_[at_] == '[') {
      const std::size_t end = std::min(text_.find(']', at_), text_.size());
      card = text_.substr(at_ + 1, end - at_ - 1);
      at_ = std::min(end + 1, text_.size());
    } else {
      card = name();
    }
    if (card.empty()) fail("count(...) takes a card");
    resolve_(card, {}, push(Kind::count));
    close();
  }

  std::string_view text_;
  const FieldResolver& resolve_;
  std::size_t at_ = 0;
  int depth_ = 0;
  Expression expression_;
  std::vector<bool> words_;  // of the values that wait for their operators: which are characters
};

// Without initial values, so that a stack of them costs nothing.
struct Operand {
  double number;
  const char* text;
  std::size_t text_size;
  const char* fault;
  double fault_number;
  bool quoted;
};

Operand plain(double number) {
  return {number, nullptr, 0, nullptr, 0.0, false};
}
Operand faulty(const char* fault, double number) {
  return {0.0, nullptr, 0, fault, number, false};
}
Operand read(const ExpressionValue& value, bool quoted) {
  return {value.number, value.text.data(), value.text.size(), nullptr, 0.0, quoted};
}
std::string_view text_of(const Operand& operand) {
  return {operand.text, operand.text_size};
}

bool same(const Operand& a, const Operand& b) {
  return a.quoted || b.quoted ? text_of(a) == text_of(b) : a.number == b.number;
}

// Of one operand; a text where there is no value.
Operand applied(Kind kind, double x) {
  // clang-format off
  switch (kind) {
    case Kind::negate: return plain(-x);
    case Kind::square_root: return x < 0.0 ? faulty("the square root of a negative number", x) : plain(std::sqrt(x));
    case Kind::sine: return plain(std::sin(x));
    case Kind::cosine: return plain(std::cos(x));
    case Kind::tangent: return plain(std::tan(x));
    case Kind::arc_sine: return std::abs(x) > 1.0 ? faulty("the arc sine of a number beyond 1", x) : plain(std::asin(x));
    case Kind::arc_cosine: return std::abs(x) > 1.0 ? faulty("the arc cosine of a number beyond 1", x) : plain(std::acos(x));
    case Kind::arc_tangent: return plain(std::atan(x));
    case Kind::absolute: return plain(std::abs(x));
    case Kind::exponential: return plain(std::exp(x));
    case Kind::logarithm: return x > 0.0 ? plain(std::log(x)) : faulty("the logarithm of a number not above zero", x);
    default: return plain(std::floor(x));
  }
  // clang-format on
}

Operand combine(Kind kind, const Operand& a, const Operand& b) {
  const double x = a.number, y = b.number;
  if (kind == Kind::both && !a.fault && x == 0.0) return plain(0.0);
  if (kind == Kind::either && !a.fault && x != 0.0) return plain(1.0);
  if (a.fault) return a;
  if (b.fault) return b;
  // clang-format off
  switch (kind) {
    case Kind::add: return plain(x + y);
    case Kind::subtract: return plain(x - y);
    case Kind::multiply: return plain(x * y);
    case Kind::divide: return y == 0.0 ? faulty("division by zero", x) : plain(x / y);
    case Kind::remainder: return y == 0.0 ? faulty("division by zero", x) : plain(x - y * std::floor(x / y));
    case Kind::arc_tangent2: return plain(std::atan2(x, y));
    case Kind::smaller: return plain(std::min(x, y));
    case Kind::larger: return plain(std::max(x, y));
    case Kind::equal: return plain(same(a, b));
    case Kind::unequal: return plain(!same(a, b));
    case Kind::less: return plain(x < y);
    case Kind::less_equal: return plain(x <= y);
    case Kind::greater: return plain(x > y);
    case Kind::greater_equal: return plain(x >= y);
    case Kind::both: return plain(x != 0.0 && y != 0.0);
    case Kind::either: return plain(x != 0.0 || y != 0.0);
    default: return plain(0.0);
  }
  // clang-format on
}

bool takes_one(Kind kind) {
  switch (kind) {
    case Kind::negate:
    case Kind::square_root:
    case Kind::sine:
    case Kind::cosine:
    case Kind::tangent:
    case Kind::arc_sine:
    case Kind::arc_cosine:
    case Kind::arc_tangent:
    case Kind::absolute:
    case Kind::exponential:
    case Kind::logarithm:
    case Kind::round_down:
      return true;
    default:
      return false;
  }
}

}  // namespace

Expression compile_expression(std::string_view text, const FieldResolver& resolve) {
  return ExpressionParser(text, resolve).parse();
}

ExpressionResult evaluate(const Expression& expression, const ExpressionScope& scope) {
  std::array<Operand, most_operands> stack;  // NOLINT: filled as far as it is used
  std::size_t size = 0;
  for (const ExpressionNode& node : expression.nodes) {
    if (node.kind == Kind::number) {
      stack[size++] = plain(node.number);
    } else if (node.kind == Kind::text) {
      stack[size++] = read({0.0, node.text}, true);
    } else if (node.kind == Kind::item || node.kind == Kind::sum_first) {
      Operand& top = stack[size - 1];
      if (!top.fault) top = read(scope.value_of(node, top.number), node.words);
      if (!top.fault && std::isnan(top.number)) top = faulty("the list has no such place", 0.0);
    } else if (node.kind < Kind::negate) {
      stack[size++] = read(scope.value_of(node, 0.0), node.words);
    } else if (takes_one(node.kind)) {
      Operand& top = stack[size - 1];
      if (!top.fault) top = applied(node.kind, top.number);
    } else if (node.kind == Kind::choose) {
      size -= 2;
      const Operand& condition = stack[size - 1];
      if (!condition.fault) stack[size - 1] = stack[condition.number != 0.0 ? size : size + 1];
    } else {
      --size;
      stack[size - 1] = combine(node.kind, stack[size - 1], stack[size]);
    }
  }
  if (size == 0) return {};
  const Operand& top = stack[0];
  if (!top.fault && !std::isfinite(top.number)) return {{}, "the result is too large for a number", 0.0};
  return {{top.number, text_of(top)}, top.fault, top.fault_number};
}

}  // namespace sage
