#include "tests/support/lone_touches.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/curves/curve.h"

namespace palpate::test {
namespace {

/// The tip's centre at that distance from the curve, positive to the left of increasing t.
Vec2 lifted(const Curve& curve, double t, double lift_m) {
  return position(curve, t) + lift_m * left_of(derivatives(curve, t).first.normalized());
}

/// Points along the stretch of the curve that contains these parameters. [m]
std::vector<Vec2> places_along(const Curve& curve, const std::vector<double>& t) {
  constexpr int kPlaces = 500;
  const auto [low, high] = std::minmax_element(t.begin(), t.end());
  std::vector<Vec2> along;
  for (int i = 0; i <= kPlaces; ++i) {
    along.push_back(position(curve, *low + (*high - *low) * i / kPlaces));
  }
  return along;
}

/// True if a tip fits there: no point of the curve is inside it, except within the tolerance for
/// the spacing of the points.
bool has_room(const std::vector<Vec2>& along, const Vec2& centre_m, double tip_radius_m) {
  constexpr double kTouching = 0.999;
  return std::none_of(along.begin(), along.end(), [&](const Vec2& place) {
    return (place - centre_m).norm() < kTouching * tip_radius_m;
  });
}

/// True if the touched stretch passes through one point twice, as no wall can: a spline with c < 0,
/// where x = t^2 and y(t) = y(-t) at a t^2 = -c.
bool crosses_itself(const Scene& scene) {
  if (scene.curve_class != CurveClass::CubicSpline || scene.values[2] >= 0.0) {
    return false;
  }
  const double crossing = std::sqrt(-scene.values[2] / scene.values[0]);
  const auto [low, high] = std::minmax_element(scene.t.front().begin(), scene.t.front().end());
  return *low < -crossing && crossing < *high;
}

}  // namespace

LoneTouches lone_touches(CurveClass curve_class, int count, double sigma_over_size,
                         double tip_over_size, std::mt19937_64& rng) {
  SceneOptions options;
  options.patches = 1;
  options.points_per_patch = 20 * count;
  options.sigma_over_size = sigma_over_size;
  // Next to a cusp, a patch is at most as long as one arm.
  const bool has_cusp = curve_class == CurveClass::SemiCubicalParabola;
  options.least_fraction = has_cusp ? 0.3 : 0.7;
  options.most_fraction = has_cusp ? 0.4 : 0.95;
  LoneTouches touches;
  do {
    touches.scene = random_scene(curve_class, options, rng);
  } while (tip_over_size > 0.0 && crosses_itself(touches.scene));
  touches.tip_radius_m = tip_over_size * options.size_m;
  const auto curve = make_curve(touches.scene.curve_class, touches.scene.values);
  const std::vector<Vec2> places = touches.scene.patches.front();
  const std::vector<double> t = touches.scene.t.front();
  double bend = 0.0;
  for (const double at : t) bend += geometry(*curve, at).kappa;
  // The side of increasing t on which the centres lie.
  const double side = bend >= 0.0 ? -1.0 : 1.0;
  std::vector<std::size_t> order(places.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  // A tip cannot touch where the curve bends around it more tightly than its radius, or where
  // another part of the curve is in its way.
  const std::vector<Vec2> along = places_along(*curve, t);
  std::erase_if(order, [&](std::size_t k) {
    constexpr double kRoom = 0.9;
    return touches.tip_radius_m > 0.0 &&
           (side * touches.tip_radius_m * geometry(*curve, t[k]).kappa > kRoom ||
            !has_room(along, lifted(*curve, t[k], side * touches.tip_radius_m),
                      touches.tip_radius_m));
  });
  std::shuffle(order.begin(), order.end(), rng);
  touches.scene.patches.clear();
  touches.scene.t.clear();
  order.resize(std::min(order.size(), static_cast<std::size_t>(count)));
  for (const std::size_t k : order) {
    const Vec2 normal = left_of(derivatives(*curve, t[k]).first.normalized());
    touches.normals.emplace_back(side * touches.scene.world_T_curve.rotate(normal));
    const Vec2 lift = touches.tip_radius_m * touches.normals.back();
    touches.scene.patches.push_back({places[k] + lift});
    touches.scene.t.push_back({t[k]});
  }
  return touches;
}

void add_touches(const LoneTouches& touches, double sigma_m, Recognizer* recognizer) {
  PatchContext context;
  context.tip_radius_m = touches.tip_radius_m;
  for (const auto& patch : touches.scene.patches) {
    const ContactSample sample{patch.front(), sigma_m, 0};
    recognizer->add(context, {&sample, 1});
    ++context.patch;
  }
}

void add_touches_with_normals(const LoneTouches& touches, double sigma_m, double normal_sigma_rad,
                              std::mt19937_64& rng, Recognizer* recognizer) {
  std::normal_distribution<double> law(0.0, normal_sigma_rad);
  PatchContext context;
  context.tip_radius_m = touches.tip_radius_m;
  for (const auto& patch : touches.scene.patches) {
    const ContactSample sample{patch.front(), sigma_m, 0};
    SampleDetail detail;
    detail.normal = Eigen::Rotation2Dd(law(rng)) * touches.normals[context.patch];
    detail.normal_sigma_rad = normal_sigma_rad;
    recognizer->add(context, {&sample, 1}, {&detail, 1});
    ++context.patch;
  }
}

}  // namespace palpate::test
