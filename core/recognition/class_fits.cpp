#include "core/recognition/class_fits.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/recognition/axis_fit.h"
#include "core/recognition/polynomial_seeds.h"

namespace palpate {
namespace {

/// Positive for ellipses, negative for hyperbolas; unit-norm coefficients.
double discriminant(const ConicCoefficients& q) { return 4.0 * q[0] * q[2] - q[1] * q[1]; }

/// Whether all points lie on one branch of a hyperbola: on one side of its conjugate axis.
bool on_one_branch(const ConicCoefficients& q, std::span<const FitPoint> points) {
  const double d = discriminant(q);
  const Vec2 centre((q[1] * q[4] - 2.0 * q[2] * q[3]) / d, (q[1] * q[3] - 2.0 * q[0] * q[4]) / d);
  // Along the real axis the polynomial changes sign from the centre outwards.
  const double at_centre = 0.5 * (q[3] * centre.x() + q[4] * centre.y()) + q[5];
  const double angle = 0.5 * std::atan2(q[1], q[0] - q[2]);
  Vec2 axis(std::cos(angle), std::sin(angle));
  const double curvature_along = q[0] * axis.x() * axis.x() + q[1] * axis.x() * axis.y() +
                                 q[2] * axis.y() * axis.y();
  if (curvature_along * at_centre > 0.0) {
    axis = left_of(axis);
  }
  bool any_positive = false;
  bool any_negative = false;
  for (const FitPoint& point : points) {
    const double along = (point.position - centre).dot(axis);
    any_positive = any_positive || along > 0.0;
    any_negative = any_negative || along < 0.0;
  }
  return !(any_positive && any_negative);
}

/// Whether a conic is one that a probe could have touched at these points: one branch, each patch
/// on one side of it. A thin ellipse, or the two branches of a flat hyperbola, "explains" straight
/// noisy points by letting neighbours lie on opposite sides: its direction of travel then flips
/// against the patch's own from point to point.
bool is_touchable(const ConicCoefficients& q, const FitData& data) {
  if (!(discriminant(q) > 0.0 || on_one_branch(q, data.points))) {
    return false;
  }
  constexpr std::size_t kOneIn = 50;  // points whose own direction noise may turn round
  for (const PatchSpan& patch : data.patches) {
    std::size_t left = 0;
    for (std::size_t i = patch.begin; i < patch.end; ++i) {
      Vec2 foot;
      signed_distance(q, data.points[i].position, &foot);
      const Vec2 gradient(2.0 * q[0] * foot.x() + q[1] * foot.y() + q[3],
                          q[1] * foot.x() + 2.0 * q[2] * foot.y() + q[4]);
      left += cross(data.points[i].tangent, gradient) >= 0.0 ? 1 : 0;
    }
    if (std::min(left, patch.size() - left) * kOneIn > patch.size()) {
      return false;
    }
  }
  return true;
}

/// The same for a polynomial curve: the curve parameter runs one way along a patch. Samples half a patch
/// apart are compared, whose order noise does not turn round.
bool is_touchable(const PolynomialFit& fit, const FitData& data) {
  constexpr std::size_t kOneIn = 10;  // that noise may turn round on a patch of four sigma
  for (const PatchSpan& patch : data.patches) {
    const std::size_t lag = patch.size() / 2;
    std::size_t forward = 0;
    for (std::size_t i = patch.begin; i + lag < patch.end; ++i) {
      forward += fit.t[i + lag] >= fit.t[i] ? 1 : 0;
    }
    const std::size_t pairs = patch.size() - lag;
    if (std::min(forward, pairs - forward) * kOneIn > pairs) {
      return false;
    }
  }
  return true;
}

/// refine_axis, the arms reassigned until they stay.
AxisFit refine_axis_and_arms(std::span<const FitPoint> points,
                             std::span<const PatchSpan> patches, AxisFit fit, int max_iterations) {
  constexpr int kMostReassignments = 5;
  fit = refine_axis(points, std::move(fit), max_iterations);
  for (int i = 0; i < kMostReassignments && !fit.arms.empty(); ++i) {
    if (!reassign_arms(points, patches, &fit)) {
      break;
    }
    fit = refine_axis(points, std::move(fit), max_iterations);
  }
  return fit;
}

/// Walks the valleys of all seeds on the reduced points; best first.
std::vector<AxisFit> walk(const std::vector<AxisFit>& seeds, const FitData& reduced) {
  constexpr int kMostIterations = 15;
  std::vector<AxisFit> walked;
  for (const AxisFit& seed : seeds) {
    AxisFit fit = refine_axis_and_arms(reduced.points, reduced.patches, seed, kMostIterations);
    if (std::isfinite(fit.chi2)) {
      walked.push_back(std::move(fit));
    }
  }
  std::sort(walked.begin(), walked.end(),
            [](const AxisFit& a, const AxisFit& b) { return a.chi2 < b.chi2; });
  return walked;
}

/// The best of the walked seeds, refined on the reduced points.
std::optional<PolynomialFit> best_of(const std::vector<AxisFit>& seeds, const FitData& reduced,
                                     int side) {
  const std::vector<AxisFit> walked = walk(seeds, reduced);
  if (walked.empty()) {
    return std::nullopt;
  }
  return refine_polynomial(walked.front().model, reduced.points,
                           to_polynomial(walked.front(), reduced.points), side, kCoarseEffort);
}

/// Walks the splines' valleys, and lets the other models start beside the splines found: near c = 0
/// splines come in pairs with a semi-cubical parabola between the two.
void add_relatives(const FitData& reduced, PolynomialSeeds* seeds) {
  seeds->cubic_spline = walk(seeds->cubic_spline, reduced);
  for (const AxisFit& spline : seeds->cubic_spline) {
    seeds->semi_cubical_parabola.push_back(semi_cubical_near(spline, reduced.points));
  }
  if (!seeds->cubic_spline.empty()) {
    // A spline with its vertex far away is a cubical parabola along the same axis.
    seeds->cubical_parabola.push_back(
        {PolynomialModel::CubicalParabola, seeds->cubic_spline.front().theta, 0.0, {}, 0.0});
  }
}

/// The best spline and the optimum on the other side of c = 0, if there is one.
struct SplinePair {
  std::optional<PolynomialFit> best;
  std::optional<PolynomialFit> rival;
};

SplinePair fit_spline(const std::vector<AxisFit>& walked, const FitData& reduced) {
  SplinePair pair;
  if (walked.empty()) {
    return pair;
  }
  constexpr int kMostIterations = 15;
  const auto refine = [&](const AxisFit& fit) {
    return refine_polynomial(fit.model, reduced.points, to_polynomial(fit, reduced.points), 0,
                             kCoarseEffort);
  };
  pair.best = refine(walked.front());
  pair.rival = refine(refine_axis_and_arms(reduced.points, reduced.patches,
                                           twin_of(walked.front(), reduced.points),
                                           kMostIterations));
  if (pair.rival->chi2 < pair.best->chi2) {
    std::swap(pair.best, pair.rival);
  }
  return pair;
}

/// Whether a fit to the reduced points is as good as noise allows.
bool fits_well(double chi2, const FitData& reduced) {
  constexpr double kStandardDeviations = 5.0;
  const double n = static_cast<double>(reduced.points.size());
  return chi2 < n + kStandardDeviations * std::sqrt(2.0 * n);
}

void keep_better(std::optional<PolynomialFit>* best, PolynomialFit fit) {
  if (std::isfinite(fit.chi2) && (!*best || fit.chi2 < (*best)->chi2)) {
    *best = std::move(fit);
  }
}

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

/// The last resort for the models with arms, whose sharp bends make narrow valleys.
void refine_every_seed(const FitData& reduced, const PolynomialSeeds& seeds, ClassFits* fits) {
  const auto improve = [&](CurveClass curve_class, const AxisFit& seed) {
    auto& fit = (*fits)[static_cast<std::size_t>(curve_class)];
    PolynomialFit refined = refine_polynomial(seed.model, reduced.points,
                                              to_polynomial(seed, reduced.points), 0);
    if (std::isfinite(refined.chi2) && (!fit || refined.chi2 < fit->chi2)) {
      fit = polynomial_class(curve_class, refined);
    }
  };
  for (const AxisFit& seed : seeds.cubic_spline) {
    improve(CurveClass::CubicSpline, seed);
    improve(CurveClass::CubicSpline, twin_of(seed, reduced.points));
  }
  for (const AxisFit& seed : seeds.semi_cubical_parabola) {
    improve(CurveClass::SemiCubicalParabola, seed);
  }
}

int sign_of(double x) { return x > 0.0 ? 1 : x < 0.0 ? -1 : 0; }

}  // namespace

ClassFits fit_classes(const FitData& reduced) {
  constexpr int side = 0;
  const std::span<const FitPoint> points(reduced.points);
  ClassFits fits;
  const auto set = [&](ClassFit fit) {
    fits[static_cast<std::size_t>(fit.curve_class)] = std::move(fit);
  };

  set(implicit_class(CurveClass::Line, refine_line(points, algebraic_line(points), side)));
  const ImplicitFit circle = refine_circle(points, algebraic_circle(points), side);
  set(implicit_class(CurveClass::Circle, circle));

  PolynomialSeeds seeds;
  add_graph_seeds(points, &seeds);
  add_arm_seeds(points, reduced.patches, &seeds);
  add_relatives(reduced, &seeds);
  const auto parabola = best_of(seeds.parabola, reduced, side);
  const auto cubical = best_of(seeds.cubical_parabola, reduced, side);
  const auto semi_cubical = best_of(seeds.semi_cubical_parabola, reduced, side);
  auto [spline, rival] = fit_spline(seeds.cubic_spline, reduced);
  // A class can be no worse than its limits: start from them too where it is.
  for (const auto* limit : {&parabola, &cubical, &semi_cubical}) {
    if (*limit && (!spline || (*limit)->chi2 < spline->chi2)) {
      PolynomialFit start = **limit;
      normalise_parameter(PolynomialModel::CubicSpline, &start);
      keep_better(&spline, refine_polynomial(PolynomialModel::CubicSpline, points,
                                             std::move(start), side, kCoarseEffort));
    }
  }

  // The algebraic start serves unless it led to a conic that nothing touches, or one that a limit
  // betters; then the limits are the starts.
  ImplicitFit conic = refine_conic(points, algebraic_conic(points), side);
  bool usable = is_touchable(conic.coefficients, reduced);
  const auto also_from = [&](double chi2, const ConicCoefficients& start) {
    if (!usable || chi2 < conic.chi2) {
      const ImplicitFit other = refine_conic(points, start, side);
      if (is_touchable(other.coefficients, reduced) && (!usable || other.chi2 < conic.chi2)) {
        conic = other;
        usable = true;
      }
    }
  };
  if (parabola) {
    also_from(parabola->chi2, conic_of_parabola(*parabola));
  }
  also_from(circle.chi2, circle.coefficients);

  if (parabola) {
    set(polynomial_class(CurveClass::Parabola, *parabola));
  }
  if (cubical) {
    set(polynomial_class(CurveClass::CubicalParabola, *cubical));
  }
  if (semi_cubical) {
    set(polynomial_class(CurveClass::SemiCubicalParabola, *semi_cubical));
  }
  if (spline) {
    ClassFit fit = polynomial_class(CurveClass::CubicSpline, *spline);
    fit.rival = std::move(rival);
    set(std::move(fit));
  }

  // Where nothing fits, no walk into a valley was good enough to be trusted: refine every seed.
  const auto fits_anything = [&] {
    return std::any_of(fits.begin(), fits.end(), [&](const std::optional<ClassFit>& fit) {
      return fit && fits_well(fit->chi2, reduced);
    });
  };
  if (!fits_well(conic.chi2, reduced) && !fits_anything()) {
    refine_every_seed(reduced, seeds, &fits);
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
  return fits;
}

namespace {

/// A polynomial on the reduced points carried to all points, not refined yet.
PolynomialFit start_on_all(const PolynomialFit& on_reduced, const SmoothModel& smooth,
                           std::span<const FitPoint> points) {
  PolynomialFit start = on_reduced;
  start.t.clear();
  double along_normal = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double t = on_reduced.t[smooth.nearest_reduced[i]];
    start.t.push_back(t);
    along_normal += place_on(start, t, points[i].position).signed_distance * points[i].offset;
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
  fit.implicit = fit.curve_class == CurveClass::Line ? refine_line(points, start, side, effort)
                 : fit.curve_class == CurveClass::Circle
                     ? refine_circle(points, start, side, effort)
                     : refine_conic(points, start, side, effort);
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
  const ConicCoefficients& q = fit.implicit->coefficients;
  return (discriminant(q) > 0.0) == ellipse && is_touchable(q, data);
}

}  // namespace

std::optional<ClassFit> refine_on_all(const ClassFit& coarse, const FitData& reduced,
                                      const SmoothModel& smooth, const FitData& data,
                                      const RefineEffort& effort) {
  // To the optimum on the few reduced points first: from there it is not far on all.
  constexpr int kMoreOnReduced = 4;
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
  constexpr RefineEffort kPolish{50, 3, 1e-6};
  const ClassFit polished = refine_parts(fit, data.points, kPolish);
  return is_what_it_says(polished, data) ? std::optional(polished) : std::nullopt;
}

}  // namespace palpate
