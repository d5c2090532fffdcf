// Searches the curve of a given class that is nearest to all points, in double precision.
#pragma once

#include <limits>
#include <span>

#include "core/recognition/given/local_points.h"
#include "core/recognition/samples/contact_sample.h"

namespace palpate {

struct GivenCandidate {
  PlacedCurve<double> curve;
  double cost = std::numeric_limits<double>::infinity();
  bool settled = false;  ///< at a minimum
  int side = 0;  ///< side of the curve on which tip centres lie (+1 left, -1 right); 0 without tips
};

/// The best curve, and how much worse the best with the tips on the other side is.
struct SidedCandidate {
  GivenCandidate taken;
  /// Cost on the other side; infinite if nothing fits there, or if the side taken is told.
  double cost_of_other = std::numeric_limits<double>::infinity();
};

/// With tips, tries both sides and takes the one that the points' stated material supports, else
/// the one that `touched_from` says, else the one that fits better. The cost is infinite if no
/// start leads to a curve.
SidedCandidate search_sides(CurveClass curve_class, const LocalPoints& local,
                            std::span<const GivenPoint> points, TouchedFrom touched_from);

}  // namespace palpate
