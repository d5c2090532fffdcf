// Shapes that stand for the prior of a class: points of a lattice rule.
#pragma once

#include <vector>

#include "core/recognition/prior/touched_coordinates.h"

namespace palpate {

/// A shape of the prior as touched in direction of increasing t, of the size that the prior's
/// centre has. Shapes of which the mirror's image is a shape too stand for both.
struct PriorShape {
  TouchedVector z;
  double curvature = 0.0;
  double rate = 0.0;    ///< of the curvature, by arc length
  double weight = 0.0;  ///< the part of the prior that it stands for; of all: 1
  /// What searches ask of it: logarithms of weight and curvature, asinh of rate over the
  /// curvature's square.
  double log_weight = 0.0;
  double log_curvature = 0.0;
  double relative_rate = 0.0;
};

/// Of every class but the line and Unclassified.
const std::vector<PriorShape>& prior_shapes(CurveClass curve_class);

}  // namespace palpate
