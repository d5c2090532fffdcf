// Signature curves (kappa, kappa_s) and semi-signature curves (slope, kappa, kappa_s): sampled, and
// as closed equations.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/curves/curve.h"

namespace palpate::test {

/// One point of both curves: the signature is its (kappa, kappa_s); the semi-signature also has the
/// canonical tangent.
struct SignaturePoint {
  double t = 0.0;
  double tangent_angle = 0.0;  ///< in the canonical frame [rad]
  double kappa = 0.0;          ///< [1/m]
  double kappa_s = 0.0;        ///< [1/m^2]

  double slope() const;  ///< lambda; infinite if the canonical tangent is vertical
};

/// `count` points, evenly in t from t0 to t1. Places without curvature (a cusp) are omitted.
std::vector<SignaturePoint> signature_curve(const Curve& curve, double t0, double t1,
                                            std::size_t count);

/// The invariants of a conic's closed signature equation (18), (24), (33):
///   Ip(kappa, kappa_s) + ic1 |kappa|^(-2/3) = ic2.
struct ConicSignature {
  double ic1 = 0.0;  ///< (a b)^(-2/3) for an ellipse, minus that for a hyperbola, 0 for a parabola
  double ic2 = 0.0;

  /// Left side minus right side, divided by the sum of the magnitudes of the terms: 0 on the
  /// signature curve, at most 1 in magnitude elsewhere. Never NaN: 1 for kappa = 0, which no conic
  /// has.
  double residual(double kappa, double kappa_s) const;
};

/// nullopt for the cubics and the line.
std::optional<ConicSignature> conic_signature(const Curve& curve);

}  // namespace palpate::test
