// Cubical and semi-cubical parabolas from any number of points: pairs of points give the starts,
// all points the fit.
#pragma once

#include <span>

#include "core/invariants/measured_geometry.h"
#include "core/invariants/signature_fit/semi_signature_fit.h"

namespace palpate {

/// Needs two points or more. Pairs of at most six points, spread evenly over those given, give
/// candidates: both roots, or the nearest angle if noise has removed the roots. The two candidates
/// that agree best with these points are refined on all points; the one with the smaller chi-square
/// is returned.
SemiSignatureFit fit_cubical_parabola(std::span<const MeasuredGeometry> points,
                                      const SemiSignatureOptions& options = {});

/// As fit_cubical_parabola.
SemiSignatureFit fit_semi_cubical_parabola(std::span<const MeasuredGeometry> points,
                                           const SemiSignatureOptions& options = {});

}  // namespace palpate
