// One common level for probabilities that are negligible, used everywhere in the method.
#pragma once

#include <cmath>

namespace palpate {

/// A probability too small to matter: of the 864,000 answers of a day, at ten per second, it
/// affects less than one.
inline constexpr double kNegligibleProbability = 1e-6;

/// -log of it. A difference of log odds or log evidences of this size is decisive.
inline constexpr double kNegligibleLogOdds = 13.815510557964274;

/// A log evidence that speaks "strongly" against something, by Kass and Raftery's scale (1995).
inline constexpr double kStrongEvidence = 3.0;

/// How far below its maximum, in logarithms, a density may be left out of an integral: a
/// thousandth. A normal distribution has 2e-4 of its mass beyond that.
inline constexpr double kTailOfDensity = 7.0;

/// Number of standard deviations beyond which a normal distribution has a negligible mass: 5.7e-7
/// on both sides together.
inline constexpr double kNegligibleDeviations = 5.0;

/// The largest chi-square that counts as noise: kNegligibleDeviations of its standard deviations
/// above its mean. (For few degrees of freedom the chi-square distribution has a longer tail: with
/// 5 of them one in a thousand exceeds this, with 100 one in 10^5.)
inline double most_of_noise(double dof) {
  return dof + kNegligibleDeviations * std::sqrt(2.0 * dof);
}

/// True if chi2 is at most five standard deviations above its expected value for pure noise.
inline bool can_be_noise(double chi2, double dof) { return chi2 <= most_of_noise(dof); }

}  // namespace palpate
