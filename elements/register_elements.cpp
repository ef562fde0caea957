#include "elements/register_elements.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "elements/entries.hpp"

namespace sage {

ElementEntry element_entry(ElementEntry entry, std::vector<Choice> choices) {
  for (const Choice& choice : choices) entry.formulations.push_back(choice.formulation);
  if (std::ranges::any_of(choices, [](const Choice& choice) { return choice.make_large != nullptr; }))
    entry.make_large = [choices](Geometry geometry, int code) -> std::unique_ptr<Element> {
      for (const Choice& choice : choices)
        if (choice.formulation.code == code && choice.make_large) return choice.make_large(geometry);
      return nullptr;
    };
  entry.make = [name = entry.name, choices = std::move(choices)](Geometry geometry, int code) {
    if (code == 0) return choices.front().make(geometry);
    std::string known;
    for (const Choice& choice : choices) {
      if (choice.formulation.code == code) return choice.make(geometry);
      known +=
          (known.empty() ? "" : ", ") + std::to_string(choice.formulation.code) + " " + choice.formulation.name;
    }
    throw ParameterError("S210", -1,
                         name + ": formulation " + std::to_string(code) + " unknown; known: " + known);
  };
  return entry;
}

void register_elements(Catalogue& catalogue) {
  catalogue.elements.add(1, quad4_entry());
  catalogue.elements.add(2, quad8_entry());
  catalogue.elements.add(3, tri3_entry());
  catalogue.elements.add(4, tri6_entry());
  catalogue.elements.add(5, quad9_entry());
  catalogue.elements.add(6, tri15_entry());
  catalogue.elements.add(7, quad25_entry());
  catalogue.elements.add(8, quad49_entry());
  catalogue.elements.add(9, quad81_entry());
  catalogue.elements.add(11, interface4_entry());
  catalogue.elements.add(12, interface6_entry());
  catalogue.elements.add(13, contact4_entry());
  catalogue.elements.add(14, contact5_entry());
  catalogue.elements.add(41, flow_quad4_entry());
  catalogue.elements.add(42, flow_quad8_entry());
  catalogue.elements.add(43, flow_tri3_entry());
  catalogue.elements.add(44, flow_tri6_entry());
  catalogue.elements.add(45, flow_quad9_entry());
  catalogue.elements.add(61, quad8p4_entry());
  catalogue.elements.add(62, quad9p4_entry());
  catalogue.elements.add(63, tri6p3_entry());
  catalogue.elements.add(64, interface6p4_entry());
  catalogue.elements.add(31, bar2_entry());
  catalogue.elements.add(32, bar3_entry());
  catalogue.elements.add(33, spring2_entry());
  catalogue.elements.add(34, ring1_entry());
  catalogue.elements.add(35, beam2_entry());
  catalogue.elements.add(36, beam3_entry());
  catalogue.elements.add(37, beam2_hinged_entry());
  catalogue.elements.add(38, beam3_hinged_entry());
  catalogue.elements.add(51, beam2_pinned_entry());
  catalogue.elements.add(52, beam3_pinned_entry());
  catalogue.elements.add(53, beam2_axial_release_entry());
  catalogue.elements.add(54, beam3_axial_release_entry());
  catalogue.elements.add(55, beam2_shear_release_entry());
  catalogue.elements.add(56, beam3_shear_release_entry());
  catalogue.elements.add(57, rotational_spring1_entry());
}

}  // namespace sage
