// What a contact message may have at most.
#pragma once

#include <cstddef>

namespace palpate {

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
