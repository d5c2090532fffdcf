#include "core/recognition/posterior/class_limits.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/numerics/matrices/small_cholesky.h"
#include "core/recognition/modes/other_modes.h"
#include "core/recognition/posterior/prior_modes.h"
#include "core/recognition/prior/touched_prior.h"

namespace palpate {
namespace {

/// Where in the tail of a normal law beyond `from` the cube has its mean: that of an exponential
/// law, 6^(1/3), times how far the tail reaches in the mean. Ellipses next to the parabola are as
/// probable as the cube of m, but for the share that is touched about a tip (arms.h), whose density
/// hardly changes there.
double tail_of_cube(double from) {
  constexpr double kOfCube = 1.817;
  const double tail = 0.5 * std::erfc(from / std::numbers::sqrt2);
  const double density = std::exp(-0.5 * from * from) / std::sqrt(2.0 * kPi);
  return kOfCube * (tail > std::numeric_limits<double>::min() ? density / tail - from : 1.0 / from);
}

/// Whether the data tell m so narrowly that what lies beyond the parabola is a normal law's tail:
/// all five coordinates of this conic are determined.
bool tells_eccentricity(const ClassEvidence& conic) {
  constexpr double kLeft =
      0.1;  // of one coordinate, to the prior: its deviation is a third of that
  return conic.determined > degrees_of_freedom(conic.touch.curve_class) - kLeft;
}

/// Whether the conic on the other side of the parabola tells what this class has beyond it.
bool is_told_from_inside(CurveClass beyond, const Evidences& evidences) {
  if (beyond != CurveClass::Ellipse && beyond != CurveClass::Hyperbola) {
    return false;
  }
  const auto& inside =
      evidences
          .classes[beyond == CurveClass::Ellipse ? CurveClass::Hyperbola : CurveClass::Ellipse];
  return inside && tells_eccentricity(*inside);
}

bool is_fitted(const ClassFits& fits, CurveClass curve_class) {
  const auto& fit = fits[curve_class];
  return fit && !fit->at_limit && std::isfinite(fit->chi2);
}

}  // namespace

std::optional<CurveClass> limit_of(CurveClass curve_class, const ClassFits& fits) {
  const bool parabola = is_fitted(fits, CurveClass::Parabola);
  const bool cusp =
      curve_class == CurveClass::CubicSpline && is_fitted(fits, CurveClass::SemiCubicalParabola);
  const auto chi2 = [&](CurveClass c) { return fits[c]->chi2; };
  if (cusp && !(parabola && chi2(CurveClass::Parabola) <= chi2(CurveClass::SemiCubicalParabola))) {
    return CurveClass::SemiCubicalParabola;
  }
  return parabola ? std::optional(CurveClass::Parabola) : std::nullopt;
}

unsigned with_limits(unsigned classes) {
  unsigned all = classes | class_bit(CurveClass::Line);
  for (const CurveClass curve_class : kClassesWithLimit) {
    all |= (classes & class_bit(curve_class)) != 0 ? class_bit(CurveClass::Parabola) : 0U;
  }
  const bool spline = (classes & class_bit(CurveClass::CubicSpline)) != 0;
  return all | (spline ? class_bit(CurveClass::SemiCubicalParabola) : 0U);
}

void add_limits(const ClassFits& fits, const FitData& reduced, const Likelihood& likelihood,
                double best, const Evidences& before, Evidences* evidences, WorkBudget& work) {
  for (const CurveClass beyond : kClassesWithLimit) {
    const auto& fit = fits[beyond];
    const auto limit = limit_of(beyond, fits);
    if (!fit || !limit || (!fit->at_limit && evidences->classes[beyond]) || !work.allows()) {
      continue;
    }
    const auto& path = evidences->classes[*limit];
    const double above = fit->chi2 - fits[*limit]->chi2;
    if (!path || !(above <= kWorseThanLimit) ||
        !(log_evidence(likelihood, *evidences, *fits[*limit]) > best - kUnseenLogOdds) ||
        is_told_from_inside(beyond, *evidences)) {
      continue;
    }
    const double fitted_chi2 = path->fitted_chi2 + above / evidences->inflation;
    const ClassEvidence* earlier = known_of(before, beyond);
    if (earlier != nullptr && earlier->prior_mode_sought) {
      ClassEvidence counted = counted_from(fitted_chi2, *earlier);
      if (is_of_optimum(counted)) {
        evidences->classes[beyond] = std::move(counted);
      }
    } else {
      // Of its limit's determined coordinates: one more would cost it more.
      const double seen_occam =
          best - kUnseenLogOdds - likelihood.log_evidence(fit->chi2, 0.0, path->determined);
      evidences->classes[beyond] = from_prior(beyond, fitted_chi2, *path,
                                              points_of(*fits[*limit], reduced), seen_occam, work);
    }
    evidences->on_reduced_chi2[beyond] = fitted_chi2;
    if (evidences->classes[beyond]) {
      evidences->classes[beyond]->counted_from_limit = fit->at_limit;
    }
  }
}

double log_density_ratio_beyond(CurveClass beyond, const ClassEvidence& inside) {
  const TouchedCurve& mode = inside.nodes[inside.mode].curve;
  const TouchedVector& z = mode.z;
  TouchedVector there = z;
  if (beyond == CurveClass::Hyperbola) {
    const double slope = 1.0 / std::tan(z[2]);
    if (!std::isfinite(slope)) {
      return -std::numeric_limits<double>::infinity();  // in the middle of a side, far from any tip
    }
    there.segment<2>(1) << 0.0, slope;
    // Of the ellipse's direction by the hyperbola's slope.
    return log_density({beyond}, there) -
           (log_density({CurveClass::Ellipse}, z) - std::log1p(slope * slope));
  }
  const double deviation = std::sqrt(inverse_cholesky(mode.root)(1, 1)) * mode.widths[1];
  there.segment<2>(1) << tail_of_cube(z[1] / deviation) * deviation, std::atan2(1.0, z[2]);
  return log_density({beyond}, there) - std::log1p(z[2] * z[2]) -
         log_density({CurveClass::Hyperbola}, z);
}

}  // namespace palpate
