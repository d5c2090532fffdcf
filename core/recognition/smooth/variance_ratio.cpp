#include "core/recognition/smooth/variance_ratio.h"

#include <cmath>

#include "core/numerics/probability/negligible.h"

namespace palpate {

// Of n and m degrees of freedom, the ratio is r or more, if r > 1, with probability exp(-x) at
// most,
//   2 x = (n + m) log((n r + m) / (n + m)) - n log(r),
// by H. Chernoff's bound (1952) for chi2_n - r (n / m) chi2_m > 0; and likewise r or less, if r
// < 1. 2 x is the statistic by which M. S. Bartlett (1937) compares variances. Unlike a normal law
// of their logarithms it holds for few degrees of freedom, which leave very little by chance far
// more often than very much.
bool is_ratio_beyond_chance(double ratio, double dof, double other_dof) {
  const double all = dof + other_dof;
  return all * std::log((dof * ratio + other_dof) / all) - dof * std::log(ratio) >
         2.0 * kNegligibleLogOdds;
}

}  // namespace palpate
