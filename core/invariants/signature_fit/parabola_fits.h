// Cubical and semi-cubical parabolas from any number of points: pairs give the starts, all points
// the answer.
#pragma once

#include <span>

#include "core/invariants/measured_geometry.h"
#include "core/invariants/signature_fit/semi_signature_fit.h"

namespace palpate {

/// Two points or more. Pairs of at most six of them, spread evenly over those given, name
/// candidates (both roots; where noise has removed the roots, the nearest angle); the two that
/// agree best with these points are refined on all points and the one of least chi-square is kept.
SemiSignatureFit fit_cubical_parabola(std::span<const MeasuredGeometry> points,
                                      const SemiSignatureOptions& options = {});

/// As fit_cubical_parabola.
SemiSignatureFit fit_semi_cubical_parabola(std::span<const MeasuredGeometry> points,
                                           const SemiSignatureOptions& options = {});

}  // namespace palpate
