// Whether the data of a scene determine its class. The margin is computed from the truth, not from
// an answer.
#pragma once

#include <span>

#include "tests/support/geometric_fit.h"
#include "tests/support/scene_prior.h"

namespace palpate::test {

/// "Determined" means these odds: probability 0.95 against one rival.
inline constexpr double kDeterminedOdds = 19.0;
/// Number of standard deviations of the noise that a margin allows for (99 %, one-sided).
inline constexpr double kNoiseDeviations = 2.33;
/// The factor by which the prior favours a class with one parameter less if that parameter is well
/// determined: the width of the parameter's prior over its standard deviation. If the truth is a
/// limit of a richer class, it equals kDeterminedOdds with 1.8 standard deviations of that
/// parameter to spare.
inline constexpr double kOccamFactor = 100.0;
/// A curve of no class counts as long enough if the best class leaves more than this chi-square
/// without noise (the limit used in recognition_scenes_test).
inline constexpr double kToldFromEveryClass = 60.0;

/// Chi-square that a rival must leave on the points without noise. By the noise, the difference d
/// of two chi-squares has the standard deviation 2 sqrt(d). The evidence d / 2 - extra
/// log(kOccamFactor) therefore exceeds log(kDeterminedOdds) with kNoiseDeviations to spare if
/// sqrt(d) >= sqrt(2 log(kDeterminedOdds) + 2 extra log(kOccamFactor)) + kNoiseDeviations. `extra`:
/// number of parameters that the true class has more than the rival.
double needed_chi2(int extra);

/// The evidence gained against a richer class that has the truth as a limit: the square root of
/// det(I + S F). F is the information of the scene on the departures of the richer class from the
/// truth (without what shape and pose of the true class can absorb); S is their prior variance.
/// Departures and their prior widths, in units of the half extent h of the touched points: a line's
/// curvature 1/h; a circle's two elliptic ones 1/2 each; a parabola's m = e^2 - 1 of the conics 1;
/// its cubic term, and the quadratic one of a cubical parabola across it, h over the touched range;
/// the c of a spline that tends to a semi-cubical parabola 1.5 sqrt(h), where chi-square grows with
/// c^4. Returns the smallest value over the departures; infinite if no class has the truth as a
/// limit.
double occam_against_richer(const PriorScene& prior_scene);

/// Least chi-square of the class on the points without noise, in units of the scene's noise, over
/// fits from each of the starts.
double least_chi2(const PriorScene& prior_scene, std::span<const PlacedShape> starts);

/// True if the rival's class has the true class as a limit: it then fits the points without noise
/// in any case.
bool has_as_limit(CurveClass rival, CurveClass truth);

}  // namespace palpate::test
