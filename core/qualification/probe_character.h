// What a qualified probe does to the positions that it reports: the contents of a probe file.
#pragma once

#include <optional>

#include "core/qualification/normal_offset.h"

namespace palpate {

struct Estimate {
  double value = 0.0;
  double deviation = 0.0;  ///< standard deviation
};

struct ProbeCharacter {
  /// Nominal; the effective radius is this plus the constant of `offset` [m]
  double tip_radius_m = 0.0;
  NormalOffset offset;  ///< distance out of the material beyond the nominal tip radius
  /// Root mean square difference between the offset's constant in another set-up of probe and part
  /// and that of `offset`, in addition to the covariance of `offset`. One constant holds for
  /// everything touched in one set-up. [m]
  Estimate setup_m;
  Estimate sigma_m;  ///< white noise along the normal [m]
  /// Deviation that neighbouring places of a stroke share. Its correlation is exp(-distance /
  /// length). [m]
  Estimate deviation_m;
  Estimate deviation_length_m;
  Estimate spike_probability;  ///< that a sample lies farther off than all of this explains
  /// The offset of a sample belongs to the place this far ahead of the sample, along travel.
  /// nullopt = unknown, because strokes went one way only or no harmonic shows it. [m]
  std::optional<Estimate> lag_m;
};

/// E[x^2] of the estimated quantity.
inline double mean_square(const Estimate& estimate) {
  return estimate.value * estimate.value + estimate.deviation * estimate.deviation;
}

/// Covariance of the offset's coefficients for a part that is touched in another set-up. [m^2]
inline Eigen::MatrixXd covariance_elsewhere(const ProbeCharacter& probe) {
  Eigen::MatrixXd covariance = probe.offset.covariance_m2;
  covariance(0, 0) += probe.setup_m.value * probe.setup_m.value;
  return covariance;
}

}  // namespace palpate
