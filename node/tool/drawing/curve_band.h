// How far the true curve may lie beside the most probable one, place by place.
#pragma once

#include <optional>
#include <vector>

#include "node/tool/drawing/curve_model.h"

namespace palpate {

/// Standard deviations within which 95 % of a normal distribution lie: the 97.5 % point.
inline constexpr double kBandSigmas = 1.959963984540054;

/// Distances of the band's two borders from the curve, along its left normal. [m]
struct BandWidth {
  double left_m = 0.0;   ///< >= 0
  double right_m = 0.0;  ///< <= 0
};

/// The 95 % band of the curve's place at one t. Each border is the curve at the most probable of
/// all parameters that lie kBandSigmas from the estimate and put the curve furthest to that side,
/// the first order reliability method: the curve itself is evaluated there, so that a long thin
/// valley of the covariance bends the band as it bends the curve. Where these parameters leave the
/// canonical form's range the border is the linear one. nullopt without a covariance.
std::optional<BandWidth> band_at(const CurveModel& model, double t);

/// First-order standard deviations of curvature [1/m] beside places of the curve.
class CurvatureDeviation {
 public:
  explicit CurvatureDeviation(const CurveModel& model);

  /// nullopt without a covariance.
  std::optional<double> at(double t) const;

 private:
  // The model one standard deviation either way along each principal axis of the covariance; the
  // model itself where that leaves the canonical form's range.
  struct Axis {
    CurveModel minus;
    CurveModel plus;
    double deviations_apart = 0.0;
  };

  CurveModel model_;
  std::vector<Axis> axes_;
};

}  // namespace palpate
