// The curve parameters that a point of known local geometry may have on a given shape (section 5.3,
// in forms that are safe for either sign): the starts of a fit.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "core/curves/curve_class.h"

namespace palpate {

struct LocalParameter {
  double t = 0.0;
  int direction = 1;  ///< +1: travel along increasing t, -1: against it
};

/// At most four curve parameters.
class ParameterCandidates {
 public:
  /// Adds t, clamped so that its powers stay in the range of a double; adds 0 if t is not finite.
  void add(double t);

  std::span<const double> values() const& { return {values_.data(), count_}; }
  std::span<const double> values() && = delete;  ///< the span would outlive the object

 private:
  std::array<double, 4> values_{};
  std::size_t count_ = 0;
};

/// `angle`: tangent angle in the canonical frame, in the direction of travel, which may be against
/// increasing t; kappa and kappa_s are of that direction too. The candidates come from the angle,
/// which is measured best, and from the curvature, which decides what the angle leaves open. Not
/// for lines and circles.
ParameterCandidates candidate_parameters(CurveClass curve_class, const Eigen::Vector3d& parameters,
                                         double angle, double kappa, double kappa_s);

/// sinh 2t = 2 kappa_s E^3 / (3 a b (a^2 + b^2)) with E^3 = (a b / kappa)^2; its sign is
/// determined.
double hyperbola_parameter(double a, double b, double kappa, double kappa_s);

/// kappa_s / (3 kappa^2), for any a.
double parabola_parameter(double kappa, double kappa_s);

}  // namespace palpate
