#include "sage/builder/build_model.hpp"

#include <cmath>

#include "sage/builder/builder.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/exchange/translate.hpp"
#include "sage/model/locate.hpp"
#include "sage/model_file/model_file.hpp"

namespace sage {

namespace builder {

bool Builder::usable(const CardView& card, std::string_view field, double value) {
  if (std::isfinite(value) && std::abs(value) < 1e100) return true;
  error("S208", card.where(field), "the " + card.label(field) + " is too large to compute with (beyond 1e100)");
  return false;
}

std::string Builder::text(const CardView& card, std::string_view field) {
  WellFormed words = card.text_with_flaws(field);
  const std::string label = "the " + card.label(field);
  if (words.latin1)
    warning("S228", card.where(field),
            label + " is not UTF-8 text: it is read as Latin-1, '?' for what that has not");
  if (words.controls)
    warning("S228", card.where(field), label + " holds control characters: '?' stands for them");
  return std::move(words.text);
}

int Builder::node(const CardView& card, std::string_view field, std::int64_t number) {
  if (const int* found = node_index.find(static_cast<int>(number))) return *found;
  if (nodes_known)
    error("S201", card.where(field),
          "node " + std::to_string(number) + " is not defined by any node or fill card");
  return -1;
}

NumberRange Builder::range(const CardView& card, std::string_view first_field) {
  const int first = card.integer(first_field);
  const int last = card.integer("last") == 0 ? first : card.integer("last");
  const int step = card.integer("step") == 0 ? 1 : card.integer("step");
  if (step < 0)
    error("S207", card.where("step"), "the " + card.label("step") + " must not be negative");
  else if (last < first)
    error("S209", card.where("last"),
          "the range runs backwards, from " + std::to_string(first) + " to " + std::to_string(last));
  else if ((std::int64_t{last} - first) % step != 0)
    error("S209", card.where("step"),
          "steps of " + std::to_string(step) + " from " + std::to_string(first) + " do not meet the last, " +
              std::to_string(last));
  else {
    if (card.blank("last") && !card.blank("step") && card.integer("step") != 0)
      note("S219", card.where("step"),
           "a step is given but no last: only " + std::to_string(first) + " is meant");
    if (card.blank("step") && last > first)
      note("S219", card.where(),
           "the step is left blank, which reads as 1: all from " + std::to_string(first) + " to " +
               std::to_string(last));
    return {first, last, step};
  }
  return {};
}

void Builder::group_missing(const SourcePosition& where, int number) {
  if (groups_known)
    error("S203", where, "group " + std::to_string(number) + " is not defined by any group card");
}

void build_control(Builder& b) {
  Model& model = b.model;
  model.file = b.deck.file;
  if (b.deck.has("title")) model.title = b.text(b.deck.one("title"), "title");
  if (b.deck.has("units")) {
    const CardView card = b.deck.one("units");
    model.units = {card.text("length", "-"), card.text("force", "-"), card.text("stress", "-"),
                   card.real("atmospheric_pressure"), card.real("water_unit_weight")};
    for (const char* field : {"atmospheric_pressure", "water_unit_weight"}) {
      if (b.usable(card, field, card.real(field)) && card.real(field) < 0.0)
        b.error("S207", card.where(field), "the " + card.label(field) + " must not be negative");
    }
  }
  const CardView card = b.deck.one("control");
  const int code = b.options.geometry != 0 ? b.options.geometry : card.integer("geometry", 1);
  if (code != 1 && code != 2)
    b.error("S210", card.where("geometry"),
            "geometry " + std::to_string(code) + " is unknown; 1 plane strain, 2 axisymmetric");
  model.geometry = code == 2 ? Geometry::axisymmetric : Geometry::plane_strain;
  model.solver = b.options.solver >= 0 ? b.options.solver : card.integer("solver", 0);
  if (model.solver != 0 && b.catalogue.solvers.find(model.solver) == nullptr)
    b.error("S213", card.where("solver"),
            "solver " + std::to_string(model.solver) + " is unknown; 0 automatic, " +
                b.catalogue.solvers.known() + plugin_hint(model.solver));
  const int strain = card.integer("strain", 0);
  if (strain != 0 && strain != 1)
    b.error("S210", card.where("strain"),
            "size of strains " + std::to_string(strain) + " is unknown; 0 small, 1 large");
  model.large_strain = strain == 1;
  build_plugins(b);
}

namespace {

void read_stage(Builder& b, const CardView& card, Report& report) {
  const int stage = card.integer("stage") == 0 ? 1 : card.integer("stage");
  report.stage = stage - 1;
  if (stage < 1 || stage > static_cast<int>(b.model.stages.size()))
    b.error("S242", card.where("stage"),
            "the report starts at stage " + std::to_string(stage) + "; the deck has " +
                std::to_string(b.model.stages.size()));
}

// Numbers of the card that a report of its kind makes nothing of.
void note_unused(Builder& b, const CardView& card, std::initializer_list<const char*> fields,
                 const std::string& why) {
  std::string ignored;
  for (const char* field : fields)
    if (!card.blank(field) && card.real(field) != 0.0)
      ignored += (ignored.empty() ? "" : ", ") + card.label(field);
  if (!ignored.empty()) b.note("S242", card.where(), why + "; of this card it does not use: " + ignored);
}

// The group that the card names, if any.
void read_group(Builder& b, const CardView& card, Report& report) {
  const int group = card.integer("group");
  if (group == 0) return;
  const auto found = b.group_index.find(group);
  if (found == b.group_index.end())
    b.group_missing(card.where("group"), group);
  else if (b.layer_pieces.empty())  // else parts of it may be groups of their own
    report.group = found->second;
}

// From the point card behind the report card.
void read_point(Builder& b, const CardView& card, Report& report) {
  read_stage(b, card, report);
  read_group(b, card, report);
  note_unused(b, card, {"first", "last", "step", "height", "area", "cell_pressure"},
              "a point report takes its place from the point card behind it (kind 2 reports nodes)");
  const std::vector<CardView> places = b.deck.all("point", card);
  if (places.empty()) {
    b.error("S242", card.where(), "a point report needs a point card with its place, x and y, behind it");
    return;
  }
  const CardView& place = places.front();
  report.where = place.where();
  report.name = b.text(place, "name");
  for (const char* field : {"x", "y"}) b.usable(place, field, place.real(field));
  report.place = {place.real("x"), place.real("y")};
}

// From the point card behind the report card, which has both ends of the cut.
void read_section(Builder& b, const CardView& card, Report& report) {
  read_stage(b, card, report);
  read_group(b, card, report);
  if (const int group = card.integer("group"); group != 0 && !b.layer_pieces.empty())
    b.error("S637", card.where("group"),
            "the initial stresses of this model divide groups into layers; a section can't be one of group " +
                std::to_string(group) + " alone. Leave the group out, and end the cut where the group ends");
  note_unused(b, card, {"first", "last", "step", "height", "area", "cell_pressure"},
              "a section report takes its cut from the point card behind it");
  const std::vector<CardView> cuts = b.deck.all("point", card);
  if (cuts.empty() || (cuts.front().blank("end_x") && cuts.front().blank("end_y"))) {
    b.error(
        "S242", card.where(),
        "a section report needs both ends of its cut: x, y, end_x and end_y on a point card behind it, or from "
        "and to of a model file");
    return;
  }
  const CardView& cut = cuts.front();
  report.where = cut.where();
  report.name = b.text(cut, "name");
  for (const char* field : {"x", "y", "end_x", "end_y"}) b.usable(cut, field, cut.real(field));
  report.place = {cut.real("x"), cut.real("y")};
  report.end = {cut.real("end_x"), cut.real("end_y")};
}

// Reports that the options ask for.
void add_requested_points(Builder& b) {
  for (const PointRequest& request : b.options.points) {
    Report report;
    report.kind = ReportKind::point;
    report.place = request.place;
    report.name = request.name;
    report.where = b.at_line(0);
    if (request.group != 0) {
      const auto found = b.group_index.find(request.group);
      if (found == b.group_index.end())
        b.group_missing(report.where, request.group);
      else
        report.group = found->second;
    }
    b.model.reports.push_back(std::move(report));
  }
}

// Without water and weight there is no factor; a line that stands upright carries nothing.
void check_uplift_line(Builder& b, const CardView& card, const Report& report) {
  if (!b.nodes_known || report.nodes.empty()) return;
  const auto [low, high] =
      std::ranges::minmax(report.nodes, {}, [&](int node) { return b.model.mesh.x(0, node); });
  if (!(b.model.mesh.x(0, high) - b.model.mesh.x(0, low) > b.model.mesh.reach))
    b.error("S242", card.where(card.blank("nodes") ? "first" : "nodes"),
            "uplift needs a line of nodes of some width along x");
  if (!(b.model.units.water_unit_weight > 0.0))
    b.error("S242", card.where(), "uplift needs the unit weight of water of the unit card, and a water card");
}

}  // namespace

void build_reports(Builder& b) {
  for (const CardView& card : b.deck.all("report")) {
    Report report;
    report.where = card.where();
    const int kind = card.integer("kind", 1);
    if (kind < 1 || kind > 6) {
      b.error("S210", card.where("kind"),
              "report kind " + std::to_string(kind) +
                  " is unknown; 1 triaxial, 2 nodes, 3 a point, 4 a discharge, 5 uplift, 6 a section");
      continue;
    }
    report.kind = static_cast<ReportKind>(kind);
    if (report.kind == ReportKind::point || report.kind == ReportKind::section) {
      if (report.kind == ReportKind::point)
        read_point(b, card, report);
      else
        read_section(b, card, report);
      b.model.reports.push_back(std::move(report));
      continue;
    }
    const NumberRange range = card.blank("nodes") ? b.range(card, "first") : NumberRange{};
    for (std::int64_t number = range.first; number <= range.last; number += range.step) {
      const int node = b.node(card, number == range.first ? "first" : "last", number);
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
    read_stage(b, card, report);
    if (report.kind == ReportKind::triaxial) {
      const auto group = b.group_index.find(card.integer("group"));
      if (group == b.group_index.end())
        b.group_missing(card.where("group"), card.integer("group"));
      else
        report.group = group->second;
      if (!(report.height > 0.0))
        b.error("S242", card.where("height"), "a triaxial report needs the specimen height (> 0)");
      if (report.area < 0.0) b.error("S207", card.where("area"), "the area must not be negative");
      if (card.blank("cell_pressure"))
        b.note("S242", card.where(),
               "the cell pressure of this triaxial report is left blank, which reads as 0");
      for (const char* field : {"height", "area", "cell_pressure"}) b.usable(card, field, card.real(field));
      if (b.nodes_known && !report.nodes.empty() && report.area == 0.0 && !(report_area(b.model, report) > 0.0))
        b.error("S242", card.where("area"),
                std::string("give the area: it is left blank and can't be found from the report's nodes, ") +
                    (b.model.geometry == Geometry::axisymmetric ? "all of which lie on the axis"
                                                                : "which have no width along x"));
    }
    if (report.kind == ReportKind::discharge || report.kind == ReportKind::uplift)
      note_unused(b, card, {"height", "area", "cell_pressure"},
                  report.kind == ReportKind::uplift ? "uplift needs the nodes of its line alone"
                                                    : "a discharge needs the nodes of its line alone");
    if (report.kind == ReportKind::uplift) check_uplift_line(b, card, report);
    b.model.reports.push_back(std::move(report));
  }
  add_requested_points(b);
}

void check_totals(Builder& b) {
  const CardView control = b.deck.one("control");
  int elements = 0;
  for (const Group& group : b.model.groups) elements += group.elements();
  const auto compare = [&](const char* field, const char* what, int made) {
    const int total = control.integer(field);
    if (total != 0 && total != made)
      b.error(
          "S215", control.where(field),
          "the deck says " + std::to_string(total) + " " + what + ", the cards make " + std::to_string(made));
  };
  compare("total_nodes", "nodes", b.model.mesh.nodes());
  compare("total_elements", "elements", elements);
}

// What a layout says that the deck asks for and the program has not.
std::vector<LeftOut> left_out_cards(Builder& b, const Deck& as_read) {
  std::vector<LeftOut> all;
  for (const CardView& card : as_read.all("left_out")) {
    const std::string what = card.text("what", "something");
    const SourcePosition where = card.blank("of") ? card.where() : card.where("of");
    const std::string instead = card.text("instead");
    const std::string message = "the deck asks for " + what +
                                (instead.empty() ? ", which this program does not compute"
                                                 : ", which its layout does not translate: " + instead);
    if (card.integer("partial") == 0)
      b.problems.add(card_diagnostic(as_read, Severity::error, "S229", where, message));
    else
      all.push_back({what, card_diagnostic(as_read, Severity::error, "S229", where, message)});
  }
  return all;
}

// A deck that asks for more than there is: refused, or computed in part with a line about it in every result.
void take_left_out(Builder& b, const Deck& as_read) {
  bool refused = false;
  std::vector<LeftOut> list = left_out_cards(b, as_read);
  list.insert(list.end(), b.deck.left_out.begin(), b.deck.left_out.end());
  for (const LeftOut& one : list) {
    Diagnostic message = one.message;
    b.model.left_out.push_back(one.what);
    if (message.severity == Severity::error) {
      refused = true;
      message.severity = b.options.partial ? Severity::warning : Severity::error;
      if (!b.options.partial)
        message.message += " (--partial computes the rest, and says with the results what is missing)";
    }
    (b.options.partial || message.severity != Severity::error ? b.model.diagnostics : b.problems).add(message);
  }
  // Every file that a run writes bears the title.
  if (refused) b.model.title = "PARTIAL: " + b.model.title;
}

}  // namespace builder

namespace {

// With what reading warned of: a number that reads as zero may be why the model makes no sense.
InputError refusal(const Deck& deck, const Diagnostics& problems) {
  Diagnostics all;
  for (const Diagnostic& d : deck.diagnostics.list())
    if (d.severity == Severity::warning) all.add(d);
  for (const Diagnostic& d : problems.list()) all.add(d);
  return InputError(std::move(all));
}

// The names of a draft were not looked at: a field that nobody uses would be lost without a word.
void refuse_draft(const Deck& deck) {
  if (deck.draft)
    throw InputError(
        "S148", {deck.file, 0, 0, 0},
        "the layout \"" + deck.layout +
            "\" is a draft, under which decks can only be shown (sagefe echo, sagefe layout check): "
            "finish it, then delete its line draft = true");
}

}  // namespace

namespace builder {

std::optional<Deck> cards_of(const Deck& as_read, const Catalogue& catalogue) {
  return is_model_file(as_read) ? model_file_deck(as_read, catalogue) : translated_deck(as_read, catalogue);
}

}  // namespace builder

namespace {

// Partial factors that the options ask for.
void take_factors(builder::Builder& b) {
  const BuildOptions& options = b.options;
  if (options.factors.empty()) return;
  const SourcePosition where{b.model.file, 0, 0, 0};
  if (options.factors.size() > 1)
    throw InputError("S742", where,
                     "one set of factors was expected here, not " + std::to_string(options.factors.size()));
  for (const std::vector<int>* list : {&options.actions.variable, &options.actions.structural})
    for (const int stage : *list)
      if (stage < 1 || stage > static_cast<int>(b.model.stages.size()))
        throw InputError("S742", where,
                         "the deck has no stage " + std::to_string(stage) +
                             " for --variable or --structural; it has " +
                             std::to_string(b.model.stages.size()));
  const std::string done = apply_factors(b.model, options.factors.front(), options.actions);
  b.model.diagnostics.add({Severity::note, "S741", where, done, {}});
  const std::vector<std::string> undivided = undivided_materials(b.model, options.factors.front());
  if (undivided.empty()) return;
  std::string text = "these materials keep their strength, because their laws name none to divide:";
  for (const std::string& one : undivided) text += "\n  " + one;
  b.model.diagnostics.add({Severity::warning, "S743", where, text, {}});
}

}  // namespace

Model build_model(const Deck& as_read, const Catalogue& catalogue, const BuildOptions& options) {
  refuse_draft(as_read);
  const std::optional<Deck> rewritten = builder::cards_of(as_read, catalogue);
  const Deck& deck = rewritten ? *rewritten : as_read;
  builder::Builder b{{deck, catalogue, options}, options};
  b.model.diagnostics = deck.diagnostics;
  b.model.fields = catalogue.fields;
  builder::build_control(b);
  builder::take_left_out(b, as_read);
  if (b.problems.errors() > 0 && as_read.has("left_out")) throw refusal(deck, b.problems);
  builder::build_nodes(b);
  builder::build_materials(b);
  builder::build_groups(b);
  builder::build_elements(b);
  builder::split_removed(b);
  builder::split_layers(b);
  builder::build_stages(b);
  builder::build_water(b);
  builder::build_reports(b);
  if (b.problems.errors() == 0) builder::check_totals(b);
  if (b.problems.errors() > 0) throw refusal(deck, b.problems);
  b.model.mesh.reach = reach_of(b.model);
  mesh::refine_as_asked(b);
  if (b.problems.errors() > 0) throw refusal(deck, b.problems);
  mesh::make_mid_nodes(b);
  if (b.problems.errors() == 0) builder::take_stored_heads(b);
  if (b.problems.errors() > 0) throw refusal(deck, b.problems);
  builder::build_laws(b);
  builder::take_large_strain(b);
  if (b.problems.errors() > 0) throw refusal(deck, b.problems);
  take_factors(b);
  builder::check_model(b);
  builder::check_stages(b);
  builder::check_points(b);
  if (b.problems.errors() == 0) builder::check_units(b);
  if (b.problems.errors() == 0) builder::check_plausible(b);
  if (b.problems.errors() == 0) builder::check_coarse(b);
  if (b.problems.errors() > 0) throw refusal(deck, b.problems);
  return std::move(b.model);
}

Model build_materials_alone(const Deck& as_read, const Catalogue& catalogue, const BuildOptions& options) {
  refuse_draft(as_read);
  const std::optional<Deck> rewritten = builder::cards_of(as_read, catalogue);
  const Deck& deck = rewritten ? *rewritten : as_read;
  builder::Builder b{{deck, catalogue, options}, options};
  b.model.fields = catalogue.fields;
  builder::build_control(b);
  builder::build_materials(b);
  if (b.problems.errors() > 0) throw refusal(deck, b.problems);
  return std::move(b.model);
}

}  // namespace sage
