// The best spline and the next best.
#pragma once

#include <optional>

#include "core/recognition/fit/orthogonal/polynomial_fit.h"

namespace palpate {

// By how much two walks may end apart in one valley.
inline constexpr double kSameChi2 = 1e-2;   // of it
inline constexpr double kSameAngle = 1e-2;  // rad, between their axes

/// The best spline and another optimum: on the other side of c = 0, or of another valley.
struct SplinePair {
  std::optional<PolynomialFit> best;
  std::optional<PolynomialFit> rival;
};

/// Ended in the same valley, on the same side of c = 0, though not at its very end.
bool is_same_valley(const PolynomialFit& a, const PolynomialFit& b);

/// Takes a fit among the two best. What it replaces is the rival.
void take(PolynomialFit fit, SplinePair* pair);

/// The spline on the other side of c = 0 of one that is refined: a walk beside a sharp bend may
/// have ended too far from it to tell. nullopt where it is a parabola.
std::optional<PolynomialFit> twin_of(const PolynomialFit& fit);

}  // namespace palpate
