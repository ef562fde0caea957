// STEM.msh: the mesh and all states as post-processing views of Gmsh (MSH 4.1), for Gmsh and all that reads its files.  meshio
// needs text: of binary files it reads only those whose elements have the numbers 1, 2, 3 ...
//
//   $NodeData         fields of nodes, at every node
//                     and stress and strain [xx xy xz, yx yy yz, zx zy zz], averaged over the elements of the same
//                     material; the shear strain is the engineering gamma, in xy and yx
//   $ElementNodeData  stress and strain where bodies that share a node have two values there: at the nodes of every solid
//   $ElementData      other fields of integration points: plain means over an element's points.  Every element of
//                     the file has a line, with nan where the field does not apply: meshio refuses less
// A view is called after its field, with unit and sign; a field of two numbers is two views.  Time as StateTime
// has it.
#pragma once

#include "sage/model/msh_numbers.hpp"
#include "sage/record/out_file.hpp"
#include "sage/record/output.hpp"

namespace sage {

class MshResults final : public Output {
 public:
  // mesh: the sections of the mesh, in this form; elements: their numbers in its order.  Throws OutputError.
  MshResults(const std::filesystem::path& folder, const std::string& stem, const std::string& mesh,
             std::vector<int> elements, MshForm form);

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
  void add(const Model&, const StepReport&, const Solution&);
  void comment(const std::string& text);
  void finish();

  OutFile file_;
  std::vector<int> elements_;
  MshForm form_;
  int count_ = 0;  // of states
  std::vector<std::filesystem::path> files_;
};

}  // namespace sage
