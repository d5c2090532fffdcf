// Appendix C: curvature and its derivative of an algebraic curve f(x, y) = 0, without a parameter.
#pragma once

#include <optional>

#include "core/curves/algebraic/bivariate_polynomial.h"
#include "core/curves/plane_curve.h"

namespace palpate {

/// Tangent angle, kappa and kappa_s at a point of the curve, travelled with the gradient on the
/// left; nullopt at a singular point: where the gradient is no larger than the rounding of its own
/// terms. The point is taken to lie on the curve: off it, the values are those of its level line.
/// Derivation: core/README.md, "Implicit curves".
std::optional<LocalGeometry> implicit_geometry(const PlaneJet& jet, int degree);

inline std::optional<LocalGeometry> implicit_geometry(const BivariatePolynomial& f,
                                                      const Vec2& point_m) {
  return implicit_geometry(f.jet(point_m), f.degree());
}

}  // namespace palpate
