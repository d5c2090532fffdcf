// The chi-square distribution to full precision. All thresholds of tests come from here.
#pragma once

namespace palpate {

/// Probability that a chi-square variable with `dof` degrees of freedom exceeds `chi2`; 1 for dof
/// <= 0 or chi2 <= 0, NaN for NaN. Absolute error below 1e-14.
double chi_square_survival(double chi2, int dof);

/// The value that is exceeded with probability `significance` in (0, 1); 0 for dof <= 0. Relative
/// error below 1e-12.
double chi_square_threshold(double significance, int dof);

}  // namespace palpate
