// Parts that are of a class but for a little, and how far they are from it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/curves/pose2.h"
#include "tests/support/random_scene.h"

namespace palpate::test {

struct NearPart {
  std::string name;
  std::function<Vec2(double)> at;
  double from;
  double to;
};

/// An egg, two arcs that follow each other, an ellipse with a dent, and the like; some 50 mm long.
std::vector<NearPart> near_parts();

/// Two strokes along the part, a hundred samples each, displaced by `sigma_m` times `normal()`.
Scene touched(const NearPart& part, double sigma_m, const std::function<double()>& normal);

/// The noise under which the best class leaves this chi-square of the exact places.
double noise_of_misfit(const NearPart& part, double chi2);

}  // namespace palpate::test
