// The foot of a point on a curve that is tried: as near as the point's noise asks for.
#pragma once

#include "core/curves/curve.h"

namespace palpate {

/// A point's foot on a curve, and the curve there.
struct TrialFoot {
  double t = 0.0;
  Vec2 position = Vec2::Zero();
  Vec2 first = Vec2::Zero();
};

/// The foot of `point` (curve's frame): on a conic the one near the point, on a cubic the one near
/// `t`, on the arm where it was. `sigma`: the point's noise.
TrialFoot trial_foot(const Curve& curve, const Vec2& point, double t, double sigma);

}  // namespace palpate
