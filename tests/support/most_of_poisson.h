// How often something may happen that is expected so many times.
#pragma once

#include <cmath>

namespace palpate::test {

/// More than so many of a Poisson law of this mean are one case in a thousand.
inline int most_of_poisson(double mean) {
  double term = std::exp(-mean);
  double beyond = 1.0 - term;
  int most = 0;
  while (beyond > 1e-3) {
    ++most;
    term *= mean / most;
    beyond -= term;
  }
  return most;
}

}  // namespace palpate::test
