// Locates patches on a known closed part: the part's pose, and the segment of each sample.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "core/part/closed_spline.h"
#include "core/recognition/samples/sample_memory.h"

namespace palpate {

struct SegmentMatchOptions {
  /// Noise of samples that state none; 0 = estimate it from the data. [m]
  double sigma_m = 0.0;
  /// Probability that samples of this very part get the answer NO_MATCH.
  double significance = 1e-3;
  /// DETERMINED needs one placement with at least this posterior probability.
  double determined_probability = 0.95;
  /// DETERMINED needs the standard deviation of the place along the part to be at most this
  /// fraction of the segment's length. At 0.1, five standard deviations to either side stay within
  /// one length of the segment.
  double determined_slide = 0.1;
  /// DETERMINED needs the covariance to describe chi-square: two standard deviations along the
  /// part, in the coordinates of the pose, chi-square must rise by 4 to within this fraction.
  double determined_nonlinearity = 0.5;
  /// Probability that spike detection removes a sample from a scene without spikes.
  double false_outlier_probability = 0.01;
  /// Placements with a smaller posterior probability are not reported.
  double least_probability = 1e-6;
};

enum class SegmentMatchStatus {
  TooFewSamples,  ///< too few to test anything, or to know their noise
  NoMatch,        ///< the samples fit nowhere on the part
  Ambiguous,      ///< the part fits, but the data do not show where
  Determined,     ///< one placement is clearly the most probable, and well known
};

/// Why a match is AMBIGUOUS. If several reasons apply, the first of them.
enum class SegmentMatchDoubt {
  None,
  SeveralPlacements,  ///< no placement is probable enough
  SlidesAlong,  ///< the part can slide so far under the samples that the covariance means little
};

/// A lower-case name: "too_few_samples", "several_placements", ...; static storage.
std::string_view name_of(SegmentMatchStatus status);
std::string_view name_of(SegmentMatchDoubt doubt);

struct SamplePlace {
  std::size_t segment = 0;
  double u = 0.0;           ///< along the segment, [0, 1)
  double residual = 0.0;    ///< (distance - tip radius) / sigma, positive left of increasing t
  bool is_outlier = false;  ///< removed as a spike; not used by the fit
};

struct PatchOnPart {
  std::size_t segment = 0;           ///< the segment that holds most of its samples
  bool along_increasing_t = true;    ///< direction of travel
  std::vector<SamplePlace> samples;  ///< all samples of the patch, in the given order
  /// Indices of the samples on other segments: there the patch leaves the cubic of `segment`.
  std::vector<std::size_t> beyond;
};

struct PartPlacement {
  Pose2 world_T_part;
  /// Of (x, y, theta): the bound for a known shape
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double probability = 0.0;  ///< posterior among all placements, for a prior uniform over poses
  double chi2 = 0.0;         ///< sum of squared normalised residuals
  int dof = 0;
  /// How much better the samples' smooth model fits than the part does, and the degrees of freedom
  /// of that difference. A wrong part shows here long before it shows in chi2.
  double misfit_chi2 = 0.0;
  int misfit_dof = 0;
  /// Standard deviation of the place along the part, at the middle of the longest patch. [m]
  double slide_sd_m = 0.0;
  /// How far chi-square deviates from the covariance's prediction two standard deviations along the
  /// part: |rise / 4 - 1|, for the worse direction.
  double nonlinearity = 0.0;
  std::vector<PatchOnPart> patches;
};

struct SegmentMatch {
  SegmentMatchStatus status = SegmentMatchStatus::TooFewSamples;
  SegmentMatchDoubt doubt = SegmentMatchDoubt::None;
  /// Most probable first. Without a match: the placements that fit best.
  std::vector<PartPlacement> placements;
  /// Probability that the middle of the longest patch lies on each segment, given that it is this
  /// part; all 0 if there is no placement.
  std::vector<double> segment_probability;
  std::size_t longest_patch = 0;  ///< of single touches alone: the first
  double sigma_m = 0.0;           ///< root mean square of the noise used; 0 if it is not known [m]
};

/// Finds where patches lie on `part`. The patches touch one part and share one world frame; their
/// order and direction are free. A stated material side excludes the opposite direction of travel.
/// Single touches (patches of one sample) may be in any order; their noise must be stated.
/// Foot points are searched on the whole closed curve, so a patch over a joint counts in full
/// (core/README.md, "A known closed part").
SegmentMatch match_segment(const ClosedSpline& part, std::span<const StoredPatch> patches,
                           const SegmentMatchOptions& options = {});

}  // namespace palpate
