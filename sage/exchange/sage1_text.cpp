// A model as a deck of layout sage1 (legacy_inputs/layouts/sage1.toml), or sage1_wide.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <set>

#include "sage/deck/wide_layout.hpp"
#include "sage/exchange/convert.hpp"

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

class Sage1Writer {
 public:
  Sage1Writer(const Model& model, Diagnostics& diagnostics, bool wide)
      : model_(model), diagnostics_(diagnostics), wide_(wide) {}

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
    diagnostics_.add({Severity::warning, {model_.file, 0, 0, 0}, message, {}});
  }

  int group_number(int group) const { return group_numbers_[static_cast<std::size_t>(group)]; }
  int node_number(int node) const { return model_.mesh.number[static_cast<std::size_t>(node)]; }
  void number_groups();
  void control(std::size_t reports);
  void nodes();
  void materials();
  void groups();
  void elements();
  void fixity(const Fixity& fixity, bool in_stage);
  void fixity(const FieldFixity& fixity, bool in_stage);
  void unknown(int field);
  void initial(const InitialStress& initial);
  void list(const std::vector<int>& groups);
  void stage(const Stage& stage);
  bool report(const Report& report, bool write);
  void point(const Report& report);

  const Model& model_;
  Diagnostics& diagnostics_;
  std::string text_;
  std::vector<int> group_numbers_;
  bool wide_ = false;
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

// Quadrilaterals and the triangles folded out of them share a number in the model; here each has its own.
void Sage1Writer::number_groups() {
  std::set<int> used;
  int largest = 0;
  for (const Group& group : model_.groups) largest = std::max(largest, group.number);
  for (const Group& group : model_.groups)
    group_numbers_.push_back(used.insert(group.number).second ? group.number : ++largest);
}

void Sage1Writer::control(std::size_t reports) {
  std::size_t elements = 0;
  for (const Group& group : model_.groups) elements += static_cast<std::size_t>(group.elements());
  const std::size_t counts[] = {model_.mesh.number.size(),
                                0,
                                model_.materials.size(),
                                model_.groups.size(),
                                elements,
                                model_.fixities.size() + model_.field_fixities.size(),
                                model_.initials.size(),
                                model_.stages.size(),
                                reports,
                                model_.mesh.number.size(),
                                elements};
  heading("* geom solv node fill matl grup elem fixi init stag rept nnod nele");
  integer(model_.geometry == Geometry::axisymmetric ? 2 : 1);
  integer(model_.solver);
  for (std::size_t count : counts) integer(static_cast<long>(count));
  line();
}

void Sage1Writer::nodes() {
  heading("* node step syst         x         y");
  for (int node = 0; node < model_.mesh.nodes(); ++node) {
    integer(node_number(node));
    two_zeros();
    real(model_.mesh.x(0, node));
    real(model_.mesh.x(1, node));
    line();
  }
}

void Sage1Writer::materials() {
  for (const Material& material : model_.materials) {
    heading("* numb  law para    weight name");
    integer(material.number);
    integer(material.code);
    integer(static_cast<long>(material.parameters.size()));
    real(material.unit_weight);
    name(material.name, 20);
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
    const Group& group = model_.groups[g];
    integer(group_number(static_cast<int>(g)));
    integer(group.element_code);
    integer(group.formulation);
    integer(model_.material_of(group).number);
    name(group.name, 20);
    line();
  }
}

void Sage1Writer::elements() {
  heading("* numb grup   n1   n2   n3   n4   n5   n6   n7   n8");
  for (std::size_t g = 0; g < model_.groups.size(); ++g) {
    const Group& group = model_.groups[g];
    if (group.elements() > 0 && group.node_count() > 8)
      throw InputError(group.where, "group " + std::to_string(group.number) + " (" + group.element_name +
                                        "): an element card of sage1 holds 8 nodes, these have " +
                                        std::to_string(group.node_count()));
    for (int e = 0; e < group.elements(); ++e) {
      integer(group.element_numbers[static_cast<std::size_t>(e)]);
      integer(group_number(static_cast<int>(g)));
      for (std::size_t i = 0; i < group.node_count(); ++i) integer(node_number(group.nodes_of(e)[i]));
      line();
    }
  }
}

void Sage1Writer::fixity(const Fixity& fixity, bool in_stage) {
  integer(node_number(fixity.node));
  two_zeros();
  for (FixityCode code : fixity.code)
    integer(code == FixityCode::fixed ? 1 : code == FixityCode::released ? -1 : 0);
  // The displacement of a held dof is written though it is zero: left blank it would get a note.
  if (in_stage && (fixity.code[0] == FixityCode::fixed || fixity.code[1] == FixityCode::fixed))
    for (double value : fixity.value) real(value);
  line();
}

// The columns of y stay blank.
void Sage1Writer::fixity(const FieldFixity& fixity, bool in_stage) {
  integer(node_number(fixity.node));
  two_zeros();
  integer(fixity.code == FixityCode::fixed ? 1 : fixity.code == FixityCode::released ? -1 : 0);
  integer(0);
  if (in_stage && fixity.code == FixityCode::fixed)
    real(fixity.value);
  else
    blank_real();
  blank_real();
  unknown(fixity.field);
}

void Sage1Writer::unknown(int field) {
  name(model_.unknowns[static_cast<std::size_t>(field)].name, 20);
  line();
}

void Sage1Writer::initial(const InitialStress& initial) {
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

void Sage1Writer::list(const std::vector<int>& groups) {
  for (std::size_t i = 0; i < groups.size(); ++i) {
    integer(group_number(groups[i]));
    if (i % 16 == 15 || i + 1 == groups.size()) line();
  }
}

void Sage1Writer::stage(const Stage& stage) {
  if (stage.duration != 1.0)
    warning("stage " + std::to_string(stage.number) +
            ": its duration is left out, a sage1 deck has no place for it");
  // A '*' in column 1 would make the title a comment.
  name(stage.title.starts_with('*') ? " " + stage.title : stage.title, 80);
  line();
  heading("* incr meth iter outp fixi load pres brth deth init    grav x    grav y tolerance");
  const std::size_t counts[] = {stage.fixities.size() + stage.field_fixities.size(),
                                stage.loads.size() + stage.field_loads.size(),
                                stage.pressures.size(),
                                stage.births.size(),
                                stage.deaths.size(),
                                stage.initials.size()};
  for (int value : {stage.increments, static_cast<int>(stage.method), stage.max_iterations, stage.output_every})
    integer(value);
  for (std::size_t count : counts) integer(static_cast<long>(count));
  for (double value : {stage.gravity.x(), stage.gravity.y(), stage.tolerance}) real(value);
  line();
  for (const Fixity& f : stage.fixities) fixity(f, true);
  for (const FieldFixity& f : stage.field_fixities) fixity(f, true);
  for (const NodalLoad& load : stage.loads) {
    integer(node_number(load.node));
    two_zeros();
    real(load.force.x());
    real(load.force.y());
    line();
  }
  for (const FieldLoad& load : stage.field_loads) {
    integer(node_number(load.node));
    two_zeros();
    real(load.value);
    real(0.0);
    unknown(load.field);
  }
  for (const EdgeLoad& load : stage.pressures) {
    const Group& group = model_.groups[static_cast<std::size_t>(load.group)];
    integer(group.element_numbers[static_cast<std::size_t>(load.element)]);
    integer(load.edge + 1);
    two_zeros();
    for (double value : {load.normal[0], load.normal[1], load.shear[0], load.shear[1]}) real(value);
    line();
  }
  list(stage.births);
  list(stage.deaths);
  for (const InitialStress& i : stage.initials) initial(i);
}

void Sage1Writer::point(const Report& report) {
  integer(static_cast<int>(report.kind));
  integer(report.group < 0 ? 0 : group_number(report.group));
  for (int i = 0; i < 3; ++i) integer(0);
  integer(report.stage + 1);
  line();
  for (double value : {report.place.x(), report.place.y()}) real(value);
  name(report.name, 20);
  line();
}

// Only nodes in equal steps fit a card.
bool Sage1Writer::report(const Report& report, bool write) {
  if (report.kind == ReportKind::point) {
    if (write) point(report);
    return true;
  }
  std::vector<int> numbers;
  for (int node : report.nodes) numbers.push_back(node_number(node));
  std::sort(numbers.begin(), numbers.end());
  const int step = numbers.size() > 1 ? numbers[1] - numbers[0] : 1;
  for (std::size_t i = 1; i < numbers.size(); ++i)
    if (numbers[i] - numbers[i - 1] != step) return false;
  if (numbers.empty()) return false;
  if (!write) return true;
  integer(static_cast<int>(report.kind));
  integer(report.group < 0 ? 0 : group_number(report.group));
  integer(numbers.front());
  integer(numbers.back());
  integer(step);
  integer(report.stage + 1);
  for (double value : {report.height, report.area, report.cell_pressure}) real(value);
  line();
  return true;
}

std::string Sage1Writer::deck() {
  number_groups();
  if (wide_) text_.append("* layout: ").append(kWideLayout) += '\n';
  name(model_.title.starts_with('*') ? " " + model_.title : model_.title, 80);
  line();
  text_ += wide_ ? "* length force   stress                   p_a             gamma_w\n"
                 : "* length force   stress         p_a   gamma_w\n";
  for (const std::string& unit : {model_.units.length, model_.units.force, model_.units.stress}) name(unit, 8);
  real(model_.units.atmospheric_pressure);
  real(model_.units.water_unit_weight);
  line();
  std::size_t reports = 0;
  for (const Report& r : model_.reports) reports += report(r, false) ? 1 : 0;
  if (reports < model_.reports.size())
    warning(std::to_string(model_.reports.size() - reports) +
            " report(s) left out: their nodes are not in equal steps");
  control(reports);
  nodes();
  materials();
  groups();
  elements();
  if (!model_.fixities.empty()) heading("* first last step xcod ycod");
  for (const Fixity& f : model_.fixities) fixity(f, false);
  for (const FieldFixity& f : model_.field_fixities) fixity(f, false);
  if (!model_.initials.empty()) heading("* group kind      v1        v2        v3        v4");
  for (const InitialStress& i : model_.initials) initial(i);
  for (const Stage& s : model_.stages) stage(s);
  for (const Report& r : model_.reports) report(r, true);
  text_ += "END\n";
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
      std::string text = Sage1Writer(model, words, wide).deck();
      for (const Diagnostic& one : words.list()) diagnostics.add(one);
      return text;
    } catch (const TooWide& number) {
      if (wide)
        throw InputError({model.file, 0, 0, 0}, "the number " + number.digits + " does not fit a sage1 card");
    }
  }
}

}  // namespace sage
