#include "core/invariants/signature_fit/semi_signature_fit.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/curves/pose2.h"
#include "core/invariants/signature_fit/canonical_models.h"
#include "core/invariants/signature_fit/semi_signature_fitter.h"
#include "core/numerics/small_cholesky.h"

namespace palpate {
namespace {

/// Powers of the length unit by which each parameter of a class scales.
Eigen::Vector3d unit_powers(CurveClass curve_class) {
  switch (curve_class) {
    case CurveClass::CubicalParabola:
      return {-2.0, 0.0, 0.0};
    case CurveClass::SemiCubicalParabola:
      return {-0.5, 0.0, 0.0};
    case CurveClass::CubicSpline:
      return {-0.5, 0.0, 0.5};
    default:
      return {1.0, 1.0, 0.0};
  }
}

/// Power of the length unit by which the curve parameter scales.
double parameter_power(CurveClass curve_class) {
  switch (curve_class) {
    case CurveClass::CubicalParabola:
      return 1.0;
    case CurveClass::SemiCubicalParabola:
    case CurveClass::CubicSpline:
      return 0.5;
    default:
      return 0.0;
  }
}

/// Brings a fit to the class's conventions: a >= b, a > 0; the t and the orientation follow.
void canonicalise(SemiSignatureFit& fit) {
  Eigen::Vector3d& p = fit.parameters;
  const auto flip = [&](int i) {
    p[i] = -p[i];
    fit.covariance.row(i) *= -1.0;
    fit.covariance.col(i) *= -1.0;
  };
  if (fit.curve_class == CurveClass::Ellipse) {
    if (p[1] > p[0]) {
      std::swap(p[0], p[1]);
      fit.covariance.row(0).swap(fit.covariance.row(1));
      fit.covariance.col(0).swap(fit.covariance.col(1));
      fit.orientation += kPi / 2.0;
      for (LocalParameter& place : fit.places) {
        place.t -= kPi / 2.0;
      }
    }
    for (LocalParameter& place : fit.places) {
      place.t = wrap_angle(place.t);
    }
  } else if (fit.curve_class == CurveClass::SemiCubicalParabola ||
             fit.curve_class == CurveClass::CubicSpline) {
    if (p[0] < 0.0) {  // t -> -t changes the signs of a and c and the direction
      flip(0);
      if (fit.curve_class == CurveClass::CubicSpline) {
        flip(2);
      }
      for (LocalParameter& place : fit.places) {
        place.t = -place.t;
        place.direction = -place.direction;
      }
    }
  }
  fit.orientation = wrap_angle(fit.orientation);
}

bool in_class(CurveClass curve_class, const Eigen::Vector3d& p) {
  switch (curve_class) {
    case CurveClass::Ellipse:
    case CurveClass::Hyperbola:
      return p[0] > 0.0 && p[1] > 0.0;
    case CurveClass::Parabola:
    case CurveClass::SemiCubicalParabola:
    case CurveClass::CubicSpline:
      return p[0] > 0.0;
    default:
      return p[0] != 0.0;
  }
}

template <typename Model>
void fit_model(const std::vector<detail::WhitePoint>& points, double unit, int max_iterations,
               SemiSignatureFit& fit) {
  using ModelFitter = detail::SemiSignatureFitter<Model>;
  constexpr int kShape = ModelFitter::kShape;
  const Eigen::Vector3d powers = unit_powers(fit.curve_class);
  const Eigen::Vector3d to_normal(std::pow(unit, -powers[0]), std::pow(unit, -powers[1]),
                                  std::pow(unit, -powers[2]));
  const double t_unit = std::pow(unit, parameter_power(fit.curve_class));
  const Eigen::Vector3d normal = to_normal.cwiseProduct(fit.parameters);
  typename ModelFitter::Global start;
  start << normal.head<kShape>(), fit.orientation;
  fit.places.clear();
  for (const detail::WhitePoint& point : points) {
    fit.places.push_back(local_parameter(fit.curve_class, normal,
                                         point.measured.tangent_angle - fit.orientation,
                                         point.measured.kappa, point.measured.kappa_s));
  }
  ModelFitter fitter(points, start, fit.places);
  fit.status = fitter.solve(max_iterations);
  if (fit.status == InvariantStatus::NotFinite) {
    return;
  }
  // At infinity every curve but an ellipse is straight: such a fit has no place and no pose.
  constexpr double kInfinitelyFar = 1e6;  // normalised: its powers leave nothing of a double
  const bool somewhere =
      std::all_of(fit.places.begin(), fit.places.end(),
                  [](const LocalParameter& place) { return std::abs(place.t) <= kInfinitelyFar; });
  if (fit.status == InvariantStatus::Ok && !somewhere) {
    fit.status = InvariantStatus::NotConverged;
  }
  fit.chi2 = fitter.chi2();
  const auto covariance = fitter.covariance();
  typename ModelFitter::Global back;
  back << to_normal.head<kShape>().cwiseInverse(), 1.0;
  for (int i = 0; i < kShape; ++i) {
    fit.parameters[i] = fitter.global()[i] * back[i];
  }
  fit.orientation = fitter.global()[kShape];
  for (int i = 0; i <= kShape; ++i) {
    for (int j = 0; j <= kShape; ++j) {
      fit.covariance(i, j) = covariance(i, j) * (back[i] * back[j]);
    }
  }
  if (fit.covariance.hasNaN()) {  // 0 times a power of the unit that has overflowed
    fit.covariance.setZero();
    fit.covariance.diagonal().head<kShape + 1>().setConstant(
        std::numeric_limits<double>::infinity());
  }
  for (LocalParameter& place : fit.places) {
    place.t *= t_unit;
  }
  canonicalise(fit);
  if (!fit.parameters.allFinite()) {
    fit.status = InvariantStatus::NotFinite;
  }
  if (fit.status == InvariantStatus::Ok && !in_class(fit.curve_class, fit.parameters)) {
    fit.status = InvariantStatus::NotThisClass;
  }
}

}  // namespace

SemiSignatureFit fit_semi_signature(CurveClass curve_class,
                                    std::span<const MeasuredGeometry> measured,
                                    const Eigen::Vector3d& start_parameters,
                                    double start_orientation, const SemiSignatureOptions& options) {
  SemiSignatureFit fit;
  fit.curve_class = curve_class;
  fit.parameters = start_parameters;
  fit.orientation = start_orientation;
  const int shape_count = static_cast<int>(parameter_letters(curve_class).size());
  const int count = static_cast<int>(measured.size());
  fit.dof = 2 * count - shape_count - 1;
  if (fit.dof < 0) {
    return fit;
  }
  const double scale = curvature_scale(measured);
  bool finite = start_parameters.allFinite() && std::isfinite(start_orientation);
  for (const MeasuredGeometry& point : measured) {
    finite = finite && is_finite(point);
  }
  if (!finite || !(scale > 0.0)) {
    fit.status = finite ? InvariantStatus::ZeroCurvature : InvariantStatus::NotFinite;
    return fit;
  }
  const double unit = 1.0 / scale;
  std::vector<detail::WhitePoint> points;
  points.reserve(measured.size());
  for (const MeasuredGeometry& point : measured) {
    detail::WhitePoint white{in_units_of(point, unit), Eigen::Matrix3d::Zero()};
    const double size = curvature_scale({&white.measured, 1});
    const Eigen::Vector3d floor =
        options.relative_floor *
        Eigen::Vector3d(1.0, size > 0.0 ? size : 1.0, size > 0.0 ? size * size : 1.0);
    Eigen::Matrix3d covariance = white.measured.covariance;
    covariance.diagonal() += floor.cwiseAbs2();
    Eigen::Matrix3d factor;
    if (!cholesky(covariance, &factor)) {
      fit.status = InvariantStatus::NotFinite;  // not a covariance
      return fit;
    }
    white.whitening = inverse_lower(factor);
    points.push_back(white);
  }
  switch (curve_class) {
    case CurveClass::Ellipse:
      fit_model<EllipseModel>(points, unit, options.max_iterations, fit);
      break;
    case CurveClass::Parabola:
      fit_model<ParabolaModel>(points, unit, options.max_iterations, fit);
      break;
    case CurveClass::Hyperbola:
      fit_model<HyperbolaModel>(points, unit, options.max_iterations, fit);
      break;
    case CurveClass::CubicalParabola:
      fit_model<CubicalParabolaModel>(points, unit, options.max_iterations, fit);
      break;
    case CurveClass::SemiCubicalParabola:
      fit_model<SemiCubicalParabolaModel>(points, unit, options.max_iterations, fit);
      break;
    case CurveClass::CubicSpline:
      fit_model<CubicSplineModel>(points, unit, options.max_iterations, fit);
      break;
    case CurveClass::Line:
    case CurveClass::Circle:
    case CurveClass::Unclassified:
      assert(false);
      break;
  }
  return fit;
}

}  // namespace palpate
