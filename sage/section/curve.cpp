#include "sage/section/curve.hpp"

#include <algorithm>
#include <cmath>

namespace sage::section {

Curve straight(const Vector2& a, const Vector2& b) {
  Curve curve;
  curve.a = a;
  curve.b = b;
  return curve;
}

Curve arc_around(const Vector2& centre, double radius, double start, double sweep) {
  Curve curve;
  curve.arc = true;
  curve.centre = centre;
  curve.radius = radius;
  curve.start = start;
  curve.sweep = sweep;
  curve.a = curve.at(0.0);
  curve.b = curve.at(1.0);
  return curve;
}

Vector2 Curve::at(double t) const {
  if (!arc) return t >= 1.0 ? b : Vector2(a + t * (b - a));
  const double angle = start + t * sweep;
  return centre + radius * Vector2(std::cos(angle), std::sin(angle));
}

double Curve::length() const {
  return arc ? radius * std::abs(sweep) : (b - a).norm();
}

double Curve::nearest(const Vector2& p) const {
  if (!arc) {
    const Vector2 along = b - a;
    const double square = along.squaredNorm();
    return square > 0.0 ? std::clamp((p - a).dot(along) / square, 0.0, 1.0) : 0.0;
  }
  const Vector2 from = p - centre;
  const double sense = sweep < 0.0 ? -1.0 : 1.0;
  double turn = std::fmod(sense * (std::atan2(from.y(), from.x()) - start), 2.0 * kPi);
  if (turn < 0.0) turn += 2.0 * kPi;
  const double whole = std::abs(sweep);
  if (turn <= whole) return turn / whole;
  return turn - whole < 2.0 * kPi - turn ? 1.0 : 0.0;
}

Curve Curve::part(double from, double to) const {
  if (!arc) return straight(at(from), at(to));
  Curve curve = arc_around(centre, radius, start + from * sweep, (to - from) * sweep);
  if (from == 0.0) curve.a = a;
  if (to == 1.0) curve.b = b;
  return curve;
}

namespace {

void meet_straight(const Curve& one, const Curve& other, std::vector<Vector2>& points) {
  const Vector2 d = one.b - one.a, e = other.b - other.a;
  const double sine = cross(d, e);
  if (std::abs(sine) <= 1e-12 * d.norm() * e.norm()) return;  // parallel: their ends tell
  points.push_back(one.a + cross(other.a - one.a, e) / sine * d);
}

void meet_circle(const Curve& line, const Curve& arc, double tolerance, std::vector<Vector2>& points) {
  const Vector2 along = (line.b - line.a).normalized();
  const Vector2 foot = line.a + (arc.centre - line.a).dot(along) * along;
  const double away = (foot - arc.centre).norm();
  if (away > arc.radius + tolerance) return;
  if (away > arc.radius - tolerance) {
    points.push_back(foot);  // touches
    return;
  }
  const double half = std::sqrt(arc.radius * arc.radius - away * away);
  points.push_back(foot - half * along);
  points.push_back(foot + half * along);
}

void meet_circles(const Curve& one, const Curve& other, double tolerance, std::vector<Vector2>& points) {
  const Vector2 between = other.centre - one.centre;
  const double d = between.norm();
  if (d <= tolerance || d > one.radius + other.radius + tolerance ||
      d < std::abs(one.radius - other.radius) - tolerance)
    return;
  const Vector2 along = between / d;
  const double to = (d * d + one.radius * one.radius - other.radius * other.radius) / (2.0 * d);
  const double square = one.radius * one.radius - to * to;
  const double half = square > 0.0 ? std::sqrt(square) : 0.0;
  const Vector2 foot = one.centre + to * along, across(-along.y(), along.x());
  points.push_back(foot - half * across);
  if (half > tolerance) points.push_back(foot + half * across);
}

}  // namespace

std::vector<Vector2> meetings(const Curve& one, const Curve& other, double tolerance) {
  std::vector<Vector2> points;
  for (const Vector2& end : {one.a, one.b})
    if (other.distance(end) <= tolerance) points.push_back(end);
  for (const Vector2& end : {other.a, other.b})
    if (one.distance(end) <= tolerance) points.push_back(end);
  std::vector<Vector2> crossings;
  if (!one.arc && !other.arc)
    meet_straight(one, other, crossings);
  else if (one.arc && other.arc)
    meet_circles(one, other, tolerance, crossings);
  else
    meet_circle(one.arc ? other : one, one.arc ? one : other, tolerance, crossings);
  // A crossing close to an end is that end: lines that meet at a small angle cross farther away than the tolerance.
  for (const Vector2& p : crossings) {
    const auto near = [&](const Vector2& q) { return (p - q).norm() <= 10.0 * tolerance; };
    if (one.distance(p) <= tolerance && other.distance(p) <= tolerance &&
        std::none_of(points.begin(), points.end(), near))
      points.push_back(p);
  }
  return points;
}

}  // namespace sage::section
