#include "sage/deck/wide_layout.hpp"

#include <charconv>

#include "sage/deck/text.hpp"

namespace sage {

std::string wide_format(std::string_view format) {
  std::string wide;
  for (std::size_t i = 0; i < format.size();) {
    const bool number = std::string_view("IFEDG").find(format[i]) != std::string_view::npos;
    wide += format[i++];
    const std::size_t first = i;
    while (i < format.size() && is_digit(format[i])) ++i;
    int width = 0;
    std::from_chars(format.data() + first, format.data() + i, width);
    wide += number && width > 0 ? std::to_string(2 * width) : std::string(format.substr(first, i - first));
  }
  return wide;
}

namespace {

// Fields behind those of a card, for which the narrow one has no columns left.
void lengthen(Layout& layout, std::string_view key, const std::string& format, std::vector<FieldSpec> fields) {
  for (CardRule& card : layout.cards) {
    if (card.key != key || card.spec.format.empty()) continue;
    card.spec.format.insert(card.spec.format.rfind(')'), "," + format);
    for (FieldSpec& field : fields) card.spec.fields.push_back(std::move(field));
    card.rules.resize(card.spec.fields.size());
  }
}

FieldSpec field(const std::string& name, const std::string& label, FieldKind kind) {
  FieldSpec spec;
  spec.name = name;
  spec.label = label;
  spec.kind = kind;
  return spec;
}

void lengthen_stage(Layout& layout) {
  lengthen(
      layout, "stage", "2F20.0,I10,2F20.0,I10,3F20.0,2A80",
      {field("duration", "duration of the stage, for laws that depend on time and for consolidation; blank = 1",
             FieldKind::real),
       field("strength_factor",
             "factor by which the strengths in this stage are already divided; sagefe does not divide again; "
             "blank = no factor",
             FieldKind::real),
       field("pore_water",
             "pore water of elements for consolidation: 0 = excess pressures keep their values, 1 = undrained, "
             "2 = consolidation",
             FieldKind::integer),
       field("theta",
             "consolidation: theta of the time integration, from 0.5 (Crank-Nicolson) to 1 (backward Euler); "
             "blank = 1",
             FieldKind::real),
       field("grading", "length of each increment divided by that of the increment before; blank = 1",
             FieldKind::real),
       field("reset_displacements",
             "reset of displacements, which then count from the start of this stage; 0 (false) = no, 1 (true) "
             "= yes",
             FieldKind::integer),
       field("time_error",
             "consolidation: largest error of one time step, divided by the largest excess pressure (root mean "
             "squares); blank = each increment is one time step",
             FieldKind::real),
       field("end_degree",
             "consolidation: degree of consolidation, below 1, at which the stage ends; blank = the stage "
             "lasts its duration",
             FieldKind::real),
       field("end_pressure",
             "consolidation: the stage ends when no excess pressure exceeds this stress; blank = the stage "
             "lasts its duration",
             FieldKind::real),
       field("output_times",
             "times since the start of the stage at which sagefe writes output, with blanks between them",
             FieldKind::text),
       field("load_control",
             "displacement that controls the load: node, direction and growth during the stage, such as 12 y "
             "-0.05; 12 15 y 0.02 is for the displacement of node 12 less that of node 15",
             FieldKind::text)});
}

void lengthen_cards(Layout& layout) {
  std::vector<FieldSpec> nodes;
  for (int i = 9; i <= kWideNodes; ++i)
    nodes.push_back(field("n" + std::to_string(i), "node " + std::to_string(i), FieldKind::integer));
  lengthen(layout, "element", std::to_string(nodes.size()) + "I10", nodes);
  FieldSpec saturated = field(
      "saturated_unit_weight",
      "unit weight of solids below a phreatic line (water cards of kind 1); blank = the unit weight above it",
      FieldKind::real);
  saturated.unit = "force/length^3";
  lengthen(layout, "material", "F20.0", {saturated});
  lengthen(
      layout, "group", "I10",
      {field("second_material", "material of the pore water, for element types that need a second material",
             FieldKind::integer)});
  lengthen_stage(layout);
  for (const char* card : {"stage_fixity", "load"})
    lengthen(layout, card, "A80",
             {field("history",
                    "table of time: pairs of a time since the start of the stage and a factor on the value of "
                    "this card, such as 0 0 2 1 10 0.5; blank = the value grows in proportion to time",
                    FieldKind::text)});
  for (const char* card : {"fixity", "stage_fixity"}) {
    FieldSpec angle = field("angle",
                            "angle of the support, counter-clockwise from the x axis: codes and values of x "
                            "are along this direction, those of y normal to it; blank = 0",
                            FieldKind::real);
    angle.unit = "deg";
    lengthen(layout, card, "F20.0,2I10",
             {angle,
              field("tie", "code 3 (tied), only before the stages: node to which the first node is tied",
                    FieldKind::integer),
              field("tie_step",
                    "code 3 (tied): increment that is added to this node for each further node of the card; "
                    "blank = all are tied to one node",
                    FieldKind::integer)});
  }
  lengthen(layout, "pressure", "A20,A80",
           {field("unknown",
                  "kind of action: blank = pressure and shear stress; excess_pressure = inflow of pore water "
                  "per area and time, in place of the pressure",
                  FieldKind::text),
            field("history",
                  "table of time: pairs of a time since the start of the stage and a factor on the pressure of "
                  "this card, such as 0 0 2 1, or on an inflow, such as 0 1 5 1 5.1 0; blank = a pressure "
                  "grows in proportion to time, an inflow is constant",
                  FieldKind::text)});
  for (const char* initial : {"initial", "stage_initial"})
    lengthen(layout, initial, "I10,A40",
             {field("material", "kind 6 (material): number of the new material, in place of value 1",
                    FieldKind::integer),
              field("parameter", "kind 7 (parameter): name of the parameter, in place of value 1",
                    FieldKind::text)});
}

}  // namespace

Layout wide_layout(Layout layout) {
  layout.title += ", with wide fields";
  layout.name += "_wide";
  layout.records.record_length = 6 * layout.records.record_length;  // the longest card is that of a stage
  layout.first_sequence_column = layout.last_sequence_column = 0;
  layout.marks.clear();
  layout.example.clear();  // its columns are those of the narrow fields
  for (CardRule& card : layout.cards) {
    if (card.spec.format.empty()) continue;
    card.spec.format = wide_format(card.spec.format);
  }
  lengthen_cards(layout);
  for (CardRule& card : layout.cards)
    if (!card.spec.format.empty()) card.format = compile_format(card.spec.format);
  return layout;
}

}  // namespace sage
