// Conics where the likelihood has no optimum that a probe could have touched.
#pragma once

#include "core/recognition/fit/class_fits.h"

namespace palpate {

/// Patches that are short beside their noise leave their curvature to it: the best conic may be a
/// needle, or bend the wrong way round, though a plain ellipse fits nearly as well. A class is not
/// excluded by that: where neither ellipse nor hyperbola has an optimum, the mode of the ellipse's
/// posterior stands for it, sought from the circle in the directions that its axis may have.
/// `fits`: of every class to `reduced`, surface points; noise variances count `inflation` times.
ClassFits with_conic_mode(ClassFits fits, const FitData& reduced, double inflation);

}  // namespace palpate
