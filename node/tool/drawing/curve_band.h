// The confidence band of the most probable curve: how far the true curve may lie beside it.
#pragma once

#include <optional>
#include <vector>

#include "node/tool/drawing/curve_model.h"

namespace palpate {

/// A normal distribution lies within this many standard deviations with 95 % probability.
inline constexpr double kBandSigmas = 1.959963984540054;

/// Distances of the two borders of the band from the curve, along its left normal. [m]
struct BandWidth {
  double left_m = 0.0;   ///< >= 0
  double right_m = 0.0;  ///< <= 0
};

/// The 95 % band of the curve at one t. Of all parameters at kBandSigmas from the estimate, each
/// border takes those that move the curve farthest to that side (the first order reliability
/// method), and evaluates the curve itself there. So a long thin valley of the covariance bends the
/// band as it bends the curve. If these parameters are outside the range of the canonical form, the
/// border is the linear one. nullopt without a covariance.
std::optional<BandWidth> band_at(const CurveModel& model, double t);

/// First-order standard deviation of the curvature along the curve. [1/m]
class CurvatureDeviation {
 public:
  explicit CurvatureDeviation(const CurveModel& model);

  /// nullopt without a covariance.
  std::optional<double> at(double t) const;

 private:
  // The model moved by one standard deviation in either direction along each principal axis of the
  // covariance; the unmoved model if that leaves the range of the canonical form.
  struct Axis {
    CurveModel minus;
    CurveModel plus;
    double deviations_apart = 0.0;
  };

  CurveModel model_;
  std::vector<Axis> axes_;
};

}  // namespace palpate
