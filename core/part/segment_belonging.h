// Which samples of a patch one cubic explains, without any part model: where segments join.
#pragma once

#include <cstddef>
#include <vector>

#include "core/recognition/samples/sample_memory.h"

namespace palpate {

/// A place where the patch leaves one cubic for another.
struct SegmentJoint {
  std::size_t index = 0;  ///< the first sample beyond it
  /// Samples between which it lies by the likelihood ratio, 95 %: the data do not say to which side
  /// those in [earliest, latest) belong.
  std::size_t earliest = 0;
  std::size_t latest = 0;
  double chi2_drop = 0.0;  ///< of the second cubic, 2 degrees of freedom
  Vec2 position_m = Vec2::Zero();
};

struct SegmentBelonging {
  bool was_tested = false;  ///< enough samples for a cubic and a joint
  /// The longest run of samples between joints, [begin, end).
  std::size_t begin = 0;
  std::size_t end = 0;
  std::vector<SegmentJoint> joints;  ///< rising
  /// Samples that do not belong to that run's cubic: those outside it, and spikes.
  std::vector<std::size_t> outside;
  double chi2 = 0.0;     ///< of the run's own cubic, on what certainly lies between the joints
  int dof = 0;           ///< 0 where that is too little for a cubic
  double sigma_m = 0.0;  ///< noise used, root mean square [m]
};

/// Tests the patch, then both sides of what it finds, against a cubic that becomes another one at a
/// knot: likelihood ratio of the bend at each of some knots, chi-square with 2 degrees of freedom,
/// at `significance` over their number. So a patch of one cubic is parted with probability at most
/// `significance` (core/README.md, "Joints without a model"). `sigma_m`: noise of samples that
/// bring none; 0 = from the data. Of a patch of more than 1,000 samples, so many that are evenly
/// spread: what is sought in is bounded, whatever has been recorded.
SegmentBelonging longest_segment(const StoredPatch& patch, double sigma_m = 0.0,
                                 double significance = 0.01);

}  // namespace palpate
