#include "tests/regression/bad_decks.hpp"

namespace sage::test {

namespace {

using Cases = std::vector<BadDeck>;

void bad_counts(Cases& c) {
  const DeckText b = block_deck();
  const auto control = [&](std::initializer_list<const char*> fields) {
    return b.with("control", card(fields));
  };
  c.push_back({"geometry_unknown",
               control({"7", "0", "4", "1", "1", "1", "1", "2", "1", "1", "1", "9", "4"}),
               "control:1-5",
               {"geometry 7 is unknown", "1 plane strain, 2 axisymmetric"}});
  c.push_back({"solver_unknown",
               control({"1", "77", "4", "1", "1", "1", "1", "2", "1", "1", "1", "9", "4"}),
               "control:6-10",
               {"solver 77 is unknown", "skyline_lu"}});
  c.push_back(
      {"solver_for_symmetric_matrices",
       control({"1", "2", "4", "1", "1", "1", "1", "2", "1", "1", "1", "9", "4"})
           .with("material", card({"1", "4", "5"}, {""}))
           .with("parameters", card({}, {"3000.", ".25", "10.", "30.", "0."})),
       "control:6-10",
       {"solver 2: skyline_ldlt is for symmetric matrices only", "material 1 (mohr_coulomb)", "group 1"}});
  c.push_back({"too_few_nodes_announced",
               control({"1", "0", "3", "1", "1", "1", "1", "2", "1", "1", "1", "9", "4"}),
               "node9",
               {"reads as a node card", "the 3 that were announced", "line 3"}});
  c.push_back({"too_many_nodes_announced",
               control({"1", "0", "5", "1", "1", "1", "1", "2", "1", "1", "1", "9", "4"}),
               "fill",
               {"reads as a fill card, but a node card was expected", "4 of 5 read", "line 3"}});
  c.push_back({"no_fill_announced",
               control({"1", "0", "4", "0", "1", "1", "1", "2", "1", "1", "1", "9", "4"}),
               "fill",
               {"fill card", "none was announced"}});
  c.push_back({"too_many_elements",
               control({"1", "0", "4", "1", "1", "1", "2", "2", "1", "1", "1", "9", "4"}),
               "initial",
               {"a fixity card was expected: 1 of 2 read", "one further up is too large"}});
  c.push_back({"too_few_fixities",
               control({"1", "0", "4", "1", "1", "1", "1", "1", "1", "1", "1", "9", "4"}),
               "fixity_left",
               {"reads as a fixity card", "line 3"}});
  c.push_back({"too_many_stages",
               control({"1", "0", "4", "1", "1", "1", "1", "2", "1", "2", "1", "9", "4"}),
               "end",
               {"closes the deck, but a stage card was expected", "a count further up is too large"}});
  c.push_back({"no_stages",
               control({"1", "0", "4", "1", "1", "1", "1", "2", "1", "0", "0", "9", "4"}),
               "stage_title:1-3",
               {"END"}});
  c.push_back({"negative_count",
               control({"1", "0", "-4", "1", "1", "1", "1", "2", "1", "1", "1", "9", "4"}),
               "control:11-15",
               {"number of node cards can't be -4"}});
  c.push_back({"huge_count",
               control({"1", "0", "99999", "1", "1", "1", "1", "2", "1", "1", "1", "9", "4"}),
               "fill",
               {"4 of 99999 read"}});
  c.push_back({"total_nodes_wrong",
               control({"1", "0", "4", "1", "1", "1", "1", "2", "1", "1", "1", "10", "4"}),
               "control:56-60",
               {"the deck says 10 nodes, the cards make 9"}});
  c.push_back({"total_elements_wrong",
               control({"1", "0", "4", "1", "1", "1", "1", "2", "1", "1", "1", "9", "5"}),
               "control:61-65",
               {"the deck says 5 elements, the cards make 4"}});
  c.push_back({"count_with_a_letter",
               control({"1", "0", "4", "1", "1", "1", "X", "2", "1", "1", "1", "9", "4"}),
               "control:31-35",
               {"\"X\" is not an integer", "number of element cards"}});
  c.push_back(
      {"unit_missing", b.with("units", "in      lbf"), "units", {"a value is missing", "unit of stress"}});
  c.push_back({"atmospheric_pressure_negative",
               b.with("units", "in      lbf     psi        -14.696"),
               "units:25-34",
               {"atmospheric pressure", "must not be negative"}});
}

void bad_nodes(Cases& c) {
  const DeckText b = block_deck();
  const auto node3 = [&](std::initializer_list<const char*> i, std::initializer_list<const char*> r) {
    return b.with("node3", card(i, r));
  };
  c.push_back({"letter_in_coordinate",
               node3({"3", "", ""}, {"1.O", "0."}),
               "node3:16-25",
               {"\"1.O\"", "x or radius, length", "the letter O stands where the digit 0 may be meant"}});
  c.push_back({"letter_in_node_number",
               node3({"E", "", ""}, {"1.", "0."}),
               "node3:1-5",
               {"\"E\" is not an integer", "node number"}});
  c.push_back({"node_number_missing",
               node3({"", "", ""}, {"1.", "0."}),
               "node3:1-5",
               {"a value is missing", "node number"}});
  c.push_back({"node_number_zero", node3({"0", "", ""}, {"1.", "0."}), "node3:1-5", {"must be 1 or more"}});
  c.push_back({"node_twice", node3({"1", "", ""}, {"1.", "0."}), "node3:1-5", {"node 1 is defined twice"}});
  c.push_back({"corner_of_fill_missing",
               node3({"2", "", ""}, {"1.", "0."}),
               "fill:1-5",
               {"corner node 3 of the block is not defined"}});
  c.push_back({"coordinate_1e308",
               node3({"3", "", ""}, {"1.E308", "0."}),
               "node3:16-25",
               {"x or radius", "too large to compute with"}});
  c.push_back({"coordinate_beyond_doubles",
               node3({"3", "", ""}, {"1.E400", "0."}),
               "node3:16-25",
               {"\"1.E400\"", "too large"}});
  c.push_back({"coordinate_nan", node3({"3", "", ""}, {"NaN", "0."}), "node3:16-25", {"not a finite number"}});
  c.push_back({"coordinate_infinite",
               node3({"3", "", ""}, {"1.", "Inf"}),
               "node3:26-35",
               {"not a finite number", "y or angle"}});
  c.push_back({"coordinate_system_unknown",
               node3({"3", "", "2"}, {"1.", "0."}),
               "node3:11-15",
               {"coordinate system 2 is unknown", "0 cartesian, 1 polar"}});
  c.push_back({"tab_in_number",
               b.with("node3", "    3\t\t1.0       0."),
               "node3:6-10",
               {"a tab counts as one column"}});
  c.push_back({"generation_never_meets_its_end",
               node3({"3", "4", ""}, {"1.", "0."}),
               "node3:6-10",
               {"the step 4 does not lead from node 1 to node 3"}});
  c.push_back({"generation_step_negative",
               node3({"3", "-1", ""}, {"1.", "0."}),
               "node3:6-10",
               {"must not be negative"}});
  c.push_back({"generation_without_a_start",
               b.with("node1", card({"1", "1", ""}, {"0.", "0."})),
               "node1:6-10",
               {"the first node card cannot generate"}});
  c.push_back({"generation_mixes_systems",
               node3({"3", "1", "1"}, {"1.", "0."}),
               "node3:11-15",
               {"both ends of a generated line must use the same coordinate system"}});
  c.push_back({"spacing_ratio_negative",
               node3({"3", "1", ""}, {"1.", "0.", "-2."}),
               "node3:36-45",
               {"spacing ratio must not be negative"}});
  c.push_back({"fill_without_rows",
               b.with("fill", card({"1", "2", "1", "", "3"})),
               "fill:16-20",
               {"a value is missing", "rows"}});
  c.push_back({"fill_rows_zero",
               b.with("fill", card({"1", "2", "1", "0", "3"})),
               "fill:16-20",
               {"must be 1 or more, not 0"}});
  c.push_back({"fill_rows_overlap",
               b.with("fill", card({"1", "2", "1", "6", "1"})),
               "fill:21-25",
               {"would number two of its nodes alike"}});
  c.push_back({"fill_too_large",
               b.with("fill", card({"1", "99999", "1", "99999", "99999"})),
               "fill:6-10",
               {"more than 20000000 nodes"}});
  c.push_back({"fill_leads_out_of_all_numbers",
               b.with("fill", card({"1", "99999", "99999", "2", "99998"})),
               "fill:1-5",
               {"corner node 9999800002 of the block is not defined"}});
}

void bad_materials(Cases& c) {
  const DeckText b = block_deck(), j = joint_deck();
  const auto parameters = [&](std::initializer_list<const char*> r) {
    return b.with("parameters", card({}, r));
  };
  c.push_back({"law_unknown",
               b.with("material", card({"1", "99", "2"}, {""})),
               "material:6-10",
               {"law 99 is unknown", "linear_elastic"}});
  c.push_back({"material_twice",
               j.with("material_joint", card({"1", "21", "2"}, {""})),
               "material_joint:1-5",
               {"material 1 is defined twice"}});
  c.push_back({"material_number_zero",
               b.with("material", card({"0", "1", "2"}, {""})),
               "material:1-5",
               {"material number must be 1 or more"}});
  c.push_back(
      {"nu_one_half", parameters({"3000.", ".5"}), "parameters:11-20", {"material 1", "poissons_ratio"}});
  c.push_back({"nu_above_one_half", parameters({"3000.", ".7"}), "parameters:11-20", {"poissons_ratio"}});
  c.push_back({"E_zero", parameters({"0.", ".25"}), "parameters:1-10", {"youngs_modulus", "psi"}});
  c.push_back({"E_negative", parameters({"-3000.", ".25"}), "parameters:1-10", {"youngs_modulus"}});
  c.push_back({"E_1e308", parameters({"1.E308", ".25"}), "parameters:1-10", {"youngs_modulus", "too large"}});
  c.push_back({"E_nan", parameters({"nan", ".25"}), "parameters:1-10", {"not a finite number", "parameter"}});
  c.push_back({"parameter_left_blank",
               parameters({"3000."}),
               "parameters",
               {"parameter 2 of linear_elastic, poissons_ratio", "is missing"}});
  c.push_back({"one_parameter_too_few",
               b.with("material", card({"1", "1", "1"}, {""})),
               "parameters",
               {"parameter 2 of linear_elastic, poissons_ratio", "is missing"}});
  c.push_back(
      {"one_parameter_too_many",
       b.with("material", card({"1", "1", "3"}, {""})).with("parameters", card({}, {"3000.", ".25", "7."})),
       "parameters",
       {"law linear_elastic has 2 parameters, the card gives 3"}});
  c.push_back({"no_parameters_announced",
               b.with("material", card({"1", "1", ""}, {""})),
               "parameters:6-10",
               {"group card"},
               4});  // the parameters are read as a group card, the group as one too many
  c.push_back(
      {"parameters_never_end", b.with("material", card({"1", "1", "99999"}, {""})), "parameters", {"99999"}});
  c.push_back({"unit_weight_infinite",
               b.with("material", card({"1", "1", "2"}, {"Infinity"})),
               "material:16-25",
               {"not a finite number", "unit weight, force/length^3"}});
  c.push_back({"joint_law_without_stiffness",
               j.with("parameters_joint", card({}, {"1.E4", "0."})),
               "parameters_joint:11-20",
               {"normal_stiffness", "kPa/m"}});
}

void bad_groups(Cases& c) {
  const DeckText b = block_deck(), j = joint_deck();
  c.push_back({"element_type_unknown",
               b.with("group", card({"1", "77", "1", "1"})),
               "group:6-10",
               {"element type 77 is unknown", "quad4"}});
  c.push_back({"formulation_unknown",
               b.with("group", card({"1", "1", "9", "1"})),
               "group:11-15",
               {"formulation 9 of quad4 is unknown", "0 default"}});
  c.push_back({"material_undefined",
               b.with("group", card({"1", "1", "1", "5"})),
               "group:16-20",
               {"material 5 is not defined"}});
  c.push_back({"group_twice",
               j.with("group_top", card({"1", "1", "", "1"})),
               "group_top:1-5",
               {"group 1 is defined twice"}});
  c.push_back({"group_number_negative",
               j.with("group_top", card({"-3", "1", "", "1"})),
               "group_top:1-5",
               {"group number must be 1 or more"}});
  c.push_back({"solid_law_on_an_interface",
               j.with("group_joint", card({"2", "11", "", "1"})),
               "group_joint:16-20",
               {"group 2: interface4 needs a law for interfaces", "linear_elastic"}});
  c.push_back({"interface_law_on_a_solid",
               j.with("group_top", card({"3", "1", "", "2"})),
               "group_top:16-20",
               {"group 3: quad4 needs a law for solids", "goodman"}});
}

void bad_elements(Cases& c) {
  const DeckText b = block_deck(), j = joint_deck();
  const auto top = [&](std::initializer_list<const char*> i) { return j.with("element_top", card(i)); };
  c.push_back({"element_group_undefined",
               top({"3", "9", "5", "6", "8", "7"}),
               "element_top:6-10",
               {"group 9 is not defined"}});
  c.push_back({"element_twice",
               top({"1", "3", "5", "6", "8", "7"}),
               "element_top:1-5",
               {"element 1 is defined twice"}});
  c.push_back(
      {"element_number_zero", top({"0", "3", "5", "6", "8", "7"}), "element_top:1-5", {"must be 1 or more"}});
  c.push_back({"element_node_undefined",
               top({"3", "3", "5", "6", "88", "7"}),
               "element_top:21-25",
               {"element 3: node 88 is not defined"}});
  c.push_back({"element_node_stands_twice",
               top({"3", "3", "5", "6", "5", "7"}),
               "element_top:21-25",
               {"element 3: node 5 stands twice"}});
  c.push_back({"joint_that_ends_at_one_node",
               j.with("element_joint", card({"2", "2", "3", "4", "4", "5"})),
               "element_joint:21-25",
               {"element 2: node 4 stands twice; a pair of an interface is two nodes at one place"}});
  c.push_back({"element_with_two_nodes", top({"3", "3", "5", "6"}), "element_top:11-15", {"4 nodes", "not 2"}});
  c.push_back({"element_corner_blank",
               top({"3", "3", "5", "6", "", "7"}),
               "element_top:21-25",
               {"element 3: corner node 3", "is missing"}});
  c.push_back({"element_with_five_nodes",
               top({"3", "3", "5", "6", "8", "7", "1"}),
               "element_top:11-15",
               {"4 nodes", "not 5"}});
  c.push_back({"clockwise",
               top({"3", "3", "7", "8", "6", "5"}),
               "element_top",
               {"element 3 (quad4", "clockwise", "4 3 2 1 would be right"}});
  c.push_back(
      {"crossed", top({"3", "3", "5", "6", "7", "8"}), "element_top", {"element 3", "crossed (bow-tie)"}});
  c.push_back({"re_entrant",
               j.with("node8", card({"8", "", ""}, {".2", "1.2"})),
               "element_top",
               {"element 3", "re-entrant corner at local node 3"}});
  c.push_back(
      {"zero_area",
       j.with("node7", card({"7", "", ""}, {"2.", "1."})).with("node8", card({"8", "", ""}, {"3.", "1."})),
       "element_top",
       {"element 3", "zero area"}});
  c.push_back({"negative_radius",
               b.with("control", card({"2", "0", "4", "1", "1", "1", "1", "2", "1", "1", "1"}))
                   .with("node1", card({"1", "", ""}, {"-.5", "0."}))
                   .with("node7", card({"7", "", ""}, {"-.5", "1."})),
               "element",
               {"node on negative radius", "the axis of symmetry is r = 0", "(and 1 more of this card)"}});
  c.push_back({"interface_pair_apart",
               j.with("node6", card({"6", "", ""}, {"1.01", "1."})),
               "element_joint",
               {"element 2", "pair (2, 3)", "must be at the same place"}});
  c.push_back({"interface_order",
               j.with("element_joint", card({"2", "2", "3", "4", "5", "6"})),
               "element_joint",
               {"element 2", "node order 1 2 4 3"}});
  c.push_back(
      {"interface_sides_swapped",
       j.with("element_joint", card({"2", "2", "5", "6", "4", "3"})),
       "element_joint:11-30",
       {"element 2 (interface4", "its sides are swapped",
        "element 3, which owns its nodes 1 and 2, lies to the left of the line from node 1 to node 2",
        "element 1, which owns its nodes 3 and 4, lies to the right", "node order 4 3 2 1 would be right"}});
  c.push_back({"interface_both_bodies_on_one_side",
               j.with("element_top", card({"3", "3", "3", "4", "8", "7"}))
                   .with("element_joint", card({"2", "2", "3", "4", "6", "5"}))
                   .with("element_bottom", card({"1", "1", "5", "6", "8", "7"})),
               "element_joint:11-30",
               {"both sides belong to bodies on the left", "which overlap there"}});
  c.push_back({"interface_zero_length",
               j.with("element_joint", card({"2", "2", "3", "4", "6", "5"}))
                   .with("node4", card({"4", "", ""}, {"0.", "1."}))
                   .with("node6", card({"6", "", ""}, {"0.", "1."})),
               "element_joint",
               {"element 2", "zero length"},
               3});
  const auto block = [&](std::initializer_list<const char*> i) { return b.with("element", card(i)); };
  c.push_back({"element_block_too_wide",
               block({"1", "1", "1", "2", "5", "4", "", "", "", "", "9", "2", "1", "3"}),
               "element:21-25",
               {"element 6: node 10 is not defined"}});
  c.push_back({"element_block_too_large",
               block({"1", "1", "1", "2", "5", "4", "", "", "", "", "99999", "99999", "1", "3"}),
               "element:51-55",
               {"more than 50000000 elements"}});
  c.push_back({"element_block_without_row_step",
               block({"1", "1", "1", "2", "5", "4", "", "", "", "", "2", "2", "1", ""}),
               "element:66-70",
               {"more than one row of elements needs the node step"}});
  c.push_back({"element_block_column_step_zero",
               block({"1", "1", "1", "2", "5", "4", "", "", "", "", "2", "2", "0", "3"}),
               "element:61-65",
               {"more than one column of elements needs the node step"}});
  c.push_back({"element_block_columns_negative",
               block({"1", "1", "1", "2", "5", "4", "", "", "", "", "-2", "2", "1", "3"}),
               "element:51-55",
               {"columns of elements must not be negative"}});
  c.push_back({"element_block_runs_below_node_1",
               block({"1", "1", "1", "2", "5", "4", "", "", "", "", "2", "1", "-1", ""}),
               "element:11-15",
               {"its block leads to node 0"}});
}

void bad_supports(Cases& c) {
  const DeckText b = block_deck(), j = joint_deck();
  const auto left = [&](std::initializer_list<const char*> i, std::initializer_list<const char*> r = {}) {
    return b.with("fixity_left", card(i, r));
  };
  c.push_back({"fixity_code_unknown",
               left({"1", "7", "3", "3", "0"}),
               "fixity_left:16-20",
               {"code 3 is unknown", "0 unchanged, 1 fixed"}});
  c.push_back({"fixity_node_undefined",
               left({"1", "10", "3", "1", "0"}),
               "fixity_left:6-10",
               {"node 10 is not defined"}});
  c.push_back({"fixity_range_backwards",
               left({"7", "1", "3", "1", "0"}),
               "fixity_left:6-10",
               {"the range runs backwards, from 7 to 1"}});
  c.push_back({"fixity_step_misses_the_last",
               left({"1", "7", "4", "1", "0"}),
               "fixity_left:11-15",
               {"steps of 4 from 1 do not meet the last, 7"}});
  c.push_back({"fixity_step_negative",
               left({"1", "7", "-3", "1", "0"}),
               "fixity_left:11-15",
               {"increment of node numbers must not be negative"}});
  c.push_back({"fixity_released_before_any_stage",
               left({"1", "7", "3", "1", "-1"}),
               "fixity_left:21-25",
               {"only a stage can release"}});
  c.push_back({"displacement_before_any_stage",
               left({"1", "7", "3", "1", "0"}, {".1"}),
               "fixity_left:26-35",
               {"belongs on a fixity card of a stage"}});
  c.push_back({"no_support",
               b.with("fixity_bottom", card({"1", "3", "1", "0", "0"}))
                   .with("fixity_left", card({"1", "7", "3", "0", "0"}))
                   .with("stage_fixity", card({"7", "9", "1", "0", "0"})),
               "stage",
               {"stage 1: nothing holds the mesh against"}});
  c.push_back({"sliding_left_free",
               left({"1", "7", "3", "0", "0"}),
               "stage",
               {"nothing holds the mesh against a rigid translation in x"}});
  c.push_back({"rotation_left_free",
               b.with("fixity_bottom", card({"1", "", "", "1", "1"}))
                   .with("fixity_left", card({"1", "", "", "1", "0"}))
                   .with("stage_fixity", card({"1", "", "", "0", "1"})),
               "stage",
               {"nothing holds the mesh against a rigid rotation"}});
  c.push_back({"floating_part",
               j.with("control", card({"1", "0", "8", "0", "2", "3", "2", "1", "1", "1", "0"}))
                   .without("element_joint")
                   .without("initial_joint"),
               "stage",
               {"nothing holds the part that contains node 5"}});
}

void bad_stages(Cases& c) {
  const DeckText b = block_deck(), j = joint_deck();
  const auto stage = [&](std::initializer_list<const char*> i, std::initializer_list<const char*> r = {}) {
    return b.with("stage", card(i, r));
  };
  c.push_back({"increments_negative",
               stage({"-2", "0", "0", "0", "1", "1", "1"}),
               "stage:1-5",
               {"number of increments must be between 1 and"}});
  c.push_back({"method_unknown",
               stage({"2", "8", "0", "0", "1", "1", "1"}),
               "stage:6-10",
               {"method 8 is unknown", "0 Newton"}});
  c.push_back({"iterations_negative",
               stage({"2", "0", "-9", "0", "1", "1", "1"}),
               "stage:11-15",
               {"iterations must not be negative"}});
  c.push_back({"tolerance_negative",
               stage({"2", "0", "0", "0", "1", "1", "1", "", "", ""}, {"", "", "-1.E-8"}),
               "stage:71-80",
               {"tolerance must lie between 0 and 1"}});
  c.push_back({"gravity_1e308",
               stage({"2", "0", "0", "0", "1", "1", "1", "", "", ""}, {"", "1.E308"}),
               "stage:61-70",
               {"gravity along y", "too large to compute with"}});
  c.push_back({"load_1e308",
               b.with("load", card({"3", "", ""}, {"-1.E308", "0."})),
               "load:16-25",
               {"force along x", "too large to compute with"}});
  c.push_back({"load_on_undefined_node",
               b.with("load", card({"33", "", ""}, {"-1.", "0."})),
               "load:1-5",
               {"node 33 is not defined"}});
  const DeckText orphan = b.with("control", card({"1", "0", "5", "1", "1", "1", "1", "2", "1", "1", "1"}))
                              .behind("node9", "orphan", card({"20", "", ""}, {"5.", "5."}));
  c.push_back({"load_on_unused_node",
               orphan.with("load", card({"20", "", ""}, {"-1.", "0."})),
               "load",
               {"node 20 is loaded but belongs to no element"}});
  c.push_back({"unused_node_displaced",
               orphan.with("stage_fixity", card({"20", "", "", "1", "1"}, {"", ".1"})),
               "stage_fixity",
               {"node 20 is displaced but belongs to no element"}});
  c.push_back({"displacement_of_a_free_node",
               b.with("stage_fixity", card({"7", "9", "1", "0", "0"}, {"", "-.1"})),
               "stage_fixity:21-25",
               {"a displacement is given but the code is not 1 (fixed)"}});
  c.push_back({"edge_out_of_range",
               b.with("pressure", card({"2", "5", "4", "2"}, {"10."})),
               "pressure:6-10",
               {"edge 5: element 2 (quad4 full) has edges 1 to 4"}});
  c.push_back({"pressure_on_undefined_element",
               b.with("pressure", card({"2", "2", "8", "2"}, {"10."})),
               "pressure:11-15",
               {"element 6 is not defined"}});
  c.push_back({"pressure_range_misses_its_last",
               b.with("pressure", card({"2", "2", "5", "2"}, {"10."})),
               "pressure:16-20",
               {"steps of 2 from 2 do not meet the last, 5"}});
  c.push_back({"initial_kind_unknown",
               b.with("initial", card({"1", "9"}, {"10."})),
               "initial:6-10",
               {"initial stress kind 9 is unknown", "0 uniform"}});
  c.push_back({"initial_group_undefined",
               b.with("initial", card({"4", "0"}, {"10."})),
               "initial:1-5",
               {"group 4 is not defined"}});
  c.push_back({"traction_for_a_solid",
               j.with("initial_joint", card({"3", "3"}, {"1."})),
               "initial_joint:6-10",
               {"for interface groups"}});
  c.push_back({"traction_of_a_group_without_stress",
               j.with("initial_joint", card({"2", "3"}, {"3."})),
               "initial_joint:11-20",
               {"group 3", "no initial card"}});
  c.push_back(
      {"birth_of_undefined_group",
       j.with("stage", card({"1", "", "", "", "", "1", "1", "1"})).behind("pressure", "birth", card({"8"})),
       "birth:1-5",
       {"group 8 is not defined"}});
  c.push_back({"birth_twice",
               j.with("stage", card({"1", "", "", "", "", "1", "1", "2"}))
                   .behind("pressure", "birth", card({"3", "3"})),
               "stage",
               {"group 3 is born twice"}});
  c.push_back({"report_kind_unknown",
               b.with("report", card({"7", "1", "7", "9", "1", "1"}, {"1."})),
               "report:1-5",
               {"the kind of report can't be 7", "1 = triaxial test, 2 = mean displacement of nodes"}});
  // The card behind it looks like that of a point: the fault is the kind all the same.
  c.push_back({"report_kind_unknown_before_a_point",
               b.with("report", card({"7"})).behind("report", "point", card({}) + "        .5        .5middle"),
               "report:1-5",
               {"the kind of report can't be 7", "1 = triaxial test, 2 = mean displacement of nodes"}});
  c.push_back({"point_behind_sums_over_nodes",
               b.with("report", card({"2", "", "7", "9"}))
                   .behind("report", "point", card({}) + "        .5        .5middle"),
               "point",
               {"reads as a point card", "report.kind == 3",
                "is 2 (1 = triaxial test, 2 = mean displacement of nodes"}});
  c.push_back({"report_without_height",
               b.with("report", card({"1", "1", "7", "9", "1", "1"}, {"0."})),
               "report:31-40",
               {"needs the specimen height"}});
  c.push_back({"report_from_a_later_stage",
               b.with("report", card({"1", "1", "7", "9", "1", "4"}, {"1."})),
               "report:26-30",
               {"starts at stage 4", "the deck has 1"}});
  c.push_back({"report_group_undefined",
               b.with("report", card({"1", "6", "7", "9", "1", "1"}, {"1."})),
               "report:6-10",
               {"group 6 is not defined"}});
  c.push_back({"end_misspelt", b.with("end", "FIN"), "end:1-3", {"must read END, not \"FIN\""}});
}

void truncated(Cases& c) {
  const DeckText b = block_deck();
  for (const std::string& label : b.labels()) {
    if (label == "title") continue;  // nothing left: the empty file
    const DeckText cut = b.cut_before(label);
    c.push_back(
        {"cut_before_" + label, cut, cut.labels().back(), {"the deck ends here, but a", "was expected"}});
  }
}

}  // namespace

std::vector<BadDeck> bad_decks() {
  Cases cases;
  bad_counts(cases);
  bad_nodes(cases);
  bad_materials(cases);
  bad_groups(cases);
  bad_elements(cases);
  bad_supports(cases);
  bad_stages(cases);
  truncated(cases);
  return cases;
}

}  // namespace sage::test
