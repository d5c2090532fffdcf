#include "tests/support/closed_spline_part.h"

#include <cmath>

#include "tests/support/shared_errors.h"

namespace palpate::test {

ClosedSpline paper_part() {
  return ClosedSpline(
      {{0.030, 0.000}, {0.012, 0.034}, {-0.032, 0.022}, {-0.028, -0.024}, {0.010, -0.030}});
}

ClosedSpline symmetric_part(int points) {
  std::vector<Vec2> control;
  for (int i = 0; i < points; ++i) {
    const double angle = 2.0 * kPi * i / points;
    control.emplace_back(0.04 * std::cos(angle), 0.04 * std::sin(angle));
  }
  return ClosedSpline(std::move(control));
}

TouchedPart touch(const ClosedSpline& part, const Pose2& world_T_part,
                  const std::vector<PartStroke>& strokes, double noise_m, double sigma_m,
                  std::mt19937_64& rng, double tip_radius_m, double correlation) {
  std::normal_distribution<double> normal;
  const double outside = part.signed_area() > 0.0 ? -1.0 : 1.0;
  TouchedPart touched;
  for (const PartStroke& stroke : strokes) {
    StoredPatch patch;
    patch.context.patch = static_cast<std::uint32_t>(touched.patches.size());
    patch.context.tip_radius_m = tip_radius_m;
    std::vector<double> places;
    SharedErrors errors(correlation);
    for (int i = 0; i < stroke.count; ++i) {
      const double t =
          part.parameter_at_arc_length(stroke.t0, stroke.arc_m * i / (stroke.count - 1));
      const CurveDerivatives d = part.derivatives(t);
      const Vec2 surface = d.position + outside * tip_radius_m * left_of(d.first.normalized());
      const Vec2 place = world_T_part * surface + noise_m * errors.next(normal, rng);
      patch.samples.push_back({place, sigma_m, 1.0});
      places.push_back(t);
    }
    touched.patches.push_back(std::move(patch));
    touched.t.push_back(std::move(places));
  }
  return touched;
}

Pose2 random_pose(std::mt19937_64& rng) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const double x = uniform(rng);
  const double y = uniform(rng);
  return {x, y, kPi * uniform(rng)};
}

}  // namespace palpate::test
