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
  /// A patch has at least this many windows where its samples suffice: no two share a sample, so
  /// that their errors are independent.
  std::size_t windows_per_patch = 2;
  /// Where patches are few, as many windows more as make this number: the tree's tests need them.
  std::size_t least_windows = 4;
  /// Fewest samples of a window; shorter patches have fewer windows.
  std::size_t window_samples = 20;
  /// Noise of samples that bring none; 0 = from each patch. [m]
  double sigma_m = 0.0;
  /// Smooth deviation of the part from its curve, one standard deviation. [m]
  double form_deviation_m = 0.0;
  /// Windows of a fixed length by one of the estimators of core/local/estimator.h instead, side by
  /// side; of it the kind, window and shift count. For comparison with the paper, whose own is the
  /// two-round one.
  std::optional<EstimatorOptions> estimator;
};

/// Contacts of a patch, at most: where its windows are more, the most informative ones.
inline constexpr std::size_t kMostContactsOfAPatch = 12;

/// The smaller the more is known of angle, kappa and kappa_s together.
double uncertainty(const LocalizedContact& contact);

/// Windows that each of so many patches is to have where its samples suffice.
std::size_t windows_of_a_patch(std::size_t patches, const ContactOptions& options);

/// Adds the estimate at the centre of each window of a patch (core/local/stream/window_fit.h), in
/// the order of travel, taken back from tip centres to the surface (`side` +1: the tip lies left of
/// travel, -1: right, 0: the samples are on the surface). A window is as long as the data allow,
/// and at most the patch's length over `least_windows`: a long patch has as many windows as its
/// bends ask for. t is 0.
void add_contacts(const StoredPatch& patch, std::size_t least_windows, int side,
                  const ContactOptions& options, std::vector<LocalizedContact>* contacts);

/// Sets t of each contact to that of its foot point on the curve.
void localise_contacts(const ShapeParameters& shape, const Pose2& world_T_curve,
                       std::vector<LocalizedContact>* contacts);

}  // namespace palpate
