#include "tests/studies/scenes/consolidation.hpp"

#include <utility>

namespace sage::scenes {

ModelInput pore_input(const LatticeMesh& mesh, double E, double nu, double k, Geometry geometry) {
  ModelInput input;
  input.geometry = geometry;
  input.units = {"m", "kN", "kPa", 101.325, 1.0};
  input.materials = {{"linear_elastic", {{"youngs_modulus", E}, {"poissons_ratio", nu}}},
                     {"pore_flow", {{"permeability", k}}}};
  mesh.write(input);
  return input;
}

SupportInput held(std::vector<int> nodes, bool x, bool y) {
  return {.nodes = std::move(nodes),
          .x = x ? FixityCode::fixed : FixityCode::unchanged,
          .y = y ? FixityCode::fixed : FixityCode::unchanged};
}

SupportInput drained(std::vector<int> nodes, double value) {
  return {.nodes = std::move(nodes), .x = FixityCode::fixed, .x_value = value, .unknown = "excess_pressure"};
}

StageInput shut_in() {
  StageInput stage{.title = "undrained"};
  stage.pores = PoreWater::shut_in;
  return stage;
}

StageInput consolidation(double duration, int increments, double grading, double theta) {
  StageInput stage{.title = "consolidation", .increments = increments};
  stage.duration = duration;
  stage.pores = PoreWater::flows;
  stage.grading = grading;
  stage.theta = theta;
  return stage;
}

}  // namespace sage::scenes
