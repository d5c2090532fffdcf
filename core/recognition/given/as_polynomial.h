// The fit of a given spline in the coefficients of its polynomials.
#pragma once

#include "core/recognition/given/given_search.h"

namespace palpate {

/// Takes a spline in whose valley a descent has not come to an end to where one in the coefficients
/// of its polynomials ends, if that is lower, and tells whether it is a minimum. As a spline's x
/// loses the quadratic term q, it becomes a cubical parabola, which is no limit in these
/// coefficients; its own parameters are powers of q up to the third, so that each step along the
/// valley is short, and double precision does not hold a matrix of them.
void descend_as_polynomial(const LocalPoints& local, bool noise_is_stated,
                           GivenCandidate* candidate);

}  // namespace palpate
