// Sizes of vectors field by field: a force and a flux have no common unit.  With displacements alone they are
// those of the whole vector.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "sage/analysis/assembly.hpp"

namespace sage {

inline double& at(FieldSums& values, int field) {
  return values[field];
}
inline double at(const FieldSums& values, int field) {
  return values[field];
}

// Dofs and equations of a field are contiguous, fields in their order: a field is a piece of a vector.
class ByField {
 public:
  struct Piece {
    int begin, end;
  };

  // Of the assembly's equations as they are now.
  explicit ByField(const Assembly& assembly) : count_(assembly.dof_map().fields()) {
    const DofMap& map = assembly.dof_map();
    int dof = map.dofs(), eq = assembly.equations();
    dof_end_.fill(dof);
    equation_end_.fill(eq);
    for (int field = count_ - 1; field > 0; --field) {
      while (dof > 0 && map.at(dof - 1).field >= field) --dof;
      while (eq > 0 && assembly.dof_of(eq - 1) >= dof) --eq;
      dof_end_[static_cast<std::size_t>(field) - 1] = dof;
      equation_end_[static_cast<std::size_t>(field) - 1] = eq;
    }
  }

  int count() const { return count_; }
  Piece equations_of(int field) const { return piece(equation_end_, field); }

  // Of vectors with one entry per equation.
  double norm(const Eigen::VectorXd& v, int field) const {
    return count_ == 1 ? v.norm() : std::sqrt(sum_of(v, v, equations_of(field)));
  }
  double dot(const Eigen::VectorXd& a, const Eigen::VectorXd& b, int field) const {
    return count_ == 1 ? a.dot(b) : sum_of(a, b, equations_of(field));
  }
  double largest(const Eigen::VectorXd& v, int field) const {
    const int eq = place_of_largest(v, field);
    return eq < 0 ? 0.0 : std::abs(v[eq]);
  }
  // The first equation with the largest entry; -1 = the field has none.
  int place_of_largest(const Eigen::VectorXd& v, int field) const {
    const Piece own = equations_of(field);
    int place = own.begin < own.end ? own.begin : -1;
    double largest = place < 0 ? 0.0 : std::abs(v[place]);
    for (int eq = own.begin; eq < own.end; ++eq)
      if (const double size = std::abs(v[eq]); size > largest) largest = size, place = eq;
    return place;
  }
  // The field's part of a vector, 0 elsewhere.
  Eigen::VectorXd part(const Eigen::VectorXd& v, int field) const {
    const Piece own = equations_of(field);
    Eigen::VectorXd all = Eigen::VectorXd::Zero(v.size());
    all.segment(own.begin, own.end - own.begin) = v.segment(own.begin, own.end - own.begin);
    return all;
  }

  // Of vectors with one entry per dof.
  double norm_of_dofs(const Eigen::VectorXd& u, int field) const {
    return count_ == 1 ? u.norm() : std::sqrt(sum_of(u, u, dofs_of(field)));
  }
  double largest_of_dofs(const Eigen::VectorXd& u, int field) const {
    if (count_ == 1) return u.size() > 0 ? u.lpNorm<Eigen::Infinity>() : 0.0;
    const Piece own = dofs_of(field);
    double largest = 0.0;
    for (int dof = own.begin; dof < own.end; ++dof) largest = std::max(largest, std::abs(u[dof]));
    return largest;
  }

 private:
  using Ends = std::array<int, kMostFields>;  // of each field

  static Piece piece(const Ends& ends, int field) {
    const auto f = static_cast<std::size_t>(field);
    return {f == 0 ? 0 : ends[f - 1], ends[f]};
  }
  Piece dofs_of(int field) const { return piece(dof_end_, field); }

  // One term after the other.
  static double sum_of(const Eigen::VectorXd& a, const Eigen::VectorXd& b, Piece own) {
    double sum = 0.0;
    for (int i = own.begin; i < own.end; ++i) sum += a[i] * b[i];
    return sum;
  }

  int count_;
  Ends dof_end_, equation_end_;
};

}  // namespace sage
