// A pass over the elements of a group, four at a time.
#pragma once

#include "sage/analysis/group_data.hpp"

namespace sage {

// Whether its elements can go by four, with the law that it has: GroupData::four_elements and four_law.
void find_fours(GroupData& data);
// w and B of all elements, side by side, where they are not there yet.
void prepare_four_abreast(const Mesh& mesh, GroupData& data);

class PassFourAbreast {
 public:
  // Of a prepared group.  du: increment of every dof since the committed state.  All must outlive it.
  PassFourAbreast(GroupData& data, const Eigen::VectorXd& du);

  // Elements first, first + 1 ... of one four, at most to the group's last one; several threads may have fours of
  // their own at once.  Forces and, where K is not nullptr, matrices of the first element begin at f and K, those of
  // the others follow.  changed: set where a matrix is another than what stood there; asked only while it is false.
  // States go to the trial side.
  Outcome evaluate(int first, double* f, double* K, bool& changed) const;

 private:
  GroupData* data_;
  const Eigen::VectorXd* du_;
  std::size_t geometry_size_, dofs_, points_, stresses_, history_;  // doubles an element
};

}  // namespace sage
