// Laws of the coordinates of curves that are touched about their bend.
#pragma once

#include "core/recognition/prior/student_law.h"

namespace palpate {

// Far out on its arms every class is straight, and so is what is very large. Parts end, and what is
// touched is not much smaller than they are: the tails are such that curvature has a density that
// falls to 0 with it at the straight line. With longer ones a straight edge would be taken for an
// arm by odds that fall with the noise only. Where curvature falls with the power n of a
// coordinate, that is 2 n degrees of freedom.

/// Slopes against an axis or vertex tangent: n = 3, half of them within 30 degrees.
inline constexpr StudentLaw kSlope{6, 2.0};
/// a t of semi-cubical parabola and spline: slope 3 / 2 a t, curvature as its power -4. One in
/// twenty lies beyond the place where the slope is 3, at which a part's size is told
/// (log_length_over_size).
inline constexpr StudentLaw kPlaceFromCusp{8, 2.45};
/// t / L of the cubical parabola: slope 3 (t / L)^2, curvature as the power -5. As many beyond 1.
inline constexpr StudentLaw kPlaceFromInflection{10, 1.4};
/// a c of the spline: curvature 2 / (a c)^2 at t = 0. Its inflections, 3 (a t)^2 = a c, have the
/// slope 3 where the scale is.
inline constexpr StudentLaw kBend{4, 3.0};
/// m = e^2 - 1 of hyperbolas, about 1: Cauchy's.
inline constexpr StudentLaw kEccentricity{1, 1.0};

}  // namespace palpate
