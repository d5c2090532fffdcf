#include "tests/support/touched_arc.h"

namespace palpate::test {

const std::vector<TouchedArc>& touched_arcs() {
  // Semi-cubical parabola and spline: parameters in metres of a curve of about 25 mm; they scale
  // with length to the powers (-1/2, 0, 1/2).
  static const std::vector<TouchedArc> arcs = {
      {"line", Line{}, {0.3, -0.1, 0.8}, 0.0, 0.022, 1},
      {"circle", Circle{0.020}, {0.1, 0.2, -2.0}, 1.0, 0.022, 1},
      {"ellipse", Ellipse{0.025, 0.0175}, {-0.2, 0.1, 2.4}, 0.7, 0.022, 1},
      {"parabola", Parabola{0.012}, {0.1, 0.3, -0.9}, 0.5, 0.022, -1},
      {"hyperbola", Hyperbola{0.025, 0.020}, {0.0, 0.4, 1.3}, 0.4, 0.022, 1},
      {"cubical_parabola", CubicalParabola{600.0, -0.3}, {0.2, 0.2, 0.4}, 0.016, 0.022, 1},
      {"semi_cubical_parabola", SemiCubicalParabola{4.0, -0.3}, {0.1, 0.0, 3.0}, 0.16, 0.022, -1},
      {"cubic_spline", CubicSpline{5.0, 0.4, -0.10}, {-0.1, 0.0, -1.7}, 0.16, 0.022, 1},
  };
  return arcs;
}

std::vector<Vec2> samples_of(const TouchedArc& arc, int count) {
  std::vector<Vec2> samples;
  for (int i = 0; i < count; ++i) {
    const double s = arc.direction * arc.length_m * (static_cast<double>(i) / (count - 1) - 0.5);
    const double t = parameter_at_arc_length(arc.curve, arc.centre_t, s);
    samples.push_back(arc.world_T_curve * position(arc.curve, t));
  }
  return samples;
}

std::vector<Vec2> with_noise(std::span<const Vec2> samples, double sigma_m, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  std::vector<Vec2> noisy;
  for (const Vec2& p : samples) {
    const double x = normal(rng);
    const double y = normal(rng);
    noisy.push_back(p + sigma_m * Vec2(x, y));
  }
  return noisy;
}

LocalEstimate truth_at(const TouchedArc& arc, const Vec2& world_point) {
  const FootPoint foot = foot_point(arc.curve, arc.world_T_curve.to_local(world_point));
  const LocalGeometry local = geometry(arc.curve, foot.t);
  LocalEstimate truth;
  truth.position = arc.world_T_curve * foot.position;
  truth.tangent_angle =
      wrap_angle(arc.world_T_curve.theta + local.tangent_angle + (arc.direction < 0 ? kPi : 0.0));
  truth.kappa = arc.direction * local.kappa;
  truth.kappa_s = local.kappa_s;
  return truth;
}

Eigen::Vector4d error_of(const LocalEstimate& estimate, const TouchedArc& arc) {
  const LocalEstimate truth = truth_at(arc, estimate.position);
  const Vec2 tangent(std::cos(truth.tangent_angle), std::sin(truth.tangent_angle));
  return {cross(tangent, estimate.position - truth.position),
          wrap_angle(estimate.tangent_angle - truth.tangent_angle), estimate.kappa - truth.kappa,
          estimate.kappa_s - truth.kappa_s};
}

}  // namespace palpate::test
