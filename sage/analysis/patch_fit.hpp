// A smooth field from the places where elements are most accurate: polynomials over patches of elements.
#pragma once

#include <span>
#include <vector>

#include "sage/analysis/assembly.hpp"
#include "sage/math/dense.hpp"

namespace sage {

// From an element's points to the places where its stress is most accurate: samples x points.  Empty: the
// points are those places.  (Element::point_to_sample, and the middle of a triangle of constant strain.)
Eigen::MatrixXd sample_map(const Element& element);

// The terms of a polynomial of full degree in x and y, scaled to a box.
struct PolynomialTerms {
  static constexpr int kMostDegree = 32;  // above that of any element, and one
  int degree = 0;
  Vector2 centre = Vector2::Zero(), scale = Vector2::Ones();  // middle and half sides of the box

  Eigen::Index count() const { return (degree + 1) * (degree + 2) / 2; }
  // Calls take(k, term k at x) for all k.
  template <class Take>
  void at(const Vector2& x, Take take) const;
};

// Fits polynomials to values at places, one patch after the other.
class PatchFitter {
 public:
  // degree: the lowest of the patch's elements.  The stress wants that; `more` take less from the fit, and are taken where
  // there are samples enough for them.  Fewer samples than terms lower it, and so do places that
  // can't tell all terms apart (a body of one row of elements).
  void set_places(const Eigen::Ref<const Eigen::Matrix2Xd>& places, int degree, int more = 1);

  const PolynomialTerms& terms() const { return terms_; }
  // Coefficients (values x terms) of least squares of values at the places (values x places), which are used up.
  template <class Values>
  void fit(Values& values, Values& coefficients) const {
    qr_.least_squares(values, coefficients);
  }

 private:
  void fill(const Eigen::Ref<const Eigen::Matrix2Xd>& places);

  PolynomialTerms terms_;
  Eigen::MatrixXd V_;  // places x terms
  dense_matrix::PivotedQr qr_;
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

  // Places in `elements` that was given, rising.
  std::span<const std::size_t> around(int vertex) const {
    const auto v = static_cast<std::size_t>(vertex);
    return std::span(items_).subspan(start_[v], start_[v + 1] - start_[v]);
  }
  bool inside(int vertex) const { return !on_boundary_[vertex]; }
  // Around all vertices of an element, each once, sorted.
  std::vector<std::size_t> neighbours(const Element& element, const int* nodes) const;

 private:
  std::vector<std::size_t> start_, items_;  // by node
  std::vector<char> on_boundary_;           // by node
};

template <class Take>
void PolynomialTerms::at(const Vector2& x, Take take) const {
  const double a = (x.x() - centre.x()) / scale.x(), b = (x.y() - centre.y()) / scale.y();
  double power_a[kMostDegree + 1], power_b[kMostDegree + 1];
  power_a[0] = power_b[0] = 1.0;
  for (int d = 1; d <= degree; ++d) {
    power_a[d] = power_a[d - 1] * a;
    power_b[d] = power_b[d - 1] * b;
  }
  Eigen::Index k = 0;
  for (int d = 0; d <= degree; ++d)
    for (int j = 0; j <= d; ++j) take(k++, power_a[d - j] * power_b[j]);
}

}  // namespace sage
