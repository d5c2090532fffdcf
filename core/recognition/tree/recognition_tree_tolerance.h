// The recognition tree with the paper's tests: invariants must agree within a plain fraction.
#pragma once

#include <span>

#include "core/recognition/tree/recognition_tree.h"

namespace palpate {

/// recognise_by_tree with options.relative_tolerance > 0. The spread of an invariant is (max - min)
/// / max |value| over the points or pairs. A test passes if its value is at most the tolerance:
///   line           all kappa and kappa_s exactly zero
///   circle         the larger of the spread of |kappa| and the largest |kappa_s| / scale^2, scale
///                  being the curvature scale of the points
///   conic          the spread of Ic1 over all pairs
///   parabola       if |Ic1| <= tolerance * min(Ip |kappa|^(2/3)): the spread of Ip over the points
///   cubical        the larger spread of Icp1 and Icp2 over the points, in the best pair's frame
///   semi-cubical   the same of Iscp1 and Iscp2
///   spline         the relative change of (a, b, c) if another point replaces the third
/// Uses at most eight points, spread evenly over those given.
TreeResult recognise_by_tolerance(std::span<const TreePoint> points,
                                  const RecognitionTreeOptions& options);

}  // namespace palpate
