// Curves touched at single places, one sample each, in no order, as a trigger probe delivers them.
#pragma once

#include <random>
#include <vector>

#include "core/recognition/recognizer.h"
#include "tests/support/random_scene.h"

namespace palpate::test {

struct LoneTouches {
  Scene scene;  ///< one patch per touch; with a tip, positions are its centres
  double tip_radius_m = 0.0;
  std::vector<Vec2> normals;  ///< true normals, from the surface towards the tip, world frame
};

/// `count` places drawn evenly along most of the curve piece. A tip is on the outer side of the
/// piece's bend, on the same side of the curve everywhere.
LoneTouches lone_touches(CurveClass curve_class, int count, double sigma_over_size,
                         double tip_over_size, std::mt19937_64& rng);

/// Adds each touch as a patch of its own. `sigma_m`: stated by the samples; 0 = not known.
void add_touches(const LoneTouches& touches, double sigma_m, Recognizer* recognizer);

/// The same with measured normals of that standard deviation.
void add_touches_with_normals(const LoneTouches& touches, double sigma_m, double normal_sigma_rad,
                              std::mt19937_64& rng, Recognizer* recognizer);

}  // namespace palpate::test
