// A short block of samples against a quartic through its neighbourhood: what noise and spikes are
// seen by, whatever the class of the curve.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/curves/pose2.h"
#include "core/local/local_status.h"

namespace palpate {

/// The polynomials orthogonal over the abscissae in use, one after another by their three-term
/// recurrence (G. E. Forsythe, "Generation and use of orthogonal polynomials for data-fitting with
/// a digital computer", 1957): no normal equations, and the leverages come with the fit.
class ResidualBlock {
 public:
  static constexpr int kDegree = 4;
  static constexpr int kUnknowns = kDegree + 1;

  /// Fits those samples whose `use` is set (empty: all), of which it needs more than kUnknowns,
  /// with a polynomial of `degree` <= kDegree. Ok, or why not. O(samples).
  LocalStatus fit(std::span<const Vec2> samples, std::span<const std::uint8_t> use = {},
                  int degree = kDegree);

  /// Residual along the normal over the factor of its standard deviation, so that white noise
  /// gives every one the variance sigma^2: r / sqrt(1 - h) for a sample that the fit used (which
  /// equals its deletion residual, normalised), r / sqrt(1 + h) for one that it did not, infinite
  /// where that lies too far beyond the fit's ends (h > kMaxExtrapolation). [m]
  double studentised(std::size_t i) const {
    return lanes_[i / kWidth].studentised_m[static_cast<Eigen::Index>(i % kWidth)];
  }

  /// Largest |studentised(i)|. [m]
  double largest() const { return largest_m_; }

  /// Of the noise's variance: beyond it a sample is told to three deviations of noise at best.
  static constexpr double kMaxExtrapolation = 10.0;

  /// Largest distance along the axis that a sample in use lies behind an earlier one. [m]
  double backtrack_m() const { return backtrack_m_; }

  /// Step between the first two and between the last two samples in use, as parts of the extent.
  double first_gap() const { return first_gap_; }
  double last_gap() const { return last_gap_; }

  /// Largest |slope| of the fit against the block's axis at a sample in use.
  double steepest() const { return steepest_; }
  /// steepest() <= kMaxSlope: within 45 degrees. A sharper corner looks like a spike.
  static constexpr double kMaxSlope = 1.0;

  /// World length of the block's extent. [m]
  double extent_m() const { return extent_m_; }

  /// extent > kMinExtentSigmas * sigma: a shorter block is scattered along its axis by the noise
  /// as much as spread by the travel, and its residuals do not have the noise's variance.
  static constexpr double kMinExtentSigmas = 20.0;

 private:
  /// Samples two by two, as processors take them; an odd one is followed by itself, not in use.
  static constexpr std::size_t kWidth = 2;
  using Pair = Eigen::Array<double, kWidth, 1>;
  struct Lane {
    Pair use;              ///< 1 or 0
    Pair u;                ///< along the axis, in use within [-1, 1]
    Pair residual_m;       ///< across the axis
    Pair p, p_before;      ///< polynomials in turn ...
    Pair d, d_before;      ///< ... and their derivatives
    Pair slope, leverage;  ///< sums so far
    Pair studentised_m;
  };

  LocalStatus place(std::span<const Vec2> samples, std::span<const std::uint8_t> use);

  std::size_t size_ = 0;
  double extent_m_ = 0.0;
  double steepest_ = 0.0;
  double largest_m_ = 0.0;
  double backtrack_m_ = 0.0;
  double first_gap_ = 0.0;
  double last_gap_ = 0.0;
  std::vector<Lane> lanes_;
};

}  // namespace palpate
