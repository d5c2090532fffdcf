// A deviation that is smooth along a run: Matern's law of order 3/2, with a slope of its own.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "core/recognition/coherent/markov_drift.h"

namespace palpate {

/// Kalman's recursion, which makes rows white that contain such a deviation. Its state is the
/// deviation and its slope; correlation (1 + a) exp(-a) at the distance a length / sqrt(3). The
/// path of a part has a direction everywhere; that of a probe (markov_drift.h) need not.
template <int Columns>
class SmoothDriftFilter {
 public:
  using Row = Eigen::Matrix<double, 1, Columns>;

  explicit SmoothDriftFilter(const Drift& drift)
      : rate_(std::sqrt(3.0) / drift.length),
        place_(drift.deviation * drift.deviation),
        slope_(rate_ * rate_ * place_) {}

  struct White {
    Row row;                ///< what the rows before do not predict, in units of its deviation
    double variance = 1.0;  ///< of that before it was divided
  };

  White next(const DriftStep& step, const Row& row) {
    move_by(step.from_last);
    const double variance = place_place_ + step.variance;
    const Row surprise = row - mean_place_;
    const double of_place = place_place_ / variance;
    const double of_slope = place_slope_ / variance;
    mean_place_ += of_place * surprise;
    mean_slope_ += of_slope * surprise;
    slope_slope_ -= of_slope * place_slope_;
    place_slope_ -= of_place * place_slope_;
    place_place_ -= of_place * place_place_;
    return {surprise / std::sqrt(variance), variance};
  }

 private:
  /// Predicts the state at the next point; at the beginning of a run it is that of the law.
  void move_by(double distance) {
    const double a = rate_ * distance;
    const double kept = std::exp(-a);
    if (!(kept > 0.0)) {
      mean_place_.setZero();
      mean_slope_.setZero();
      place_place_ = place_;
      place_slope_ = 0.0;
      slope_slope_ = slope_;
      return;
    }
    const double pp = kept * (1.0 + a);  // the transition
    const double ps = kept * distance;
    const double sp = -kept * rate_ * a;
    const double ss = kept * (1.0 - a);
    const Row place = pp * mean_place_ + ps * mean_slope_;
    mean_slope_ = sp * mean_place_ + ss * mean_slope_;
    mean_place_ = place;
    const double less_pp = place_place_ - place_;  // what is known beyond the law
    const double less_ss = slope_slope_ - slope_;
    place_place_ = place_ + pp * pp * less_pp + 2.0 * pp * ps * place_slope_ + ps * ps * less_ss;
    slope_slope_ = slope_ + sp * sp * less_pp + 2.0 * sp * ss * place_slope_ + ss * ss * less_ss;
    place_slope_ = pp * sp * less_pp + (pp * ss + ps * sp) * place_slope_ + ps * ss * less_ss;
  }

  double rate_;
  double place_;  ///< variances by the law
  double slope_;
  double place_place_ = 0.0;
  double place_slope_ = 0.0;
  double slope_slope_ = 0.0;
  Row mean_place_ = Row::Zero();
  Row mean_slope_ = Row::Zero();
};

}  // namespace palpate
