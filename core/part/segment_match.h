// Where patches lie on a known closed part: the part's pose, and each sample's segment.
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
  /// Noise of samples that bring no sigma of their own; 0 = from the data. [m]
  double sigma_m = 0.0;
  /// Probability that samples of the part itself are answered NO_MATCH.
  double significance = 1e-3;
  /// DETERMINED needs one placement with posterior >= this.
  double determined_probability = 0.95;
  /// DETERMINED needs the place along the part known to this fraction of the segment's length, one
  /// standard deviation: noise, which spans five of them either way, then stays within a segment's
  /// length.
  double determined_slide = 0.1;
  /// DETERMINED needs the covariance to mean something: two standard deviations along the part, in
  /// the pose's own coordinates, chi-square rises by the 4 that it says, to within this fraction.
  double determined_nonlinearity = 0.5;
  /// Probability that a scene without spikes loses a sample to spike detection.
  double false_outlier_probability = 0.01;
  /// Placements below this posterior are left out.
  double least_probability = 1e-6;
};

enum class SegmentMatchStatus {
  TooFewSamples,  ///< nothing to test with
  NoMatch,        ///< nowhere on the part do the samples fit
  Ambiguous,      ///< the part fits, but the data do not tell where
  Determined,     ///< one placement stands out and is known well
};

/// Why a match is AMBIGUOUS; the first that applies.
enum class SegmentMatchDoubt {
  None,
  SeveralPlacements,  ///< none is probable enough
  SlidesAlong,  ///< the part may slide so far under the samples that its covariance means little
};

/// "too_few_samples", "several_placements", ...; static storage.
std::string_view name_of(SegmentMatchStatus status);
std::string_view name_of(SegmentMatchDoubt doubt);

struct SamplePlace {
  std::size_t segment = 0;
  double u = 0.0;           ///< along the segment, [0, 1)
  double residual = 0.0;    ///< (distance less tip radius) / sigma, positive left of increasing t
  bool is_outlier = false;  ///< set aside as a spike: no part of the fit
};

struct PatchOnPart {
  std::size_t segment = 0;           ///< that most of its samples lie on
  bool along_increasing_t = true;    ///< its direction of travel
  std::vector<SamplePlace> samples;  ///< as given
  /// Samples on other segments than that: the patch's curve leaves the segment's cubic there.
  std::vector<std::size_t> beyond;
};

struct PartPlacement {
  Pose2 world_T_part;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (x, y, theta); the bound
  double probability = 0.0;  ///< posterior among all placements, prior uniform over poses
  double chi2 = 0.0;         ///< sum of squared normalised residuals
  int dof = 0;
  /// What the samples' smooth model explains and the part does not, and its degrees of freedom:
  /// where a part is wrong, this shows long before chi2 does.
  double misfit_chi2 = 0.0;
  int misfit_dof = 0;
  /// Standard deviation of the place along the part, in the middle of the longest patch. [m]
  double slide_sd_m = 0.0;
  /// What chi-square rises by at two of these deviations, beside the covariance's prediction: |rise
  /// / 4
  /// - 1|, the worse direction.
  double nonlinearity = 0.0;
  std::vector<PatchOnPart> patches;
};

struct SegmentMatch {
  SegmentMatchStatus status = SegmentMatchStatus::TooFewSamples;
  SegmentMatchDoubt doubt = SegmentMatchDoubt::None;
  /// Most probable first; without a match, how the best ones fit.
  std::vector<PartPlacement> placements;
  /// Probability, given that it is this part, that the middle of the longest patch is on each
  /// segment; zeros where there is no placement.
  std::vector<double> segment_probability;
  std::size_t longest_patch = 0;
  double sigma_m = 0.0;  ///< noise used, root mean square [m]
};

/// Patches of one part in one world frame, in any order and direction; a known material side rules
/// out the contrary travel. Fits the pose with foot points on the whole closed curve, so that a
/// patch over a joint is used in full (core/README.md, "A known closed part").
SegmentMatch match_segment(const ClosedSpline& part, std::span<const StoredPatch> patches,
                           const SegmentMatchOptions& options = {});

}  // namespace palpate
