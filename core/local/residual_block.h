// A short block of samples against a quartic through its neighbourhood: what noise and spikes are
// seen by, whatever the class of the curve.
#pragma once

#include <span>
#include <vector>

#include "core/local/aligned_frame.h"
#include "core/local/legendre_fit.h"

namespace palpate {

class ResidualBlock {
 public:
  static constexpr int kDegree = 4;

  /// Fits those samples whose `use` is set (empty: all). Ok, or why not.
  LocalStatus fit(std::span<const Vec2> samples, const std::vector<bool>& use = {});

  /// Residual along the normal over the factor of its standard deviation, so that white noise
  /// gives every one the variance sigma^2: r / sqrt(1 - h) for a sample that the fit used (which
  /// equals its deletion residual, normalised), r / sqrt(1 + h) for one that it did not. [m]
  double studentised(std::size_t i) const { return studentised_m_[i]; }
  std::size_t size() const { return studentised_m_.size(); }

  /// Largest |slope| of the fit against the block's axis at a sample in use.
  double steepest() const { return steepest_; }
  /// steepest() <= kMaxSlope: within 45 degrees. A sharper corner looks like a spike.
  static constexpr double kMaxSlope = 1.0;

  /// World length of the block's extent. [m]
  double extent_m() const { return 2.0 * frame_.half_extent_m; }

  /// extent > kMinExtentSigmas * sigma: a shorter block is scattered along its axis by the noise
  /// as much as spread by the travel, and its residuals do not have the noise's variance.
  static constexpr double kMinExtentSigmas = 20.0;

 private:
  AlignedFrame frame_;
  double steepest_ = 0.0;
  std::vector<Vec2> used_;
  std::vector<double> studentised_m_;
};

}  // namespace palpate
