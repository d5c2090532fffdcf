// Quantiles of the standard normal distribution.
#pragma once

namespace palpate {

/// The z with P(|standard normal| > z) = probability, for probability in (0, 1).
double two_sided_normal_quantile(double probability);

}  // namespace palpate
