// A model as a deck of layout sage1 (legacy_inputs/layouts/sage1.toml), or sage1_wide.
#include <fmt/ranges.h>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <map>

#include "sage/deck/wide_layout.hpp"
#include "sage/exchange/convert.hpp"
#include "sage/model/dof_map.hpp"

namespace sage {

namespace {

// "0.050" -> ".05", "1.5e-07" -> "1.5E-7", "12" -> "12."; all read the same.
std::string shortened(const std::string& text) {
  const std::size_t e = text.find('e');
  std::string mantissa = text.substr(0, e), exponent;
  if (e != std::string::npos) {
    const int power = std::atoi(text.c_str() + e + 1);
    exponent = (power < 0 ? "E-" : "E") + std::to_string(std::abs(power));
  }
  if (mantissa.find('.') == std::string::npos) mantissa += '.';
  while (mantissa.back() == '0') mantissa.pop_back();
  const std::size_t zero = mantissa.find("0.");
  if (mantissa.size() > 2 && zero != std::string::npos && (zero == 0 || (zero == 1 && mantissa[0] == '-')))
    mantissa.erase(zero, 1);
  return mantissa + exponent;
}

// A number that takes more columns than its field has.
struct TooWide {
  std::string digits;
};

constexpr std::size_t kNodesOfCard = 8;  // beside the fields of a block

// Upwards, as "first, last, step" counts them.
bool in_equal_steps(const std::vector<int>& numbers) {
  if (numbers.empty()) return false;
  const int step = numbers.size() > 1 ? numbers[1] - numbers[0] : 1;
  for (std::size_t i = 1; i < numbers.size(); ++i)
    if (numbers[i] - numbers[i - 1] != step) return false;
  return step > 0;
}

class Sage1Writer {
 public:
  // exact: a narrow field that would change a number is one too narrow.
  Sage1Writer(const Model& model, Diagnostics& diagnostics, bool wide, bool exact)
      : model_(model), diagnostics_(diagnostics), wide_(wide), exact_(exact) {}

  std::string deck();

 private:
  std::size_t integer_width() const { return wide_ ? 10 : 5; }
  std::size_t real_width() const { return 2 * integer_width(); }
  void integer(long value) {
    std::string digits = std::to_string(value);
    if (digits.size() > integer_width()) throw TooWide{digits};
    text_.append(integer_width() - digits.size(), ' ') += digits;
  }
  void real(double value) {
    const FieldText field = field_text(value, static_cast<int>(real_width()));
    if (!field.exact) {
      if (!wide_ && exact_) throw TooWide{field.text};
      ++inexact_;
      largest_ = std::max(largest_, field.change);
    }
    text_.append(real_width() - field.text.size(), ' ') += field.text;
  }
  void blank_real() { text_.append(real_width(), ' '); }
  void two_zeros() {
    integer(0);
    integer(0);
  }
  // A comment with the names of fields, each above the end of its field: given for narrow ones.
  void heading(std::string_view names);
  void name(std::string value, std::size_t width) {
    if (value.size() > width) cut_.push_back(value);
    // Not in the middle of a character of UTF-8.
    const std::size_t columns = width;
    while (value.size() > width && (static_cast<unsigned char>(value[width]) & 0xc0u) == 0x80u) --width;
    value.resize(width, ' ');
    value.resize(columns, ' ');
    text_ += value;
  }
  void line() {
    while (!text_.empty() && text_.back() == ' ') text_.pop_back();
    text_ += '\n';
  }
  void warning(const std::string& message) {
    diagnostics_.add({Severity::warning, "S720", {model_.file, 0, 0, 0}, message, {}});
  }

  int group_number(int group) const { return group_numbers_[group]; }
  bool is_folded(int group) const { return folded_[group] != 0; }
  int node_number(int node) const { return model_.mesh.number[node]; }
  // Other nodes are made again as they were, with what they took over from those beside them.
  bool is_given(int node) const { return node < model_.mesh.given_nodes(); }
  template <class Card>
  std::size_t given(const std::vector<Card>& cards) const {
    const auto of_given = [&](const Card& card) { return is_given(card.node); };
    return static_cast<std::size_t>(std::count_if(cards.begin(), cards.end(), of_given));
  }
  void number_groups();
  void control(std::size_t reports);
  void nodes();
  void materials();
  void groups();
  // Entries of a list of groups or initial stresses that get a place of their own.
  template <class Entry>
  std::size_t of_groups(const std::vector<Entry>& list) const {
    return static_cast<std::size_t>(
        std::count_if(list.begin(), list.end(), [&](const Entry& e) { return !is_folded(group_of(e)); }));
  }
  static int group_of(int group) { return group; }
  static int group_of(const InitialStress& initial) { return initial.group; }
  std::vector<int> card_nodes(const Group& group, int element) const;
  void elements();
  void fixity(const Fixity& fixity, bool in_stage);
  void fixity(const TurnedFixity& fixity, bool in_stage);
  std::size_t given_ties() const;
  void tie(const Tie& tie);
  void fixity(const FieldFixity& fixity, bool in_stage);
  void unknown(int field, const TimeTable& history);
  void end_with_table(const TimeTable& history);
  void end_with_history(const TimeTable& history);
  void exit(const Exit& exit);
  void initial(const InitialStress& initial);
  void list(const std::vector<int>& groups);
  void control(const LoadControl& control);
  void stage(const Stage& stage);
  void actions(const Stage& stage);
  void write_list(const std::vector<int>& numbers);
  bool is_written(const Report& report) const;
  // Those of undrained groups are twins of others, with their numbers.
  std::size_t given_materials() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(model_.materials, [](const Material& m) { return !m.undrained && !m.twin; }));
  }
  void report(const Report& report);
  void water(const WaterCard& card);
  void point(const Report& report);

  const Model& model_;
  Diagnostics& diagnostics_;
  std::string text_;
  std::vector<int> group_numbers_;
  bool wide_ = false, exact_ = false;
  std::vector<char> folded_;      // groups of triangles that stand on cards of quadrilaterals
  std::vector<std::string> cut_;  // names that are longer than their columns
  int inexact_ = 0;
  double largest_ = 0.0;
};

void Sage1Writer::heading(std::string_view names) {
  if (!wide_) {
    text_.append(names) += '\n';
    return;
  }
  std::string line = "*";
  for (std::size_t at = 1; at < names.size();) {
    const std::size_t first = names.find_first_not_of(' ', at);
    const std::size_t end = std::min(names.find(' ', first), names.size());
    line.append(2 * (end - 1) + 1 - (end - first) - line.size(), ' ');
    line += names.substr(first, end - first);
    at = end;
  }
  text_ += line + '\n';
}

bool same(const InitialStress& a, const InitialStress& b) {
  const auto equal = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  return a.kind == b.kind && std::equal(a.value.begin(), a.value.end(), b.value.begin(), equal);
}

// What lists of groups say of one they say of the other: one card for both is enough.
bool go_together(const Model& model, int a, int b) {
  const auto stated = [](const std::vector<InitialStress>& list, int group) {
    std::vector<const InitialStress*> all;
    for (const InitialStress& one : list)
      if (one.group == group) all.push_back(&one);
    return all;
  };
  const auto initials = [&](const std::vector<InitialStress>& list) {
    const auto first = stated(list, a), second = stated(list, b);
    return std::equal(first.begin(), first.end(), second.begin(), second.end(),
                      [](const auto* x, const auto* y) { return same(*x, *y); });
  };
  const auto together = [&](const std::vector<int>& groups) {
    return std::count(groups.begin(), groups.end(), a) == std::count(groups.begin(), groups.end(), b);
  };
  return initials(model.initials) &&
         std::all_of(model.stages.begin(), model.stages.end(), [&](const Stage& stage) {
           return initials(stage.initials) && together(stage.births) && together(stage.deaths);
         });
}

// Triangles that were folded out of quadrilaterals share the number of their group; a group that can't be
// written so gets a number of its own.
void Sage1Writer::number_groups() {
  std::map<int, int> first_of;  // group of a number
  int largest = 0;
  for (const Group& group : model_.groups) largest = std::max(largest, group.number);
  for (int g = 0; g < static_cast<int>(model_.groups.size()); ++g) {
    const Group& group = model_.groups[g];
    const auto [first, is_new] = first_of.try_emplace(group.number, g);
    const Group& other = model_.groups[first->second];
    const bool folded = !is_new && other.entry->folded == group.entry->name &&
                        other.material == group.material && go_together(model_, first->second, g);
    folded_.push_back(folded ? 1 : 0);
    group_numbers_.push_back(is_new || folded ? group.number : ++largest);
  }
}

void Sage1Writer::control(std::size_t reports) {
  std::size_t elements = 0;
  for (const Group& group : model_.groups) elements += static_cast<std::size_t>(group.elements());
  const auto nodes = static_cast<std::size_t>(model_.mesh.given_nodes());
  const std::size_t counts[] = {
      nodes,
      0,
      given_materials(),
      static_cast<std::size_t>(std::count(folded_.begin(), folded_.end(), 0)),
      elements,
      given(model_.fixities) + given(model_.turned_fixities) + given(model_.field_fixities) + given_ties(),
      of_groups(model_.initials),
      model_.stages.size(),
      reports,
      nodes,
      elements};
  const std::size_t waters = model_.water.size();
  heading(model_.large_strain ? "* geom solv node fill matl grup elem fixi init stag rept nnod nele watr st"
                              : "* geom solv node fill matl grup elem fixi init stag rept nnod nele");
  integer(model_.geometry == Geometry::axisymmetric ? 2 : 1);
  integer(model_.solver);
  for (std::size_t count : counts) integer(static_cast<long>(count));
  if (waters > 0 || model_.large_strain) integer(static_cast<long>(waters));
  if (model_.large_strain) text_ += wide_ ? "   1" : " 1";
  line();
}

void Sage1Writer::nodes() {
  heading("* node step syst         x         y");
  for (int node = 0; is_given(node); ++node) {
    integer(node_number(node));
    two_zeros();
    real(model_.mesh.x(0, node));
    real(model_.mesh.x(1, node));
    line();
  }
}

void Sage1Writer::materials() {
  for (const Material& material : model_.materials) {
    if (material.undrained || material.twin) continue;
    heading("* numb  law para    weight name");
    integer(material.number);
    integer(material.code);
    integer(static_cast<long>(material.parameters.size()));
    real(material.unit_weight);
    name(material.name, 40);
    if (material.saturated_unit_weight != 0.0) {
      if (!wide_) throw TooWide{"of the saturated unit weight of a material"};
      real(material.saturated_unit_weight);
    }
    line();
    for (std::size_t i = 0; i < material.parameters.size(); ++i) {
      real(material.parameters[i]);
      if (i % 8 == 7 || i + 1 == material.parameters.size()) line();
    }
  }
}

void Sage1Writer::groups() {
  heading("* numb elem form matl name");
  for (std::size_t g = 0; g < model_.groups.size(); ++g) {
    if (folded_[g] != 0) continue;
    const Group& group = model_.groups[g];
    integer(group_number(static_cast<int>(g)));
    integer(group.element_code);
    integer(group.formulation);
    integer(model_.material_of(group).number);
    name(group.name, 40);
    if (group.second_material >= 0 && !wide_) throw TooWide{"of the second material of a group"};
    if (group.overlay || group.second_material >= 0) integer(group.overlay ? 1 : 0);
    if (group.second_material >= 0) integer(model_.materials[group.second_material].number);
    line();
  }
}

// Their numbers as a card lists them, 0 for one that is made.
std::vector<int> Sage1Writer::card_nodes(const Group& group, int element) const {
  const ElementEntry& entry = *group.entry;
  const int* nodes = group.nodes_of(element);
  const std::size_t usual =
      std::min<std::size_t>(group.node_count(), 2 * static_cast<std::size_t>(entry.corners));
  std::vector<char> listed(group.node_count(), 0);
  std::vector<int> numbers;
  for (std::size_t i = 0; i < usual; ++i) {
    const std::size_t local = node_of_card(group, i, usual);
    listed[local] = 1;
    numbers.push_back(is_given(nodes[local]) ? node_number(nodes[local]) : 0);
  }
  for (std::size_t i = 0; i < group.node_count(); ++i)
    if (listed[i] == 0 && is_given(nodes[i])) {  // the card gives all of them, in their own order
      numbers.clear();
      for (std::size_t k = 0; k < group.node_count(); ++k)
        numbers.push_back(is_given(nodes[k]) ? node_number(nodes[k]) : 0);
      break;
    }
  while (!numbers.empty() && numbers.back() == 0) numbers.pop_back();
  return numbers;
}

void Sage1Writer::elements() {
  heading("* numb grup   n1   n2   n3   n4   n5   n6   n7   n8");
  for (std::size_t g = 0; g < model_.groups.size(); ++g) {
    const Group& group = model_.groups[g];
    for (int e = 0; e < group.elements(); ++e) {
      std::vector<int> numbers = card_nodes(group, e);
      // A ring's card gives its node twice: with one node it would read like a card of another kind.
      if (folded_[g] != 0 || numbers.size() == 1) numbers.push_back(numbers.back());
      if (numbers.size() > static_cast<std::size_t>(kWideNodes))
        throw InputError("S722", group.where,
                         "group " + std::to_string(group.number) + " (" + group.element_name +
                             "): an element card holds up to " + std::to_string(kWideNodes) +
                             " nodes, these have " + std::to_string(numbers.size()));
      if (numbers.size() > kNodesOfCard && !wide_) throw TooWide{std::to_string(numbers.size())};
      integer(group.element_numbers[e]);
      integer(group_number(static_cast<int>(g)));
      for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (i == kNodesOfCard) text_.append(4 * integer_width(), ' ');  // no block
        integer(numbers[i]);
      }
      line();
    }
  }
}

void Sage1Writer::fixity(const Fixity& fixity, bool in_stage) {
  if (!is_given(fixity.node)) return;
  integer(node_number(fixity.node));
  two_zeros();
  for (FixityCode code : fixity.code)
    integer(code == FixityCode::fixed ? 1 : code == FixityCode::released ? -1 : 0);
  // The displacement of a held dof is written though it is zero: left blank it would get a note.
  if (in_stage && (fixity.code[0] == FixityCode::fixed || fixity.code[1] == FixityCode::fixed))
    for (double value : fixity.value) real(value);
  end_with_table(fixity.history);
}

void Sage1Writer::fixity(const TurnedFixity& fixity, bool in_stage) {
  if (!is_given(fixity.node)) return;
  if (!wide_) throw TooWide{"of the angle of a support"};
  integer(node_number(fixity.node));
  two_zeros();
  for (FixityCode code : fixity.code)
    integer(code == FixityCode::fixed ? 1 : code == FixityCode::released ? -1 : 0);
  for (double value : fixity.value) in_stage ? real(value) : blank_real();
  text_.append(in_stage ? 20 + 80 : 20, ' ');  // no unknown and no history
  real(fixity.angle);
  line();
}

std::size_t Sage1Writer::given_ties() const {
  return static_cast<std::size_t>(std::ranges::count_if(
      model_.ties, [&](const Tie& tie) { return is_given(tie.node) && is_given(tie.to); }));
}

void Sage1Writer::tie(const Tie& tie) {
  if (!is_given(tie.node) || !is_given(tie.to)) return;
  if (!wide_) throw TooWide{"of a tie"};
  integer(node_number(tie.node));
  two_zeros();
  for (const char tied : tie.component) integer(tied ? 3 : 0);
  text_.append(2 * real_width() + 20 + real_width(), ' ');  // no values, unknown and angle
  integer(node_number(tie.to));
  line();
}

// The columns of y stay blank.
void Sage1Writer::fixity(const FieldFixity& fixity, bool in_stage) {
  if (!is_given(fixity.node)) return;
  integer(node_number(fixity.node));
  two_zeros();
  integer(fixity.code == FixityCode::fixed ? 1 : fixity.code == FixityCode::released ? -1 : 0);
  integer(0);
  if (in_stage && fixity.code == FixityCode::fixed)
    real(fixity.value);
  else
    blank_real();
  blank_real();
  unknown(fixity.field, fixity.history);
}

void Sage1Writer::exit(const Exit& exit) {
  if (!is_given(exit.node)) return;
  integer(node_number(exit.node));
  two_zeros();
  integer(2);
  integer(0);
  real(exit.pressure_head);
  blank_real();
  unknown(exit.field >= 0 ? exit.field : find_unknown(model_.unknowns, "head"), {});
}

void Sage1Writer::unknown(int field, const TimeTable& history) {
  name(model_.unknowns[field].name, 20);
  end_with_history(history);
}

void Sage1Writer::end_with_table(const TimeTable& history) {
  if (!history.empty()) text_.append(20, ' ');  // no unknown: a displacement, force or pressure
  end_with_history(history);
}

void Sage1Writer::end_with_history(const TimeTable& history) {
  if (!history.empty() && !wide_) throw TooWide{"of the history of a support or load"};
  if (!history.empty()) name(history_text(history), 80);
  line();
}

void Sage1Writer::initial(const InitialStress& initial) {
  if (is_folded(initial.group)) return;
  integer(group_number(initial.group));
  integer(static_cast<int>(initial.kind));
  for (double value : initial.value) {
    if (std::isnan(value))
      blank_real();  // left as it is
    else
      real(value);
  }
  line();
}

void Sage1Writer::write_list(const std::vector<int>& numbers) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    integer(numbers[i]);
    if (i % 16 == 15 || i + 1 == numbers.size()) line();
  }
}

void Sage1Writer::list(const std::vector<int>& groups) {
  std::vector<int> numbers;
  for (int group : groups)
    if (!is_folded(group)) numbers.push_back(group_number(group));
  write_list(numbers);
}

void Sage1Writer::control(const LoadControl& control) {
  const std::string other = control.other < 0 ? "" : fmt::format(" {}", node_number(control.other));
  name(fmt::format("{}{} {} {}", node_number(control.node), other, control.component == 0 ? 'x' : 'y',
                   control.growth),
       80);
}

void Sage1Writer::stage(const Stage& stage) {
  const bool timed =
      stage.is_controlled() || stage.time_error != 0.0 || stage.may_end_early() || !stage.output_times.empty();
  const bool resets = timed || stage.resets_displacements;
  // Fields behind one another: each is written where one behind it is.
  const bool pores = resets || stage.pores != PoreWater::kept || stage.theta != 1.0 || stage.grading != 1.0;
  const bool factor = pores || stage.strength_factor != 0.0, lasts = factor || stage.duration != 1.0;
  if (lasts && !wide_)
    throw TooWide{resets ? "of the fields of the stage" : "of the stage's duration or strength factor"};
  // A '*' in column 1 would make the title a comment.
  name(stage.title.starts_with('*') ? " " + stage.title : stage.title, 80);
  line();
  heading("* incr meth iter outp fixi load pres brth deth init    grav x    grav y tolerance");
  const std::size_t counts[] = {
      given(stage.fixities) + given(stage.turned_fixities) + given(stage.field_fixities) + given(stage.exits),
      stage.loads.size() + stage.field_loads.size(),
      stage.pressures.size(),
      of_groups(stage.births),
      of_groups(stage.deaths),
      of_groups(stage.initials)};
  for (int value :
       {stage.given_increments(), static_cast<int>(stage.method), stage.max_iterations, stage.output_every})
    integer(value);
  for (std::size_t count : counts) integer(static_cast<long>(count));
  for (double value : {stage.gravity.x(), stage.gravity.y(), stage.tolerance}) real(value);
  if (lasts) real(stage.duration);
  if (factor) real(stage.strength_factor);
  if (pores) {
    integer(static_cast<long>(stage.pores));
    real(stage.theta);
    real(stage.grading);
  }
  if (resets) integer(stage.resets_displacements ? 1 : 0);
  if (timed) {
    for (const double value : {stage.time_error, stage.end_degree, stage.end_pressure}) real(value);
    name(fmt::format("{}", fmt::join(stage.output_times, " ")), 80);
  }
  if (stage.is_controlled()) control(stage.control);
  line();
  actions(stage);
  list(stage.births);
  list(stage.deaths);
  for (const InitialStress& i : stage.initials) initial(i);
}

// Supports and loads.
void Sage1Writer::actions(const Stage& stage) {
  for (const Fixity& f : stage.fixities) fixity(f, true);
  for (const TurnedFixity& f : stage.turned_fixities) fixity(f, true);
  for (const FieldFixity& f : stage.field_fixities) fixity(f, true);
  for (const Exit& e : stage.exits) exit(e);
  for (const NodalLoad& load : stage.loads) {
    integer(node_number(load.node));
    two_zeros();
    real(load.force.x());
    real(load.force.y());
    end_with_table(load.history);
  }
  for (const FieldLoad& load : stage.field_loads) {
    integer(node_number(load.node));
    two_zeros();
    real(load.value);
    real(0.0);
    unknown(load.field, load.history);
  }
  for (const EdgeLoad& load : stage.pressures) {
    const Group& group = model_.groups[load.group];
    integer(group.element_numbers[load.element]);
    // A folded triangle a b c stands on its card as a b c c: side 3 is what vanished.
    integer(load.edge + (is_folded(load.group) && load.edge == 2 ? 2 : 1));
    two_zeros();
    for (double value : {load.normal[0], load.normal[1], load.shear[0], load.shear[1]}) real(value);
    end_with_table(load.history);
  }
}

void Sage1Writer::point(const Report& report) {
  integer(static_cast<int>(report.kind));
  integer(report.group < 0 ? 0 : group_number(report.group));
  for (int i = 0; i < 3; ++i) integer(0);
  integer(report.stage + 1);
  line();
  for (double value : {report.place.x(), report.place.y()}) real(value);
  name(report.name, 20);
  if (report.kind == ReportKind::section)
    for (double value : {report.end.x(), report.end.y()}) real(value);
  line();
}

bool Sage1Writer::is_written(const Report& report) const {
  return report.kind == ReportKind::point || report.kind == ReportKind::section ||
         std::any_of(report.nodes.begin(), report.nodes.end(), [&](int node) { return is_given(node); });
}

void Sage1Writer::report(const Report& report) {
  if (!is_written(report)) return;
  if (report.kind == ReportKind::point || report.kind == ReportKind::section) return point(report);
  std::vector<int> numbers;
  for (int node : report.nodes)
    if (is_given(node)) numbers.push_back(node_number(node));
  const bool range = in_equal_steps(numbers);
  integer(static_cast<int>(report.kind));
  integer(report.group < 0 ? 0 : group_number(report.group));
  integer(range ? numbers.front() : 0);
  integer(range ? numbers.back() : 0);
  integer(range && numbers.size() > 1 ? numbers[1] - numbers[0] : range ? 1 : 0);
  integer(report.stage + 1);
  for (double value : {report.height, report.area, report.cell_pressure}) real(value);
  if (!range) integer(static_cast<int>(numbers.size()));
  line();
  if (!range) write_list(numbers);
}

void Sage1Writer::water(const WaterCard& card) {
  std::vector<double> values;
  for (const Vector2& point : card.line) values.insert(values.end(), {point.x(), point.y()});
  int made = 0, negative = 0;
  for (const auto& [node, pressure] : card.nodes) {
    if (!is_given(node)) {
      ++made;
      continue;
    }
    negative += pressure < 0.0 ? 1 : 0;  // heads may lie lower than the node
    values.insert(values.end(), {1.0 * node_number(node), std::max(0.0, pressure)});
  }
  if (made > 0)
    warning("pressures at " + std::to_string(made) +
            " node(s) that the deck does not name are left out: there the new deck has what is linear between "
            "the ends of "
            "an edge");
  if (negative > 0)
    warning("negative pressures of water at " + std::to_string(negative) +
            " node(s) are written as 0: the water's surface lies a little otherwise between nodes");
  integer(static_cast<int>(card.kind));
  integer(card.group < 0 ? 0 : group_number(card.group));
  integer(card.stage + 1);
  integer(static_cast<int>(card.action));
  real(card.value);
  real(0.0);
  integer(static_cast<long>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i % 8 == 0) line();
    real(values[i]);
  }
  line();
}

std::string Sage1Writer::deck() {
  number_groups();
  if (wide_) text_.append("* layout: ").append(kWideLayout) += '\n';
  for (const std::string& plugin : model_.plugins) text_.append("* plugin: ").append(plugin) += '\n';
  name(model_.title.starts_with('*') ? " " + model_.title : model_.title, 80);
  line();
  text_ += wide_ ? "* length force   stress                   p_a             gamma_w\n"
                 : "* length force   stress         p_a   gamma_w\n";
  for (const std::string& unit : {model_.units.length, model_.units.force, model_.units.stress}) name(unit, 8);
  real(model_.units.atmospheric_pressure);
  real(model_.units.water_unit_weight);
  line();
  const auto reports = static_cast<std::size_t>(std::count_if(
      model_.reports.begin(), model_.reports.end(), [&](const Report& report) { return is_written(report); }));
  if (reports < model_.reports.size())
    warning(std::to_string(model_.reports.size() - reports) +
            " report(s) left out: they have no node of a card");
  for (const Report& report : model_.reports)
    if (!report.fields.empty())
      warning("report " + (report.name.empty() ? std::string("of a point") : report.name) +
              ": its further fields are left out (--field asks for them)");
  control(reports);
  nodes();
  materials();
  groups();
  elements();
  if (given(model_.fixities) + given(model_.turned_fixities) + given_ties() > 0)
    heading("* first last step xcod ycod");
  for (const Fixity& f : model_.fixities) fixity(f, false);
  for (const TurnedFixity& f : model_.turned_fixities) fixity(f, false);
  for (const Tie& one : model_.ties) tie(one);
  for (const FieldFixity& f : model_.field_fixities) fixity(f, false);
  if (!model_.initials.empty()) heading("* group kind      v1        v2        v3        v4");
  for (const InitialStress& i : model_.initials) initial(i);
  for (const Stage& s : model_.stages) stage(s);
  for (const Report& r : model_.reports) report(r);
  if (!model_.water.empty()) heading("* kind grup stag actn    value1    value2 list");
  for (const WaterCard& card : model_.water) water(card);
  text_ += "END\n";
  if (!cut_.empty())
    warning(std::to_string(cut_.size()) + " name(s) or title(s) are longer than their columns and are cut: \"" +
            cut_.front() + "\"" + (cut_.size() > 1 ? ", ..." : ""));
  if (inexact_ > 0) {
    char change[32];
    std::snprintf(change, sizeof change, "%.2g", largest_);
    warning(std::to_string(inexact_) + " number(s) need more digits than " + (wide_ ? "twenty" : "ten") +
            " columns hold; largest relative change " + change);
  }
  return std::move(text_);
}

}  // namespace

FieldText field_text(double value, int width) {
  if (value == 0.0) return {"0.", true, 0.0};
  char buffer[64];
  std::string nearest;
  double nearest_error = HUGE_VAL;
  // The shortest exact text in both styles, then fewer and fewer digits.
  for (int digits = 0; digits < 18; ++digits) {
    for (const auto style : {std::chars_format::fixed, std::chars_format::scientific}) {
      const bool fixed = style == std::chars_format::fixed;
      if (fixed && (std::abs(value) > 1e17 || std::abs(value) < 1e-9)) continue;
      const auto end = digits == 0 ? std::to_chars(buffer, buffer + sizeof buffer, value, style)
                                   : std::to_chars(buffer, buffer + sizeof buffer, value, style, 17 - digits);
      if (end.ec != std::errc()) continue;
      std::string text = shortened(std::string(buffer, end.ptr));
      const double error = std::abs(std::strtod(text.c_str(), nullptr) - value);
      // 1.5E-7 may be written 1.5-7 on a card.
      if (static_cast<int>(text.size()) == width + 1 && text.find("E-") != std::string::npos)
        text.erase(text.find('E'), 1);
      if (static_cast<int>(text.size()) > width) continue;
      if (error == 0.0) return {text, true, 0.0};
      if (error < nearest_error) {
        nearest = text;
        nearest_error = error;
      }
    }
  }
  return {nearest, false, nearest_error / std::abs(value)};
}

std::string sage1_text(const Model& model, Diagnostics& diagnostics, FieldWidth width) {
  bool wide = width == FieldWidth::wide;
  for (;; wide = true) {
    Diagnostics words;
    try {
      std::string text = Sage1Writer(model, words, wide, width != FieldWidth::narrow).deck();
      for (const Diagnostic& one : words.list()) diagnostics.add(one);
      return text;
    } catch (const TooWide& number) {
      if (wide)
        throw InputError("S722", {model.file, 0, 0, 0},
                         "the number " + number.digits + " does not fit a sage1 card");
    }
  }
}

}  // namespace sage
