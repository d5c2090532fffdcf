#include "core/recognition/given/given_limit.h"

#include <algorithm>
#include <vector>

namespace palpate {
namespace {

/// Classes that one turns into at its limit, besides a pair of lines.
std::vector<CurveClass> limits_of(CurveClass curve_class) {
  switch (curve_class) {
    case CurveClass::Circle:
    case CurveClass::Parabola:
      return {CurveClass::Line};
    case CurveClass::Ellipse:
    case CurveClass::Hyperbola:
    case CurveClass::CubicalParabola:
    case CurveClass::SemiCubicalParabola:
      return {CurveClass::Parabola, CurveClass::Line};
    case CurveClass::CubicSpline:
      // Far from its bend an arm is a cubical parabola, and a bend of no width is a cusp.
      return {CurveClass::Parabola, CurveClass::CubicalParabola, CurveClass::SemiCubicalParabola};
    default:
      return {};
  }
}

}  // namespace

bool limit_fits_no_worse(CurveClass curve_class, double misfit, const LocalPoints& local,
                         const GivenNoise& noise) {
  // Of the logarithm of the likelihood: far above what rounding makes of a sum of squares, and far
  // below what tells one curve from another.
  constexpr double kAlike = 1e-6;
  const std::vector<CurveClass> limits = limits_of(curve_class);
  return std::any_of(limits.begin(), limits.end(), [&](CurveClass limit) {
    const std::vector<GivenCandidate> found = search_minima(limit, local, noise);
    return std::any_of(found.begin(), found.end(), [&](const GivenCandidate& candidate) {
      return candidate.misfit <= misfit + kAlike;
    });
  });
}

}  // namespace palpate
