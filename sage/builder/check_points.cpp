// Places of point reports.
#include <algorithm>

#include "sage/builder/builder.hpp"
#include "sage/model/activity.hpp"
#include "sage/model/locate.hpp"

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

}  // namespace

void check_points(Builder& b) {
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
