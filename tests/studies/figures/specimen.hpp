// The source chapter's specimens, computed in memory, and what its figures show of them.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sage/record/result.hpp"
#include "tests/studies/figures/measures.hpp"
#include "tests/studies/scenes/specimen_deck.hpp"
#include "tests/studies/scenes/whole_run.hpp"

namespace sage::figures {

// One specimen under one end condition.  The interfaces: Table 7.2.
struct Scene {
  const char* name;
  double slenderness = 2.0;  // L/D
  scenes::SpecimenEnd end = scenes::SpecimenEnd::platen;
  double phi = 28.5;     // of the platen's interface, degrees
  bool plastic = false;  // Drucker-Prager, to 15 percent; else elastic, to 10 percent
  double nu = 0.495, E = 3000.0;

  bool lubricated() const { return end == scenes::SpecimenEnd::platen && phi == 0.8; }
  double cell() const { return slenderness == 1.0 ? 0.0 : 50.0; }
  double radius() const { return 1.4; }
  double height() const { return 1.4 * slenderness; }  // of the quarter
  double last_strain() const { return plastic ? 15.0 : 10.0; }
  // Deviator stress between frictionless ends, psi; strain in percent.
  double correct(double strain) const;
  // Of a quantity between frictionless ends.
  double correct(Quantity quantity, double strain) const;
};
std::span<const Scene> scene_list();
// Throws std::out_of_range for a name that the list lacks.
const Scene& scene_named(const std::string& name);

enum class Elements { full, b_bar };  // 4-node elements: 2x2 points as published, or B-bar

// A place in the section with the area that it stands for; both in units of the specimen: r / R and z / H.
struct Spot {
  double r = 0.0, z = 0.0, area = 0.0;
  bool corner = false;  // of the 2 x 2 elements at the rim of the end
};

// What figures show at one strain.  Compression positive, psi.
struct State {
  double strain = 0.0;                           // percent
  std::vector<std::vector<double>> at_elements;  // by Quantity from sigma_r (first) to conf: of its mean stress
  std::vector<double> level;                     // of every element's mean stress
  std::vector<double> joint_normal, joint_shear, joint_level;  // of every point of the interface
  std::shared_ptr<const Frame> frame;  // for pictures, which take means of elements (NodalRule)

  const std::vector<double>& values(Quantity quantity) const;
};

// Everything that is kept of a run.  Elements run along r first, from the axis, then up.
struct SpecimenRun {
  const Scene* scene = nullptr;
  Elements elements = Elements::full;
  double k_j = 0.0;  // of the lubricated platen
  int columns = 0, rows = 0;
  std::vector<Spot> cells;       // elements
  std::vector<double> joint_r;   // in
  std::vector<double> strain;    // percent, of every increment
  std::vector<double> measured;  // deviator stress, force / area - cell pressure, psi
  std::vector<double> joint_most,
      yielded;  // largest stress level of the interface; share of the points that yield
  std::vector<State> states;
  double largest_radius = 0.0, largest_height = 0.0;  // of the mesh, in
  double flatness = 0.0;  // largest |u_z / prescribed - 1| of the loaded face at the end
  std::shared_ptr<const Model> model;

  // Throws std::out_of_range for a strain that was not kept.
  const State& state(double strain) const;
  double ratio(double strain) const;
  // measured / correct, an increment each.
  std::vector<double> ratios() const;
};

// Strains at which states are kept, in percent.
std::span<const double> kept_strains(const Scene& scene);

// `increments` of the whole strain; 0 = 0.05 percent each.  Throws AnalysisError where there is no equilibrium.
SpecimenRun run_specimen(const scenes::Workbench& bench, const Scene& scene, Elements elements, double k_j,
                         int increments = 0);
// The deck of it.
scenes::SpecimenDeck specimen_deck(const Scene& scene, Elements elements, double k_j, int increments = 0);

// Runs that were asked for, each computed once.
class Runs {
 public:
  explicit Runs(const scenes::Workbench& bench) : bench_(&bench) {}
  const SpecimenRun& get(const std::string& scene, Elements elements, double k_j = 0.0);
  std::size_t size() const { return runs_.size(); }
  const scenes::Workbench& bench() const { return *bench_; }

 private:
  const scenes::Workbench* bench_;
  std::map<std::string, SpecimenRun> runs_;
};

}  // namespace sage::figures
