// Both hyperbolic functions of one argument, by one exponential.
#pragma once

#include <cmath>

namespace palpate {

struct SinhCosh {
  double sinh = 0.0;
  double cosh = 1.0;
};

/// Right to two units in the last place, also about 0; infinite from 709.8 on, where their doubles
/// would overflow.
inline SinhCosh sinh_cosh(double t) {
  const double less_one = std::expm1(std::abs(t));
  const double grown = less_one + 1.0;
  // e^t - e^-t = (e^t - 1) (1 + e^-t), in which nothing cancels.
  const double shrunk = 1.0 / grown;
  return {std::copysign(0.5 * less_one * (1.0 + shrunk), t), 0.5 * (grown + shrunk)};
}

}  // namespace palpate
