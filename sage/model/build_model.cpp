#include "sage/model/build_model.hpp"

#include <cmath>

#include "sage/model/builder.hpp"
#include "sage/model/canonical.hpp"

namespace sage {

namespace build {

bool Builder::usable(const CardView& card, std::string_view field, double value) {
  if (std::isfinite(value) && std::abs(value) < 1e100) return true;
  error(card.where(field), "the " + card.label(field) + " is too large to compute with (beyond 1e100)");
  return false;
}

int Builder::node(const CardView& card, std::string_view field, int number) {
  const auto it = node_index.find(number);
  if (it != node_index.end()) return it->second;
  error(card.where(field), "node " + std::to_string(number) + " is not defined by any node or fill card");
  return -1;
}

void build_control(Builder& b) {
  Model& model = b.model;
  model.file = b.deck.file;
  if (b.deck.has("title")) model.title = b.deck.one("title").text("title");
  if (b.deck.has("units")) {
    const CardView card = b.deck.one("units");
    model.units = {card.text("length", "-"), card.text("force", "-"), card.text("stress", "-"),
                   card.real("atmospheric_pressure"), card.real("water_unit_weight")};
    for (const char* field : {"atmospheric_pressure", "water_unit_weight"}) {
      if (b.usable(card, field, card.real(field)) && card.real(field) < 0.0)
        b.error(card.where(field), "the " + card.label(field) + " must not be negative");
    }
  }
  const CardView card = b.deck.one("control");
  const int code = b.options.geometry != 0 ? b.options.geometry : card.integer("geometry", 1);
  if (code != 1 && code != 2)
    b.error(card.where("geometry"),
            "geometry " + std::to_string(code) + " is unknown; 1 plane strain, 2 axisymmetric");
  model.geometry = code == 2 ? Geometry::axisymmetric : Geometry::plane_strain;
  model.solver = card.integer("solver", 0);
  if (model.solver != 0 && b.catalogue.solvers.find(model.solver) == nullptr)
    b.error(card.where("solver"), "solver " + std::to_string(model.solver) + " is unknown; 0 automatic, " +
                                      b.catalogue.solvers.known());
}

void build_reports(Builder& b) {
  for (const CardView& card : b.deck.all("report")) {
    Report report;
    report.where = card.where();
    const int kind = card.integer("kind", 1);
    if (kind != 1 && kind != 2) {
      b.error(card.where("kind"), "report kind " + std::to_string(kind) + " is unknown; 1 triaxial, 2 nodes");
      continue;
    }
    report.kind = static_cast<ReportKind>(kind);
    const int first = card.integer("first"), last = std::max(first, card.integer("last", first));
    const int step = std::max(1, card.integer("step", 1));
    for (int number = first; number <= last && card.blank("nodes"); number += step) {
      const int node = b.node(card, number == first ? "first" : "last", number);
      if (node < 0) break;
      report.nodes.push_back(node);
    }
    for (const FieldValue& value : card.list("nodes")) {
      const int node = b.node(card, "nodes", static_cast<int>(value.number));
      if (node >= 0) report.nodes.push_back(node);
    }
    report.height = card.real("height");
    report.area = card.real("area");
    report.cell_pressure = card.real("cell_pressure");
    report.stage = std::max(1, card.integer("stage", 1)) - 1;
    if (report.stage >= static_cast<int>(b.model.stages.size()))
      b.error(card.where("stage"), "the report starts at stage " + std::to_string(report.stage + 1) + " of " +
                                       std::to_string(b.model.stages.size()));
    if (report.kind == ReportKind::triaxial) {
      const auto group = b.group_index.find(card.integer("group"));
      if (group == b.group_index.end())
        b.error(card.where("group"), "group " + std::to_string(card.integer("group")) + " is not defined");
      else
        report.group = group->second;
      if (!(report.height > 0.0))
        b.error(card.where("height"), "a triaxial report needs the specimen height (> 0)");
      if (report.area < 0.0) b.error(card.where("area"), "the area must not be negative");
      for (const char* field : {"height", "area", "cell_pressure"}) b.usable(card, field, card.real(field));
    }
    b.model.reports.push_back(std::move(report));
  }
}

}  // namespace build

Model build_model(const Deck& as_read, const Catalogue& catalogue, const BuildOptions& options) {
  const Deck deck = canonical_deck(as_read, catalogue);
  build::Builder b{deck, catalogue, options, {}, {}, {}, {}, {}, {}};
  b.model.diagnostics = deck.diagnostics;
  build::build_control(b);
  build::build_nodes(b);
  build::build_materials(b);
  build::build_groups(b);
  build::build_elements(b);
  build::build_stages(b);
  build::build_reports(b);
  if (b.problems.errors() > 0) throw InputError(b.problems);
  build::make_mid_nodes(b);
  build::check_model(b);
  if (b.problems.errors() > 0) throw InputError(b.problems);
  return std::move(b.model);
}

}  // namespace sage
