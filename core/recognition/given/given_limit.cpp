#include "core/recognition/given/given_limit.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "core/recognition/given/parallel_lines.h"

namespace palpate {
namespace {

/// Classes that one turns into at its limit.
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

double misfit_of_limit(CurveClass curve_class, const LocalPoints& local, const GivenNoise& noise) {
  double least = std::numeric_limits<double>::infinity();
  for (const CurveClass limit : limits_of(curve_class)) {
    for (const GivenCandidate& candidate : search_minima(limit, local, noise)) {
      least = std::min(least, candidate.misfit);
    }
  }
  if (curve_class != CurveClass::Line && curve_class != CurveClass::Circle) {
    least = std::min(least, misfit_of_parallels(local, noise));
  }
  return least;
}

}  // namespace palpate
