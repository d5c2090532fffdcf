#include "tests/support/canonical_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "core/curves/length_powers.h"
#include "core/invariants/signature_fit/canonical_models.h"
#include "tests/support/test_rng.h"

namespace palpate::test {
namespace {

template <typename Function>
auto with_model(CurveClass curve_class, Function&& function) {
  switch (curve_class) {
    case CurveClass::Ellipse:
      return function(EllipseModel());
    case CurveClass::Parabola:
      return function(ParabolaModel());
    case CurveClass::Hyperbola:
      return function(HyperbolaModel());
    case CurveClass::CubicalParabola:
      return function(CubicalParabolaModel());
    case CurveClass::SemiCubicalParabola:
      return function(SemiCubicalParabolaModel());
    case CurveClass::CubicSpline:
      return function(CubicSplineModel());
    default:
      throw std::logic_error("no canonical model");
  }
}

}  // namespace

std::span<const CurveClass> invariant_classes() {
  static constexpr std::array kClasses = {CurveClass::Ellipse,
                                          CurveClass::Parabola,
                                          CurveClass::Hyperbola,
                                          CurveClass::CubicalParabola,
                                          CurveClass::SemiCubicalParabola,
                                          CurveClass::CubicSpline};
  return kClasses;
}

PlacedCurve random_curve(CurveClass curve_class, std::mt19937_64& rng) {
  PlacedCurve curve;
  curve.curve_class = curve_class;
  curve.world_T_curve = {uniform(rng, -5.0, 5.0), uniform(rng, -5.0, 5.0), uniform(rng, -kPi, kPi)};
  const double a = uniform(rng, 0.7, 2.0);
  switch (curve_class) {
    case CurveClass::Ellipse:
      curve.parameters = {a, a * uniform(rng, 0.3, 0.85), 0.0};
      break;
    case CurveClass::Parabola:
      curve.parameters = {a, 0.0, 0.0};
      break;
    case CurveClass::Hyperbola:
      curve.parameters = {a, uniform(rng, 0.5, 2.0), 0.0};
      break;
    case CurveClass::CubicalParabola:
      curve.parameters = {a * random_sign(rng), uniform(rng, -1.0, 1.0), 0.0};
      break;
    case CurveClass::SemiCubicalParabola:
      curve.parameters = {a, uniform(rng, -1.0, 1.0), 0.0};
      break;
    default:
      curve.parameters = {a, uniform(rng, -1.0, 1.0), random_sign(rng) * uniform(rng, 0.3, 1.5)};
      break;
  }
  return curve;
}

std::vector<double> random_places(const PlacedCurve& curve, int count, std::mt19937_64& rng) {
  double low = -1.2;
  double high = 1.2;
  double least = 0.0;  // smallest distance from t = 0
  if (curve.curve_class == CurveClass::Ellipse) {
    low = 0.0;
    high = 2.0 * kPi;
  } else if (curve.curve_class == CurveClass::SemiCubicalParabola) {
    least = 0.15;  // away from the cusp
  }
  // One in each of `count` equal parts, so that no two coincide.
  std::vector<double> places;
  for (int i = 0; i < count; ++i) {
    const double width = (high - low) / count;
    const double t = low + width * (i + uniform(rng, 0.15, 0.85));
    places.push_back(std::abs(t) < least ? std::copysign(least, t) : t);
  }
  std::shuffle(places.begin(), places.end(), rng);
  return places;
}

LocalEstimate exact_estimate(const PlacedCurve& curve, double t, int direction) {
  return with_model(curve.curve_class, [&](auto model) {
    using Model = decltype(model);
    const double* p = curve.parameters.data();
    const auto geometry = geometry_of(Model::derivatives(p, t));
    const auto position = Model::position(p, t);
    LocalEstimate estimate;
    estimate.position = curve.world_T_curve * Vec2(position.x, position.y);
    estimate.tangent_angle = wrap_angle(curve.world_T_curve.theta + geometry.tangent_angle +
                                        (direction < 0 ? kPi : 0.0));
    estimate.kappa = direction * geometry.kappa;
    estimate.kappa_s = geometry.kappa_s;
    return estimate;
  });
}

std::vector<TreePoint> exact_points(const PlacedCurve& curve, std::span<const double> places,
                                    std::mt19937_64& rng) {
  std::vector<TreePoint> points;
  for (const double t : places) {
    points.push_back({exact_estimate(curve, t, random_sign(rng) < 0.0 ? -1 : 1),
                      static_cast<int>(points.size())});
  }
  return points;
}

std::vector<MeasuredGeometry> measured(std::span<const TreePoint> points) {
  std::vector<MeasuredGeometry> result;
  for (const TreePoint& point : points) {
    result.push_back(measured_geometry(point.estimate, point.patch));
  }
  return result;
}

PlacedCurve scaled(const PlacedCurve& curve, double factor) {
  PlacedCurve result = curve;
  const Eigen::Vector3d powers = length_powers(curve.curve_class);
  for (int i = 0; i < 3; ++i) {
    result.parameters[i] *= std::pow(factor, powers[i]);
  }
  result.world_T_curve.x *= factor;
  result.world_T_curve.y *= factor;
  return result;
}

}  // namespace palpate::test
