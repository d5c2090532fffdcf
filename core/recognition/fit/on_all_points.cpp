#include "core/recognition/fit/on_all_points.h"

#include <cassert>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/recognition/fit/orthogonal/counted_in_order.h"
#include "core/recognition/fit/orthogonal/measured_normal.h"
#include "core/recognition/fit/orthogonal/touchable.h"
#include "core/recognition/fit/polynomial_fits.h"

namespace palpate {
namespace {

/// To which all points and reduced ones agree. Of chi-square: odds are right to a factor of 1.6.
constexpr double kAgreement = 1.0;

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

/// Distances of points from a curve, its parameters near their feet.
std::vector<double> distances_from(const PolynomialFit& curve, std::span<const FitPoint> points) {
  std::vector<double> distances;
  distances.reserve(points.size());
  const double last_step = last_foot_step(least_sigma(points));
  for (std::size_t i = 0; i < points.size(); ++i) {
    distances.push_back(place_on(curve, curve.t[i], points[i], last_step).signed_distance);
  }
  return distances;
}

/// The distance of a point, and its foot: a tip's on the branch of the curve's foot of that number.
double distance_from(const ImplicitFit& curve, std::size_t number, const FitPoint& point,
                     Vec2* foot, WorkBudget& work) {
  return point.offset > 0.0 ? signed_distance_of_tip(curve.feet[number], curve.coefficients,
                                                     point.position, foot, work)
                            : signed_distance(curve.coefficients, point.position, foot);
}

std::vector<double> distances_from(const ImplicitFit& curve, std::span<const FitPoint> points,
                                   WorkBudget& work) {
  std::vector<double> distances;
  distances.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    Vec2 foot;
    distances.push_back(distance_from(curve, i, points[i], &foot, work));
  }
  return distances;
}

/// What the measured normals leave of chi-square.
double squares_of_normals(const ClassFit& fit, const SmoothModel& smooth,
                          std::span<const FitPoint> points, WorkBudget& work) {
  double squares = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!has_normal(points[i])) {
      continue;
    }
    double residual = 0.0;
    if (fit.polynomial) {
      const PlacedPoint foot =
          place_on(*fit.polynomial, fit.polynomial->t[smooth.nearest_reduced[i]], points[i]);
      residual = normal_residual(fit.polynomial->coefficients, foot, points[i]);
    } else {
      Vec2 foot;
      distance_from(*fit.implicit, smooth.nearest_reduced[i], points[i], &foot, work);
      residual = normal_residual(fit.implicit->coefficients, foot, points[i]);
    }
    squares += residual * residual;
  }
  return squares;
}

/// On which side of the curve the tip centres lie; 0 without tips.
int side_of_tips(std::span<const double> distances, std::span<const FitPoint> points) {
  double sum = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    sum += distances[i] * points[i].offset;
  }
  return sum > 0.0 ? 1 : sum < 0.0 ? -1 : 0;
}

/// The parameters at the reduced points, for all points: near their feet.
void carry_to_all(const SmoothModel& smooth, PolynomialFit* curve) {
  std::vector<double> t;
  t.reserve(smooth.nearest_reduced.size());
  for (const std::uint32_t nearest : smooth.nearest_reduced) {
    t.push_back(curve->t[nearest]);
  }
  curve->t = std::move(t);
}

/// The same of an implicit curve: the feet themselves.
void carry_to_all(const SmoothModel& smooth, ImplicitFit* curve) {
  std::vector<Vec2> feet;
  feet.reserve(smooth.nearest_reduced.size());
  for (const std::uint32_t nearest : smooth.nearest_reduced) {
    feet.push_back(curve->feet[nearest]);
  }
  curve->feet = std::move(feet);
}

/// For points whose foot, followed from their reduced point, ended on the wrong arm of a bend, or
/// on a cusp, where every way ends: the parameters of the nearest feet. Near a cusp a tip's centre
/// may be as far from the wrong arm as from its own, on the other side of it.
void seek_feet(std::span<const FitPoint> points, PolynomialFit* curve, WorkBudget& work) {
  // Of a residual, in deviations of the noise: what lies nearer than noise leaves one point in
  // twenty gains next to nothing from another foot, and seeking costs as much as ten steps of
  // following.
  constexpr double kFar = 2.0;
  const std::vector<double> distances = distances_from(*curve, points);
  const int side = side_of_tips(distances, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const FitPoint& point = points[i];
    const double off = distances[i] - side * point.offset;
    if (std::abs(off) * point.inverse_sigma > kFar && work.allows()) {
      work.spend(WorkKind::SoughtFoot, 1);
      curve->t[i] = nearest_parameter(curve->coefficients, point.position);
    }
  }
}

/// How the points' feet are found: from the reduced points', or anywhere where those are far.
enum class Feet { Followed, Sought };

/// A fit on the reduced points, not refined on all points yet.
ClassFit start_on_all(const ClassFit& fit, const SmoothModel& smooth,
                      std::span<const FitPoint> points, Feet feet, WorkBudget& work) {
  const bool tips = has_tips(points);
  ClassFit start = fit;
  start.chi2_of_all = start.on_all = true;
  if (start.rival && start.rival->chi2 > start.polynomial->chi2 + kHopelessRival) {
    start.rival.reset();
  }
  if (start.implicit && tips) {
    carry_to_all(smooth, &*start.implicit);
    start.implicit->side = side_of_tips(distances_from(*start.implicit, points, work), points);
  }
  for (auto* curve : {&start.polynomial, &start.rival}) {
    if (*curve) {
      carry_to_all(smooth, &**curve);
      if (feet == Feet::Sought) {
        seek_feet(points, &**curve, work);
      }
      (*curve)->side = tips ? side_of_tips(distances_from(**curve, points), points) : 0;
    }
  }
  return start;
}

/// The fit's own parts refined, their sides as they are. A hopeless rival of what is not the best
/// keeps its place.
ClassFit refine_parts(ClassFit fit, std::span<const FitPoint> points, const RefineEffort& effort,
                      RivalOf rival, WorkBudget& work) {
  if (fit.polynomial) {
    const auto refine = [&](PolynomialFit& part, const RefineEffort& with) {
      const int side = part.side;
      part = refine_polynomial(polynomial_model(fit), points, part, side, with, work);
    };
    refine(*fit.polynomial, effort);
    if (fit.rival &&
        (rival == RivalOf::Best || fit.rival->chi2 < fit.polynomial->chi2 + kHopelessRival)) {
      RefineEffort followed = effort;
      followed.seek_feet = false;
      refine(*fit.rival, followed);
      if (fit.rival->chi2 < fit.polynomial->chi2) {
        std::swap(*fit.polynomial, *fit.rival);
      }
    }
    fit.chi2 = fit.polynomial->chi2;
    return fit;
  }
  const ConicCoefficients start = fit.implicit->coefficients;
  const int side = fit.implicit->side;
  const std::span<const Vec2> near =
      side != 0 ? std::span<const Vec2>(fit.implicit->feet) : std::span<const Vec2>();
  RefineEffort to_the_end = effort;
  to_the_end.chi2_tolerance = RefineEffort{}.chi2_tolerance;
  fit.implicit = fit.curve_class == CurveClass::Line
                     ? refine_line(points, start, side, to_the_end, work, near)
                 : fit.curve_class == CurveClass::Circle
                     ? refine_circle(points, start, side, to_the_end, work, near)
                     : refine_conic(points, start, side, to_the_end, work, near);
  fit.chi2 = fit.implicit->chi2;
  return fit;
}

/// Whether strokes can have run along a polynomial curve as the data do.
bool may_be_stroked(const PolynomialFit& fit, const FitData& data) {
  return is_touchable(fit, data) && !leaps(fit, data);
}

/// Of a fit and its rival what may be touched so, with strokes in order along it; nullopt if
/// neither.
std::optional<ClassFit> of_what_it_says(ClassFit fit, const FitData& data, WorkBudget& work) {
  for (std::optional<PolynomialFit>* polynomial : {&fit.polynomial, &fit.rival}) {
    if (*polynomial) *polynomial = counted_in_order(*std::move(*polynomial), data, work);
  }
  if (fit.polynomial) fit.chi2 = fit.polynomial->chi2;
  if (fit.rival && !may_be_stroked(*fit.rival, data)) {
    fit.rival.reset();
  }
  if (is_what_it_says(fit, data)) {
    return fit;
  }
  if (!fit.rival) {
    return std::nullopt;
  }
  fit.polynomial = std::move(fit.rival);
  fit.rival.reset();
  fit.chi2 = fit.polynomial->chi2;
  return fit;
}

}  // namespace

bool is_what_it_says(const ClassFit& fit, const FitData& data) {
  if (fit.polynomial) {
    return may_be_stroked(*fit.polynomial, data);
  }
  const bool ellipse = fit.curve_class == CurveClass::Ellipse;
  if (!ellipse && fit.curve_class != CurveClass::Hyperbola) {
    return true;
  }
  return (discriminant(fit.implicit->coefficients) > 0.0) == ellipse &&
         is_touchable(*fit.implicit, data);
}

ClassFit settled(const ClassFit& fit, const FitData& reduced, RivalOf rival, WorkBudget& work) {
  const RefineEffort& effort = rival == RivalOf::Best ? kBestOnReducedEffort : kOnReducedEffort;
  return refine_parts(fit, reduced.points, effort, rival, work);
}

ClassFit beside_centres(ClassFit fit, int side, const FitData& centres, const RefineEffort& effort,
                        WorkBudget& work) {
  (fit.polynomial ? fit.polynomial->side : fit.implicit->side) = side;
  fit.rival.reset();
  return refine_parts(std::move(fit), centres.points, effort, RivalOf::Other, work);
}

double chi2_on_all(const ClassFit& fit, const SmoothModel& smooth, const FitData& data,
                   WorkBudget& work) {
  const std::span<const FitPoint> points(data.points);
  work.spend(fit.polynomial ? WorkKind::PolynomialRow : WorkKind::ConicRow, points.size());
  std::vector<double> distances;
  if (fit.polynomial) {
    PolynomialFit curve = *fit.polynomial;
    carry_to_all(smooth, &curve);
    distances = distances_from(curve, points);
  } else {
    ImplicitFit curve = *fit.implicit;
    if (has_tips(points)) {
      carry_to_all(smooth, &curve);
    }
    distances = distances_from(curve, points, work);
  }
  const int side = side_of_tips(distances, points);
  double chi2 =
      residual_count(data) > points.size() ? squares_of_normals(fit, smooth, points, work) : 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double residual = (distances[i] - side * points[i].offset) * points[i].inverse_sigma;
    chi2 += residual * residual;
  }
  return chi2;
}

std::optional<ClassFit> where_all_agree(const ClassFit& settled, const FitData& reduced,
                                        const SmoothModel& smooth, const FitData& data,
                                        WorkBudget& work) {
  if (!is_what_it_says(settled, reduced)) {
    return std::nullopt;
  }
  ClassFit fit = settled;
  fit.chi2 = chi2_on_all(settled, smooth, data, work);
  fit.chi2_of_all = true;
  const bool agrees = std::abs(fit.chi2 - (settled.chi2 + smooth.chi2)) <= kAgreement;
  return agrees ? std::optional(std::move(fit)) : std::nullopt;
}

std::optional<ClassFit> refine_on_all(const ClassFit& fit, const SmoothModel& smooth,
                                      const FitData& data, const RefineEffort& effort,
                                      WorkBudget& work, RivalOf rival) {
  const std::span<const FitPoint> points(data.points);
  work.spend(WorkKind::PlacedRow, points.size());
  ClassFit refined = refine_parts(start_on_all(fit, smooth, points, Feet::Followed, work), points,
                                  effort, RivalOf::Best, work);
  // All points leave what the reduced ones and the smooth model do: where they leave more, some
  // feet are on the wrong arm of a bend. So they may be of the best class where the reduced points
  // fit no better, about a cusp that no section follows.
  const std::size_t reduced = residual_count(smooth.reduced);
  const double more = refined.chi2 - smooth.chi2;
  // Of a spline not unless noise cannot leave it: between the nearest feet of some points on either
  // side a loop, as thin as noise, would pass twice.
  const bool on_wrong_arm = fit.curve_class == CurveClass::SemiCubicalParabola
                                ? more > fit.chi2 + kAgreement
                                : !fits_well(more, reduced);
  if (fit.polynomial && (rival == RivalOf::Best || fits_well(fit.chi2, reduced)) && on_wrong_arm &&
      work.allows()) {
    work.spend(WorkKind::PlacedRow, points.size());
    ClassFit again = refine_parts(start_on_all(fit, smooth, points, Feet::Sought, work), points,
                                  effort, RivalOf::Best, work);
    if (again.chi2 < refined.chi2 &&
        (is_what_it_says(again, data) || !is_what_it_says(refined, data))) {
      refined = std::move(again);
    }
  }
  return of_what_it_says(std::move(refined), data, work);
}

std::optional<ClassFit> polish(const ClassFit& fit, const FitData& data, WorkBudget& work) {
  assert(fit.on_all);
  ClassFit start = fit;
  if (start.rival && is_same_curve(*start.polynomial, *start.rival)) {
    start.rival.reset();  // one optimum: it need not be walked to twice
  }
  return of_what_it_says(
      refine_parts(std::move(start), data.points, kPolishEffort, RivalOf::Best, work), data, work);
}

}  // namespace palpate
