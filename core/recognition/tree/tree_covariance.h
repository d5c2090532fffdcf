// Covariance of shape and pose by propagation from the local estimates.
#pragma once

#include <span>

#include "core/recognition/tree/recognition_tree.h"

namespace palpate {

/// Of [shape; x; y; theta] of `answer`, the tree's over `points`: the estimates' covariances
/// through the answer's derivatives by each of them, central differences over a tenth of a
/// deviation. What the pose symmetry leaves free has variance 0, by convention; all variances are
/// infinite where there is no pose, and where the tree does not come to the same class beside the
/// estimates.
ShapePoseCovariance propagated_covariance(std::span<const TreePoint> points,
                                          const TreeResult& answer,
                                          const RecognitionTreeOptions& options);

}  // namespace palpate
