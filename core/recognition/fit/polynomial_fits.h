// What a search for the polynomial classes has found.
#pragma once

#include <limits>
#include <optional>

#include "core/curves/algebraic/canonical_conic.h"
#include "core/recognition/fit/orthogonal/polynomial_fit.h"
#include "core/recognition/fit/starts/polynomial_seeds.h"

namespace palpate {

struct PolynomialFits {
  std::optional<PolynomialFit> parabola;
  std::optional<PolynomialFit> cubical_parabola;
  std::optional<PolynomialFit> semi_cubical_parabola;
  std::optional<PolynomialFit> cubic_spline;
  /// The spline's optimum on the other side of c = 0, if there is one; of single touches, the
  /// second best of all.
  std::optional<PolynomialFit> rival;
  /// For a few of the points: the nearest conic, the only start.
  std::optional<ConicCoefficients> conic;
  PolynomialSeeds seeds;    ///< starts of the search
  bool every_seed = false;  ///< every seed was refined, because nothing fitted
  /// Lowest chi-square of all classes, conics included, on the points of these fits: fits far above
  /// it are not followed.
  double lowest_chi2 = std::numeric_limits<double>::infinity();
};

}  // namespace palpate
