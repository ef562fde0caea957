// A smooth field from the places where elements are most accurate: polynomials over patches of elements.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "sage/analysis/assembly.hpp"

namespace sage {

// From an element's points to the places where its stress is most accurate: samples x points.  Empty: the
// points are those places.  (Element::point_to_sample, and the middle of a triangle of constant strain.)
Eigen::MatrixXd sample_map(const Element& element);

// The terms of a polynomial of full degree in x and y, scaled to the box of its samples.
class PatchPolynomial {
 public:
  // degree: the lowest of the patch's elements.  The stress wants that; one more takes less from the fit, and
  // is taken where there are samples enough for it.  Fewer samples than terms lower it, and so do places that
  // can't tell all terms apart (a body of one row of elements).
  PatchPolynomial(const std::vector<const Eigen::Matrix2Xd*>& samples, int degree);

  Eigen::RowVectorXd terms(const Vector2& x) const;
  // samples x terms, in the order that they were given in
  const Eigen::MatrixXd& matrix() const { return V_; }

 private:
  void fill(const std::vector<const Eigen::Matrix2Xd*>& samples, Eigen::Index count);
  bool independent() const;

  int degree_;
  Vector2 centre_, scale_;
  Eigen::MatrixXd V_;
};

struct ElementRef {
  std::size_t group = 0;
  int element = 0;
};

// Elements of some groups around each vertex.
class Patches {
 public:
  // of_these: by group.
  Patches(const Model& model, const std::vector<char>& of_these, const std::vector<ElementRef>& elements);

  // Places in `elements` that was given.
  const std::vector<std::size_t>& around(int vertex) const { return around_.at(vertex); }
  bool inside(int vertex) const { return on_boundary_.count(vertex) == 0; }
  // Around all vertices of an element, each once, sorted.
  std::vector<std::size_t> neighbours(const Element& element, const int* nodes) const;

 private:
  std::map<int, std::vector<std::size_t>> around_;
  std::map<int, bool> on_boundary_;
};

}  // namespace sage
