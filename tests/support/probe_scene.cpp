#include "tests/support/probe_scene.h"

#include <algorithm>
#include <cmath>

namespace palpate::test {

ArtefactRecording simulate(const ProbeScene& scene, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  const ProbeCharacter& probe = scene.probe;
  const double lag = probe.lag_m ? probe.lag_m->value : 0.0;
  ArtefactRecording recording;
  for (int s = 0; s < scene.strokes; ++s) {
    ArtefactStroke stroke;
    stroke.tip_radius_m = scene.tip_radius_m;
    const double direction = s % 2 == 0 ? 1.0 : -1.0;
    double deviation = probe.deviation_m.value * normal(rng);
    Vec2 last = Vec2::Zero();
    for (int i = 0; i < scene.samples; ++i) {
      const double share = (i + 0.5) / scene.samples;
      const double t = scene.start_t + scene.arc_t * (direction > 0.0 ? share : 1.0 - share);
      const LocalGeometry local = geometry(scene.curve, t);
      // The tip's path is (1 + r kappa) times as long as the surface's.
      const double stretch = 1.0 + scene.tip_radius_m * local.kappa;
      const double t_behind = parameter_at_arc_length(scene.curve, t, -direction * lag / stretch);
      const LocalGeometry behind = geometry(scene.curve, t_behind);
      const auto normal_of = [&](const LocalGeometry& g) {
        const double angle = g.tangent_angle + scene.world_T_curve.theta - 0.5 * kPi;
        return Vec2(std::cos(angle), std::sin(angle));
      };
      const Vec2 centre = scene.world_T_curve * position(scene.curve, t_behind) +
                          scene.tip_radius_m * normal_of(behind);
      if (i > 0) {
        const double decay = std::exp(-(centre - last).norm() / probe.deviation_length_m.value);
        deviation = decay * deviation +
                    std::sqrt(1.0 - decay * decay) * probe.deviation_m.value * normal(rng);
      }
      last = centre;
      const Vec2 out = normal_of(local);
      Vec2 sample =
          centre + (offset_at(probe.offset, std::atan2(out.y(), out.x())) + deviation) * out;
      sample += probe.sigma_m.value * Vec2(normal(rng), normal(rng));
      if (uniform(rng) < probe.spike_probability.value) {
        const double angle = 2.0 * kPi * uniform(rng);
        sample += scene.spike_m * Vec2(std::cos(angle), std::sin(angle));
      }
      stroke.samples.push_back({sample, 0.0, 0});
    }
    recording.strokes.push_back(std::move(stroke));
  }
  return recording;
}

ProbeCharacter lobed_probe() {
  ProbeCharacter probe;
  probe.tip_radius_m = 2e-3;
  probe.offset.order = 3;
  probe.offset.coefficients_m.resize(offset_coefficients(3));
  probe.offset.coefficients_m << -3e-5, 4e-5, -2e-5, 1e-5, 1.5e-5;
  probe.sigma_m = {1e-5, 0.0};
  probe.deviation_m = {6e-6, 0.0};
  probe.deviation_length_m = {5e-3, 0.0};
  probe.spike_probability = {0.02, 0.0};
  probe.lag_m = Estimate{3e-4, 0.0};
  return probe;
}

}  // namespace palpate::test
