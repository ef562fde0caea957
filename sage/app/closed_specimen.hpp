// A triaxial specimen between rough, rigid platens, in a membrane and without drains: its water can't leave, but moves
// from place to place.
#pragma once

#include <string>
#include <vector>

#include "sage/analysis/run.hpp"
#include "sage/builder/model_input.hpp"

namespace sage::app {

// Radius 1; the upper half is computed.
struct ClosedSpecimen {
  double slenderness = 1.0;  // length over diameter
  MaterialInput skeleton;
  double permeability = 1.0;  // over the unit weight of water
  double cell = 0.0;          // effective stress at the start, the same in all directions
  int columns =
      12;  // of elements; as many rows for each unit of slenderness, smaller towards the platen's edge
  std::string element = "quad8p4";
};

// A part of a test: so much more axial strain (of shortening), in proportion to time, in equal increments.
// Without a duration no water moves.
struct SpecimenPart {
  double strain = 0.0, duration = 0.0;
  int increments = 1;
  double theta = 1.0;
};

// Compression positive.
struct SpecimenState {
  double time = 0.0, strain = 0.0;
  double deviator = 0.0;  // force over area, less what it was at the start
  // Excess pressures: centre of the platen, centre and rim at mid-height, mean over the volume.
  double pressure_end = 0.0, pressure_middle = 0.0, pressure_rim = 0.0, pressure_mean = 0.0;
};

struct SpecimenCurve {
  std::vector<SpecimenState> states;  // at the end of each increment
  std::string reason;                 // why it ends early; empty: it is complete
};

ModelInput specimen_input(const ClosedSpecimen& specimen, const std::vector<SpecimenPart>& parts);
SpecimenCurve run_specimen(const ClosedSpecimen& specimen, const std::vector<SpecimenPart>& parts,
                           const Catalogue& catalogue, Pulse* pulse = nullptr);

// One point of the skeleton that is compressed as much at constant volume: a specimen without friction.
struct FrictionlessState {
  double deviator = 0.0, pressure = 0.0;  // growth since the start
};
// At the end of each of so many equal steps.  Throws AnalysisError where the law has no state.
std::vector<FrictionlessState> frictionless_test(const ClosedSpecimen& specimen, double strain, int steps,
                                                 const Catalogue& catalogue);

}  // namespace sage::app
