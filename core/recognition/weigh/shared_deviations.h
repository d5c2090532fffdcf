// Odds of the classes where probe and part may deviate smoothly: what one class has for its shape
// may be such a deviation from another.
#pragma once

#include "core/recognition/weigh/contenders.h"

namespace palpate {

/// A probe with two lobes makes an ellipse of a ring. So each class within reach has what
/// deviations that neighbours share add to its evidence (coherent/coherent_gain.h): they change the
/// shares that classes have of what all of them have together. "Unclassified" keeps its own: paths
/// that are free follow any deviation. `of_any_size`: where classes with deviations have more than
/// these paths, it is even odds whether there is such a deviation or another shape; otherwise, as
/// of a probe that is trusted, it is another shape. `margin`: log odds that keep the best from
/// being RECOGNIZED.
Contenders with_shared_deviations(Contenders contenders, const Ground& ground, bool of_any_size,
                                  double margin);

}  // namespace palpate
