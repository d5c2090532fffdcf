// What a contact message may have at most, and at least.
#pragma once

#include <cstddef>

namespace palpate {

/// Smallest valid sigma, except 0 ("not known"): no real noise is smaller, and its square would
/// underflow. [m]
inline constexpr double kMinSigma = 1e-15;

/// Smallest valid standard deviation of a normal's direction: ten times the rounding of a unit
/// vector. [rad]
inline constexpr double kMinNormalSigma = 1e-15;

struct IngestLimits {
  /// Of the second frame. A sample takes at most 40 bytes, 27 more with a normal and 27 more with a
  /// covariance: with both, 650 fit and not max_samples_per_batch.
  std::size_t max_message_bytes = 65536;
  std::size_t max_samples_per_batch = 1024;
  /// Largest |x| and |y|. A double beyond 1e7 m does not resolve a nanometre. [m]
  double max_coordinate_m = 1e7;
  double max_sigma_m = 1e3;       ///< [m]
  double max_tip_radius_m = 1e3;  ///< [m]
};

}  // namespace palpate
