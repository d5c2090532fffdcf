// Covariance of shape and pose, propagated from the local estimates.
#pragma once

#include <span>

#include "core/recognition/tree/recognition_tree.h"

namespace palpate {

/// Of [shape; x; y; theta] of `answer`, the tree's answer for `points`. The estimates' covariances
/// are propagated through derivatives of the answer, computed by central differences with steps of
/// 0.1 standard deviation. What the pose symmetry leaves free has variance 0 by convention. All
/// variances are infinite if there is no pose, or if a moved estimate leads the tree to another
/// class.
ShapePoseCovariance propagated_covariance(std::span<const TreePoint> points,
                                          const TreeResult& answer,
                                          const RecognitionTreeOptions& options);

}  // namespace palpate
