// Parts drawn from the very prior that the recogniser assumes (core/README.md, "The prior").
#pragma once

#include <cstdint>
#include <vector>

#include "core/curves/curve_class.h"
#include "core/recognition/samples/contact_sample.h"

namespace palpate::test {

/// One stroke of 111 samples on a part.
struct AssumedScene {
  CurveClass truth = CurveClass::Unclassified;
  double sigma = 0.0;                  ///< noise of a coordinate, in half extents of the stroke
  double sigma_m = 0.0;                ///< the same in metres
  std::vector<ContactSample> samples;  ///< without a noise of their own
};

/// A part of one of the eight classes or of none, all alike probable: shape and place as the prior
/// has them, a stroke about that place so long that half of its extent is the prior's unit. A draw
/// that cannot be touched so far (a circle that is too small, a cusp within the stroke) is left
/// out, and so is its class's share: the odds of the others are as they were. Noise log-uniform
/// from 1e-5 to 2e-3 half extents, half extent log-uniform from 5 mm to 0.5 m, within a metre of
/// the origin.
/// Scene `number` does not depend on what others draw.
AssumedScene draw_assumed(std::uint64_t seed, std::uint32_t number);

}  // namespace palpate::test
