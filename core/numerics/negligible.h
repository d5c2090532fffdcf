// One level for what changes no answer and for what is no chance, wherever the method has to say.
#pragma once

#include <cmath>

namespace palpate {

/// A probability that no answer depends on: of a day's 864,000 answers, ten a second, it touches
/// less than one.
inline constexpr double kNegligibleProbability = 1e-6;

/// -log of it: log odds, and log evidences, that far apart are decided.
inline constexpr double kNegligibleLogOdds = 13.815510557964274;

/// Below its highest, in logarithms, where a density may be left out of an integral: a thousandth,
/// beyond which a normal law has 2e-4 of its mass.
inline constexpr double kTailOfDensity = 7.0;

/// Standard deviations of a normal law that leave less: 5.7e-7 on both sides together.
inline constexpr double kNegligibleDeviations = 5.0;

/// The most chi-square that noise of the size that is taken for it leaves: so many of its standard
/// deviations above its mean. (Of few degrees of freedom the law has a longer
/// tail: with 5 of them one in a thousand is beyond, with 100 one in 10^5.)
inline double most_of_noise(double dof) {
  return dof + kNegligibleDeviations * std::sqrt(2.0 * dof);
}

/// Whether noise can have left this chi-square.
inline bool can_be_noise(double chi2, double dof) { return chi2 <= most_of_noise(dof); }

}  // namespace palpate
