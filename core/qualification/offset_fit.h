// Poses, offset by direction and lag, fitted together to all samples on an artefact.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "core/qualification/artefact.h"

namespace palpate {

/// Everything that is fitted.
struct OffsetUnknowns {
  std::vector<Pose2> poses;  ///< of the recordings
  NormalOffset offset;
  /// What a recording's constant differs by from the offset's: a set-up of its own. Empty = all are
  /// alike. The fits below hold it as it is.
  std::vector<double> setup_m;
  std::optional<double> lag_m;  ///< nullopt = not sought, 0
};

/// What a sample lies farther out for its recording's set-up. [m]
double setup_of(const OffsetUnknowns& unknowns, const ArtefactSample& sample);

/// Residuals of all samples about the unknowns, and how they change: columns as in OffsetModel.
struct OffsetResiduals {
  Eigen::VectorXd residual_m;  ///< distance less offset
  Eigen::MatrixXd flat;        ///< constant of each recording but the first, where they have their
                               ///< own; x, y (and angle, where the artefact is no circle) of each
                               ///< recording; the lag; a column's negative derivative
  Eigen::MatrixXd basis;       ///< of `order`
  std::vector<double> normal_angle;
};
OffsetResiduals residuals_about(const Curve& artefact, MaterialSign material,
                                std::span<const ArtefactSample> samples,
                                const OffsetUnknowns& unknowns, int order);

/// What holds the harmonics, where the samples do not: a normal law about 0.
struct HarmonicPrior {
  double deviation_m = 0.0;
};

/// Least absolute-like residuals (Cauchy's loss of width 2 `scale_m`): spikes have little say.
/// Returns whether it converged.
bool fit_robustly(const Curve& artefact, MaterialSign material,
                  std::span<const ArtefactSample> samples, double scale_m,
                  const HarmonicPrior& prior, OffsetUnknowns& unknowns);

/// Noise as it has been weighed.
struct KnownNoise {
  double sigma_m = 0.0;
  Coherence coherence;
  std::span<const StrokePlaces> strokes;
  std::span<const double> arc_m;
  std::span<const char> used;
};

/// Most probable unknowns under that noise. Fills the offset's covariance; returns the lag's
/// variance too (0 where it is not sought), or nullopt where it did not converge or the samples
/// leave something open altogether.
std::optional<double> fit_under_noise(const Curve& artefact, MaterialSign material,
                                      std::span<const ArtefactSample> samples,
                                      const KnownNoise& noise, const HarmonicPrior& prior,
                                      OffsetUnknowns& unknowns);

}  // namespace palpate
