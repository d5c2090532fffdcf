// Local estimates along the patches, and their places on the recognised curve.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/curves/pose2.h"
#include "core/curves/shape_parameters.h"
#include "core/local/estimator.h"
#include "core/recognition/localized_contact.h"
#include "core/recognition/samples/sample_memory.h"

namespace palpate {

struct ContactOptions {
  /// Fewest windows of a patch that has enough samples for them. Windows share no samples, so that
  /// their errors are independent.
  std::size_t windows_per_patch = 2;
  /// Fewest windows of all patches together: where patches are few, each has more windows. The
  /// tests of the recognition tree need this many.
  std::size_t least_windows = 4;
  /// Fewest samples of a window. Shorter patches have fewer windows.
  std::size_t window_samples = 20;
  /// Noise of samples that state none; 0 = estimate it for each patch. [m]
  double sigma_m = 0.0;
  /// Of so many samples, which err together, each counts as one (SmoothModel::noise_time).
  double noise_time = 1.0;
  /// Standard deviation of the part's smooth form error. [m]
  double form_deviation_m = 0.0;
  /// If set: windows of fixed length, side by side, with this estimator of core/local/estimator.h.
  /// Only its kind, window and shift are used. For comparison with the paper, whose estimator is
  /// the two-round one.
  std::optional<EstimatorOptions> estimator;
};

/// Most contacts of a patch. If it has more windows, the most informative ones are kept.
inline constexpr std::size_t kMostContactsOfAPatch = 12;

/// Determinant of the covariance of (angle, kappa, kappa_s): the smaller, the better they are known
/// together.
double uncertainty(const LocalizedContact& contact);

/// Windows that each of `patches` patches should have, if it has enough samples.
std::size_t windows_of_a_patch(std::size_t patches, const ContactOptions& options);

/// Adds the estimate at the centre of each window of a patch (core/local/stream/window_fit.h), in
/// the order of travel. Tip centres are moved to the surface. `side` +1: the tip lies left of
/// travel, -1: right, 0: the samples are surface points. A window is as long as one fit can follow,
/// at most the patch's length over `least_windows`: a long patch with bends has more windows. t is
/// 0.
void add_contacts(const StoredPatch& patch, std::size_t least_windows, int side,
                  const ContactOptions& options, std::vector<LocalizedContact>* contacts);

/// Sets t of each contact to the curve parameter of its foot point.
void localise_contacts(const ShapeParameters& shape, const Pose2& world_T_curve,
                       std::vector<LocalizedContact>* contacts);

}  // namespace palpate
