// Joint fit of poses, direction-dependent offset and lag to all samples on an artefact.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "core/qualification/artefact.h"

namespace palpate {

/// All quantities that are fitted.
struct OffsetUnknowns {
  std::vector<Pose2> poses;  ///< of the artefact, one per recording
  NormalOffset offset;
  /// Difference between a recording's constant and that of `offset`: every recording may be a
  /// set-up of its own. Empty = all recordings have the same constant. The fits below do not change
  /// it.
  std::vector<double> setup_m;
  std::optional<double> lag_m;  ///< nullopt = not estimated, 0
};

/// The set-up constant of the sample's recording; 0 if there are none. [m]
double setup_of(const OffsetUnknowns& unknowns, const ArtefactSample& sample);

/// Residuals of all samples at the unknowns, and their derivatives; columns as in OffsetModel.
struct OffsetResiduals {
  Eigen::VectorXd residual_m;  ///< distance minus offset
  /// Constant of each recording but the first, if recordings have their own; x, y (and the angle
  /// unless the artefact is a circle) of each recording; the lag. Each column is minus the
  /// derivative of the residual.
  Eigen::MatrixXd flat;
  Eigen::MatrixXd basis;  ///< offset_basis up to `order`
  std::vector<double> normal_angle;
};
OffsetResiduals residuals_about(const Curve& artefact, MaterialSign material,
                                std::span<const ArtefactSample> samples,
                                const OffsetUnknowns& unknowns, int order);

/// A normal prior about 0 for the harmonics, for what the samples leave open.
struct HarmonicPrior {
  double deviation_m = 0.0;
};

/// Fit with Cauchy's loss of width 2 `scale_m`, under which spikes have little influence. Returns
/// whether it converged.
bool fit_robustly(const Curve& artefact, MaterialSign material,
                  std::span<const ArtefactSample> samples, double scale_m,
                  const HarmonicPrior& prior, OffsetUnknowns& unknowns);

/// The noise that the evidence has chosen.
struct KnownNoise {
  double sigma_m = 0.0;
  Coherence coherence;
  std::span<const StrokePlaces> strokes;
  std::span<const double> arc_m;
  std::span<const char> used;
};

/// The most probable unknowns under that noise. Fills the covariance of the offset. Returns the
/// variance of the lag (0 if it is not estimated); nullopt if the fit did not converge or the
/// samples leave an unknown undetermined.
std::optional<double> fit_under_noise(const Curve& artefact, MaterialSign material,
                                      std::span<const ArtefactSample> samples,
                                      const KnownNoise& noise, const HarmonicPrior& prior,
                                      OffsetUnknowns& unknowns);

}  // namespace palpate
