#include "sage/sweep/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <utility>

#include "sage/deck/source.hpp"
#include "sage/deck/toml_file.hpp"
#include "sage/sweep/draws.hpp"

namespace sage::sweep {

namespace {

using Value = std::variant<double, std::string>;

constexpr double kAsInDeck = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMostCases = 10'000'000;

bool before(const toml::node& a, const toml::node& b) {
  const toml::source_position x = a.source().begin, y = b.source().begin;
  return x.line != y.line ? x.line < y.line : x.column < y.column;
}

// What varies together: names, and rows of their values.
struct Block {
  std::vector<std::string> names;
  std::vector<std::vector<Value>> rows;
};

class StudyReader : private TomlFile {
 public:
  StudyReader(const toml::table& root, const std::string& file) : TomlFile(file, "S732"), root_(root) {}

  Study read();

 private:
  // A name with what the file gives for it.  Tables within tables are parts of names.
  struct Named {
    std::string name;
    const toml::node* node;
  };

  [[noreturn]] void wrong(const toml::node& node, const std::string& message) const {
    fail("S732", node, message);
  }
  double number(const toml::node& node, const std::string& name) const;
  Value value(const toml::node& node, const std::string& name) const;
  const toml::table* table(const char* key) const;
  void gather(const toml::table& table, const std::string& prefix, std::vector<Named>& out) const;
  std::vector<Named> names_in(const toml::table& table) const;
  void claim(const Named& one);
  std::vector<Value> list(const Named& one) const;
  std::vector<Value> range(const toml::table& table, const std::string& name) const;
  std::vector<Block> grid();
  void pairs(std::vector<Block>& blocks);
  void random(std::vector<Block>& blocks);
  Distribution distribution(const Named& one) const;
  std::optional<Vector2> correlation_length(const Named& one) const;
  void add_draws(Block& block, const std::vector<FieldVariable>& variables, const Eigen::MatrixXd& matrix,
                 int draws, int seed);
  Eigen::MatrixXd correlation(const toml::node* node, const std::vector<std::string>& names) const;
  void multiply(const std::vector<Block>& blocks);
  void single_cases();
  void failure();
  std::vector<std::string> texts(const char* key) const;

  const toml::table& root_;
  Study study_;
  std::set<std::string> claimed_;
  std::vector<std::string> field_names_;
};

double StudyReader::number(const toml::node& node, const std::string& name) const {
  const std::optional<double> value = node.is_number() ? node.value<double>() : std::nullopt;
  if (!value || !std::isfinite(*value)) wrong(node, name + ": wanted a finite number");
  return *value;
}

Value StudyReader::value(const toml::node& node, const std::string& name) const {
  if (const auto text = node.value_exact<std::string>()) return *text;
  if (!node.is_number()) wrong(node, name + ": wanted a number or a text in quotes");
  return number(node, name);
}

const toml::table* StudyReader::table(const char* key) const {
  const toml::node* node = root_.get(key);
  if (node == nullptr) return nullptr;
  if (!node->is_table()) wrong(*node, fmt::format("\"{}\" must be a table, [{}]", key, key));
  return node->as_table();
}

void StudyReader::gather(const toml::table& table, const std::string& prefix, std::vector<Named>& out) const {
  for (const auto& [key, node] : table) {
    const std::string name = prefix.empty() ? std::string(key.str()) : prefix + "." + std::string(key.str());
    const toml::table* inner = node.as_table();
    if (inner != nullptr && !inner->contains("distribution") && !inner->contains("from"))
      gather(*inner, name, out);
    else
      out.push_back({name, &node});
  }
}

// In the order of the file.
std::vector<StudyReader::Named> StudyReader::names_in(const toml::table& table) const {
  std::vector<Named> names;
  gather(table, "", names);
  std::ranges::stable_sort(names, [](const Named& a, const Named& b) { return before(*a.node, *b.node); });
  return names;
}

// A name has one place in a study.
void StudyReader::claim(const Named& one) {
  if (!claimed_.insert(one.name).second) wrong(*one.node, one.name + " is given in two places of the study");
}

std::vector<Value> StudyReader::range(const toml::table& table, const std::string& name) const {
  known_keys(table, {"from", "to", "count", "log"});
  for (const char* key : {"to", "count"})
    if (!table.contains(key)) wrong(table, fmt::format("{}: \"{}\" is missing", name, key));
  const double from = number(*table.get("from"), name), to = number(*table.get("to"), name);
  const int count = integer(table, "count", 0, 2, 1'000'000);
  const bool logs = flag(table, "log");
  if (logs && !(from > 0.0 && to > 0.0)) wrong(table, name + ": both ends must be above 0 with log = true");
  std::vector<Value> values;
  for (int i = 0; i < count; ++i) {
    const double t = static_cast<double>(i) / (count - 1);
    values.emplace_back(i == count - 1 ? to : logs ? from * std::pow(to / from, t) : from + t * (to - from));
  }
  return values;
}

std::vector<Value> StudyReader::list(const Named& one) const {
  if (const toml::table* inner = one.node->as_table()) return range(*inner, one.name);
  const toml::array* array = one.node->as_array();
  if (array == nullptr || array->empty())
    wrong(*one.node, one.name + ": wanted a list of values, [ ... ], or {from = A, to = B, count = N}");
  std::vector<Value> values;
  for (const toml::node& node : *array) values.push_back(value(node, one.name));
  return values;
}

std::vector<Block> StudyReader::grid() {
  std::vector<Block> blocks;
  if (const toml::table* part = table("grid"))
    for (const Named& one : names_in(*part)) {
      claim(one);
      Block block{{one.name}, {}};
      for (Value& value : list(one)) block.rows.push_back({std::move(value)});
      blocks.push_back(std::move(block));
    }
  return blocks;
}

// Lists of equal length, whose values go together.
void StudyReader::pairs(std::vector<Block>& blocks) {
  const toml::table* part = table("pairs");
  if (part == nullptr) return;
  Block block;
  for (const Named& one : names_in(*part)) {
    claim(one);
    const std::vector<Value> values = list(one);
    if (!block.names.empty() && values.size() != block.rows.size())
      wrong(*one.node, fmt::format("{}: {} values, {} has {}; lists of [pairs] are of one length", one.name,
                                   values.size(), block.names.front(), block.rows.size()));
    block.rows.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) block.rows[i].push_back(values[i]);
    block.names.push_back(one.name);
  }
  if (!block.names.empty()) blocks.push_back(std::move(block));
}

Distribution StudyReader::distribution(const Named& one) const {
  const toml::table* part = one.node->as_table();
  if (part == nullptr || !part->contains("distribution"))
    wrong(*one.node, one.name + ": wanted {distribution = \"normal\", mean = M, sd = S} or the like");
  known_keys(*part, {"distribution", "mean", "sd", "cov", "low", "high", "correlation_length"});
  const std::string shape = text(*part, "distribution", true);
  const auto has = [&](const char* key) { return part->contains(key); };
  const auto get = [&](const char* key) { return number(*part->get(key), one.name + "." + key); };
  Distribution d;
  if (has("low")) d.low = get("low");
  if (has("high")) d.high = get("high");
  if (!(d.low < d.high)) wrong(*part, one.name + ": low must be below high");
  if (shape == "uniform") {
    d.shape = Shape::uniform;
    if (!has("low") || !has("high") || has("mean") || has("sd") || has("cov"))
      wrong(*part, one.name + ": a uniform distribution has low and high");
    return d;
  }
  if (shape != "normal" && shape != "lognormal")
    wrong(*part, one.name + ": the distribution is normal, lognormal or uniform" +
                     did_you_mean(shape, {"normal", "lognormal", "uniform"}));
  if (!has("mean") || has("sd") == has("cov"))
    wrong(*part, fmt::format("{}: a {} distribution has mean and one of sd and cov", one.name, shape));
  d.shape = shape == "normal" ? Shape::normal : Shape::lognormal;
  d.mean = get("mean");
  d.deviation = has("sd") ? get("sd") : get("cov") * std::abs(d.mean);
  if (!(d.deviation > 0.0)) wrong(*part, one.name + ": the standard deviation must be above 0");
  if (d.shape == Shape::lognormal && !(d.mean > 0.0 && d.high > 0.0))
    wrong(*part, one.name + ": a lognormal value is above 0");
  return d;
}

// Of a variable that differs from place to place: one number, or one each in x and y.
std::optional<Vector2> StudyReader::correlation_length(const Named& one) const {
  const toml::node* node = one.node->as_table()->get("correlation_length");
  if (node == nullptr) return {};
  Vector2 length;
  if (const toml::array* both = node->as_array(); both != nullptr && both->size() == 2)
    length = {number((*both)[0], one.name), number((*both)[1], one.name)};
  else
    length.setConstant(number(*node, one.name + ".correlation_length"));
  if (!(length.minCoeff() > 0.0))
    wrong(*node, one.name + ": a correlation length is above 0, or a list of two: in x and in y");
  return length;
}

Eigen::MatrixXd StudyReader::correlation(const toml::node* node, const std::vector<std::string>& names) const {
  const auto count = static_cast<Eigen::Index>(names.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(count, count);
  if (node == nullptr) return matrix;
  const toml::array* rows = node->as_array();
  const std::string wanted =
      fmt::format("correlation: wanted {} rows of {} numbers, in the order of the variables: {}", count, count,
                  fmt::join(names, ", "));
  if (rows == nullptr || rows->size() != names.size()) wrong(*node, wanted);
  for (Eigen::Index i = 0; i < count; ++i) {
    const toml::array* row = (*rows)[i].as_array();
    if (row == nullptr || row->size() != names.size()) wrong(*node, wanted);
    for (Eigen::Index j = 0; j < count; ++j) matrix(i, j) = number((*row)[j], "correlation");
  }
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j <= i; ++j)
      if (matrix(i, j) != matrix(j, i) || (i == j && matrix(i, j) != 1.0) || std::abs(matrix(i, j)) > 1.0)
        wrong(*node, "correlation: the matrix is symmetric, with 1 on its diagonal and no number beyond 1");
  return matrix;
}

void StudyReader::random(std::vector<Block>& blocks) {
  const toml::table* part = table("random");
  if (part == nullptr) return;
  known_keys(*part, {"draws", "seed", "variables", "correlation"});
  for (const char* key : {"draws", "seed", "variables"})
    if (!part->contains(key)) wrong(*part, fmt::format("[random]: \"{}\" is missing", key));
  const int draws = integer(*part, "draws", 0, 1, 1'000'000);
  const int seed = integer(*part, "seed", 0, 0, std::numeric_limits<int>::max());
  const toml::table* variables = part->get("variables")->as_table();
  if (variables == nullptr) wrong(*part->get("variables"), "[random.variables] must be a table");
  Block block;
  std::vector<FieldVariable> all;
  for (const Named& one : names_in(*variables)) {
    claim(one);
    block.names.push_back(one.name);
    const std::optional<Vector2> length = correlation_length(one);
    all.push_back({distribution(one), length.value_or(Vector2::Zero())});
  }
  if (block.names.empty()) wrong(*variables, "[random.variables] names no variable");
  study_.random = block.names;
  try {
    add_draws(block, all, correlation(part->get("correlation"), block.names), draws, seed);
  } catch (const std::invalid_argument& error) {
    wrong(part->contains("correlation") ? *part->get("correlation") : *part, error.what());
  }
  blocks.push_back(std::move(block));
}

// Numbers, and the number of the draw for what differs from place to place (its correlation length is not zero).
void StudyReader::add_draws(Block& block, const std::vector<FieldVariable>& variables,
                            const Eigen::MatrixXd& matrix, int draws, int seed) {
  std::vector<Eigen::Index> kinds[2];  // places of numbers, of fields
  for (std::size_t i = 0; i < variables.size(); ++i)
    kinds[variables[i].correlation_length.isZero(0.0) ? 0 : 1].push_back(static_cast<Eigen::Index>(i));
  for (const Eigen::Index a : kinds[0])
    for (const Eigen::Index b : kinds[1])
      if (matrix(a, b) != 0.0)
        throw std::invalid_argument("a variable with a correlation_length and one without are not correlated");
  std::vector<Distribution> numbers;
  std::vector<FieldVariable> fields;
  for (const Eigen::Index a : kinds[0]) numbers.push_back(variables[a].distribution);
  for (const Eigen::Index b : kinds[1]) fields.push_back(variables[b]);
  const auto wide = static_cast<unsigned long long>(seed);
  const Eigen::MatrixXd values = draw(numbers, matrix(kinds[0], kinds[0]), draws, wide);
  if (!fields.empty())
    study_.fields = std::make_shared<RandomFields>(std::move(fields), matrix(kinds[1], kinds[1]), wide);
  for (int row = 0; row < draws; ++row) {
    std::vector<Value>& one = block.rows.emplace_back(variables.size(), Value(row + 1.0));
    for (std::size_t c = 0; c < kinds[0].size(); ++c)
      one[static_cast<std::size_t>(kinds[0][c])] = values(row, static_cast<Eigen::Index>(c));
  }
  for (std::size_t b = 0; b < kinds[1].size(); ++b)
    field_names_.push_back(block.names[static_cast<std::size_t>(kinds[1][b])]);
}

// Every row of a block with every row of the others; the last one varies first.
void StudyReader::multiply(const std::vector<Block>& blocks) {
  std::size_t count = blocks.empty() ? 0 : 1;
  for (const Block& block : blocks) {
    study_.names.insert(study_.names.end(), block.names.begin(), block.names.end());
    count *= block.rows.size();
    if (count > kMostCases) wrong(root_, fmt::format("the study has more than {} cases", kMostCases));
  }
  for (std::size_t index = 0; index < count; ++index) {
    std::vector<Value> values;
    std::size_t rest = index, below = count;
    for (const Block& block : blocks) {
      below /= block.rows.size();
      const std::vector<Value>& row = block.rows[rest / below];
      values.insert(values.end(), row.begin(), row.end());
      rest %= below;
    }
    study_.cases.push_back(std::move(values));
  }
}

// [[case]]: the names that one does not give are as in the deck.
void StudyReader::single_cases() {
  const toml::node* node = root_.get("case");
  if (node == nullptr) return;
  const toml::array* list = node->as_array();
  if (list == nullptr) wrong(*node, "\"case\" must be tables, [[case]]");
  for (const toml::node& one : *list) {
    if (!one.is_table()) wrong(one, "\"case\" must be tables, [[case]]");
    std::vector<Value> values(study_.names.size(), Value(kAsInDeck));
    for (const Named& named : names_in(*one.as_table())) {
      auto at = static_cast<std::size_t>(std::ranges::find(study_.names, named.name) - study_.names.begin());
      if (at == study_.names.size()) {
        study_.names.push_back(named.name);
        values.emplace_back(kAsInDeck);
      }
      values[at] = value(*named.node, named.name);
    }
    study_.cases.push_back(std::move(values));
  }
  for (std::vector<Value>& values : study_.cases) values.resize(study_.names.size(), Value(kAsInDeck));
}

void StudyReader::failure() {
  const toml::table* part = table("failure");
  if (part == nullptr) return;
  known_keys(*part, {"when", "confidence"});
  const std::string rule = text(*part, "when", true);
  const std::size_t sign = rule.find_first_of("<>");
  FailureRule out;
  try {
    if (sign == std::string::npos) throw std::invalid_argument("");
    std::size_t end = 0;
    out.limit = std::stod(rule.substr(sign + 1), &end);
    if (rule.find_first_not_of(' ', sign + 1 + end) != std::string::npos || !std::isfinite(out.limit))
      throw std::invalid_argument("");
  } catch (const std::exception&) {
    wrong(*part->get("when"), "when: wanted a quantity, < or >, and a number: \"report1.ratio > 1.1\"");
  }
  out.above = rule[sign] == '>';
  out.quantity = rule.substr(0, sign);
  out.quantity.erase(std::remove(out.quantity.begin(), out.quantity.end(), ' '), out.quantity.end());
  if (const toml::node* node = part->get("confidence")) {
    out.confidence = number(*node, "confidence");
    if (!(out.confidence > 0.0 && out.confidence < 1.0))
      wrong(*node, "confidence: wanted a number between 0 and 1");
  }
  study_.failure = out;
}

std::vector<std::string> StudyReader::texts(const char* key) const {
  std::vector<std::string> list;
  const toml::node* node = root_.get(key);
  if (node == nullptr) return list;
  const toml::array* array = node->as_array();
  if (array == nullptr) wrong(*node, fmt::format("\"{}\" must be a list of texts", key));
  for (const toml::node& one : *array) {
    const auto text = one.value_exact<std::string>();
    if (!text) wrong(one, fmt::format("\"{}\" must be a list of texts", key));
    list.push_back(*text);
  }
  return list;
}

Study StudyReader::read() {
  known_keys(root_, {"deck", "layout", "collect", "allow", "set", "grid", "pairs", "random", "case", "failure",
                     "plot"});
  study_.file = file_;
  const std::filesystem::path deck = text(root_, "deck", true);
  study_.deck = deck.is_absolute()
                    ? deck.string()
                    : (std::filesystem::path(file_).parent_path() / deck).lexically_normal().string();
  study_.layout = text(root_, "layout");
  study_.collect = texts("collect");
  study_.allowed = texts("allow");
  if (const toml::table* part = table("set"))
    for (const Named& one : names_in(*part)) {
      claim(one);
      study_.fixed.push_back({one.name, value(*one.node, one.name)});
    }
  std::vector<Block> blocks = grid();
  pairs(blocks);
  random(blocks);
  multiply(blocks);
  single_cases();
  failure();
  if (const toml::table* part = table("plot")) {
    known_keys(*part, {"x", "y"});
    study_.plot_x = text(*part, "x");
    study_.plot_y = text(*part, "y");
  }
  study_.field_of.assign(study_.names.size(), -1);
  for (std::size_t f = 0; f < field_names_.size(); ++f) {
    const auto name = std::ranges::find(study_.names, field_names_[f]) - study_.names.begin();
    study_.field_of[name] = static_cast<int>(f);
  }
  if (study_.cases.empty()) wrong(root_, "the study has no case: give [grid], [pairs], [random] or [[case]]");
  return std::move(study_);
}

}  // namespace

void Study::put(NamedModel& model, std::size_t name, const std::variant<double, std::string>& value) const {
  const auto* number = std::get_if<double>(&value);
  if (number != nullptr && std::isnan(*number)) return;
  const int field = name < field_of.size() ? field_of[name] : -1;
  if (field < 0)
    model.set({names[name], value});
  else
    model.vary(names[name], fields->field(static_cast<std::size_t>(field), static_cast<int>(*number)));
}

Study read_study(const std::string& file) {
  const std::string text = read_file(file);
  toml::table root;
  try {
    root = toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    const int column = static_cast<int>(at.column);
    throw InputError("S732", {file, static_cast<int>(at.line), column, column},
                     std::string(error.description()));
  }
  return StudyReader(root, file).read();
}

}  // namespace sage::sweep
