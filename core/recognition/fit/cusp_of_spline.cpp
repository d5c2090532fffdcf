#include "core/recognition/fit/cusp_of_spline.h"

#include <cmath>
#include <utility>
#include <vector>

#include "core/curves/algebraic/polynomial_curve.h"
#include "core/recognition/fit/on_all_points.h"
#include "core/recognition/fit/orthogonal/polynomial_foot.h"
#include "core/recognition/fit/starts/axis_fit.h"

namespace palpate {
namespace {

/// The bend that a spline starts with in place of a cusp, in radii of the tip that rolls about it.
/// (The feet of the roll all lie on the cusp, which has no direction to leave it by. A bend gives
/// them one. If it is far sharper than the tip, that goes about both alike.)
constexpr double kStartRadius = 1e-2;

/// The optimum of a class on all points from such a curve.
std::optional<ClassFit> polished_from(CurveClass curve_class, PolynomialFit start,
                                      const FitData& data, WorkBudget& work) {
  ClassFit fit;
  fit.curve_class = curve_class;
  fit.chi2_of_all = fit.on_all = true;
  fit.polynomial = std::move(start);
  auto found = polish(fit, data, work);
  if (found) {
    found->polished = true;
  }
  return found;
}

/// The spline that goes round the cusp of a semi-cubical parabola in a bend of that radius.
PolynomialFit rounded_at_cusp(PolynomialFit cusp, double radius, const FitData& data,
                              WorkBudget& work) {
  PolynomialCoefficients& c = cusp.coefficients;
  const Vec2 across = Vec2(c.col(3)).normalized();
  // Near the cusp the curve goes by t^2 along the axis, and by v t across: of curvature 2 along /
  // v^2.
  const double along = std::abs(cross(across, Vec2(c.col(2))));
  c.col(1) = std::sqrt(2.0 * along * radius) * across;
  work.spend(WorkKind::SoughtFoot, data.points.size());
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    cusp.t[i] = nearest_parameter(c, data.points[i].position);
  }
  return cusp;
}

}  // namespace

std::optional<ClassFit> cusp_of_spline(const ClassFit& spline, const FitData& data,
                                       WorkBudget& work) {
  const PolynomialFit& from = *spline.polynomial;
  const auto vertex = vertex_of(from.coefficients);
  if (!vertex) {
    return std::nullopt;
  }
  PolynomialFit start = from;
  start.coefficients = PolynomialCurve2{from.coefficients}.shifted(*vertex).coefficients;
  start.coefficients.col(1).setZero();
  for (double& t : start.t) {
    t -= *vertex;
  }
  return polished_from(CurveClass::SemiCubicalParabola, std::move(start), data, work);
}

std::optional<ClassFit> spline_from_limit(const ClassFit& limit, const FitData& data,
                                          WorkBudget& work) {
  PolynomialFit start = *limit.polynomial;
  const double tip = largest_offset(data.points);
  if (limit.curve_class == CurveClass::SemiCubicalParabola && tip > 0.0) {
    start = rounded_at_cusp(std::move(start), kStartRadius * tip, data, work);
  }
  normalise_parameter(PolynomialModel::CubicSpline, &start);
  return polished_from(CurveClass::CubicSpline, std::move(start), data, work);
}

ClassFit placed_on_reduced(const ClassFit& on_all, const FitData& reduced, WorkBudget& work) {
  ClassFit fit = on_all;
  fit.chi2_of_all = fit.on_all = fit.polished = false;
  fit.polynomial->side = 0;  // these are surface points
  work.spend(WorkKind::SoughtFoot, reduced.points.size());
  fit.polynomial->t.clear();
  for (const FitPoint& point : reduced.points) {
    fit.polynomial->t.push_back(nearest_parameter(fit.polynomial->coefficients, point.position));
  }
  fit.polynomial = placed_on(reduced.points, *std::move(fit.polynomial));
  fit.chi2 = fit.polynomial->chi2;
  return fit;
}

}  // namespace palpate
