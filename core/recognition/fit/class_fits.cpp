#include "core/recognition/fit/class_fits.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/recognition/fit/on_all_points.h"
#include "core/recognition/fit/orthogonal/feet_in_order.h"
#include "core/recognition/fit/orthogonal/touchable.h"
#include "core/recognition/fit/parabola_beside_conic.h"
#include "core/recognition/fit/polynomial_search.h"
#include "core/recognition/fit/starts/algebraic_fit.h"
#include "core/recognition/fit/starts/few_points.h"
#include "core/recognition/fit/warm_start.h"

namespace palpate {
namespace {

/// That are carried from points to others: a parabola, the cubics, a spline's rival.
constexpr std::size_t kPolynomials = 5;

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

/// A polynomial that fits, but with strokes that run back and forth along it, as it fits with these
/// in order; unchanged where it cannot.
void put_in_order(PolynomialModel model, const FitData& reduced, const RefineEffort& effort,
                  std::optional<PolynomialFit>* fit, WorkBudget& work) {
  const std::size_t residuals = residual_count(reduced);
  if (!*fit || !fits_well((*fit)->chi2, residuals) || is_touchable(**fit, reduced) ||
      !work.allows()) {
    return;
  }
  RefineEffort follow = effort;
  follow.seek_feet = false;
  PolynomialFit ordered =
      refine_polynomial(model, reduced.points, with_feet_in_order(**fit, reduced, work),
                        kSurfacePoints, follow, work);
  if (fits_well(ordered.chi2, residuals) && is_touchable(ordered, reduced)) {
    *fit = std::move(ordered);
  }
}

/// As fit_classes, searched on all points or from `starts`; nullopt where these fitted and nothing
/// does any more.
std::optional<ClassFits> fits_from(const PolynomialFits* starts, const FitData& reduced,
                                   unsigned classes, double out_of_reach, WorkBudget& work) {
  constexpr int side = 0;
  const RefineEffort near_enough{100, 1, 1e-3, out_of_reach};  // what is plausible is settled later
  const std::span<const FitPoint> points(reduced.points);
  ClassFits result;
  const auto set = [&](ClassFit fit) { result[fit.curve_class] = std::move(fit); };

  const ImplicitFit line = refine_line(points, algebraic_line(points), side, near_enough, work);
  const std::size_t residuals = residual_count(reduced);
  const bool line_fits = fits_well(line.chi2, residuals);
  set(implicit_class(CurveClass::Line, line));
  const ImplicitFit circle =
      refine_circle(points, algebraic_circle(points), side, near_enough, work);
  set(implicit_class(CurveClass::Circle, circle));

  PolynomialFits polynomials =
      starts != nullptr          ? follow_polynomials(reduced, *starts, out_of_reach, work)
      : (classes & kCubics) != 0 ? search_polynomials(reduced, line_fits, out_of_reach, work)
                                 : search_parabola(reduced, work);
  put_in_order(PolynomialModel::Parabola, reduced, near_enough, &polynomials.parabola, work);
  put_in_order(PolynomialModel::SemiCubicalParabola, reduced, near_enough,
               &polynomials.semi_cubical_parabola, work);
  put_in_order(PolynomialModel::CubicSpline, reduced, near_enough, &polynomials.cubic_spline, work);
  // The algebraic start serves unless it led to a conic that nothing touches, or one that a limit
  // betters; then the limits are the starts.
  const bool started = starts != nullptr && starts->conic;
  RefineEffort on_all = kOnAllEffort;
  on_all.out_of_reach = out_of_reach;
  ImplicitFit conic = started
                          ? refine_conic(points, *starts->conic, side, on_all, work)
                          : refine_conic(points, algebraic_conic(points), side, near_enough, work);
  bool usable = is_touchable(conic, reduced);
  const auto also_from = [&](double chi2, const ConicCoefficients& start) {
    if (!started && (!usable || chi2 < conic.chi2) && work.allows()) {
      const ImplicitFit other = refine_conic(points, start, side, near_enough, work);
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
  if (usable && starts == nullptr) {
    start_parabola_beside_conic(conic.coefficients, conic.chi2, reduced, &polynomials, work);
  }

  // A parabola is the cubics' limit, and data that leave a conic possible tell no cubic from it.
  // Where none of these fits, one cubic that does says nothing of another: the best seed by the
  // walk need not be the best by distances.
  const auto fits = [&](const auto& fit) { return fit && fits_well(fit->chi2, residuals); };
  polynomials.lowest_chi2 = std::min(circle.chi2, usable ? conic.chi2 : circle.chi2);
  if (polynomials.parabola) {
    polynomials.lowest_chi2 = std::min(polynomials.lowest_chi2, polynomials.parabola->chi2);
  }
  const bool conic_fits = fits_well(polynomials.lowest_chi2, residuals);
  if (starts == nullptr && !line_fits) {  // a line is the limit of all
    refine_every_seed(reduced, out_of_reach, &polynomials, work);
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
    ClassFit fit =
        polynomial_class(CurveClass::SemiCubicalParabola, *polynomials.semi_cubical_parabola);
    fit.rival = std::move(polynomials.other_cusp);
    set(std::move(fit));
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

/// Whether every class leaves more than noise or form error of any size that is measured at.
bool leaves_more_than_noise(const ClassFits& fits, const FitData& data) {
  const double most = most_chi2_of_noise(data.points);
  return std::none_of(fits.begin(), fits.end(),
                      [&](const auto& fit) { return fit && fit->chi2 <= most; });
}

/// Whether some class fits as well as noise allows.
bool any_fits(const ClassFits& fits, const FitData& data) {
  const std::size_t residuals = residual_count(data);
  return std::any_of(fits.begin(), fits.end(),
                     [&](const auto& fit) { return fit && fits_well(fit->chi2, residuals); });
}

/// Of the carried polynomials that of a class; the parabola's where an ellipse or hyperbola is at
/// its limit.
const std::optional<PolynomialFit>& polynomial_of(CurveClass curve_class,
                                                  const PolynomialFits& carried) {
  switch (curve_class) {
    case CurveClass::CubicalParabola:
      return carried.cubical_parabola;
    case CurveClass::SemiCubicalParabola:
      return carried.semi_cubical_parabola;
    case CurveClass::CubicSpline:
      return carried.cubic_spline;
    default:
      return carried.parabola;
  }
}

/// Of the carried polynomials the rival of a class.
const std::optional<PolynomialFit>& rival_of(CurveClass curve_class,
                                             const PolynomialFits& carried) {
  return curve_class == CurveClass::SemiCubicalParabola ? carried.other_cusp : carried.rival;
}

/// Fits to few of the points as they are on all of them.
ClassFits placed_on(ClassFits fits, const FitData& few, const FitData& all, WorkBudget& work) {
  work.spend(WorkKind::PlacedRow, fits.size() * all.points.size());
  const PolynomialFits carried = carried_to(warm_start_from(fits, few), all);
  for (auto& fit : fits) {
    if (fit && fit->implicit) {
      fit->implicit = placed_on(all.points, *std::move(fit->implicit));
      fit->chi2 = fit->implicit->chi2;
    } else if (fit) {
      fit->polynomial = placed_on(all.points, *polynomial_of(fit->curve_class, carried));
      fit->chi2 = fit->polynomial->chi2;
      if (fit->rival) {
        fit->rival = placed_on(all.points, *rival_of(fit->curve_class, carried));
      }
    }
  }
  return fits;
}

/// Fits to few of the points followed on all of them.
ClassFits followed_on(const ClassFits& found, const FitData& few, const FitData& all,
                      unsigned classes, double out_of_reach, WorkBudget& work) {
  work.spend(WorkKind::PlacedRow, kPolynomials * all.points.size());
  PolynomialFits carried = carried_to(warm_start_from(found, few), all);
  if (carried.parabola) {
    carried.conic = conic_of_parabola(*carried.parabola);  // the limit, if none is nearer
  }
  for (const CurveClass curve_class : {CurveClass::Ellipse, CurveClass::Hyperbola}) {
    const auto& conic = found[curve_class];
    if (conic && conic->implicit) {
      carried.conic = conic->implicit->coefficients;
    }
  }
  carried.every_seed = true;  // not asked to fit: what does not is for the caller to see
  return *fits_from(&carried, all, classes, out_of_reach, work);
}

/// The polynomials among them that fitted the few, settled on all from feet wherever these are:
/// near a sharp bend the nearest of some places may be on the other arm.
ClassFits settled_from_feet(const ClassFits& found, const FitData& few, const FitData& all,
                            WorkBudget& work) {
  work.spend(WorkKind::PlacedRow, kPolynomials * all.points.size());
  const PolynomialFits carried = carried_to(warm_start_from(found, few), all);
  const std::size_t residuals = residual_count(few);
  const auto with_feet = [&](PolynomialFit fit) {
    for (std::size_t i = 0; i < all.points.size() && work.allows(); ++i) {
      work.spend(WorkKind::SoughtFoot, 1);
      fit.t[i] = nearest_parameter(fit.coefficients, all.points[i].position);
    }
    return fit;
  };
  ClassFits result;
  for (const auto& fit : found) {
    if (fit && fit->polynomial && !fit->at_limit && fits_well(fit->chi2, residuals)) {
      ClassFit start = *fit;
      start.polynomial = with_feet(*polynomial_of(fit->curve_class, carried));
      if (fit->rival && fits_well(fit->rival->chi2, residuals)) {
        start.rival = with_feet(*rival_of(fit->curve_class, carried));
      } else {
        start.rival.reset();
      }
      result[fit->curve_class] = settled(start, all, RivalOf::Other, work);
    }
  }
  return result;
}

/// By what the best fit misses each point, squared, over its noise.
std::vector<double> squares_of_best(const ClassFits& fits, std::span<const FitPoint> points) {
  const ClassFit* best = nullptr;
  for (const auto& fit : fits) {
    if (fit && (best == nullptr || fit->chi2 < best->chi2)) {
      best = &*fit;
    }
  }
  std::vector<double> squares;
  squares.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const FitPoint& point = points[i];
    squares.push_back((point.position - foot_of(*best, i)).squaredNorm() * point.inverse_sigma *
                      point.inverse_sigma);
  }
  return squares;
}

/// Of two fits of every class the better ones.
ClassFits better_of(ClassFits a, const ClassFits& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool better =
        b[i] &&
        (!a[i] || (a[i]->at_limit == b[i]->at_limit ? b[i]->chi2 < a[i]->chi2 : a[i]->at_limit));
    if (better) {
      a[i] = b[i];
    }
  }
  return a;
}

/// fit_classes() without a start, of points that are many.
ClassFits searched_on_few(const FitData& few, const FitData& all, unsigned classes,
                          double out_of_reach, WorkBudget& work) {
  ClassFits found = *fits_from(nullptr, few, classes, out_of_reach, work);
  if (leaves_more_than_noise(found, few)) {
    return placed_on(std::move(found), few, all, work);
  }
  ClassFits fits = followed_on(found, few, all, classes, out_of_reach, work);
  if (!any_fits(found, few) || any_fits(fits, all) || !work.allows()) {
    return fits;
  }
  fits = better_of(std::move(fits), settled_from_feet(found, few, all, work));
  if (any_fits(fits, all) || !work.allows()) {
    return fits;
  }
  // What fits the few and not all was not told by them: once more with those that it misses most.
  const FitData more = few_and_worst_fitted(all, squares_of_best(fits, all.points));
  const ClassFits again = *fits_from(nullptr, more, classes, out_of_reach, work);
  fits = better_of(std::move(fits), followed_on(again, more, all, classes, out_of_reach, work));
  return any_fits(fits, all) || !work.allows()
             ? fits
             : better_of(std::move(fits), settled_from_feet(again, more, all, work));
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

ClassFits fit_classes(const FitData& reduced, WorkBudget& work, const WarmStart* start,
                      unsigned classes, double out_of_reach) {
  const auto few = few_of(reduced);
  if (start != nullptr) {
    if (few && start->polynomials.every_seed) {
      work.spend(WorkKind::PlacedRow, kPolynomials * few->points.size());
      const PolynomialFits carried = carried_to(*start, *few);
      ClassFits found = *fits_from(&carried, *few, classes, out_of_reach, work);
      if (leaves_more_than_noise(found, *few)) {
        return placed_on(std::move(found), *few, reduced, work);
      }
    }
    work.spend(WorkKind::PlacedRow, kPolynomials * reduced.points.size());
    const PolynomialFits carried = carried_to(*start, reduced);
    if (auto fits = fits_from(&carried, reduced, classes, out_of_reach, work)) {
      return *std::move(fits);
    }
  }
  return few ? searched_on_few(*few, reduced, classes, out_of_reach, work)
             : *fits_from(nullptr, reduced, classes, out_of_reach, work);
}

}  // namespace palpate
