// Sizes of vectors field by field: a force and a flux have no common unit.  With displacements alone they are
// those of the whole vector.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "sage/analysis/assembly.hpp"

namespace sage {

inline double& at(FieldSums& values, int field) {
  return values[static_cast<std::size_t>(field)];
}
inline double at(const FieldSums& values, int field) {
  return values[static_cast<std::size_t>(field)];
}

class ByField {
 public:
  // Of the assembly's equations as they are now; it must outlive it.
  explicit ByField(const Assembly& assembly) : assembly_(&assembly), count_(assembly.dof_map().fields()) {
    if (count_ == 1) return;
    for (int eq = 0; eq < assembly.equations(); ++eq)
      field_.push_back(static_cast<std::uint8_t>(assembly.dof_map().at(assembly.dof_of(eq)).field));
  }

  int count() const { return count_; }
  int of_equation(int eq) const { return count_ == 1 ? 0 : field_[static_cast<std::size_t>(eq)]; }

  // Of vectors with an entry an equation.
  double norm(const Eigen::VectorXd& v, int field) const {
    return count_ == 1 ? v.norm() : std::sqrt(sum_of(v, v, field));
  }
  double dot(const Eigen::VectorXd& a, const Eigen::VectorXd& b, int field) const {
    return count_ == 1 ? a.dot(b) : sum_of(a, b, field);
  }
  double largest(const Eigen::VectorXd& v, int field) const {
    const int eq = place_of_largest(v, field);
    return eq < 0 ? 0.0 : std::abs(v[eq]);
  }
  // The first equation with the largest entry; -1 = the field has none.
  int place_of_largest(const Eigen::VectorXd& v, int field) const {
    int place = -1;
    for (int eq = 0; eq < static_cast<int>(v.size()); ++eq)
      if (of_equation(eq) == field && (place < 0 || std::abs(v[eq]) > std::abs(v[place]))) place = eq;
    return place;
  }
  // The field's part of a vector, 0 elsewhere.
  Eigen::VectorXd part(const Eigen::VectorXd& v, int field) const {
    Eigen::VectorXd own = Eigen::VectorXd::Zero(v.size());
    for (int eq = 0; eq < static_cast<int>(v.size()); ++eq)
      if (of_equation(eq) == field) own[eq] = v[eq];
    return own;
  }
  // 1 and -1 without an order at all equations: no row of a matrix cancels against them but by chance.
  Eigen::VectorXd signs() const {
    Eigen::VectorXd v(assembly_->equations());
    std::minstd_rand next;
    for (double& sign : v) sign = next() % 2 == 0 ? 1.0 : -1.0;
    return v;
  }

  // Of vectors with an entry a dof.
  double norm_of_dofs(const Eigen::VectorXd& u, int field) const {
    if (count_ == 1) return u.norm();
    double sum = 0.0;
    for_dofs(field, [&](int dof) { sum += u[dof] * u[dof]; });
    return std::sqrt(sum);
  }
  double largest_of_dofs(const Eigen::VectorXd& u, int field) const {
    if (count_ == 1) return u.size() > 0 ? u.lpNorm<Eigen::Infinity>() : 0.0;
    double largest = 0.0;
    for_dofs(field, [&](int dof) { largest = std::max(largest, std::abs(u[dof])); });
    return largest;
  }

 private:
  double sum_of(const Eigen::VectorXd& a, const Eigen::VectorXd& b, int field) const {
    double sum = 0.0;
    for (int eq = 0; eq < static_cast<int>(a.size()); ++eq)
      if (of_equation(eq) == field) sum += a[eq] * b[eq];
    return sum;
  }
  template <class Do>
  void for_dofs(int field, Do action) const {
    const DofMap& map = assembly_->dof_map();
    for (int dof = 0; dof < map.dofs(); ++dof)
      if (map.at(dof).field == field) action(dof);
  }

  const Assembly* assembly_;
  int count_;
  std::vector<std::uint8_t> field_;  // of each equation, where there are several
};

}  // namespace sage
