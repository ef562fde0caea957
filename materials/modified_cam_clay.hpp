// Modified Cam clay (Roscoe and Burland 1968).  docs/theory/modified_cam_clay.md
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "materials/parameters.hpp"
#include "sage/core/elastic_shear.hpp"
#include "sage/core/law.hpp"
#include "sage/core/law_remark.hpp"
#include "sage/core/start_adjustment.hpp"

namespace sage {

// How M depends on Lode's angle; M itself is that of triaxial compression.
enum class DeviatoricShape : std::uint8_t { circle, matsuoka_nakai, van_eekelen };

// Pressures are compression positive.
struct CamClay {
  double M;              // q/p at the critical state in triaxial compression                    [-]
  double lambda, kappa;  // slopes of v against ln p, 0 < kappa < lambda                         [-]
  double v0;             // specific volume at the start, > 1                                    [-]
  double nu;             // Poisson's ratio; not used where G > 0                                [-]
  double ocr;            // p_c at the start over that of a surface through the stress; or 0     [-]
  double pop;            // the difference of the two; or 0                                 [stress]
  double p_c;            // p_c at the start; or 0: one of the three is not 0               [stress]
  DeviatoricShape shape;
  bool current_volume;  // v changes with the volume, else it stays v0
  double G;             // constant shear modulus, or 0: from nu                            [stress]
  double floor;         // least mean stress as a share of the first p_c                         [-]
};

class ModifiedCamClay final : public SolidLaw,
                              public PathError<4>,
                              public StartAdjustment<4>,
                              public ElasticShear,
                              public LawRemark {
 public:
  // Of the parameters `floor` must not exceed 1/4.
  explicit ModifiedCamClay(const CamClay& clay);

  static constexpr std::array<Quantity, 5> kHistory{
      {{"preconsolidation_pressure", Dimension::stress},
       {"specific_volume", Dimension::none},
       {"least_pressure", Dimension::stress},
       {"plastic_shear_strain", Dimension::none, 0.0, QuantityRole::plastic_shear_strain},
       {"plastic_volume_strain", Dimension::none, 0.0, QuantityRole::plastic_volume_strain}}};
  LawTraits traits() const override;
  // Refuses stresses whose mean is no compression.  Raises a p_c whose surface lies inside the stress.
  bool initialise(const Vector4& sigma, std::span<double> h) const override;
  bool adjusts_start(const Vector4& sigma) const override;
  bool accepts_history(const Vector4& sigma, std::span<const double> h) const override;
  Outcome update(const PointIn<4>& in, PointOut<4>& out) const override;
  double path_error(const PointIn<4>& in, const Vector4& sigma, std::span<const double> h) const override;
  std::string caution() const override;
  std::string remark() const override;
  double stress_level(const Vector4& sigma, std::span<const double> h) const override;
  double shear_modulus(const Vector4& sigma, std::span<const double> h) const override;

 private:
  enum { kPressure, kVolume, kLeast, kShear, kPlasticVolume };
  struct Slope {
    double M, by_lode;  // M and its derivative with respect to sin(3 theta)
  };
  struct Increment;
  struct Deviator;
  struct Point;
  struct Part;
  struct Step;
  struct Trial;
  struct OnSurface;
  struct ElasticEnd;
  struct PlasticIncrement;
  Slope slope(double lode) const;
  Slope slope_of(const Vector4& s, double q) const;
  double size_through(const Vector4& sigma) const;
  static Increment increment_of(const PointIn<4>& in, bool rates);
  static Point start_of(const PointIn<4>& in, const Increment& of);
  Step step_from(const Increment& of, const Point& point, const Part& part) const;
  Trial trial_of(const Step& step, double growth, double exponential) const;
  ElasticEnd stay_elastic(const Step& step) const;
  Point elastic_end(const Step& step, const ElasticEnd& elastic) const;
  OnSurface on_surface(const Step& step, double place) const;
  OnSurface return_to_surface(const Step& step, double log_trial, double guess) const;
  Vector4 direct_G_rate(const Step& step, double G) const;
  static double left_of_trial(const OnSurface& at);
  Point plastic_end(const Step& step, const OnSurface& at) const;
  void set_plastic_rates(const Step& step, const OnSurface& at, double left, Point& end) const;
  Point advance(const Increment& of, const Point& point, const Part& part, double guess) const;
  Vector4 log_level_rate(const Increment& of, const Point& point) const;
  bool yields_at_once(const Increment& of, const Point& start, const Vector4& deps) const;
  Part elastic_part(const Increment& of, const Point& start, const Vector4& deps) const;
  PlasticIncrement plastic_increment(const Increment& of, const Point& start, const Vector4& deps) const;
  static Deviator ratio_of(const Point& point);
  Point extrapolated(const Increment& of, const Point& once, const Point& twice) const;

  CamClay clay_;
  double by_bulk_;            // G over the bulk modulus
  double width_, skew_, m4_;  // of the shapes
};

MaterialEntry modified_cam_clay_entry();

}  // namespace sage
