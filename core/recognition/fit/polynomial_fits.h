// What a search for the polynomial classes has found.
#pragma once

#include <limits>
#include <optional>

#include "core/curves/algebraic/canonical_conic.h"
#include "core/numerics/probability/negligible.h"
#include "core/recognition/fit/orthogonal/polynomial_fit.h"
#include "core/recognition/fit/starts/polynomial_seeds.h"

namespace palpate {

/// How far above a spline's chi-square its rival's may be: odds of a million, and as much again
/// that the prior may leave.
inline constexpr double kHopelessRival = 2.0 * kNegligibleLogOdds;

struct PolynomialFits {
  std::optional<PolynomialFit> parabola;
  std::optional<PolynomialFit> cubical_parabola;
  std::optional<PolynomialFit> semi_cubical_parabola;
  std::optional<PolynomialFit> cubic_spline;
  /// The spline's second best optimum, on the other side of c = 0 or in another valley, if one was
  /// found.
  std::optional<PolynomialFit> rival;
  /// A semi-cubical parabola that opens the other way and fits about as well: an arc of one arm is
  /// often nearly one of another.
  std::optional<PolynomialFit> other_cusp;
  /// For a few of the points: the nearest conic, the only start.
  std::optional<ConicCoefficients> conic;
  PolynomialSeeds seeds;    ///< starts of the search
  bool every_seed = false;  ///< every seed was refined, because nothing fitted
  /// Lowest chi-square of all classes, conics included, on the points of these fits: fits far above
  /// it are not followed.
  double lowest_chi2 = std::numeric_limits<double>::infinity();
};

}  // namespace palpate
