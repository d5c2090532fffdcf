// Algebraic fits of conic, circle and line: where their least squares start.
#pragma once

#include <span>

#include "core/recognition/fit/orthogonal/implicit_fit.h"

namespace palpate {

/// Starts without a previous fit: the algebraic fit of G. Taubin ("Estimation of planar curves,
/// surfaces and nonplanar space curves defined by implicit equations", 1991). It weights by
/// gradients, so that it has no bias towards small ellipses, and costs one 5 x 5 eigenproblem.
ConicCoefficients algebraic_conic(std::span<const FitPoint> points);
ConicCoefficients algebraic_circle(std::span<const FitPoint> points);
ConicCoefficients algebraic_line(std::span<const FitPoint> points);

}  // namespace palpate
