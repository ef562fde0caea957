#include "sage/bounds/bounds_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "sage/draw/colour_map.hpp"
#include "sage/draw/svg.hpp"

namespace sage::bounds {

namespace {

auto to(std::string& text) {
  return std::back_inserter(text);
}

std::string words_of(const std::optional<double>& value) {
  return value ? fmt::format("{:.6g}", *value) : "-";
}

std::string bound_line(const char* name, const Bound& bound, const char* reserve) {
  if (!bound.value) return fmt::format("  {}  none: {}\n", name, bound.reason);
  return fmt::format("  {}  {:<12.7g}margin {:.1e}, residual {:.1e}, {} {:.1e}; {} programs, {} iterations\n",
                     name, *bound.value, bound.margin, bound.residual, reserve, bound.reserve, bound.solved,
                     bound.iterations);
}

std::string title_of(const Model& model) {
  return model.title.empty() ? model.file : model.title;
}

// ---- the picture

struct Frame {
  Vector2 low = Vector2::Constant(1e300), high = Vector2::Constant(-1e300);
  double scale = 1.0, left = 0.0, top = 0.0;

  Frame(const Domain& domain, double width, double left_px, double top_px) : left(left_px), top(top_px) {
    for (const Vector2& x : domain.x) {
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
    scale = width / std::max(high.x() - low.x(), 1e-300);
    scale = std::min(scale, 420.0 / std::max(high.y() - low.y(), 1e-300));
  }
  double height() const { return scale * (high.y() - low.y()); }
  double width() const { return scale * (high.x() - low.x()); }
  Vector2 place(const Vector2& x) const {
    return {left + scale * (x.x() - low.x()), top + scale * (high.y() - x.y())};
  }
};

void add_polygon(std::string& out, const Frame& frame, std::span<const Vector2> x, const std::string& colour) {
  out += "<path d=\"M";
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vector2 p = frame.place(x[i]);
    if (i > 0) out += "L";
    svg::number(out, p.x());
    out += " ";
    svg::number(out, p.y());
  }
  fmt::format_to(to(out), "Z\" fill=\"{0}\" stroke=\"#555555\" stroke-width=\"0.2\"/>\n", colour);
}

std::array<Vector2, 3> corners(const Domain& domain, const Triangle& t) {
  std::array<Vector2, 3> x;
  for (std::size_t i = 0; i < 3; ++i) x[i] = domain.x[t.node[i]];
  return x;
}

// Largest shear strain rate, the mean over a part: velocities are linear along its sides.
double shear_rate(const MovingPart& part) {
  double area = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
  for (std::size_t i = 0, n = part.corner.size(); i < n; ++i) {
    const std::size_t j = (i + 1) % n;
    const Vector2 &a = part.corner[i], side = part.corner[j] - a, v = 0.5 * (part.motion[i] + part.motion[j]);
    area += 0.5 * (a.x() * side.y() - a.y() * side.x());
    xx += v.x() * side.y();
    yy -= v.y() * side.x();
    xy += v.y() * side.y() - v.x() * side.x();
  }
  return std::hypot(xx - yy, xy) / area;
}

std::vector<MovingPart> mechanism_of(const Bounds& found) {
  std::vector<MovingPart> parts;
  if (found.velocity.cols() == 0) return parts;
  for (const Triangle& t : found.domain.triangles) {
    MovingPart& part = parts.emplace_back();
    for (const int node : t.node) {
      part.corner.push_back(found.domain.x[node]);
      part.motion.emplace_back(found.velocity.col(node));
    }
  }
  return parts;
}

void draw_stress(std::string& out, const Frame& frame, const Bounds& found, double factor) {
  for (std::size_t t = 0; t < found.domain.triangles.size(); ++t)
    add_polygon(out, frame, corners(found.domain, found.domain.triangles[t]),
                hex(viridis(mobilised(found, t, factor))));
}

void draw_mechanism(std::string& out, const Frame& frame, const std::vector<MovingPart>& parts) {
  if (parts.empty()) return;
  std::vector<double> rate;
  double largest = 0.0;
  for (const MovingPart& part : parts) {
    rate.push_back(shear_rate(part));
    for (const Vector2& v : part.motion) largest = std::max(largest, v.cwiseAbs().maxCoeff());
  }
  std::vector<double> sorted = rate;
  std::sort(sorted.begin(), sorted.end());
  const double most = std::max(sorted[(sorted.size() - 1) * 95 / 100], 1e-300);
  const double moved = 0.05 * std::max(frame.high.x() - frame.low.x(), frame.high.y() - frame.low.y()) /
                       std::max(largest, 1e-300);
  for (std::size_t t = 0; t < parts.size(); ++t) {
    std::vector<Vector2> x = parts[t].corner;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += moved * parts[t].motion[i];
    add_polygon(out, frame, x, hex(viridis(std::sqrt(rate[t] / most))));
  }
}

// How an answer lies beside the bounds.
std::string beside(const Bounds& found, const OtherAnswer& other) {
  if (!other.remark.empty()) return "NOT PROVED: " + other.remark;
  if (!other.associated || !other.lower || !found.upper.value) return {};
  if (contradicts(found, other)) return "BELOW the lower bound";
  const double above = 100.0 * (*other.lower / *found.upper.value - 1.0);
  return above > 0.0 ? fmt::format("lower end {:.2f} % above the upper bound", above) : "beside the bounds";
}

std::string answers_table(const Bounds& found, const std::vector<OtherAnswer>& others) {
  constexpr const char* kRow = "{:<36}{:>12}{:>12}  {}\n";
  std::string text = fmt::format(kRow, "", "lower", "upper", "");
  text += fmt::format(kRow, "bounds, psi = phi", words_of(found.lower.value), words_of(found.upper.value), "");
  for (const OtherAnswer& other : others)
    text += fmt::format(kRow, other.name, words_of(other.lower), words_of(other.upper), beside(found, other));
  return text;
}

}  // namespace

double mobilised(const Bounds& found, std::size_t t, double factor) {
  const Domain& domain = found.domain;
  const Strength s = domain.soils[domain.triangles[t].soil].strength.reduced(factor).in_plane();
  const double phi = s.friction, c = s.cohesion;
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3 sigma = found.stress.col(static_cast<Eigen::Index>(3 * t + i));
    const double radius = std::hypot(0.5 * (sigma[0] - sigma[1]), sigma[2]),
                 most = c * std::cos(phi) - 0.5 * (sigma[0] + sigma[1]) * std::sin(phi);
    sum += most > 0.0 ? std::min(radius / most, 1.0) : (radius > 0.0 ? 1.0 : 0.0);
  }
  return sum / 3.0;
}

double shown_factor(const Bounds& found, Quantity quantity) {
  return quantity == Quantity::strength && found.lower.value ? std::max(*found.lower.value, 1e-6) : 1.0;
}

bool contradicts(const Bounds& found, const OtherAnswer& other) {
  return other.associated && other.remark.empty() && other.upper && found.lower.value &&
         *other.upper < *found.lower.value;
}

std::string quantity_words(const Domain& domain, Quantity quantity) {
  if (quantity == Quantity::strength) return "factor of safety";
  return domain.moved() ? "force at the supports that move" : "load multiplier";
}

std::string bracket_words(const Bounds& found) {
  if (found.lower.value && found.upper.value)
    return fmt::format("between {:.7g} and {:.7g}", *found.lower.value, *found.upper.value);
  if (found.lower.value) return fmt::format("above {:.7g}", *found.lower.value);
  if (found.upper.value) return fmt::format("below {:.7g}", *found.upper.value);
  return "not bounded";
}

std::string to_text(const Model& model, const Ground& ground, Quantity quantity, const Bounds& found,
                    const std::vector<OtherAnswer>& others) {
  std::string text =
      fmt::format("{}: {}\nbounds by limit analysis: flow associated (psi = phi), small displacements\n",
                  model.file, model.title);
  for (const std::string& soil : ground.soils) fmt::format_to(to(text), "  material {}\n", soil);
  for (const std::string& note : ground.notes) fmt::format_to(to(text), "  note: {}\n", note);
  fmt::format_to(to(text), "{:>10}{:>14}{:>14}{:>10}\n", "triangles", "lower", "upper", "gap %");
  for (const Round& round : found.rounds) {
    const bool both = round.lower && round.upper;
    const double gap =
        both ? 200.0 * (*round.upper - *round.lower) / std::abs(*round.upper + *round.lower) : 0.0;
    fmt::format_to(to(text), "{:>10}{:>14}{:>14}{:>10}\n", round.triangles, words_of(round.lower),
                   words_of(round.upper), both ? fmt::format("{:.2f}", gap) : "-");
  }
  fmt::format_to(to(text), "{} {}\n", quantity_words(found.domain, quantity), bracket_words(found));
  text += bound_line("lower", found.lower, "least reserve to yield");
  text += bound_line("upper", found.upper, "least reserve of dilation");
  if (!others.empty()) text += answers_table(found, others);
  return text;
}

std::string to_csv(const Bounds& found, int digits) {
  std::string text = "triangles,lower,upper\n";
  for (const Round& round : found.rounds) {
    const auto number = [&](const std::optional<double>& v) {
      return v ? fmt::format("{:.{}g}", *v, digits) : "";
    };
    fmt::format_to(to(text), "{},{},{}\n", round.triangles, number(round.lower), number(round.upper));
  }
  return text;
}

std::string answers_csv(const Bounds& found, const std::vector<OtherAnswer>& others, int digits) {
  const auto number = [&](const std::optional<double>& v) {
    return v ? fmt::format("{:.{}g}", *v, digits) : "";
  };
  std::string text = "answer,lower,upper,proved\n";
  fmt::format_to(to(text), "\"bounds, psi = phi\",{},{},{}\n", number(found.lower.value),
                 number(found.upper.value), found.lower.value && found.upper.value ? 1 : 0);
  for (const OtherAnswer& other : others)
    fmt::format_to(to(text), "\"{}\",{},{},{}\n", other.name, number(other.lower), number(other.upper),
                   other.remark.empty() ? 1 : 0);
  return text;
}

std::string fields_csv(const Bounds& found, int digits) {
  std::string text = "triangle,x,y,stress_xx,stress_yy,stress_xy,velocity_x,velocity_y\n";
  for (std::size_t t = 0; t < found.domain.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const int node = found.domain.triangles[t].node[i];
      const Vector2& x = found.domain.x[node];
      fmt::format_to(to(text), "{},{:.{}g},{:.{}g}", t + 1, x.x(), digits, x.y(), digits);
      if (found.stress.cols() > 0) {
        const Vector3 s = -found.stress.col(static_cast<Eigen::Index>(3 * t + i));
        fmt::format_to(to(text), ",{:.{}g},{:.{}g},{:.{}g}", s[0], digits, s[1], digits, s[2], digits);
      } else {
        text += ",,,";
      }
      if (found.velocity.cols() > 0)
        fmt::format_to(to(text), ",{:.{}g},{:.{}g}\n", found.velocity(0, node), digits, found.velocity(1, node),
                       digits);
      else
        text += ",,\n";
    }
  return text;
}

std::string fields_svg(const Model& model, Quantity quantity, const Bounds& found,
                       const std::vector<OtherAnswer>& others) {
  constexpr double kPanel = 620.0, kEdge = 30.0, kTop = 96.0;
  const Frame left(found.domain, kPanel, kEdge, kTop);
  const double step = left.width() + 2.0 * kEdge, down = left.height() + 2.5 * kEdge;
  const std::size_t rows = 1 + (others.size() + 1) / 2;  // of two panels each
  const double height = kTop + static_cast<double>(rows) * down;
  std::string out = svg::open(static_cast<int>(2.0 * step + kEdge), static_cast<int>(height));
  svg::text_within(out, kEdge, 24.0, title_of(model), svg::kTitleFont, 2.0 * step, "start", svg::kBold);
  svg::text(out, kEdge, 46.0, quantity_words(found.domain, quantity) + " " + bracket_words(found), svg::kFont,
            "start");
  const auto panel = [&](std::size_t place, const std::string& caption) {
    const std::size_t row = place / 2;
    const double x = kEdge + (place % 2 == 0 ? 0.0 : step), y = kTop + down * static_cast<double>(row);
    svg::text_within(out, x, y - 20.0, caption, svg::kFont, left.width() + kEdge, "start");
    return Frame(found.domain, kPanel, x, y);
  };
  const Frame stress = panel(0, "lower bound " + words_of(found.lower.value) + ": strength mobilised, 0 to 1");
  if (found.stress.cols() > 0) draw_stress(out, stress, found, shown_factor(found, quantity));
  const Frame motion =
      panel(1, "upper bound " + words_of(found.upper.value) + ": mechanism, rate of shear strain");
  draw_mechanism(out, motion, mechanism_of(found));
  for (std::size_t i = 0; i < others.size(); ++i) {
    const OtherAnswer& other = others[i];
    const Frame frame =
        panel(2 + i, fmt::format("{}: {} to {}{}", other.name, words_of(other.lower), words_of(other.upper),
                                 other.remark.empty() ? "" : ", NOT PROVED"));
    draw_mechanism(out, frame, other.mechanism);
  }
  return out + std::string(svg::kClose);
}

}  // namespace sage::bounds
