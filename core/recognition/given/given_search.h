// The curve of a given class that lies nearest to all points, in double precision.
#pragma once

#include <limits>
#include <span>

#include "core/recognition/given/local_points.h"

namespace palpate {

struct GivenCandidate {
  PlacedCurve<double> curve;
  double cost = std::numeric_limits<double>::infinity();
  bool settled = false;  ///< at a minimum
  int side = 0;          ///< of the curve on which tip centres lie; 0 without tips
};

/// Of both sides that tips may lie on, the one that the points' material tells, else the better
/// one. Its cost is infinite where no start leads anywhere.
GivenCandidate search_sides(CurveClass curve_class, const LocalPoints& local,
                            std::span<const GivenPoint> points);

}  // namespace palpate
