// VTU files for ParaView and everything else that reads VTK's XML format, one an output increment, and a PVD
// file that lists them.
//
// Points: one for each node and material that meet there, so that stress may jump between materials.  Cells:
// solids as VTK's own shapes, interfaces as lines along their bottom sides; active groups only.
//   point data  fields of nodes; stress and strain [xx yy zz xy yz xz], averaged over the elements of the same
//               material
//   cell data   fields of elements, and those of integration points: plain means over the points.  What does not
//               apply to a cell is NaN
#pragma once

#include "sage/record/out_file.hpp"
#include "sage/record/output.hpp"

namespace sage {

// STEM_0001.vtu, STEM_0002.vtu, ..., STEM.pvd.  In the names of the VTU files stands %XX for bytes that are no
// UTF-8.  Times as StateTime has them.
class Vtu final : public Output {
 public:
  // Throws OutputError.
  Vtu(std::filesystem::path folder, const std::string& stem);

  void on_increment(const Model&, const StepReport&, const Solution&) override;
  void on_failure(const Model&, const StepReport&, const std::string& reason, const Solution&) override;
  void on_finish(const Model&, const RunResult&) override;
  bool wants_states(const Model& model, const StepReport& report) const override {
    return is_output_increment(stage_of(model, report.stage), report);
  }
  void exchange(Archive& archive) override;
  void stop(const std::string& reason) override;
  std::vector<std::filesystem::path> files() const override { return files_; }

 private:
  void add(const Model&, const StepReport&, const Solution&, std::string_view comment);
  void finish(std::string_view comment);
  std::filesystem::path file(int number) const;  // from 1

  std::filesystem::path folder_;
  std::string stem_;  // of the VTU files: XML, which names them, is UTF-8
  OutFile pvd_;
  int count_ = 0;
  std::vector<std::filesystem::path> files_;
};

// A warning for each group whose elements VTK has not: their corners are written.
void warn_of_vtu(const Model& model, Diagnostics& diagnostics);

// One state as the text of a VTU file.  The comment stands at its top, where a person sees it.  With a step, its
// time, stage, increment and load factor are the file's field data.
std::string vtu_text(const Model& model, const Solution& solution, std::string_view comment = "",
                     const StepReport* step = nullptr);

}  // namespace sage
