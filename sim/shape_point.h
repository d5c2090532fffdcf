// A place on a shape and how the shape runs there.
#pragma once

#include "core/curves/pose2.h"

namespace palpate::sim {

/// Position, first and second derivative with respect to the curve parameter. [m]
struct ShapePoint {
  Vec2 position;
  Vec2 first;
  Vec2 second;
};

}  // namespace palpate::sim
