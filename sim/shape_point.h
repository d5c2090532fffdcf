// A point of a shape with its derivatives.
#pragma once

#include "core/curves/pose2.h"

namespace palpate::sim {

/// Position, first and second derivative by the curve parameter. [m]
struct ShapePoint {
  Vec2 position;
  Vec2 first;
  Vec2 second;
};

}  // namespace palpate::sim
