// Which samples of a patch belong to one cubic, and where the segments join, without a model of the
// part.
#pragma once

#include <cstddef>
#include <vector>

#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// A place where the patch changes from one cubic to another.
struct SegmentJoint {
  std::size_t index = 0;  ///< the first sample beyond the joint
  /// 95 % interval of the joint, by the likelihood ratio. The data do not show on which side the
  /// samples in [earliest, latest) lie.
  std::size_t earliest = 0;
  std::size_t latest = 0;
  Vec2 position_m = Vec2::Zero();
};

struct SegmentBelonging {
  /// The longest run of samples between two joints: [begin, end).
  std::size_t begin = 0;
  std::size_t end = 0;
  std::vector<SegmentJoint> joints;  ///< in increasing order
  /// Samples that do not belong to the cubic of that run: those outside the run, and spikes.
  std::vector<std::size_t> outside;
  /// of the run's cubic, over the samples that certainly lie between the joints
  double chi2 = 0.0;
  int dof = 0;           ///< 0 if there are too few of them for a cubic
  double sigma_m = 0.0;  ///< root mean square of the noise used [m]
};

/// Searches for joints in a patch, then again on both sides of each joint found. The test compares
/// one cubic with two cubics that join at a knot, for a number of knots: a likelihood ratio with 2
/// degrees of freedom, at a significance of 1 % divided by that number. So a patch of one cubic is
/// split with a probability of at most 1 % (core/README.md, "Joints without a model").
/// `sigma_m`: noise of samples that state none; 0 = estimate it from the data. A patch of more than
/// 1,000 samples is tested on 1,000 of them, evenly spread; this bounds the time.
SegmentBelonging longest_segment(const StoredPatch& patch, double sigma_m = 0.0);

}  // namespace palpate
