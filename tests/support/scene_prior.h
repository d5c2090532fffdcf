// The prior over scenes on which calibration is measured: class, size, pose, arcs, patches, noise.
#pragma once

#include <array>
#include <cstdint>

#include "tests/support/random_scene.h"

namespace palpate::test {

/// The distribution of scenes. Sizes are log-uniform between 5 mm and 0.5 m, positions within ten
/// sizes of the origin, directions uniform. One to four patches of 111 samples, equally likely, lie
/// in disjoint parts of the curve. Arcs and noise are log-uniform, in units of the size (the half
/// diagonal of the whole curve piece). Shapes: random_scene.cpp.
struct ScenePrior {
  /// Relative frequency by CurveClass; that of Unclassified is the frequency of curves of no class,
  /// which are one of the four OutsideShapes.
  std::array<double, 9> frequency = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
  double least_arc_over_size = 0.1;
  double most_arc_over_size = 2.0;
  double least_sigma_over_size = 1e-5;
  double most_sigma_over_size = 2e-3;
};

/// Nine equally frequent kinds of curve: the prior that the recognizer assumes.
ScenePrior even_prior();

/// The same without curves of no class.
ScenePrior classes_only(ScenePrior prior);

/// A prior that differs from the assumed one: splines five times as frequent, arcs half as long.
ScenePrior other_prior();

struct PriorScene {
  Scene scene;  ///< its curve_class is Unclassified for a curve of no class
  std::vector<std::vector<Vec2>> exact_patches;  ///< the same touches without noise
  double size_m = 0.0;
};

/// Scene `number` of the sequence `seed`. It does not depend on which other scenes are drawn.
PriorScene scene_from(const ScenePrior& prior, std::uint64_t seed, std::uint32_t number);

}  // namespace palpate::test
