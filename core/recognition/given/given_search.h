// Searches the curve of a given class that is nearest to all points, in double precision.
#pragma once

#include <limits>
#include <span>

#include "core/recognition/given/local_points.h"

namespace palpate {

struct GivenCandidate {
  PlacedCurve<double> curve;
  double cost = std::numeric_limits<double>::infinity();
  bool settled = false;  ///< at a minimum
  int side = 0;  ///< side of the curve on which tip centres lie (+1 left, -1 right); 0 without tips
};

/// With tips, tries both sides and takes the one that the points' stated material supports, else
/// the one that fits better. The cost is infinite if no start leads to a curve.
GivenCandidate search_sides(CurveClass curve_class, const LocalPoints& local,
                            std::span<const GivenPoint> points);

}  // namespace palpate
