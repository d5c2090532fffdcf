// The recognition tree as the paper runs it: invariants that agree within a plain fraction.
#pragma once

#include <span>

#include "core/recognition/tree/recognition_tree.h"

namespace palpate {

/// recognise_by_tree with options.relative_tolerance > 0. Each test's value is the spread
/// (max - min) of its invariant over the points or pairs, relative to its largest size:
///   line, circle   kappa and kappa_s against the curvature scale
///   conic          Ic1 over all pairs, against the larger of |Ic1| and Ip |kappa|^(2/3)
///   parabola       the same with Ic1 = 0, and Ip over the points
///   cubical        Icp1 and Icp2 over the points, in the best pair's frame
///   semi-cubical   Iscp1 and Iscp2 likewise
///   spline         (a, b, c) from three points against those with another point in place of the
///   third
/// Uses at most eight points, spread evenly over those given.
TreeResult recognise_by_tolerance(std::span<const TreePoint> points,
                                  const RecognitionTreeOptions& options);

}  // namespace palpate
