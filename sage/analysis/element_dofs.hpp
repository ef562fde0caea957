// An element's own numbering against that of the model.
#pragma once

#include <span>

#include <Eigen/Core>

#include "sage/model/dof_map.hpp"

namespace sage {

// The dofs of one element, in its order.  A view: what it was made of must outlive it.
class ElementDofs {
 public:
  // The displacements of these nodes.
  explicit ElementDofs(std::span<const int> nodes) : nodes_(nodes.data()), size_(2 * nodes.size()) {}
  static ElementDofs listed(std::span<const int> dofs) {
    ElementDofs view;
    view.listed_ = dofs.data();
    view.size_ = dofs.size();
    return view;
  }

  std::size_t size() const { return size_; }
  int operator[](std::size_t i) const {
    return listed_ != nullptr ? listed_[i] : DofMap::displacement(nodes_[i / 2], static_cast<int>(i % 2));
  }

  // part[i] = u[dof i].
  void gather(const Eigen::VectorXd& u, double* part) const {
    if (listed_ != nullptr) {
      for (std::size_t i = 0; i < size_; ++i) part[i] = u[listed_[i]];
      return;
    }
    for (std::size_t i = 0; i < size_; i += 2) {
      const int dof = DofMap::displacement(nodes_[i / 2]);
      part[i] = u[dof];
      part[i + 1] = u[dof + 1];
    }
  }
  // to[dof i] += f[i].
  void add(const double* f, Eigen::VectorXd& to) const {
    if (listed_ != nullptr) {
      for (std::size_t i = 0; i < size_; ++i) to[listed_[i]] += f[i];
      return;
    }
    for (std::size_t i = 0; i < size_; i += 2) {
      const int dof = DofMap::displacement(nodes_[i / 2]);
      to[dof] += f[i];
      to[dof + 1] += f[i + 1];
    }
  }

 private:
  ElementDofs() = default;

  const int* nodes_ = nullptr;
  const int* listed_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace sage
