// What a qualified probe does to the positions that it reports: what a probe file holds.
#pragma once

#include <optional>

#include "core/qualification/normal_offset.h"

namespace palpate {

struct Estimate {
  double value = 0.0;
  double deviation = 0.0;  ///< standard
};

struct ProbeCharacter {
  double tip_radius_m = 0.0;  ///< nominal; effective: with the offset's constant added [m]
  NormalOffset offset;        ///< out of the material, beyond the nominal tip radius
  /// By how much the offset's constant is another in another set-up of probe and part: root mean
  /// square, beside `offset`'s covariance. The same for all that is touched in one set-up. [m]
  Estimate setup_m;
  Estimate sigma_m;  ///< white noise along the normal [m]
  /// Deviation that is alike at neighbouring places of a stroke: correlated as
  /// exp(-distance / length). [m]
  Estimate deviation_m;
  Estimate deviation_length_m;
  Estimate spike_probability;  ///< of a sample: it lies farther off than all this explains
  /// The offset belongs to a place this far ahead, along travel, of where the sample says; nullopt
  /// = not told: strokes went one way only, or no harmonic shows it. [m]
  std::optional<Estimate> lag_m;
};

/// Covariance of the offset's coefficients where a part is touched: in a set-up of its own. [m^2]
inline Eigen::MatrixXd covariance_elsewhere(const ProbeCharacter& probe) {
  Eigen::MatrixXd covariance = probe.offset.covariance_m2;
  covariance(0, 0) += probe.setup_m.value * probe.setup_m.value;
  return covariance;
}

}  // namespace palpate
