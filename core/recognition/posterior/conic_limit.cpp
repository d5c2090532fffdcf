#include "core/recognition/posterior/conic_limit.h"

#include <cmath>
#include <utility>

namespace palpate {
namespace {

/// Of a conic that is no parabola, up to a constant.
double log_density(CurveClass curve_class, const TouchedVector& z) {
  return log_prior({curve_class}, z) - std::log(prior_widths({curve_class}, z).head<3>().prod());
}

}  // namespace

double log_density_ratio_at_parabola(CurveClass beyond, const ClassEvidence& parabola) {
  const TouchedVector& z = parabola.nodes[parabola.mode].curve.z;
  const double slope = z[1];
  TouchedVector of_hyperbola = TouchedVector::Zero();
  of_hyperbola.head<3>() << z[0], 0.0, slope;
  TouchedVector of_ellipse = TouchedVector::Zero();
  of_ellipse.head<3>() << z[0], 0.0, std::atan2(1.0, slope);
  // Of the ellipse's direction by the hyperbola's slope.
  const double log_rate = -std::log1p(slope * slope);
  const double ratio = log_density(CurveClass::Ellipse, of_ellipse) + log_rate -
                       log_density(CurveClass::Hyperbola, of_hyperbola);
  return beyond == CurveClass::Ellipse ? ratio : -ratio;
}

std::optional<ClassEvidence> evidence_at_limit(CurveClass curve_class,
                                               const ClassEvidence& parabola, const FitData& data,
                                               WorkBudget& work) {
  ClassEvidence evidence;
  evidence.at_limit = true;
  evidence.touch = along_patch(parabola.touch, data);
  evidence.touch.curve_class = curve_class;
  evidence.fitted_chi2 = parabola.fitted_chi2;
  const TouchedCurve& path = parabola.nodes[parabola.mode].curve;
  return from_prior(std::move(evidence), CurveClass::Parabola, path, data, work);
}

bool tells_eccentricity(const ClassEvidence& conic) {
  constexpr double kLeft =
      0.1;  // of one coordinate, to the prior: its deviation is a third of that
  return conic.determined > degrees_of_freedom(conic.touch.curve_class) - kLeft;
}

}  // namespace palpate
