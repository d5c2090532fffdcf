// The last digits of a localisation, from all that was measured there.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/curves/plane_curve.h"

namespace palpate {

/// A place and how badly it disagrees with a measurement.
struct RefinedPlace {
  double t = 0.0;
  double disagreement = std::numeric_limits<double>::infinity();  ///< squared, without unit
};

/// Gauss-Newton from t on the tangent angle [rad] and on kappa over sqrt(kappa^2 + |kappa_s|), both
/// for increasing t: the angle alone is blind at an inflection (and coarse next to a cusp), kappa
/// at a vertex, and no point is both. The disagreement counts kappa_s as well, which tells places
/// of like angle apart.
template <typename C>
RefinedPlace refine_place(const C& curve, double t, const LocalGeometry& measured) {
  // Of an exact geometry the digits double; of one that no place has exactly, the error falls by a
  // constant factor, and where twenty steps do not settle it, the disagreement says so.
  constexpr int kMostIterations = 20;
  // Where the digits end: t moves the position by less than this part of the radius of curvature.
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
    // By arc length the angle changes at kappa, the scaled curvature at kappa_s / scale.
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
