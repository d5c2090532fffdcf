// Conics where the likelihood has no optimum that a probe could have touched.
#pragma once

#include "core/recognition/weigh/contenders.h"

namespace palpate {

/// Patches that are short beside their noise leave their curvature to it: the best conic may be a
/// needle, or bend the wrong way round, though a plain ellipse fits nearly as well. A class is not
/// excluded by that: where neither ellipse nor hyperbola has an optimum, and it is not that the
/// points are straight, the mode of the ellipse's posterior stands for it, sought from the circle
/// in the directions that its axis may have. Where none comes near, the contenders say so; those
/// that have been told so already are left as they are. `classes`: wanted, by bit 1 << CurveClass.
Contenders with_conic_mode(Contenders contenders, const Ground& ground, unsigned classes);

}  // namespace palpate
