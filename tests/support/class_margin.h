// Whether the data of a scene determine its class: a margin of the truth, not of an answer.
#pragma once

#include <span>

#include "tests/support/geometric_fit.h"
#include "tests/support/scene_prior.h"

namespace palpate::test {

/// Odds that "determined" stands for: the class asked for with probability 0.95 against one rival.
inline constexpr double kDeterminedOdds = 19.0;
/// How many standard deviations of the noise a margin allows for (99 % one-sided).
inline constexpr double kNoiseDeviations = 2.33;
/// Factor by which prior mass favours a class of one parameter less where that parameter is well
/// determined: the ratio of its prior's width to its standard deviation. Where the truth is a limit
/// of a richer class it is kDeterminedOdds with 1.8 standard deviations of that parameter to spare.
inline constexpr double kOccamFactor = 100.0;
/// A curve of no class is long enough to tell where the best class leaves more than this chi-square
/// without noise (the bound of recognition_scenes_test).
inline constexpr double kToldFromEveryClass = 60.0;

/// Chi-square that a rival must leave on the points without noise. The difference d of two
/// chi-squares has the standard deviation 2 sqrt(d) by the noise, so that the evidence
/// d / 2 - extra log(kOccamFactor) exceeds log(kDeterminedOdds) with kNoiseDeviations to spare
/// where sqrt(d) >= sqrt(2 log(kDeterminedOdds) + 2 extra log(kOccamFactor)) + kNoiseDeviations.
/// `extra`: parameters that the true class has more than the rival.
double needed_chi2(int extra);

/// The evidence gained against a richer class that has the truth as a limit: the root of
/// det(I + S F), F the information of the scene on the departures of the richer class from the
/// truth (what shape and pose of the true class cannot take up), S their prior variance. Departures
/// and their prior widths, in the half extent h of the touched points: a line's curvature 1/h; a
/// circle's two elliptic ones 1/2 each; a parabola's m = e^2 - 1 of the conics 1; its cubic term,
/// and the quadratic one of a cubical parabola across it, h over the touched range; the c of a
/// spline beside a semi-cubical parabola 1.5 sqrt(h), where chi-square grows with c^4. The smallest
/// over the departures; infinite where no class has the truth as a limit.
double occam_against_richer(const PriorScene& prior_scene);

/// Least chi-square of the class on the points without noise, each counted with the scene's noise,
/// from each of the starts.
double least_chi2(const PriorScene& prior_scene, std::span<const PlacedShape> starts);

/// Whether the class of the rival has the true one as a limit: it fits the points without noise
/// whatever they are.
bool has_as_limit(CurveClass rival, CurveClass truth);

}  // namespace palpate::test
