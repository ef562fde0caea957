#include "sage/section/size_field.hpp"

#include <algorithm>
#include <cmath>

namespace sage::section {

namespace {

double diagonal_of(const Arrangement& arrangement) {
  Vector2 low = Vector2::Constant(1e300), high = Vector2::Constant(-1e300);
  for (const Piece& piece : arrangement.pieces)
    for (const Vector2& x : {piece.curve.a, piece.curve.b, piece.curve.at(0.5)}) {
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
  return (high - low).norm();
}

}  // namespace

SizeField::SizeField(const Section& section, const Arrangement& arrangement, const MeshSettings& settings,
                     const std::vector<double>& edges_of_circle)
    : growth_(settings.growth), factor_(settings.size_factor) {
  default_ = factor_ * (section.size > 0.0 ? section.size : diagonal_of(arrangement) / 20.0);
  for (const SectionArea& area : section.areas)
    limits_.push_back(area.size > 0.0 ? factor_ * area.size : default_);
  for (std::size_t i = 0; i < section.points.size(); ++i)
    if (section.points[i].size > 0.0)
      add(straight(section.points[i].x, section.points[i].x), factor_ * section.points[i].size);
  for (std::size_t p = 0; p < arrangement.pieces.size(); ++p) {
    const Piece& piece = arrangement.pieces[p];
    if (piece.size > 0.0) add(piece.curve, factor_ * piece.size);
    double limit = 1e300;
    for (const bool back : {false, true}) {
      const int area = arrangement.area_left_of({static_cast<int>(p), back});
      if (area >= 0) limit = std::min(limit, limit_of(area));
    }
    if (limit < default_) add(piece.curve, limit);
  }
  add_short_pieces(arrangement, edges_of_circle);
}

void SizeField::add(const Curve& curve, double size) {
  sources_.push_back({curve, size});
}

// Where lines meet closer than the sizes wished, elements are as small as that.
void SizeField::add_short_pieces(const Arrangement& arrangement, const std::vector<double>& edges_of_circle) {
  for (std::size_t p = 0; p < arrangement.pieces.size(); ++p) {
    const Piece& piece = arrangement.pieces[p];
    const double length = piece.curve.length(), here = at(piece.curve.at(0.5));
    const double edge =
        piece.curve.arc ? factor_ * 2.0 * kPi * piece.curve.radius / edges_of_circle[p] : length;
    if (std::min(length, edge) < 0.7 * here) add(piece.curve, std::min(length, edge));
  }
}

double SizeField::limit_of(int area) const {
  return area < 0 ? default_ : limits_[area];
}

double SizeField::at(const Vector2& x) const {
  double size = 1e300;
  for (const Source& source : sources_) {
    if (source.size >= size) continue;
    size = std::min(size, source.size + growth_ * source.curve.distance(x));
  }
  return size;
}

double SizeField::elements(const Arrangement& arrangement) const {
  double count = 0.0;
  for (const Source& source : sources_) count += (1.0 + source.curve.length() / source.size) / growth_;
  for (const Face& face : arrangement.faces) {
    if (face.area < 0) continue;
    double twice = 0.0;
    for (const Way& way : face.outer) {
      const Curve& curve = arrangement.pieces[way.piece].curve;
      twice +=
          (way.back ? -1.0 : 1.0) * cross(curve.a - arrangement.vertices[0], curve.b - arrangement.vertices[0]);
    }
    count += 0.5 * std::abs(twice) / (limit_of(face.area) * limit_of(face.area));
  }
  return count;
}

}  // namespace sage::section
