// The second moment of an ellipse that may be a circle: beyond it the axes change places.
#pragma once

#include <optional>

#include "core/recognition/fit/canonical_fit.h"

namespace palpate {

/// E[(q - estimate)(q - estimate)^T] of q = [a; b; x; y; theta] where mean radius, ovality and
/// centre have the normal law that `linear`, a covariance of q, is of to first order. Ovality is
/// (a - b) / 2 along twice the direction of the long axis: two numbers that pass through 0 as
/// smoothly as any other, where theta turns by a quarter and a and b change places. nullopt where
/// that is so many deviations away that `linear` holds, and if `linear` is no covariance.
std::optional<ShapePoseCovariance> moment_across_circle(const CanonicalFit& ellipse,
                                                        const ShapePoseCovariance& linear);

}  // namespace palpate
