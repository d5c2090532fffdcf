// Ellipses and hyperbolas whose fit runs away to the parabola, m = 0: what they have on their own
// side of it.
#pragma once

#include <optional>

#include "core/recognition/posterior/class_evidence.h"

namespace palpate {

/// log of the density that the prior of `beyond` (Ellipse or Hyperbola) has next to the parabola
/// over the other's, at the curve of that parabola; both by m.
double log_density_ratio_at_parabola(CurveClass beyond, const ClassEvidence& parabola);

/// The evidence of a conic that fits no better than the parabola: its mode lies where the prior
/// leads to. nullopt where none comes near the points.
std::optional<ClassEvidence> evidence_at_limit(CurveClass curve_class,
                                               const ClassEvidence& parabola, const FitData& data,
                                               WorkBudget& work);

/// Whether the data tell m so narrowly that what lies beyond the parabola is a normal law's tail:
/// all five coordinates of this conic are determined.
bool tells_eccentricity(const ClassEvidence& conic);

}  // namespace palpate
