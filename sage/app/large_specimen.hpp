// A triaxial specimen under large strain between rigid platens, which hold its ends or let them slide with friction.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sage/analysis/run.hpp"
#include "sage/builder/model_input.hpp"
#include "sage/record/report.hpp"

namespace sage::app {

// The upper half of a specimen of radius 1.4 in is computed; units in, lbf, psi.
struct LargeSpecimen {
  double slenderness = 1.0;  // length over diameter
  MaterialInput soil;
  double cell = 0.0;                        // pressure around it
  std::optional<MaterialInput> joint = {};  // of the ends; none: they are pinned to the platens
  // Radius of the platen over the specimen's, where its side may roll onto it, frictionless or with the joint's law; 0: the
  // side touches nothing.  An end that slides stays on the platen.
  double platen = 0.0;
  // Of elements, as many rows for each unit of slenderness; along each side the largest is `shrink` times as long as the
  // smallest, which is at the platen's edge.
  int columns = 24;
  double shrink = 20.0;
  // Penalty of the contact times the radius over Young's modulus.
  double contact_stiffness = 2e4;
};

// A joint of an end that slides: friction alone, with the shear stiffness of Clough and Duncan's law.  friction_angle: degrees.
MaterialInput platen_friction(double friction_angle, double stiffness_number, double exponent);

struct LargeCurve {
  std::vector<TriaxialRow> rows;  // of each increment that has equilibrium; the last one's part that has
  std::string reason;             // why it ends early; empty: it is complete
};

// Shortened to the strain in equal increments, after a stage that puts up the cell pressure.
ModelInput large_specimen_input(const LargeSpecimen& specimen, double strain, int increments);
LargeCurve run_large_specimen(const LargeSpecimen& specimen, double strain, int increments,
                              const Catalogue& catalogue, Pulse* pulse = nullptr);

}  // namespace sage::app
