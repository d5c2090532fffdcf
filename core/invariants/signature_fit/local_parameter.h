// The curve parameters that a point of known local geometry may have on a given shape, section 5.3
// in sign-safe forms: the starts of a fit.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "core/curves/curve_class.h"

namespace palpate {

struct LocalParameter {
  double t = 0.0;
  int direction = 1;  ///< +1: travelled with t increasing, -1: against it
};

/// At most four curve parameters.
class ParameterCandidates {
 public:
  /// Kept finite, and where powers of it leave something of a double.
  void add(double t);

  std::span<const double> values() const& { return {values_.data(), count_}; }
  std::span<const double> values() && = delete;  ///< would outlive them

 private:
  std::array<double, 4> values_{};
  std::size_t count_ = 0;
};

/// `angle`: tangent angle in the canonical frame in the direction of travel, which need not be that
/// of increasing t; kappa and kappa_s of that direction. From the angle, which is measured best,
/// and from the curvature, which tells what the angle leaves open or cannot resolve. Not for lines
/// and circles.
ParameterCandidates candidate_parameters(CurveClass curve_class, const Eigen::Vector3d& parameters,
                                         double angle, double kappa, double kappa_s);

/// sinh 2t = 2 kappa_s E^3 / (3 a b (a^2 + b^2)) with E^3 = (a b / kappa)^2: signed, no choice
/// left.
double hyperbola_parameter(double a, double b, double kappa, double kappa_s);

/// kappa_s / (3 kappa^2), whatever a is.
double parabola_parameter(double kappa, double kappa_s);

}  // namespace palpate
