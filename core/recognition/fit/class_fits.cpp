#include "core/recognition/fit/class_fits.h"

#include <algorithm>
#include <utility>

#include "core/recognition/fit/few_points.h"
#include "core/recognition/fit/touchable.h"
#include "core/recognition/fit/warm_start.h"

namespace palpate {
namespace {

ClassFit implicit_class(CurveClass curve_class, const ImplicitFit& fit) {
  ClassFit result;
  result.curve_class = curve_class;
  result.chi2 = fit.chi2;
  result.implicit = fit;
  return result;
}

ClassFit polynomial_class(CurveClass curve_class, const PolynomialFit& fit) {
  ClassFit result;
  result.curve_class = curve_class;
  result.chi2 = fit.chi2;
  result.polynomial = fit;
  return result;
}

/// As fit_classes, searched on all points or from `starts`; nullopt where these fitted and nothing
/// does any more.
std::optional<ClassFits> fits_from(const PolynomialFits* starts, const FitData& reduced,
                                   unsigned classes, double out_of_reach) {
  constexpr int side = 0;
  constexpr RefineEffort kNearEnough{100, 1, 1e-3};  // what is plausible is settled later
  const std::span<const FitPoint> points(reduced.points);
  ClassFits result;
  const auto set = [&](ClassFit fit) {
    result[static_cast<std::size_t>(fit.curve_class)] = std::move(fit);
  };

  set(implicit_class(CurveClass::Line,
                     refine_line(points, algebraic_line(points), side, kNearEnough)));
  const ImplicitFit circle = refine_circle(points, algebraic_circle(points), side, kNearEnough);
  set(implicit_class(CurveClass::Circle, circle));

  PolynomialFits polynomials = starts != nullptr ? follow_polynomials(reduced, *starts)
                               : (classes & kCubics) != 0
                                   ? search_polynomials(reduced, out_of_reach)
                                   : search_parabola(reduced);
  // The algebraic start serves unless it led to a conic that nothing touches, or one that a limit
  // betters; then the limits are the starts.
  const bool started = starts != nullptr && starts->conic;
  ImplicitFit conic =
      refine_conic(points, started ? *starts->conic : algebraic_conic(points), side, kNearEnough);
  bool usable = is_touchable(conic, reduced);
  double least_chi2 = conic.chi2;  // of any conic, touchable or not
  const auto also_from = [&](double chi2, const ConicCoefficients& start) {
    if (!started && (!usable || chi2 < conic.chi2)) {
      const ImplicitFit other = refine_conic(points, start, side, kNearEnough);
      least_chi2 = std::min(least_chi2, other.chi2);
      if (is_touchable(other, reduced) && (!usable || other.chi2 < conic.chi2)) {
        conic = other;
        usable = true;
      }
    }
  };
  if (polynomials.parabola) {
    also_from(polynomials.parabola->chi2, conic_of_parabola(*polynomials.parabola));
  }
  also_from(circle.chi2, circle.coefficients);

  // A parabola is the cubics' limit, and data that leave a conic possible tell no cubic from it.
  // Where none of these fits, one cubic that does says nothing of another: the best seed by the
  // walk need not be the best by distances.
  const std::size_t residuals = residual_count(reduced);
  const auto fits = [&](const auto& fit) { return fit && fits_well(fit->chi2, residuals); };
  polynomials.lowest_chi2 = std::min(circle.chi2, usable ? conic.chi2 : circle.chi2);
  if (polynomials.parabola) {
    polynomials.lowest_chi2 = std::min(polynomials.lowest_chi2, polynomials.parabola->chi2);
  }
  const bool conic_fits = fits_well(polynomials.lowest_chi2, residuals);
  const bool line_fits = fits(result[static_cast<std::size_t>(CurveClass::Line)]);
  if (starts == nullptr && !line_fits) {  // a line is the limit of all
    refine_every_seed(reduced, out_of_reach, &polynomials);
  } else if (starts != nullptr && !starts->every_seed && !conic_fits &&
             !fits(polynomials.cubical_parabola) && !fits(polynomials.semi_cubical_parabola) &&
             !fits(polynomials.cubic_spline)) {
    return std::nullopt;
  }
  const auto& parabola = polynomials.parabola;
  if (parabola) {
    set(polynomial_class(CurveClass::Parabola, *parabola));
  }
  if (polynomials.cubical_parabola) {
    set(polynomial_class(CurveClass::CubicalParabola, *polynomials.cubical_parabola));
  }
  if (polynomials.semi_cubical_parabola) {
    set(polynomial_class(CurveClass::SemiCubicalParabola, *polynomials.semi_cubical_parabola));
  }
  if (polynomials.cubic_spline) {
    ClassFit fit = polynomial_class(CurveClass::CubicSpline, *polynomials.cubic_spline);
    fit.rival = std::move(polynomials.rival);
    set(std::move(fit));
  }

  const bool elliptic = discriminant(conic.coefficients) > 0.0;
  for (const CurveClass curve_class : {CurveClass::Ellipse, CurveClass::Hyperbola}) {
    if (usable && elliptic == (curve_class == CurveClass::Ellipse)) {
      set(implicit_class(curve_class, conic));
    } else if (parabola) {
      ClassFit limit = polynomial_class(curve_class, *parabola);
      limit.at_limit = true;
      limit.least_chi2 = least_chi2;
      set(std::move(limit));
    }
  }
  return result;
}

}  // namespace

ConicCoefficients conic_of_parabola(const PolynomialFit& fit) {
  // (11), (12) eliminated as below (13): with u = b2 (x - a0) - a2 (y - b0) and
  // v = b1 (x - a0) - a1 (y - b0) the curve is u^2 = (a1 b2 - a2 b1) (-v) up to sign.
  const auto& c = fit.coefficients;
  const Vec2 nu(c(1, 2), -c(0, 2));
  const Vec2 nv(c(1, 1), -c(0, 1));
  const Vec2 origin = c.col(0);
  const double k = c(0, 1) * c(1, 2) - c(0, 2) * c(1, 1);
  // On the curve: u = k t, v = -k t^2, hence u^2 + k v = 0.
  const double u0 = -nu.dot(origin);
  const double v0 = -nv.dot(origin);
  ConicCoefficients q;
  q << nu.x() * nu.x(), 2.0 * nu.x() * nu.y(), nu.y() * nu.y(), 2.0 * nu.x() * u0 + k * nv.x(),
      2.0 * nu.y() * u0 + k * nv.y(), u0 * u0 + k * v0;
  return q.normalized();
}

ClassFits fit_classes(const FitData& reduced, const PolynomialFits* starts, unsigned classes,
                      double out_of_reach) {
  if (starts != nullptr) {
    if (auto fits = fits_from(starts, reduced, classes, out_of_reach)) {
      return *std::move(fits);
    }
  }
  if (const auto few = few_of(reduced)) {
    const ClassFits found = *fits_from(nullptr, *few, classes, out_of_reach);
    PolynomialFits carried = carried_to(warm_start_from(found, *few), reduced);
    for (const CurveClass curve_class : {CurveClass::Ellipse, CurveClass::Hyperbola}) {
      const auto& conic = found[static_cast<std::size_t>(curve_class)];
      if (carried.every_seed && conic && conic->implicit) {
        carried.conic = conic->implicit->coefficients;
      }
    }
    if (auto fits = fits_from(&carried, reduced, classes, out_of_reach)) {
      return *std::move(fits);
    }
  }
  return *fits_from(nullptr, reduced, classes, out_of_reach);
}

}  // namespace palpate
