// The constant of a probe's offset in another set-up than those that it was qualified in.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/qualification/coherent_whitening.h"
#include "core/qualification/offset_evidence.h"
#include "core/qualification/probe_character.h"

namespace palpate {

/// The offset's constant of each recording, everything else alike: what their samples say.
struct SetupConstants {
  Eigen::VectorXd value_m;
  Eigen::MatrixXd covariance_m2;
};

/// Of a model about its optimum, whose first columns of `flat` are the constants of each recording
/// but the first; `coefficients_m` is the offset there, `setup_m` what each recording's constant
/// differs by from the offset's. Harmonics are normal about 0 with `harmonic_m`.
SetupConstants constants_of(const OffsetModel& model, const Coherence& coherence, double sigma_m,
                            const Eigen::VectorXd& coefficients_m,
                            const std::vector<double>& setup_m, double harmonic_m);

struct SetupSpread {
  double constant_m = 0.0;  ///< mean over set-ups [m]
  /// By how much the constant of another set-up differs from that, standard deviation, beside what
  /// the samples' noise leaves open of it. [m]
  Estimate elsewhere_m;
};

/// `expected_m`: what the constant is expected to differ by before recordings are compared.
SetupSpread spread_of(const SetupConstants& constants, double expected_m);

}  // namespace palpate
