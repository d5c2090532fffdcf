// Two parallel lines as the limit of a given class.
#pragma once

#include "core/recognition/given/given_search.h"

namespace palpate {

/// Least misfit of two parallel lines. All classes but line and circle turn into them: an ellipse
/// as it grows long, the arms of a parabola far from its vertex, those of a cubic far from its
/// bend. (Of lines that cross nothing is asked. A hyperbola turns into its asymptotes, but a search
/// comes as near to them as rounding lets it: by steps in the ratio of the hyperbola's size.)
double misfit_of_parallels(const LocalPoints& local, const GivenNoise& noise);

}  // namespace palpate
