// Places of point reports, and cuts of section reports.
#include <algorithm>

#include "sage/builder/builder.hpp"
#include "sage/model/activity.hpp"
#include "sage/model/locate.hpp"
#include "sage/model/section_cut.hpp"

namespace sage::builder {

namespace {

std::string place_text(const Vector2& place) {
  return "(" + rounded_text(place.x(), 10) + "; " + rounded_text(place.y(), 10) + ")";
}

std::string number_of(const Model& model, std::size_t group) {
  return std::to_string(model.groups[group].number);
}

// Several bodies at one place have stresses of their own there.
void note_boundary(Builder& b, const Report& report, const std::vector<Location>& found) {
  const std::vector<Location> answering = one_body(b.model, found, {}, report.group);
  if (report.group >= 0 || answering.size() == found.size()) return;
  const auto answers = [&](const Location& l) {
    return std::any_of(answering.begin(), answering.end(),
                       [&](const Location& a) { return a.group == l.group && a.element == l.element; });
  };
  std::string others;
  for (const Location& l : found)
    if (!answers(l) && others.empty()) others = number_of(b.model, l.group);
  b.note("S318", report.where,
         "the point " + place_text(report.place) + " lies where bodies meet: group " +
             number_of(b.model, answering.front().group) + " answers while it is active, not group " + others +
             "; give the point's group to choose");
}

bool placed_from(const Model& model, const Report& report, const std::vector<Location>& found) {
  Activity activity(model);
  for (std::size_t s = 0; s < model.stages.size(); ++s) {
    activity.enter(model.stages[s]);
    if (static_cast<int>(s) >= report.stage && !one_body(model, found, activity.group, report.group).empty())
      return true;
  }
  return false;
}

bool cut_from(const Model& model, const Report& report) {
  Activity activity(model);
  for (std::size_t s = 0; s < model.stages.size(); ++s) {
    activity.enter(model.stages[s]);
    if (static_cast<int>(s) >= report.stage &&
        !cut_pieces(model, report.place, report.end, activity.group, report.group).empty())
      return true;
  }
  return false;
}

// What a section report can't be computed for; empty: it can.
std::string fault_of_section(const Model& model, const Report& report) {
  const double radius = 0.5 * (report.place.x() + report.end.x());
  if (!((report.end - report.place).norm() > 0.0)) return "the two ends of its cut are one place";
  if (model.geometry == Geometry::axisymmetric && !(radius > 0.0))
    return "its cut lies on the axis, where a unit of circumference is nothing";
  if (model.large_strain) return "its forces are computed for small strains alone";
  const bool on_others =
      std::ranges::any_of(model.groups, [](const Group& group) { return group.solid() && group.overlay; });
  if (on_others && report.group < 0) return "solids lie on one another (overlay): give the group that is cut";
  if (report.group >= 0 && !model.groups[static_cast<std::size_t>(report.group)].solid())
    return "group " + number_of(model, static_cast<std::size_t>(report.group)) + " has no solids";
  return {};
}

void check_sections(Builder& b) {
  const Model& model = b.model;
  for (const Report& report : model.reports) {
    if (report.kind != ReportKind::section) continue;
    const std::string cut = "the cut from " + place_text(report.place) + " to " + place_text(report.end);
    if (const std::string fault = fault_of_section(model, report); !fault.empty())
      b.error("S636", report.where, "the section can't be computed: " + fault);
    else if (cut_pieces(model, report.place, report.end, {}, report.group).empty())
      b.error("S635", report.where,
              cut + " meets no solid element" +
                  (report.group < 0 ? std::string(" of the mesh")
                                    : " of group " + number_of(model, static_cast<std::size_t>(report.group))));
    else if (!cut_from(model, report))
      b.warning("S638", report.where,
                "no solid on " + cut + " is active from the report's stage on: it shows no forces");
  }
}

}  // namespace

void check_points(Builder& b) {
  check_sections(b);
  const Model& model = b.model;
  const auto is_point = [](const Report& r) { return r.kind == ReportKind::point; };
  if (std::none_of(model.reports.begin(), model.reports.end(), is_point)) return;
  const ElementKind kind = kind_at_points(model);
  const Locator locator(model, kind);
  for (std::size_t i = 0; i < model.reports.size(); ++i) {
    const Report& report = model.reports[i];
    if (!is_point(report)) continue;
    const std::vector<Location> found = locator.at(report.place);
    const bool held = !one_body(model, found, {}, report.group).empty();
    const bool requested = i + b.options.points.size() >= model.reports.size();
    if (!held && requested && b.options.points_outside) continue;
    if (!held)
      b.error("S243", report.where,
              "the point " + place_text(report.place) +
                  (found.empty()
                       ? std::string(" lies outside the mesh: no ") +
                             (kind == ElementKind::flow ? "element of flow" : "solid element") + " holds it"
                       : " does not lie in group " + number_of(model, static_cast<std::size_t>(report.group)) +
                             " but in group " + number_of(model, found.front().group)));
    else if (!placed_from(model, report, found))
      b.warning("S318", report.where,
                "no element that holds the point " + place_text(report.place) +
                    " is active from the report's stage on: it shows nothing");
    else
      note_boundary(b, report, found);
  }
}

}  // namespace sage::builder
