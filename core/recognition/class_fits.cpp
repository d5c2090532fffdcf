#include "core/recognition/class_fits.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/recognition/touchable.h"

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

/// An ellipse or hyperbola at its limit is a parabola.
PolynomialModel polynomial_model(const ClassFit& fit) {
  switch (fit.curve_class) {
    case CurveClass::CubicalParabola:
      return PolynomialModel::CubicalParabola;
    case CurveClass::SemiCubicalParabola:
      return PolynomialModel::SemiCubicalParabola;
    case CurveClass::CubicSpline:
      return PolynomialModel::CubicSpline;
    default:
      return PolynomialModel::Parabola;
  }
}

/// Whether any class of `classes` needs the models with a cubic term.
bool wants_cubics(unsigned classes) {
  return (classes & (1U << static_cast<int>(CurveClass::CubicalParabola) |
                     1U << static_cast<int>(CurveClass::SemiCubicalParabola) |
                     1U << static_cast<int>(CurveClass::CubicSpline))) != 0;
}

int sign_of(double x) { return x > 0.0 ? 1 : x < 0.0 ? -1 : 0; }

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

ClassFits fit_classes(const FitData& reduced, const PolynomialFits* starts, unsigned classes) {
  constexpr int side = 0;
  const std::span<const FitPoint> points(reduced.points);
  ClassFits result;
  const auto set = [&](ClassFit fit) {
    result[static_cast<std::size_t>(fit.curve_class)] = std::move(fit);
  };

  set(implicit_class(CurveClass::Line, refine_line(points, algebraic_line(points), side)));
  const ImplicitFit circle = refine_circle(points, algebraic_circle(points), side);
  set(implicit_class(CurveClass::Circle, circle));

  PolynomialFits polynomials = starts != nullptr       ? follow_polynomials(reduced, *starts)
                               : wants_cubics(classes) ? search_polynomials(reduced)
                                                       : search_parabola(reduced);
  // The algebraic start serves unless it led to a conic that nothing touches, or one that a limit
  // betters; then the limits are the starts.
  ImplicitFit conic = refine_conic(points, algebraic_conic(points), side);
  bool usable = is_touchable(conic, reduced);
  const auto also_from = [&](double chi2, const ConicCoefficients& start) {
    if (!usable || chi2 < conic.chi2) {
      const ImplicitFit other = refine_conic(points, start, side);
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

  // Where nothing fits, no walk into a valley was good enough to be trusted.
  const auto fits = [&](const auto& fit) {
    return fit && fits_well(fit->chi2, reduced.points.size());
  };
  if (!fits_well(conic.chi2, reduced.points.size()) &&
      !fits_well(circle.chi2, reduced.points.size()) && !fits(polynomials.parabola) &&
      !fits(polynomials.cubical_parabola) && !fits(polynomials.semi_cubical_parabola) &&
      !fits(polynomials.cubic_spline)) {
    if (starts != nullptr && !starts->every_seed) {
      return fit_classes(reduced, nullptr, classes);
    }
    if (starts == nullptr) {
      refine_every_seed(reduced, &polynomials);
    }
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
      set(std::move(limit));
    }
  }
  return result;
}

namespace {

/// A polynomial on the reduced points carried to all points, not refined yet.
PolynomialFit start_on_all(const PolynomialFit& on_reduced, const SmoothModel& smooth,
                           std::span<const FitPoint> points) {
  PolynomialFit start = on_reduced;
  start.t.clear();
  start.t.reserve(points.size());
  double along_normal = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double t = on_reduced.t[smooth.nearest_reduced[i]];
    start.t.push_back(t);
    if (points[i].offset > 0.0) {
      along_normal += place_on(start, t, points[i].position).signed_distance * points[i].offset;
    }
  }
  start.side = sign_of(along_normal);
  return start;
}

/// On which side of the conic the tip centres lie.
int side_of_tips(const ConicCoefficients& q, std::span<const FitPoint> points) {
  double along_gradient = 0.0;
  for (const FitPoint& point : points) {
    if (point.offset > 0.0) {
      Vec2 foot;
      along_gradient += signed_distance(q, point.position, &foot) * point.offset;
    }
  }
  return sign_of(along_gradient);
}

/// The fit's own parts refined, their sides as they are.
ClassFit refine_parts(ClassFit fit, std::span<const FitPoint> points, const RefineEffort& effort) {
  if (fit.polynomial) {
    const auto refine = [&](PolynomialFit& part) {
      part = refine_polynomial(polynomial_model(fit), points, std::move(part), part.side, effort);
    };
    refine(*fit.polynomial);
    if (fit.rival) {
      refine(*fit.rival);
      if (fit.rival->chi2 < fit.polynomial->chi2) {
        std::swap(*fit.polynomial, *fit.rival);
      }
    }
    fit.chi2 = fit.polynomial->chi2;
    return fit;
  }
  const ConicCoefficients start = fit.implicit->coefficients;
  const int side = fit.implicit->side;
  RefineEffort to_the_end = effort;
  to_the_end.chi2_tolerance = RefineEffort{}.chi2_tolerance;
  fit.implicit = fit.curve_class == CurveClass::Line ? refine_line(points, start, side, to_the_end)
                 : fit.curve_class == CurveClass::Circle
                     ? refine_circle(points, start, side, to_the_end)
                     : refine_conic(points, start, side, to_the_end);
  fit.chi2 = fit.implicit->chi2;
  return fit;
}

/// Whether a fit to all points is still the curve that it is called.
bool is_what_it_says(const ClassFit& fit, const FitData& data) {
  if (fit.polynomial) {
    return is_touchable(*fit.polynomial, data);
  }
  const bool ellipse = fit.curve_class == CurveClass::Ellipse;
  if (!ellipse && fit.curve_class != CurveClass::Hyperbola) {
    return true;
  }
  return (discriminant(fit.implicit->coefficients) > 0.0) == ellipse &&
         is_touchable(*fit.implicit, data);
}

}  // namespace

std::optional<ClassFit> refine_on_all(const ClassFit& coarse, const FitData& reduced,
                                      const SmoothModel& smooth, const FitData& data,
                                      const RefineEffort& effort) {
  // To the optimum on the few reduced points first: from there it is not far on all.
  constexpr int kMoreOnReduced = 10;
  RefineEffort on_reduced = effort;
  on_reduced.iterations *= kMoreOnReduced;
  ClassFit start = coarse;
  if (coarse.polynomial) {
    start = refine_parts(coarse, reduced.points, on_reduced);
    if (start.rival && start.rival->chi2 > start.chi2 + kHopeless) {
      start.rival.reset();
    }
    start.polynomial = start_on_all(*start.polynomial, smooth, data.points);
    if (start.rival) {
      start.rival = start_on_all(*start.rival, smooth, data.points);
    }
  } else {
    start.implicit->side = side_of_tips(start.implicit->coefficients, data.points);
  }
  start.on_all = true;
  const ClassFit refined = refine_parts(std::move(start), data.points, effort);
  return is_what_it_says(refined, data) ? std::optional(refined) : std::nullopt;
}

std::optional<ClassFit> polish(const ClassFit& fit, const FitData& data) {
  assert(fit.on_all);
  if (fit.implicit) {
    return fit;  // these converge at once
  }
  constexpr RefineEffort kPolish{50, 3, 1e-6};
  ClassFit start = fit;
  if (start.rival && is_same_curve(*start.polynomial, *start.rival)) {
    start.rival.reset();  // one optimum: it need not be walked to twice
  }
  const ClassFit polished = refine_parts(std::move(start), data.points, kPolish);
  return is_what_it_says(polished, data) ? std::optional(polished) : std::nullopt;
}

}  // namespace palpate
