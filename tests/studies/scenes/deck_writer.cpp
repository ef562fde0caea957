#include "tests/studies/scenes/deck_writer.hpp"

#include <cstdio>
#include <stdexcept>

namespace sage::scenes {

namespace {

std::string five(int value) {
  char text[16];
  std::snprintf(text, sizeof text, "%5d", value);
  return text;
}

std::string integers(const std::vector<int>& values) {
  std::string text;
  for (int value : values) text += five(value);
  return text;
}

std::string reals(const std::vector<double>& values) {
  std::string text;
  for (double value : values) text += ten_columns(value);
  return text;
}

void append(std::string& text, const std::vector<std::string>& cards) {
  for (const std::string& card : cards) text += card + "\n";
}

int size_of(const std::vector<std::string>& cards) {
  return static_cast<int>(cards.size());
}

std::string stage_text(const StageCards& stage) {
  std::string text =
      stage.title + "\n" + integers({stage.increments, stage.method, stage.max_iterations, stage.output_every});
  text += integers({size_of(stage.fixities), size_of(stage.loads), size_of(stage.pressures),
                    static_cast<int>(stage.births.size()), static_cast<int>(stage.deaths.size()),
                    size_of(stage.initials)});
  text += reals({stage.gravity_x, stage.gravity_y, stage.tolerance}) + "\n";
  append(text, stage.fixities);
  append(text, stage.loads);
  append(text, stage.pressures);
  if (!stage.births.empty()) text += integers(stage.births) + "\n";
  if (!stage.deaths.empty()) text += integers(stage.deaths) + "\n";
  append(text, stage.initials);
  return text;
}

}  // namespace

std::string ten_columns(double value) {
  for (int digits = 15; digits > 0; --digits) {
    char text[40];
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    std::string s = text;
    const std::size_t e = s.find('e');
    std::string mantissa = s.substr(0, e);
    if (mantissa.find('.') == std::string::npos) mantissa += '.';
    if (e != std::string::npos) mantissa += "E" + std::to_string(std::stoi(s.substr(e + 1)));
    if (mantissa.size() <= 10) return std::string(10 - mantissa.size(), ' ') + mantissa;
  }
  throw std::logic_error("a number does not fit in ten columns");
}

void StageCards::fix(int node, int x_code, int y_code, double x, double y) {
  fixities.push_back(integers({node, 0, 0, x_code, y_code}) + reals({x, y}));
}

void StageCards::load(int node, double x, double y) {
  loads.push_back(integers({node, 0, 0}) + reals({x, y}));
}

void StageCards::pressure(int element, int edge, double normal1, double normal2, double shear1, double shear2) {
  pressures.push_back(integers({element, edge, 0, 0}) + reals({normal1, normal2, shear1, shear2}));
}

void StageCards::initial(int group, int kind, double v1, double v2, double v3, double v4) {
  initials.push_back(integers({group, kind}) + reals({v1, v2, v3, v4}));
}

void DeckWriter::node(int number, double x, double y, bool polar) {
  nodes.push_back(integers({number, 0, polar ? 1 : 0}) + reals({x, y}));
}

void DeckWriter::node_row(int number, int step, double x, double y, double ratio, bool polar) {
  nodes.push_back(integers({number, step, polar ? 1 : 0}) + reals({x, y, ratio}));
}

void DeckWriter::fill(int first, int columns, int column_step, int rows, int row_step, double column_ratio,
                      double row_ratio) {
  fills.push_back(integers({first, columns, column_step, rows, row_step}) + reals({column_ratio, row_ratio}));
}

void DeckWriter::material(int number, int law, const std::vector<double>& parameters, double unit_weight,
                          const std::string& name) {
  std::string card = integers({number, law, static_cast<int>(parameters.size())}) + ten_columns(unit_weight);
  card += " " + name;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    card += (i % 8 == 0 ? "\n" : "") + ten_columns(parameters[i]);
  materials.push_back(card);
}

void DeckWriter::group(int number, int element, int formulation, int material, const std::string& name) {
  groups.push_back(integers({number, element, formulation, material}) + name);
}

void DeckWriter::element(int number, int group, const std::vector<int>& element_nodes) {
  elements.push_back(integers({number, group}) + integers(element_nodes));
}

void DeckWriter::elements_block(int number, int group, const std::vector<int>& element_nodes, int columns,
                                int rows, int column_step, int row_step) {
  std::string card = integers({number, group}) + integers(element_nodes);
  card.resize(50, ' ');
  elements.push_back(card + integers({columns, rows, column_step, row_step}));
}

void DeckWriter::fix_row(int first, int last, int step, int x_code, int y_code) {
  fixities.push_back(integers({first, last, step, x_code, y_code}));
}

void DeckWriter::fix(int node, int x_code, int y_code) {
  fixities.push_back(integers({node, 0, 0, x_code, y_code}));
}

void DeckWriter::initial(int group, int kind, double v1, double v2, double v3, double v4) {
  initials.push_back(integers({group, kind}) + reals({v1, v2, v3, v4}));
}

StageCards& DeckWriter::stage(int increments) {
  stages.emplace_back().increments = increments;
  return stages.back();
}

void DeckWriter::triaxial_report(int group_number, int first, int last, int from_stage, double height,
                                 double cell_pressure) {
  reports.push_back(integers({1, group_number, first, last, 1, from_stage}) + ten_columns(height) +
                    ten_columns(0.0) + ten_columns(cell_pressure));
}

void DeckWriter::water(int kind, int group_number, int from_stage, int action,
                       const std::vector<double>& values, double v1, double v2) {
  std::string card = integers({kind, group_number, from_stage, action}) + reals({v1, v2}) +
                     five(static_cast<int>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) card += (i % 8 == 0 ? "\n" : "") + ten_columns(values[i]);
  waters.push_back(card);
}

std::string DeckWriter::text() const {
  std::string text = title + "\nm       kN      kPa     ";
  text += ten_columns(atmospheric_pressure) + ten_columns(water_unit_weight) + "\n";
  text += integers({geometry, 0, size_of(nodes), size_of(fills), size_of(materials), size_of(groups),
                    size_of(elements), size_of(fixities), size_of(initials), static_cast<int>(stages.size()),
                    size_of(reports)});
  if (!waters.empty() || large_strain) text += integers({0, 0, size_of(waters)});
  if (large_strain) text += " 1";
  text += "\n";
  for (const auto* cards : {&nodes, &fills, &materials, &groups, &elements, &fixities, &initials})
    append(text, *cards);
  for (const StageCards& stage : stages) text += stage_text(stage);
  append(text, reports);
  append(text, waters);
  return text + "END\n";
}

int Block::element(int i, int j) const {
  const int per_cell = cell == Cell::tri3 || cell == Cell::tri6 ? 2 : 1;
  return first_element + per_cell * (j * columns + i);
}

bool Block::exists(int i, int j) const {
  const bool quadrilateral = cell == Cell::quad8 || cell == Cell::quad9;
  return !(quadrilateral && i % 2 == 1 && j % 2 == 1);
}

Vector2 Block::at(int i, int j) const {
  if (straight && order() == 2 && i % 2 == 1) return 0.5 * (at(i - 1, j) + at(i + 1, j));
  if (straight && order() == 2 && j % 2 == 1) return 0.5 * (at(i, j - 1) + at(i, j + 1));
  return place(static_cast<double>(i) / (across() - 1), static_cast<double>(j) / (up() - 1));
}

void Block::write_nodes(DeckWriter& deck) const {
  for (int j = 0; j < up(); ++j)
    for (int i = 0; i < across(); ++i)
      if (exists(i, j)) deck.node(node(i, j), at(i, j).x(), at(i, j).y(), polar);
}

void Block::write_elements(DeckWriter& deck, int group) const {
  const int s = order();
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const auto n = [&](int a, int b) { return node(s * i + a, s * j + b); };
      const int number = element(i, j);
      switch (cell) {
        case Cell::quad4:
          deck.element(number, group, {n(0, 0), n(1, 0), n(1, 1), n(0, 1)});
          break;
        case Cell::quad8:
        case Cell::quad9:  // the middle node is the program's
          deck.element(number, group, {n(0, 0), n(2, 0), n(2, 2), n(0, 2), n(1, 0), n(2, 1), n(1, 2), n(0, 1)});
          break;
        case Cell::tri3:
          deck.element(number, group, {n(0, 0), n(1, 0), n(0, 1)});
          deck.element(number + 1, group, {n(1, 1), n(0, 1), n(1, 0)});
          break;
        case Cell::tri6:
          deck.element(number, group, {n(0, 0), n(2, 0), n(0, 2), n(1, 0), n(1, 1), n(0, 1)});
          deck.element(number + 1, group, {n(2, 2), n(0, 2), n(2, 0), n(1, 2), n(1, 1), n(2, 1)});
          break;
      }
    }
}

std::vector<int> Block::left() const {
  std::vector<int> list;
  for (int j = 0; j < up(); ++j) list.push_back(node(0, j));
  return list;
}

std::vector<int> Block::right() const {
  std::vector<int> list;
  for (int j = 0; j < up(); ++j) list.push_back(node(across() - 1, j));
  return list;
}

std::vector<int> Block::bottom() const {
  std::vector<int> list;
  for (int i = 0; i < across(); ++i) list.push_back(node(i, 0));
  return list;
}

std::vector<int> Block::top() const {
  std::vector<int> list;
  for (int i = 0; i < across(); ++i) list.push_back(node(i, up() - 1));
  return list;
}

void join(DeckWriter& deck, int first, int group, const std::vector<int>& lower, const std::vector<int>& upper,
          int order) {
  const auto step = static_cast<std::size_t>(order);
  for (std::size_t i = 0; i + step < lower.size(); i += step) {
    std::vector<int> nodes{lower[i], lower[i + step], upper[i + step], upper[i]};
    if (order == 2) nodes.insert(nodes.end(), {lower[i + 1], upper[i + 1]});
    deck.element(first++, group, nodes);
  }
}

std::vector<int> copy_row(DeckWriter& deck, const Block& block, const std::vector<int>& row, int first) {
  std::vector<int> copy;
  for (int j = 0; j < block.up(); ++j)
    for (int i = 0; i < block.across(); ++i)
      for (int n : row)
        if (block.node(i, j) == n) {
          deck.node(first, block.at(i, j).x(), block.at(i, j).y(), block.polar);
          copy.push_back(first++);
        }
  return copy;
}

std::function<Vector2(double, double)> rectangle(double x0, double x1, double y0, double y1) {
  return [=](double s, double t) { return Vector2(x0 + s * (x1 - x0), y0 + t * (y1 - y0)); };
}

}  // namespace sage::scenes
