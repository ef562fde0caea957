// One function an element: its catalogue entry with names, formulations and how to make it.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "sage/core/catalogue.hpp"

namespace sage {

// A formulation and the function that makes it.
struct Choice {
  Formulation formulation;
  std::function<std::unique_ptr<Element>(Geometry)> make;
  std::function<std::unique_ptr<Element>(Geometry)> make_large = {};  // empty: it has none
};

// Completes an entry by its formulations and a make() that takes code 0 as the first choice and throws
// ParameterError for a code that isn't listed.
ElementEntry element_entry(ElementEntry entry, std::vector<Choice> choices);

ElementEntry quad4_entry();
ElementEntry quad8_entry();
ElementEntry quad9_entry();
ElementEntry quad25_entry();
ElementEntry quad49_entry();
ElementEntry quad81_entry();
ElementEntry tri3_entry();
ElementEntry tri6_entry();
ElementEntry tri15_entry();
ElementEntry interface4_entry();
ElementEntry interface6_entry();
ElementEntry interface6p4_entry();
ElementEntry contact4_entry();
ElementEntry contact5_entry();
ElementEntry flow_quad4_entry();
ElementEntry flow_quad8_entry();
ElementEntry flow_quad9_entry();
ElementEntry flow_tri3_entry();
ElementEntry flow_tri6_entry();
ElementEntry quad8p4_entry();
ElementEntry quad9p4_entry();
ElementEntry tri6p3_entry();
ElementEntry bar2_entry();
ElementEntry bar3_entry();
ElementEntry spring2_entry();
ElementEntry ring1_entry();
ElementEntry beam2_entry();
ElementEntry beam3_entry();
ElementEntry beam2_hinged_entry();
ElementEntry beam3_hinged_entry();
ElementEntry beam2_pinned_entry();
ElementEntry beam3_pinned_entry();
ElementEntry beam2_axial_release_entry();
ElementEntry beam3_axial_release_entry();
ElementEntry beam2_shear_release_entry();
ElementEntry beam3_shear_release_entry();
ElementEntry rotational_spring1_entry();

}  // namespace sage
