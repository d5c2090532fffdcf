#include "core/invariants/signature_fit/semi_signature_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/curves/length_powers.h"
#include "core/curves/pose2.h"
#include "core/invariants/signature_fit/canonical_models.h"
#include "core/invariants/signature_fit/semi_signature_fitter.h"
#include "core/numerics/matrices/small_cholesky.h"

namespace palpate {
namespace {

/// Converts a fit to the conventions of the class: a >= b, a > 0. The t and the orientation change
/// with it.
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

/// The place on a shape that explains a point best, and the chi-square that remains.
struct PlacedPoint {
  LocalParameter place;
  double chi2 = std::numeric_limits<double>::infinity();
};

template <typename Model>
PlacedPoint best_place(CurveClass curve_class, const detail::WhitePoint& point,
                       const Eigen::Vector3d& parameters, double orientation) {
  const MeasuredGeometry& m = point.measured;
  const double angle = m.tangent_angle - orientation;
  const ParameterCandidates candidates =
      candidate_parameters(curve_class, parameters, angle, m.kappa, m.kappa_s);
  PlacedPoint best;
  for (const double t : candidates.values()) {
    const auto model = geometry_of(Model::derivatives(parameters.data(), t));
    for (const int direction : {1, -1}) {
      const double half_turn = direction < 0 ? kPi : 0.0;
      const Eigen::Vector3d difference(wrap_angle(angle - half_turn - model.tangent_angle),
                                       m.kappa - direction * model.kappa,
                                       m.kappa_s - model.kappa_s);
      const double chi2 = (point.whitening * difference).squaredNorm();
      if (chi2 < best.chi2) {
        best = {{t, direction}, chi2};
      }
    }
  }
  return best;
}

/// Factors that convert a class's parameters to lengths of `unit`.
Eigen::Vector3d to_units_of(CurveClass curve_class, double unit) {
  const Eigen::Vector3d powers = length_powers(curve_class);
  return {std::pow(unit, -powers[0]), std::pow(unit, -powers[1]), std::pow(unit, -powers[2])};
}

/// The points in lengths of `unit` with their whitening matrices; empty if a covariance is not
/// positive definite.
std::vector<detail::WhitePoint> whitened(std::span<const MeasuredGeometry> measured, double unit,
                                         double relative_floor) {
  std::vector<detail::WhitePoint> points;
  points.reserve(measured.size());
  for (const MeasuredGeometry& point : measured) {
    detail::WhitePoint white{in_units_of(point, unit), Eigen::Matrix3d::Zero()};
    const double size = curvature_scale({&white.measured, 1});
    const Eigen::Vector3d floor = relative_floor * Eigen::Vector3d(1.0, size > 0.0 ? size : 1.0,
                                                                   size > 0.0 ? size * size : 1.0);
    Eigen::Matrix3d covariance = white.measured.covariance;
    covariance.diagonal() += floor.cwiseAbs2();
    Eigen::Matrix3d factor;
    if (!cholesky(covariance, &factor)) {
      return {};
    }
    white.whitening = inverse_lower(factor);
    points.push_back(white);
  }
  return points;
}

template <typename Model>
void fit_model(const std::vector<detail::WhitePoint>& points, double unit,
               const SemiSignatureOptions& options, SemiSignatureFit& fit) {
  using ModelFitter = detail::SemiSignatureFitter<Model>;
  constexpr int kShape = ModelFitter::kShape;
  const Eigen::Vector3d to_normal = to_units_of(fit.curve_class, unit);
  const double t_unit = std::pow(unit, length_power_of_t(fit.curve_class));
  const Eigen::Vector3d normal = to_normal.cwiseProduct(fit.parameters);
  typename ModelFitter::Global start;
  start << normal.head<kShape>(), fit.orientation;
  fit.places.clear();
  for (const detail::WhitePoint& point : points) {
    fit.places.push_back(best_place<Model>(fit.curve_class, point, normal, fit.orientation).place);
  }
  ModelFitter fitter(points, start, options, fit.places);
  fit.status = fitter.solve();
  if (fit.status == InvariantStatus::NotFinite) {
    return;
  }
  // At infinity every curve except an ellipse is straight: such a fit has no place and no pose.
  constexpr double kInfinitelyFar = 1e6;  // normalised; its powers exhaust the digits of a double
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
  if (fit.covariance.hasNaN()) {  // 0 times a power of the unit that overflowed
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

void keep_better(SemiSignatureFit fit, SemiSignatureFit& best) {
  const bool fit_ok = fit.status == InvariantStatus::Ok;
  const bool best_ok = best.status == InvariantStatus::Ok;
  if (fit.status != InvariantStatus::NotFinite &&
      (fit_ok == best_ok ? fit.chi2 < best.chi2 : fit_ok)) {
    best = std::move(fit);
  }
}

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
  const std::vector<detail::WhitePoint> points = whitened(measured, unit, options.relative_floor);
  if (points.size() != measured.size()) {
    fit.status = InvariantStatus::NotFinite;
    return fit;
  }
  with_model(curve_class,
             [&](auto model) { fit_model<decltype(model)>(points, unit, options, fit); });
  return fit;
}

std::vector<CurveStart> best_starts(CurveClass curve_class,
                                    std::span<const MeasuredGeometry> measured,
                                    std::vector<CurveStart> starts, std::size_t keep,
                                    const SemiSignatureOptions& options) {
  const double scale = curvature_scale(measured);
  if (!(scale > 0.0) || starts.size() <= 1) {
    return starts;
  }
  const double unit = 1.0 / scale;
  const Eigen::Vector3d to_normal = to_units_of(curve_class, unit);
  const std::vector<detail::WhitePoint> points = whitened(measured, unit, options.relative_floor);
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const Eigen::Vector3d normal = to_normal.cwiseProduct(starts[i].parameters);
    double left = 0.0;
    with_model(curve_class, [&](auto model) {
      for (const detail::WhitePoint& point : points) {
        left += std::log1p(
            best_place<decltype(model)>(curve_class, point, normal, starts[i].orientation).chi2);
      }
    });
    order.emplace_back(left, i);
  }
  std::sort(order.begin(), order.end());
  order.resize(std::min(order.size(), keep));
  std::vector<CurveStart> best;
  best.reserve(order.size());
  for (const auto& [left, i] : order) {
    best.push_back(starts[i]);
  }
  return best;
}

}  // namespace palpate
