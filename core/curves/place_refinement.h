// Improves a localisation to full precision, from all measured quantities at the place.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/curves/plane_curve.h"

namespace palpate {

/// A place on a curve, and how far its geometry is from a measurement.
struct RefinedPlace {
  double t = 0.0;
  double disagreement = std::numeric_limits<double>::infinity();  ///< squared, dimensionless
};

/// Gauss-Newton from t on the tangent angle [rad] and on kappa / sqrt(kappa^2 + |kappa_s|), both
/// for increasing t. Both are needed: the angle does not change at an inflection (and is inaccurate
/// next to a cusp), kappa does not change at a vertex, and no point is both. The disagreement also
/// includes kappa_s, which distinguishes places with equal angles.
template <typename C>
RefinedPlace refine_place(const C& curve, double t, const LocalGeometry& measured) {
  // For an exact geometry the number of digits doubles. For a geometry that no place has exactly,
  // the error falls by a constant factor; if twenty steps are not enough, the disagreement shows
  // it.
  constexpr int kMostIterations = 20;
  // Full precision: t moves the position by less than this fraction of the radius of curvature.
  constexpr double kRounding = 2.0 * std::numeric_limits<double>::epsilon();
  RefinedPlace best;
  for (int i = 0; i < kMostIterations; ++i) {
    const LocalGeometry here = curve.geometry(t);
    const double scale2 = std::max(here.kappa * here.kappa, measured.kappa * measured.kappa) +
                          std::max(std::abs(here.kappa_s), std::abs(measured.kappa_s));
    if (!(scale2 > 0.0) || !std::isfinite(scale2)) {
      return best;
    }
    const double scale = std::sqrt(scale2);
    const double angle = wrap_angle(measured.tangent_angle - here.tangent_angle);
    const double bend = (measured.kappa - here.kappa) / scale;
    const double change = (measured.kappa_s - here.kappa_s) / scale2;
    const double disagreement = angle * angle + bend * bend + change * change;
    if (!(disagreement < best.disagreement)) {
      return best;
    }
    best = {t, disagreement};
    // Derivatives by arc length: kappa for the angle, kappa_s / scale for the scaled curvature.
    const double bend_rate = here.kappa_s / scale;
    const double step =
        (angle * here.kappa + bend * bend_rate) / (here.kappa * here.kappa + bend_rate * bend_rate);
    const double next = t + step / curve.derivatives(t).first.norm();
    if (!std::isfinite(next) || std::abs(step) * scale <= kRounding) {
      return best;
    }
    t = next;
  }
  return best;
}

}  // namespace palpate
