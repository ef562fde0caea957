// Integration rules on the parent line (-1, 1), square (-1, 1)^2 and triangle (0, 0) (1, 0) (0, 1).
// Weights sum to the size of the parent: 2, 4 and 1/2.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace sage {

struct LinePoint {
  double xi, w;
};

struct RulePoint {
  double xi, eta, w;
};

// n points are exact for polynomials of degree 2n - 1.
template <int n>
struct GaussLine;

template <>
struct GaussLine<1> {
  static constexpr std::array<LinePoint, 1> table{{{0.0, 2.0}}};
};

template <>
struct GaussLine<2> {
  static constexpr std::array<LinePoint, 2> table{
      {{-0.57735026918962576451, 1.0}, {0.57735026918962576451, 1.0}}};
};

template <>
struct GaussLine<3> {
  static constexpr std::array<LinePoint, 3> table{{{-0.77459666924148337704, 0.55555555555555555556},
                                                   {0.0, 0.88888888888888888889},
                                                   {0.77459666924148337704, 0.55555555555555555556}}};
};

template <>
struct GaussLine<4> {
  static constexpr std::array<LinePoint, 4> table{{{-0.86113631159405257522, 0.34785484513745385737},
                                                   {-0.3399810435848562648, 0.65214515486254614263},
                                                   {0.3399810435848562648, 0.65214515486254614263},
                                                   {0.86113631159405257522, 0.34785484513745385737}}};
};

template <>
struct GaussLine<5> {
  static constexpr std::array<LinePoint, 5> table{{{-0.9061798459386639928, 0.23692688505618908751},
                                                   {-0.53846931010568309104, 0.47862867049936646804},
                                                   {0.0, 0.56888888888888888889},
                                                   {0.53846931010568309104, 0.47862867049936646804},
                                                   {0.9061798459386639928, 0.23692688505618908751}}};
};

template <>
struct GaussLine<6> {
  static constexpr std::array<LinePoint, 6> table{{{-0.93246951420315202781, 0.17132449237917034504},
                                                   {-0.66120938646626451366, 0.36076157304813860757},
                                                   {-0.23861918608319690863, 0.46791393457269104739},
                                                   {0.23861918608319690863, 0.46791393457269104739},
                                                   {0.66120938646626451366, 0.36076157304813860757},
                                                   {0.93246951420315202781, 0.17132449237917034504}}};
};

template <>
struct GaussLine<7> {
  static constexpr std::array<LinePoint, 7> table{{{-0.94910791234275852453, 0.12948496616886969327},
                                                   {-0.74153118559939443986, 0.2797053914892766679},
                                                   {-0.40584515137739716691, 0.38183005050511894495},
                                                   {0.0, 0.41795918367346938776},
                                                   {0.40584515137739716691, 0.38183005050511894495},
                                                   {0.74153118559939443986, 0.2797053914892766679},
                                                   {0.94910791234275852453, 0.12948496616886969327}}};
};

template <>
struct GaussLine<8> {
  static constexpr std::array<LinePoint, 8> table{{{-0.96028985649753623168, 0.10122853629037625915},
                                                   {-0.79666647741362673959, 0.22238103445337447054},
                                                   {-0.52553240991632898582, 0.31370664587788728734},
                                                   {-0.18343464249564980494, 0.36268378337836198297},
                                                   {0.18343464249564980494, 0.36268378337836198297},
                                                   {0.52553240991632898582, 0.31370664587788728734},
                                                   {0.79666647741362673959, 0.22238103445337447054},
                                                   {0.96028985649753623168, 0.10122853629037625915}}};
};

template <>
struct GaussLine<9> {
  static constexpr std::array<LinePoint, 9> table{{{-0.96816023950762608984, 0.081274388361574411972},
                                                   {-0.8360311073266357943, 0.18064816069485740406},
                                                   {-0.61337143270059039731, 0.26061069640293546232},
                                                   {-0.32425342340380892904, 0.31234707704000284007},
                                                   {0.0, 0.33023935500125976316},
                                                   {0.32425342340380892904, 0.31234707704000284007},
                                                   {0.61337143270059039731, 0.26061069640293546232},
                                                   {0.8360311073266357943, 0.18064816069485740406},
                                                   {0.96816023950762608984, 0.081274388361574411972}}};
};

// Of any number of points, from the one next to 1 down.
std::vector<LinePoint> gauss_line(int points);

// n x n Gauss points of the square (xi slowest), or these on the square folded onto the triangle, which is exact for
// polynomials of full degree 2n - 2.
std::vector<RulePoint> gauss_area(bool triangle, int n);

// Product of two Gauss lines; xi runs fastest.
template <int n>
struct GaussSquare {
  static constexpr int points = n * n;
  static constexpr std::array<RulePoint, points> make() {
    std::array<RulePoint, points> rule{};
    std::size_t p = 0;
    for (const LinePoint& b : GaussLine<n>::table)
      for (const LinePoint& a : GaussLine<n>::table) rule[p++] = {a.xi, b.xi, a.w * b.w};
    return rule;
  }
  static constexpr std::array<RulePoint, points> table = make();
};

// A symmetric rule on the triangle, orbit by orbit.  Weights are given as shares of the area (sum 1).
template <std::size_t n>
class TriangleRule {
 public:
  constexpr TriangleRule centroid(double w) { return add(w, 1.0 / 3.0, 1.0 / 3.0); }
  // Three points with area coordinates (1 - 2b, b, b).
  constexpr TriangleRule three(double w, double b) {
    const double a = 1.0 - 2.0 * b;
    add(w, b, b);
    add(w, a, b);
    return add(w, b, a);
  }
  // Six points with area coordinates (a, b, 1 - a - b).
  constexpr TriangleRule six(double w, double a, double b) {
    const double c = 1.0 - a - b;
    add(w, a, b);
    add(w, b, a);
    add(w, a, c);
    add(w, c, a);
    add(w, b, c);
    return add(w, c, b);
  }
  constexpr std::array<RulePoint, n> points() const { return rule_; }

 private:
  constexpr TriangleRule& add(double w, double xi, double eta) {
    rule_[next_++] = {xi, eta, 0.5 * w};
    return *this;
  }

  std::array<RulePoint, n> rule_{};
  std::size_t next_ = 0;
};

// The number is that of the points, all of them inside: none on an edge, which may lie at r = 0.
// Degrees 1, 2, 4, 6, 8.  Dunavant (1985), polished to double precision.
struct Triangle1 {
  static constexpr int points = 1;
  static constexpr auto table = TriangleRule<1>().centroid(1.0).points();
};

struct Triangle3 {
  static constexpr int points = 3;
  static constexpr auto table = TriangleRule<3>().three(1.0 / 3.0, 1.0 / 6.0).points();
};

struct Triangle6 {
  static constexpr int points = 6;
  static constexpr auto table = TriangleRule<6>()
                                    .three(0.2233815896780114657, 0.44594849091596488632)
                                    .three(0.10995174365532186764, 0.09157621350977074346)
                                    .points();
};

struct Triangle12 {
  static constexpr int points = 12;
  static constexpr auto table =
      TriangleRule<12>()
          .three(0.11678627572637936603, 0.24928674517091042129)
          .three(0.050844906370206816921, 0.06308901449150222834)
          .six(0.082851075618373575194, 0.053145049844816947353, 0.31035245103378440542)
          .points();
};

struct Triangle16 {
  static constexpr int points = 16;
  static constexpr auto table =
      TriangleRule<16>()
          .centroid(0.14431560767778716825)
          .three(0.095091634267284624794, 0.45929258829272315603)
          .three(0.10321737053471825028, 0.17056930775176020662)
          .three(0.032458497623198080311, 0.050547228317030975458)
          .six(0.027230314174434994265, 0.0083947774099576053372, 0.26311282963463811342)
          .points();
};

}  // namespace sage
