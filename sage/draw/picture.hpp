// The mesh with a field as an SVG picture, without libraries; several of them on one sheet.
#pragma once

#include <limits>

#include "sage/record/end_forces.hpp"
#include "sage/record/nodal_values.hpp"
#include "sage/record/out_file.hpp"
#include "sage/record/output.hpp"

namespace sage {

// A field is named as FieldTable::choose takes it, of fields_of(model): "stress_yy", "displacement",
// "plastic_shear_strain"; "flow_net" is the head with stream lines; forces and moments of structures are
// diagrams along them, and "bending_moment_envelope" shows the least and the largest of all stages.
// An unknown one, or one that lives neither at nodes nor at points: std::invalid_argument.
FieldChoice picture_field(const FieldTable& table, std::string_view name);

// What water flows through is drawn as solids are, but not over them.
inline ElementKind drawn_as(const Group& group) {
  return group.flow() && !group.overlay ? ElementKind::solid : group.entry->kind;
}

struct PictureOptions {
  std::string title = {};  // empty = the model's
  std::string state = {};  // "end of stage 2", before the name of the field
  int width = 760;         // at most, for the mesh; the height follows from it
  bool deformed = false;   // with the undeformed outline dashed
  double scale =
      0.0;  // of the displacements; 0 = such that the largest is about 5 % of the mesh, but at least 1
  double paper = 0.0;  // px for each unit of length; 0 = such that the mesh fits into `width`
  bool mesh = true;    // element edges (never above 6000 elements)
  int levels = 10;     // bands of colour, about
  // Colours leave out what is rare and far off (a singular corner); the picture then says so.  false = the whole
  // range of the field.
  bool robust = true;
  // The other halves of a symmetric model: to the left of its left side, below its lower side.
  bool mirror_left = false, mirror_down = false;
  bool arrows = false;                        // displacements of nodes
  bool crosses = false;                       // principal stresses in the plane, at integration points
  bool yielded = false;                       // integration points, those that yield (slip, are open) full
  bool smooth = true;                         // contour bands; false = one colour an element
  NodalRule rule = NodalRule::element_means;  // of fields that live at integration points
  double low = std::numeric_limits<double>::quiet_NaN();  // range of the colours; NaN = that of the field
  double high = std::numeric_limits<double>::quiet_NaN();
  const std::vector<EnvelopeEnd>* envelope = nullptr;  // of "..._envelope"; without: the state alone
};

struct FieldRange {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
};

// What the colours of a picture with these options show (PictureOptions::robust); low > high where no solid is active.
FieldRange field_range(const Model& model, const Solution& solution, std::string_view field,
                       const PictureOptions& options = {});

// What a picture with these options has: the factor of the displacements (0 where nothing is deformed), and px for
// each unit of length.
struct PictureScales {
  double deformation = 0.0, paper = 0.0;
};
PictureScales scales_of(const Model& model, const Solution& solution, std::string_view field,
                        const PictureOptions& options = {});

// A whole SVG document of the active groups.  Stress at nodes is averaged over the elements of the same
// material, by options.rule; between the nodes both stress and displacement are what the element's shape functions
// make of them.  A direction, which is no mean of directions, has one colour an element.  Displacements that are
// rounding beside the size of the mesh are not magnified.  Interfaces are dark red lines.
std::string field_svg(const Model& model, const Solution& solution, std::string_view field,
                      const PictureOptions& options = {});

// One of several pictures; model and what the solution refers to must outlive it.
struct FieldPanel {
  const Model* model = nullptr;
  Solution solution;
  std::string field;
  std::string title = {};  // empty = the model's
  std::string state = {};  // before the name of the field
  std::string scale = {};  // panels of a field share one with those that name the same (FieldSheet::one_scale)
  const std::vector<EnvelopeEnd>* envelope = nullptr;  // PictureOptions::envelope of this panel
};

struct FieldSheet {
  std::string title;
  std::vector<FieldPanel> panels;
  int columns = 0;  // 0 = as many as stand side by side in about 1400 px
  bool one_scale =
      true;  // of colours and diagrams of all panels that show the same field and name the same scale
  PictureOptions look{};  // of each; title and state are those of the panels
};

// A whole SVG document.
std::string sheet_svg(const FieldSheet& sheet);

// STEM_stage1_stress_yy.svg, ... at the end of every stage (envelopes: of the last) and at a
// failure (STEM_stage1_failed_...).
class Pictures final : public Output {
 public:
  // Throws OutputError where a folder bears a name that a picture could get.
  Pictures(std::filesystem::path folder, std::string stem, std::vector<std::string> fields,
           PictureOptions options = {});

  void on_stage_end(const Model&, int stage, const EquilibriumAudit&, const Solution&) override;
  void on_failure(const Model&, const StepReport&, const std::string& reason, const Solution&) override;
  // At increments that `run --states` asks for: STEM_stage1_increment5_stress_yy.svg, ...
  void on_increment(const Model&, const StepReport&, const Solution&) override;
  void draw_increment(const Model&, const StepReport&, const Solution&);
  bool wants_states(const Model& model, const StepReport& report) const override {
    return report.increment == report.increments || is_asked_increment(stage_of(model, report.stage), report);
  }
  void exchange(Archive& archive) override;
  void stop(const std::string&) override {}
  std::vector<std::filesystem::path> files() const override { return files_; }

 private:
  // last: no stage comes after it.
  void draw(const Model&, const Solution&, const std::string& state, const std::string& caption, bool last);

  std::filesystem::path folder_;
  std::string stem_;
  std::vector<std::string> fields_;
  PictureOptions options_;
  Envelope envelope_;
  std::vector<std::filesystem::path> files_;
};

}  // namespace sage
