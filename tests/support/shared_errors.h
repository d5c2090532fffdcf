// Errors that neighbouring samples share: a first-order Markov process.
#pragma once

#include <cmath>
#include <random>

#include "core/curves/plane_curve.h"

namespace palpate::test {

/// The errors of neighbours, one after the other. Each coordinate has the variance 1, and
/// neighbours correlate by `correlation`, in [0, 1).
class SharedErrors {
 public:
  explicit SharedErrors(double correlation) : correlation_(correlation) {}

  Vec2 next(std::normal_distribution<double>& normal, std::mt19937_64& rng) {
    const double x = normal(rng);
    const Vec2 own(x, normal(rng));
    const double rest = is_first_ ? 1.0 : std::sqrt(1.0 - correlation_ * correlation_);
    last_ = correlation_ * last_ + rest * own;
    is_first_ = false;
    return last_;
  }

 private:
  double correlation_;
  bool is_first_ = true;
  Vec2 last_ = Vec2::Zero();
};

}  // namespace palpate::test
