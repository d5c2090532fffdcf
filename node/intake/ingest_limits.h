// What a contact message may have at most.
#pragma once

#include <cstddef>

namespace palpate {

struct IngestLimits {
  /// Of the second frame. Holds max_samples_per_batch samples with all their fields, of at most
  /// 94 bytes each, and 2 kB for the rest.
  std::size_t max_message_bytes = 98304;
  std::size_t max_samples_per_batch = 1024;
  /// Largest |x| and |y|. A double beyond 1e7 m does not resolve a nanometre. [m]
  double max_coordinate_m = 1e7;
  double max_sigma_m = 1e3;       ///< [m]
  double max_tip_radius_m = 1e3;  ///< [m]
};

}  // namespace palpate
