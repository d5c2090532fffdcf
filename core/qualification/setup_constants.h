// The constant of a probe's offset in another set-up than those of the qualification.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/qualification/coherent_whitening.h"
#include "core/qualification/offset_evidence.h"
#include "core/qualification/probe_character.h"

namespace palpate {

/// The offset's constant of each recording, with all other unknowns in common, as the samples
/// determine it.
struct SetupConstants {
  Eigen::VectorXd value_m;
  Eigen::MatrixXd covariance_m2;
};

/// Solves `model` at its optimum. The first columns of `model.flat` are the constants of each
/// recording but the first. `coefficients_m` is the offset there, `setup_m` the difference of each
/// recording's constant from the offset's. The harmonics have a normal prior about 0 with standard
/// deviation `harmonic_m`.
SetupConstants constants_of(const OffsetModel& model, const Coherence& coherence, double sigma_m,
                            const Eigen::VectorXd& coefficients_m,
                            const std::vector<double>& setup_m, double harmonic_m);

struct SetupSpread {
  double constant_m = 0.0;  ///< mean over set-ups [m]
  /// Standard deviation of the difference between another set-up's constant and that mean, in
  /// addition to what the noise of the samples leaves open. [m]
  Estimate elsewhere_m;
};

/// The spread of the constants over set-ups. `expected_m`: how much the constant is expected to
/// differ, before any recordings are compared.
SetupSpread spread_of(const SetupConstants& constants, double expected_m);

}  // namespace palpate
