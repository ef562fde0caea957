#include "sage/compare/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>

#include "sage/math/rounding.hpp"
#include "sage/messages/split_at.hpp"
#include "sage/record/extremes.hpp"
#include "sage/record/values.hpp"

namespace sage::compare {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

std::vector<double> numbers(const std::string& text, std::size_t count) {
  std::vector<double> values;
  for (const std::string_view part : split_at(',', text)) {
    const std::string word(part);
    std::size_t used = 0;
    try {
      values.push_back(std::stod(word, &used));
    } catch (const std::exception&) {
      used = std::string::npos;
    }
    if (used != word.size() || !std::isfinite(values.back()))
      throw std::invalid_argument("\"" + word + "\" in \"" + text + "\" is not a number");
  }
  if (values.size() != count)
    throw std::invalid_argument(
        fmt::format("\"{}\" has {} numbers, {} are needed", text, values.size(), count));
  return values;
}

// The parts between colons.
std::vector<std::string> parts_of(const std::string& text, std::size_t most) {
  std::vector<std::string> parts{""};
  for (char c : text) {
    if (c == ':' && parts.size() < most)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

// Values of the same quantities of one side, by their place in a list.
using Values = std::vector<std::pair<std::string, double>>;

struct Table {
  Comparison& comparison;
  std::string section, unit;
  double floor_a = 0.0, floor_b = 0.0;

  void add(const std::string& name, double a, double b, double expected = kUnknown) const {
    Row row{section, name, unit, a, b, expected};
    row.floor_a = floor_a;
    row.floor_b = floor_b;
    comparison.rows.push_back(row);
  }
  // Quantities by name; what only one side has stands with it alone.
  void add(const Values& a, const Values& b) const {
    const auto find = [](const Values& list, const std::string& name) {
      for (const auto& [n, value] : list)
        if (n == name) return value;
      return kUnknown;
    };
    for (const auto& [name, value] : a) add(name, value, find(b, name));
    for (const auto& [name, value] : b)
      if (std::none_of(a.begin(), a.end(), [&, n = name](const auto& one) { return one.first == n; }))
        add(name, kUnknown, value);
  }
};

const Model* model_of(const Side& side) {
  return side.has_model() ? &side.model() : nullptr;
}

const UnitSystem& units_of(const Side& a, const Side& b) {
  static const UnitSystem none;
  return model_of(a) != nullptr ? a.model().units : model_of(b) != nullptr ? b.model().units : none;
}

double part(long count, long all) {
  return all > 0 ? static_cast<double>(count) / static_cast<double>(all) : kUnknown;
}

void add_course(Comparison& c, const Side& a, const Side& b) {
  const auto course = [](const Side& side) {
    Values v;
    if (!side.has_model()) return v;
    const RunRecord& r = side.record();
    RunRecord::StageCount sum;
    for (const auto& stage : r.stages) {
      sum.increments += stage.increments;
      sum.iterations += stage.iterations;
      sum.cuts += stage.cuts;
    }
    v = {{"elements", r.scene.elements},
         {"equations", r.equations},
         {"stages done", r.result.stages_done},
         {"increments done", r.result.increments_done},
         {"iterations", sum.iterations},
         {"cuts of a step", sum.cuts},
         {"factorisations", static_cast<double>(r.result.work.factorisations)},
         {"warnings", r.warnings}};
    return v;
  };
  Table{c, "course", "-"}.add(course(a), course(b));
  const Table time{c, "course", "s"};
  time.add("time", a.has_model() ? a.record().seconds : kUnknown,
           b.has_model() ? b.record().seconds : kUnknown);
}

void add_points(Comparison& c, const Side& a, const Side& b) {
  const auto fractions = [](const Side& side) {
    Values v;
    if (!side.has_state()) return v;
    const PointCounts n = count_points(side.model().mesh, side.last());
    v.emplace_back("solids: yielded", part(n.yielded, n.solids));
    v.emplace_back("solids: at the apex", part(n.apex, n.solids));
    v.emplace_back("solids: cut off in tension", part(n.cut_off, n.solids));
    if (n.interfaces > 0) {
      v.emplace_back("interfaces: slipping", part(n.slipping, n.interfaces));
      v.emplace_back("interfaces: open", part(n.open, n.interfaces));
    }
    return v;
  };
  Table{c, "points", "-"}.add(fractions(a), fractions(b));
}

bool one_geometry(const Side& a, const Side& b) {
  return !a.has_model() || !b.has_model() || a.model().geometry == b.model().geometry;
}

std::string axis(const Side& a, const Side& b, int component) {
  const auto ring = [](const Side& s) { return s.has_model() && s.model().geometry == Geometry::axisymmetric; };
  if (component == 0) return ring(a) && ring(b) ? "r" : ring(a) || ring(b) ? "x (r)" : "x";
  return ring(a) && ring(b) ? "z" : ring(a) || ring(b) ? "y (z)" : "y";
}

void add_totals(Comparison& c, const Side& a, const Side& b) {
  const std::size_t stages = std::max(a.stages().size(), b.stages().size());
  for (std::size_t s = 0; s < stages; ++s) {
    const Table table{c, fmt::format("forces, end of stage {}", s + 1), units_of(a, b).force, a.floors().force,
                      b.floors().force};
    const auto value = [&](const Side& side, Vector2 StageState::*what, int component) {
      return s < side.stages().size() ? (side.stages()[s].*what)[component] : kUnknown;
    };
    for (int k : {0, 1})
      for (const auto& [name, what] :
           {std::pair{"loads", &StageState::applied}, std::pair{"reactions", &StageState::reactions}})
        table.add(fmt::format("{} along {}", name, axis(a, b, k)), value(a, what, k), value(b, what, k));
  }
}

const Face* face_of(const Side& side, const std::string& name) {
  for (const Face& face : side.faces())
    if (face.name == name) return &face;
  return nullptr;
}

// Of a stage; NaN where a side has no such face.
double face_stress(const Side& side, std::size_t stage, const std::string& name,
                   double (*stress)(const Face&, const FaceState&)) {
  if (stage >= side.stages().size() || side.stages()[stage].faces.empty()) return kUnknown;
  for (std::size_t i = 0; i < side.faces().size(); ++i)
    if (side.faces()[i].name == name) return stress(side.faces()[i], side.stages()[stage].faces[i]);
  return kUnknown;
}

void add_faces(Comparison& c, const Side& a, const Side& b) {
  const std::size_t stages = std::max(a.stages().size(), b.stages().size());
  const auto floor = [](const Side& side, const std::string& name) {
    const Face* face = face_of(side, name);
    return face != nullptr && face->area > 0.0 ? side.floors().force / face->area : 0.0;
  };
  const auto modulus = [](const Side& side, std::size_t s) {
    return s < side.stages().size() && uniform_ends(side, s) ? apparent_modulus(side, s) : kUnknown;
  };
  for (std::size_t s = 0; s < stages; ++s) {
    const std::string section = fmt::format("sides, end of stage {}", s + 1);
    for (const char* name : {"bottom", "top", "left", "right"}) {
      const Table table{c, section, units_of(a, b).stress, floor(a, name), floor(b, name)};
      for (const auto& [what, of] : {std::pair{": mean normal stress", &normal_stress},
                                     std::pair{": mean shear stress", &shear_stress}}) {
        const double va = face_stress(a, s, name, of), vb = face_stress(b, s, name, of);
        if (!std::isnan(va) || !std::isnan(vb)) table.add(std::string(name) + what, va, vb);
      }
    }
    const double ma = modulus(a, s), mb = modulus(b, s);
    if (!std::isnan(ma) || !std::isnan(mb))
      Table{c, section, units_of(a, b).stress}.add("stress of the top / strain of the height", ma, mb);
  }
}

// Rows of a report by stage and increment.
template <class ReportRow>
std::map<std::pair<int, int>, ReportRow> by_step(const std::vector<ReportRow>& rows) {
  std::map<std::pair<int, int>, ReportRow> map;
  for (const ReportRow& row : rows) map[{row.stage, row.increment}] = row;
  return map;
}

// The last step of every stage, and the last that both sides reached.
template <class ReportRow>
std::set<std::pair<int, int>> shown_steps(const std::map<std::pair<int, int>, ReportRow>& a,
                                          const std::map<std::pair<int, int>, ReportRow>& b) {
  std::map<int, int> last;
  std::pair<int, int> common{0, 0};
  for (const auto* rows : {&a, &b})
    for (const auto& [step, row] : *rows) {
      last[step.first] = std::max(last[step.first], step.second);
      if (a.count(step) && b.count(step)) common = std::max(common, step);
    }
  std::set<std::pair<int, int>> shown(last.begin(), last.end());
  if (common.first > 0) shown.insert(common);
  return shown;
}

void add_triaxial(Comparison& c, const Side& a, const Side& b, std::size_t i) {
  const auto rows = [&](const Side& side) {
    return side.has_model() && i < side.reports().count() ? by_step(side.reports().triaxial(i))
                                                          : std::map<std::pair<int, int>, TriaxialRow>{};
  };
  const auto ra = rows(a), rb = rows(b);
  std::set<std::pair<int, int>> steps;
  for (const auto* map : {&ra, &rb})
    for (const auto& [step, row] : *map) steps.insert(step);
  const auto ends = shown_steps(ra, rb);
  const UnitSystem& u = units_of(a, b);
  for (const auto& step : steps) {
    std::vector<Row>& list = ends.count(step) ? c.rows : c.details;
    const auto value = [&](const auto& map, double TriaxialRow::*what) {
      const auto it = map.find(step);
      return it == map.end() ? kUnknown : it->second.*what;
    };
    const std::string section =
        fmt::format("report {}, stage {}, increment {}", i + 1, step.first, step.second);
    const auto add = [&](const char* name, const std::string& unit, double TriaxialRow::*what,
                         double expected = kUnknown) {
      list.push_back({section, name, unit, value(ra, what), value(rb, what), expected});
    };
    const double expected =
        value(rb, &TriaxialRow::correct_deviator) / value(ra, &TriaxialRow::correct_deviator);
    add("axial strain", "-", &TriaxialRow::axial_strain);
    add("force", u.force, &TriaxialRow::force);
    add("measured deviator", u.stress, &TriaxialRow::measured_deviator, expected);
    add("correct deviator", u.stress, &TriaxialRow::correct_deviator);
    add("measured / correct", "-", &TriaxialRow::ratio);
  }
}

// What the force of a report along x (component 0) or y acts on, by the places of its nodes: what they span across that
// direction, or else along it; of a unit of thickness or the full circle.  NaN where they span nothing.  (An area on
// the card holds for one geometry.)
double loaded_area(const Model& model, const Report& report, int component) {
  Vector2 low = Vector2::Constant(kInfinite), high = -low;
  for (int node : report.nodes) {
    low = low.cwiseMin(model.mesh.x.col(node));
    high = high.cwiseMax(model.mesh.x.col(node));
  }
  const int other = 1 - component, along = high[other] > low[other] ? other : component;
  if (!(high[along] > low[along])) return kUnknown;
  if (model.geometry != Geometry::axisymmetric) return high[along] - low[along];
  if (along == 0) return kPi * (high.x() * high.x() - low.x() * low.x());
  return kPi * (high.x() + low.x()) * (high.y() - low.y());
}

void add_node_report(Comparison& c, const Side& a, const Side& b, std::size_t i) {
  const auto rows = [&](const Side& side) {
    return side.has_model() && i < side.reports().count() ? by_step(side.reports().nodes(i))
                                                          : std::map<std::pair<int, int>, NodesRow>{};
  };
  const auto ra = rows(a), rb = rows(b);
  std::set<std::pair<int, int>> steps;
  for (const auto* map : {&ra, &rb})
    for (const auto& [step, row] : *map) steps.insert(step);
  const auto ends = shown_steps(ra, rb);
  const auto area = [&](const Side& side, int k) {
    if (!side.has_model() || i >= side.model().reports.size()) return kUnknown;
    const Report& report = side.model().reports[i];
    return one_geometry(a, b) ? report_area(side.model(), report) : loaded_area(side.model(), report, k);
  };
  const UnitSystem& u = units_of(a, b);
  for (const auto& step : steps) {
    std::vector<Row>& list = ends.count(step) ? c.rows : c.details;
    const std::string section =
        fmt::format("report {}, stage {}, increment {}", i + 1, step.first, step.second);
    for (int k : {0, 1}) {
      const auto value = [&](const auto& map, auto what) {
        const auto it = map.find(step);
        return it == map.end() ? kUnknown : what(it->second)[k];
      };
      const auto moved = [](const NodesRow& row) { return row.displacement; };
      const auto force = [](const NodesRow& row) { return row.force; };
      const double fa = value(ra, force), fb = value(rb, force), area_a = area(a, k), area_b = area(b, k);
      list.push_back({section, "mean displacement along " + axis(a, b, k), u.length, value(ra, moved),
                      value(rb, moved), kUnknown});
      list.push_back({section, "force along " + axis(a, b, k), u.force, fa, fb, kUnknown});
      if (area_a > 0.0 || area_b > 0.0)
        list.push_back({section, "force / area along " + axis(a, b, k), u.stress,
                        area_a > 0.0 ? fa / area_a : kUnknown, area_b > 0.0 ? fb / area_b : kUnknown,
                        kUnknown});
    }
  }
}

// Values of a row by the names of these columns: sections of rings have more of them than those of plane strain.
std::vector<double> values_of(const Side& side, std::size_t report, std::size_t row,
                              const std::vector<ReportColumn>& columns) {
  const std::vector<ReportColumn>& own = side.reports().columns(report);
  const std::vector<double> values = side.reports().values(report, row);
  std::vector<double> named;
  for (const ReportColumn& column : columns) {
    const auto found = std::ranges::find(own, column.name, &ReportColumn::name);
    named.push_back(found == own.end() ? kUnknown : values[static_cast<std::size_t>(found - own.begin())]);
  }
  return named;
}

void add_point_report(Comparison& c, const Side& a, const Side& b, std::size_t i, const Model& model) {
  using Rows = std::map<std::pair<int, int>, std::vector<double>>;
  const std::vector<ReportColumn> columns = report_columns(model, model.reports[i]);
  const auto rows = [&](const Side& side) {
    Rows map;
    for (std::size_t r = 0; side.has_model() && i < side.reports().count() && r < side.reports().rows(i); ++r)
      map[side.reports().step(i, r)] = values_of(side, i, r, columns);
    return map;
  };
  const Rows ra = rows(a), rb = rows(b);
  std::set<std::pair<int, int>> steps;
  for (const auto* map : {&ra, &rb})
    for (const auto& [step, row] : *map) steps.insert(step);
  const auto ends = shown_steps(ra, rb);
  for (const auto& step : steps) {
    std::vector<Row>& list = ends.count(step) ? c.rows : c.details;
    const std::string section =
        fmt::format("{}, stage {}, increment {}", report_title(model, i), step.first, step.second);
    const auto value = [&](const Rows& map, std::size_t k) {
      const auto it = map.find(step);
      return it == map.end() ? kUnknown : it->second[k];
    };
    for (std::size_t k = 0; k < columns.size(); ++k)
      list.push_back({section, columns[k].name, columns[k].unit, value(ra, k), value(rb, k), kUnknown});
  }
}

void add_reports(Comparison& c, const Side& a, const Side& b) {
  const auto count = [](const Side& side) { return side.has_model() ? side.reports().count() : 0; };
  for (std::size_t i = 0; i < std::max(count(a), count(b)); ++i) {
    const Side& any = i < count(a) ? a : b;
    const ReportKind kind = any.model().reports[i].kind;
    if (i < count(a) && i < count(b) && b.model().reports[i].kind != kind)
      continue;  // the decks ask for others
    if (kind == ReportKind::triaxial)
      add_triaxial(c, a, b, i);
    else if (kind == ReportKind::nodes)
      add_node_report(c, a, b, i);
    else
      add_point_report(c, a, b, i, any.model());
  }
}

struct Component {
  std::string name, unit;
};

std::vector<Component> components_of(const FieldList& fields, const UnitSystem& units) {
  std::vector<Component> components;
  for (const FieldEntry* field : fields)
    for (std::size_t c = 0; c < field->size(); ++c) {
      const std::string& name = field->symbol.empty() ? field->name : field->symbol;
      components.push_back({field->components.empty() ? name : name + "_" + field->components[c].name,
                            unit_text(field->dimension, units)});
    }
  return components;
}

// The rows that either side's results have.
FieldTable table_of(const Side& a, const Side& b) {
  FieldTable table = a.has_model() ? fields_of(a.model()) : FieldTable();
  table.add_free((b.has_model() ? fields_of(b.model()) : FieldTable()).rows());
  return table;
}

// The least and the largest of each force and moment, for each unit of width or circumference in both geometries, by
// the structures' names.
void add_structures(Comparison& c, const Side& a, const Side& b) {
  struct Extreme {
    std::string section, name, unit;
    double value;
  };
  const auto extremes_of = [](const Side& side) {
    std::vector<Extreme> list;
    if (!side.has_state()) return list;
    const Model& model = side.model();
    const FieldList fields = structure_forces(model);
    for (const ExtremeRow& row : extremes(model, 0, side.last())) {
      if (row.low == 0.0 && row.high == 0.0) continue;  // what the geometry does not have
      const FieldEntry& field = *fields[row.field];
      const std::string section = "structure " + structure_name(model.groups[row.group]) + ", end of the run",
                        unit = unit_text(field.dimension, model.units);
      list.push_back({section, field.name + ", least", unit, row.low});
      list.push_back({section, field.name + ", largest", unit, row.high});
    }
    return list;
  };
  const std::vector<Extreme> of_a = extremes_of(a), of_b = extremes_of(b);
  const auto find = [](const std::vector<Extreme>& list, const Extreme& one) {
    const auto at = std::ranges::find_if(
        list, [&](const Extreme& e) { return e.section == one.section && e.name == one.name; });
    return at == list.end() ? nullptr : &*at;
  };
  for (const Extreme& one : of_a) {
    const Extreme* other = find(of_b, one);
    c.rows.push_back({one.section, one.name, one.unit, one.value, other != nullptr ? other->value : kUnknown});
  }
  for (const Extreme& one : of_b)
    if (find(of_a, one) == nullptr) c.rows.push_back({one.section, one.name, one.unit, kUnknown, one.value});
}

// By the means of its places, which are in the CSV one by one.
void add_line(Comparison& c, const Side& a, const Side& b, const Line& line, const FieldList& fields) {
  const std::vector<Component> components = components_of(fields, units_of(a, b));
  std::vector<Sample> samples[2];
  const Side* sides[2] = {&a, &b};
  for (std::size_t k = 0; k < 2; ++k) {
    if (!sides[k]->has_state()) continue;
    const Solution last = sides[k]->last();
    const Sampler sampler(sides[k]->model(), last, fields);
    for (int i = 0; i < line.n; ++i) {
      const double t = static_cast<double>(i) / (line.n - 1);
      samples[k].push_back(sampler.at((1.0 - t) * line.from + t * line.to));
    }
  }
  const auto value = [&](std::size_t k, int i, std::size_t component) {
    return samples[k].empty() ? kUnknown : samples[k][i].values[component];
  };
  for (int i = 0; i < line.n; ++i) {
    const double t = static_cast<double>(i) / (line.n - 1);
    const Vector2 place = (1.0 - t) * line.from + t * line.to;
    const std::string section = fmt::format("line {} at ({:.6g}; {:.6g})", line.name, place.x(), place.y());
    for (std::size_t n = 0; n < components.size(); ++n)
      c.details.push_back(
          {section, components[n].name, components[n].unit, value(0, i, n), value(1, i, n), kUnknown});
  }
  // A side without results has no places, and takes none from the other.
  std::vector<int> common;
  for (int i = 0; i < line.n; ++i)
    if (std::ranges::all_of(
            samples, [i](const std::vector<Sample>& side) { return side.empty() || side[i].element > 0; }))
      common.push_back(i);
  const int n = static_cast<int>(common.size());
  const std::string section = n == line.n
                                  ? fmt::format("line {}: mean of {} places", line.name, line.n)
                                  : fmt::format("line {}: mean of {} of {} places", line.name, n, line.n);
  if (n < line.n)
    c.notes.push_back(fmt::format("line {}: {} of {} places lie outside of one mesh or both; the means are {}",
                                  line.name, line.n - n, line.n,
                                  n > 0 ? "over the other " + std::to_string(n) : std::string("not known")));
  for (std::size_t q = 0; q < components.size(); ++q) {
    double mean[2] = {0.0, 0.0};
    for (std::size_t k = 0; k < 2; ++k) {
      for (const int i : common) mean[k] += value(k, i, q) / n;
      if (n == 0) mean[k] = kUnknown;
    }
    c.rows.push_back({section, components[q].name, components[q].unit, mean[0], mean[1], kUnknown});
  }
}

// Rows of results without floors of their own: by what they measure.
void set_floors(std::vector<Row>& rows, const Side& a, const Side& b) {
  const UnitSystem& u = units_of(a, b);
  const auto floor = [&](const Side& side, const std::string& unit) {
    if (unit == u.force) return side.floors().force;
    if (unit == u.stress) return side.floors().stress;
    return unit == u.length ? side.floors().displacement : 0.0;
  };
  for (Row& row : rows) {
    if (row.floor_a > 0.0 || row.floor_b > 0.0 || row.unit == "-") continue;
    row.floor_a = floor(a, row.unit);
    row.floor_b = floor(b, row.unit);
  }
}

// Whether a number is for a unit of thickness in plane strain and for the full circle in axisymmetry.
bool of_the_whole(const std::string& unit, const UnitSystem& units) {
  return unit == units.force || unit == unit_text(Dimension::discharge, units);
}

void set_comparable(std::vector<Row>& rows, const Side& a, const Side& b) {
  if (one_geometry(a, b)) return;
  for (Row& row : rows)
    row.comparable = row.section.starts_with("structure ") || !of_the_whole(row.unit, units_of(a, b));
}

void set_scales(std::vector<Row>& rows) {
  std::map<std::pair<std::string, std::string>, double> scale;
  for (const Row& row : rows)
    for (double value : {row.a, row.b}) {
      double& largest = scale[{row.section, row.unit}];
      if (std::abs(value) > largest) largest = std::abs(value);
    }
  for (Row& row : rows) row.scale = scale[{row.section, row.unit}];
}

bool same_mesh(const Side& a, const Side& b) {
  if (!a.has_state() || !b.has_state()) return false;
  const Mesh &ma = a.model().mesh, &mb = b.model().mesh;
  return ma.number == mb.number && ma.x == mb.x;
}

// Same nodes: the largest displacement of each side, and the largest difference of any node.
void add_nodal(Comparison& c, const Side& a, const Side& b) {
  if (!same_mesh(a, b)) return;
  const Eigen::VectorXd &ua = *a.last().u, &ub = *b.last().u;
  for (int k : {0, 1}) {
    const Table table{c, "nodes (same mesh)", units_of(a, b).length};
    double largest_a = 0.0, largest_b = 0.0, difference = -1.0;
    int worst = 0;
    for (int n = 0; n < a.model().mesh.nodes(); ++n) {
      const int dof = DofMap::displacement(n, k);
      largest_a = std::max(largest_a, std::abs(ua[dof]));
      largest_b = std::max(largest_b, std::abs(ub[dof]));
      const double d = std::abs(ub[dof] - ua[dof]);
      if (d > difference) {
        difference = d;
        worst = n;
      }
    }
    const std::string direction = axis(a, b, k);
    table.add("largest |u| along " + direction, largest_a, largest_b);
    table.add(
        fmt::format("u along {} of node {} (largest difference)", direction, a.model().mesh.number[worst]),
        ua[DofMap::displacement(worst, k)], ub[DofMap::displacement(worst, k)]);
  }
}

void add_notes(Comparison& c, const Side& a, const Side& b) {
  if (!a.has_model() || !b.has_model()) return;
  const Model &ma = a.model(), &mb = b.model();
  if (ma.geometry != mb.geometry)
    c.notes.push_back(
        "Forces are not comparable as they stand: axisymmetry has the full circle (2 pi r), plane strain a "
        "unit "
        "thickness. Compare the mean stresses of the sides.");
  if (a.has_state() && b.has_state()) {
    const StageState &last_a = a.stages().back(), &last_b = b.stages().back();
    if (last_a.stage != last_b.stage || last_a.load_factor != last_b.load_factor)
      c.notes.push_back(
          fmt::format("The runs end at different loads, so that ends of stages, fields and theory are not for "
                      "the same state: A at "
                      "{:.4g} of stage {}, B at {:.4g} of stage {}. The reports also show the last increment "
                      "that both reached.",
                      last_a.load_factor, last_a.stage + 1, last_b.load_factor, last_b.stage + 1));
  }
  const auto differ = [](const std::string& x, const std::string& y) { return x != "-" && y != "-" && x != y; };
  if (differ(ma.units.length, mb.units.length) || differ(ma.units.force, mb.units.force) ||
      differ(ma.units.stress, mb.units.stress))
    c.notes.push_back(fmt::format(
        "The decks have different units ({} {} {} and {} {} {}): numbers are not converted.", ma.units.length,
        ma.units.force, ma.units.stress, mb.units.length, mb.units.force, mb.units.stress));
  const auto elements = [](const Model& m) {
    std::set<std::string> names;
    for (const Group& g : m.groups) names.insert(g.element_name);
    return names;
  };
  const auto laws = [](const Model& m) {
    std::vector<std::pair<std::string, std::vector<double>>> list;
    for (const Material& material : m.materials) list.emplace_back(material.law_name, material.parameters);
    return list;
  };
  const bool same_elements = elements(ma) == elements(mb), same_laws = laws(ma) == laws(mb);
  if (ma.geometry == mb.geometry && same_laws && same_mesh(a, b)) {
    if (ma.large_strain != mb.large_strain)
      c.notes.push_back(
          "Large strain and small strain: another theory, whose answers come together as motions get small.");
    else if (same_elements)
      c.notes.push_back(
          "Same mesh, elements, laws and geometry: the equations are the same, and theory expects "
          "differences of rounding and of the tolerance of equilibrium only.");
    else
      c.notes.push_back(
          "Same mesh, laws and geometry, other elements: both tend to the same answer as meshes get "
          "finer; the difference shows the size of the mesh's error.");
  }
  if (!same_mesh(a, b) && a.has_state() && b.has_state())
    c.notes.push_back("The meshes differ: fields are compared on lines and at points only.");
}

// Columns of a report that people read first.
bool is_answer(ReportKind kind, const std::string& column) {
  if (kind == ReportKind::triaxial) return column == "measured_deviator" || column == "ratio";
  if (kind == ReportKind::section) return column != "length" && !column.ends_with("_error");
  return !column.starts_with("strain_");
}

// The last row that both sides have.
std::optional<std::pair<std::size_t, std::size_t>> last_common(const Side& a, const Side& b, std::size_t i) {
  for (std::size_t ra = a.reports().rows(i); ra-- > 0;)
    for (std::size_t rb = b.reports().rows(i); rb-- > 0;)
      if (a.reports().step(i, ra) == b.reports().step(i, rb)) return std::pair{ra, rb};
  return std::nullopt;
}

void use_certain(const std::vector<CertainValue>& certain, const std::string& name, double& value,
                 double& error, bool& reached) {
  for (const CertainValue& c : certain)
    if (c.name == name) {
      value = c.value;
      error = c.error;
      reached = c.reached;
    }
}

// A force of a unit of thickness and one of a full circle: each over the area of its report; without areas they have
// no ratio.
void make_comparable(Answer& answer, const Side& a, const Side& b, std::size_t report, int component) {
  const double area_a = loaded_area(a.model(), a.model().reports[report], component),
               area_b = loaded_area(b.model(), b.model().reports[report], component);
  const UnitSystem& u = units_of(a, b);
  if (answer.unit != u.force || std::isnan(area_a + area_b)) {
    answer.comparable = false;
    answer.why = "A for a unit of thickness, B for the full circle: no ratio";
    if (a.model().geometry == Geometry::axisymmetric)
      answer.why = "A for the full circle, B for a unit of thickness: no ratio";
    answer.expected = kUnknown;
    return;
  }
  answer.name += " / area";
  answer.unit = u.stress;
  answer.a /= area_a;
  answer.error_a /= area_a;
  answer.b /= area_b;
  answer.error_b /= area_b;
  answer.expected *= area_a / area_b;
  constexpr std::string_view kAreas = " x areas";  // of the forces' ratio
  if (answer.why.ends_with(kAreas)) answer.why.resize(answer.why.size() - kAreas.size());
}

// Nothing that is zero in both.
void add_answers(Comparison& c, const Side& a, const Side& b, const std::vector<CertainValue>& certain_a,
                 const std::vector<CertainValue>& certain_b) {
  if (!a.has_state() || !b.has_state()) return;
  const UnitSystem& u = units_of(a, b);
  const auto floor = [&](const Side& side, const std::string& unit) {
    if (unit == "-") return 0.0;
    return unit == u.force    ? side.floors().force
           : unit == u.length ? side.floors().displacement
                              : side.floors().stress;
  };
  for (std::size_t i = 0; i < std::min(a.reports().count(), b.reports().count()); ++i) {
    const ReportKind kind = a.model().reports[i].kind;
    const auto rows = last_common(a, b, i);
    if (kind != b.model().reports[i].kind || !rows) continue;
    const bool at_end = rows->first + 1 == a.reports().rows(i) && rows->second + 1 == b.reports().rows(i);
    const std::vector<ReportColumn> columns = report_columns(a.model(), a.model().reports[i]);
    const std::vector<double> va = values_of(a, i, rows->first, columns),
                              vb = values_of(b, i, rows->second, columns);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (!is_answer(kind, columns[k].name)) continue;
      Answer answer;
      answer.name = fmt::format("report{}.{}", i + 1, columns[k].name);
      answer.unit = columns[k].unit;
      answer.a = va[k];
      answer.b = vb[k];
      const double zero_a = floor(a, answer.unit), zero_b = floor(b, answer.unit);
      if (std::abs(va[k]) <= zero_a && std::abs(vb[k]) <= zero_b) continue;
      if (at_end) {
        use_certain(certain_a, answer.name, answer.a, answer.error_a, answer.reached_a);
        use_certain(certain_b, answer.name, answer.b, answer.error_b, answer.reached_b);
      }
      const ExpectedRatio expected = expected_ratio(a, b, i, columns[k].name);
      answer.expected = expected.value;
      answer.why = expected.why;
      if (std::abs(answer.a) <= zero_a) answer.a = 0.0;
      if (std::abs(answer.b) <= zero_b) answer.b = 0.0;
      if (!one_geometry(a, b) && kind != ReportKind::section && of_the_whole(answer.unit, u))
        make_comparable(answer, a, b, i, columns[k].name == "fx" ? 0 : 1);
      c.answers.push_back(answer);
    }
  }
}

}  // namespace

double Row::relative() const {
  constexpr double kRounding = rounding::kRun;
  if (difference() == 0.0) return 0.0;
  return comparable && !zero_a() && std::abs(a) > kRounding * scale ? difference() / std::abs(a) : kUnknown;
}

Line line_from_text(const std::string& text) {
  const std::vector<std::string> parts = parts_of(text, 3);
  const std::vector<double> v = numbers(parts[0], 4);
  Line line{{v[0], v[1]}, {v[2], v[3]}, parts.size() > 1 ? parts[1] : parts[0], 11};
  if (parts.size() > 2) {
    const double n = numbers(parts[2], 1)[0];
    if (n != std::floor(n) || n < 2.0 || n > 10000.0)
      throw std::invalid_argument("\"" + parts[2] + "\": a line has 2 to 10000 places");
    line.n = static_cast<int>(n);
  }
  return line;
}

double Answer::ratio_error() const {
  return std::abs(ratio()) * (error_a / std::abs(a) + error_b / std::abs(b));
}

Comparison compare(const Side& a, const Side& b, const std::vector<Line>& lines,
                   const std::vector<CertainValue>& certain_a, const std::vector<CertainValue>& certain_b,
                   const std::vector<std::string>& fields) {
  Comparison c;
  add_answers(c, a, b, certain_a, certain_b);
  add_course(c, a, b);
  add_points(c, a, b);
  add_totals(c, a, b);
  add_faces(c, a, b);
  add_structures(c, a, b);
  add_reports(c, a, b);
  const FieldTable table = table_of(a, b);
  const FieldList on_lines =
      fields_at_places(table, {"displacement", "stress", "mean_stress", "deviator"}, fields);
  for (const Line& line : lines) add_line(c, a, b, line, on_lines);
  add_nodal(c, a, b);
  for (std::vector<Row>* rows : {&c.rows, &c.details}) {
    set_floors(*rows, a, b);
    set_scales(*rows);
    set_comparable(*rows, a, b);
  }
  c.theory = expectations(a, b);
  add_notes(c, a, b);
  return c;
}

}  // namespace sage::compare
