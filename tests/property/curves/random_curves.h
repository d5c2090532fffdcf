// Random curves of every class with a size of about 1 m, and the same curve at another size.
#pragma once

#include <random>

#include "core/curves/curve.h"
#include "tests/support/test_rng.h"

namespace palpate {

using test::random_sign;
using test::uniform;

struct RandomCurve {
  Curve curve;
  Eigen::Vector3d values;
  double t_least, t_most;

  double random_t(std::mt19937_64& rng) const { return uniform(rng, t_least, t_most); }
};

RandomCurve random_curve(CurveClass curve_class, std::mt19937_64& rng);

/// The same shape `factor` times as large; the parameter of the place that was at t.
Curve scaled(const RandomCurve& random, double factor);
double scaled_parameter(CurveClass curve_class, double t, double factor);

}  // namespace palpate
