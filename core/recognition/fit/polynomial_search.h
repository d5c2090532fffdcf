// The polynomial classes on the reduced points: searched for, or followed from earlier ones.
#pragma once

#include <limits>
#include <optional>

#include "core/curves/algebraic/canonical_conic.h"
#include "core/recognition/fit/polynomial_fit.h"
#include "core/recognition/fit/polynomial_seeds.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

struct PolynomialFits {
  std::optional<PolynomialFit> parabola;
  std::optional<PolynomialFit> cubical_parabola;
  std::optional<PolynomialFit> semi_cubical_parabola;
  std::optional<PolynomialFit> cubic_spline;
  /// The spline's optimum on the other side of c = 0, if there is one.
  std::optional<PolynomialFit> rival;
  /// Of few of the points: the conic nearest to them, the one start.
  std::optional<ConicCoefficients> conic;
  PolynomialSeeds seeds;    ///< that the search started from
  bool every_seed = false;  ///< refined, as nothing fitted
  /// Of all classes, conics included, on the points of these fits: what is far above it is not
  /// followed.
  double lowest_chi2 = std::numeric_limits<double>::infinity();
};

/// Exhaustive coarse search, valleys walked, the best of each refined with coarse effort; of the
/// cubics, unless it is `out_of_reach` (as fit_classes).
PolynomialFits search_polynomials(const FitData& reduced, double out_of_reach, WorkBudget& work);

/// The parabola alone, which the conics need at their limit.
PolynomialFits search_parabola(const FitData& reduced, WorkBudget& work);

/// The same from earlier fits, whose t must be those of `reduced` (warm_start.h): no search. Fits
/// that were out by far stay as they are, their chi2 that of the new points. `out_of_reach`: as
/// above, of all of them.
PolynomialFits follow_polynomials(const FitData& reduced, const PolynomialFits& starts,
                                  double out_of_reach, WorkBudget& work);

/// The last resort where nothing fits: refines thoroughly every seed of the models with arms, whose
/// sharp bends make narrow valleys, and the best of the others.
void refine_every_seed(const FitData& reduced, double out_of_reach, PolynomialFits* fits,
                       WorkBudget& work);

}  // namespace palpate
