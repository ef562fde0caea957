#include "materials/pore_flow.hpp"

#include "materials/darcy.hpp"

namespace sage {

namespace {

const std::vector<Parameter>& rows() {
  static const std::vector<Parameter> table = {
      required("permeability", Dimension::velocity, "permeability k1"),
      optional("permeability_2", Dimension::velocity, "permeability k2 across the direction of k1; 0 = k1",
               0.0),
      optional("direction", Dimension::angle, "direction of k1, counter-clockwise from +x", 0.0),
      optional("water_bulk", Dimension::stress,
               "bulk of the water over the porosity; 0 = water can't be compressed", 0.0)};
  return table;
}

const std::vector<Parameter>& joint_rows() {
  static const std::vector<Parameter> table = {required(
      "conductance", Dimension::none,
      "permeability over thickness, 1/time: what crosses per area for a drop of head of 1; 0 = tight")};
  return table;
}

}  // namespace

PoreFlow::PoreFlow(const Matrix2& mobility, double storage) : D_(Matrix<3>::Zero()) {
  D_.topLeftCorner<2, 2>() = mobility;
  D_(2, 2) = storage;
}

MaterialEntry pore_flow_entry() {
  MaterialEntry entry{"pore_flow", "water in the pores of consolidating soil: Darcy's law and storage", 3,
                      rows(), [](std::span<const double> values, const UnitSystem& units) -> LawPtr {
                        const Parameters p(rows(), values, units);
                        const double bulk = p.not_negative("water_bulk");
                        return std::make_unique<PoreFlow>(permeability_of(p) / p.water_unit_weight(),
                                                          bulk > 0.0 ? 1.0 / bulk : 0.0);
                      }};
  entry.of_pores = true;
  return entry;
}

MaterialEntry pore_joint_entry() {
  MaterialEntry entry{
      "pore_joint", "water that crosses an interface of consolidating soil", 1, joint_rows(),
      [](std::span<const double> values, const UnitSystem& units) -> LawPtr {
        const Parameters p(joint_rows(), values, units);
        return std::make_unique<PoreJoint>(p.not_negative("conductance") / p.water_unit_weight());
      }};
  entry.of_pores = true;
  return entry;
}

}  // namespace sage
