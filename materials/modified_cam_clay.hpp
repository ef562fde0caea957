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

class ModifiedCamClay final : public ElasticShear,
                              public PathError<4>,
                              public StartAdjustment<4>,
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
  struct LevelChange {
    double by_log_p;
    Vector4 by_s;  // tensor components
  };
  struct Point;
  struct Part;
  struct Step;
  struct OnSurface;
  struct ElasticTrial;
  struct PlasticIncrement;
  Slope slope(double lode) const;
  double size_through(const Vector4& sigma) const;
  Step step_from(const Point& point, const Vector4& deps, const Part& part) const;
  static Vector4 trial_of(const Step& step, double G);
  void set_trial(const Step& step, OnSurface& at) const;
  OnSurface on_surface(const Step& step, double height) const;
  OnSurface return_to_surface(const Step& step, const ElasticTrial& trial, double guess) const;
  Point elastic_end(const Step& step, const OnSurface& trial) const;
  Point plastic_end(const Step& step, const OnSurface& at) const;
  void set_plastic_rates(const Step& step, const OnSurface& at, double left, Point& end) const;
  ElasticTrial elastic_trial(const Step& step) const;
  Point advance(const Point& point, const Vector4& deps, const Part& part, double guess) const;
  Point end_of(const Step& step, const ElasticTrial& trial, double guess) const;
  LevelChange level_change(const Point& point) const;
  bool loads(const Step& still, const Step& whole) const;
  Part elastic_part(Point start, const Vector4& deps) const;
  PlasticIncrement plastic_increment(const Point& start, const Vector4& deps) const;
  Point extrapolated(const Point& once, const Point& twice) const;
  Point start_of(const PointIn<4>& in) const;

  CamClay clay_;
  double by_bulk_;            // G over the bulk modulus
  double width_, skew_, m4_;  // of the shapes
};

MaterialEntry modified_cam_clay_entry();

}  // namespace sage
