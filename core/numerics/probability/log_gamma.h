// log Gamma, safe for threads.
#pragma once

#include <cmath>

namespace palpate {

/// log |Gamma(x)|. Unlike this function, std::lgamma writes the sign to a variable that all threads
/// share.
inline double log_gamma(double x) {
  int sign = 0;
  return ::lgamma_r(x, &sign);
}

}  // namespace palpate
