#include "sim/contacts.h"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>

#include "sim/random.h"

namespace palpate::sim {
namespace {

constexpr double kDefaultRateHz = 1000.0;
constexpr std::size_t kDefaultBatchSamples = 10;
constexpr double kDefaultLiftOffS = 0.2;

double or_default(double value, double standard) { return value > 0.0 ? value : standard; }

double rate_of(const v1::SceneProbe& probe) { return or_default(probe.rate_hz(), kDefaultRateHz); }

/// The places that a patch touches, at equal arc lengths.
class PatchWalk {
 public:
  PatchWalk(const Shape& shape, const v1::SceneProbe& probe, const v1::ScenePatch& patch)
      : shape_(shape), rate_hz_(rate_of(probe)) {
    const double spacing = spacing_of(probe, patch);
    // If the spacing divides the arc except for rounding, the last sample is at its end.
    count_ = static_cast<std::size_t>(std::floor(patch.arc_m() / spacing * (1.0 + 1e-12))) + 1;
    step_ = patch.backwards() ? -spacing : spacing;
    t_ = patch.start_case() == v1::ScenePatch::kStartArcM
             ? parameter_at_arc_length(shape, 0.0, patch.start_arc_m())
             : patch.start_t();
  }

  std::size_t count() const { return count_; }
  double interval_s() const { return 1.0 / rate_hz_; }
  double t() const { return t_; }

  /// Each step starts from the place before. Over n samples the rounding adds up to n units in the
  /// last place of t, and the cost of a step stays constant.
  void advance() { t_ = parameter_at_arc_length(shape_, t_, step_); }

 private:
  const Shape& shape_;
  double rate_hz_;
  std::size_t count_ = 0;
  double step_ = 0.0;
  double t_ = 0.0;
};

/// +1 if the material lies to the left of increasing t, else -1.
double material_sign(const v1::Scene& scene) {
  return scene.material_side() == v1::MATERIAL_SIDE_RIGHT ? -1.0 : 1.0;
}

const v1::SceneNoise& noise_of(const v1::Scene& scene, const v1::SceneProbe& probe) {
  return probe.has_noise() ? probe.noise() : scene.noise();
}

bool has_covariance(const v1::SceneNoise& noise) { return noise.cov_xx_m2() > 0.0; }

/// Noise from a standard normal pair: the pair times sigma, or times a factor of the covariance.
Vec2 coloured(const Vec2& normal, const v1::SceneNoise& noise) {
  if (!has_covariance(noise)) return noise.sigma_m() * normal;
  const double xx = std::sqrt(noise.cov_xx_m2());
  const double yx = noise.cov_xy_m2() / xx;
  return {xx * normal.x(), yx * normal.x() + std::sqrt(noise.cov_yy_m2() - yx * yx) * normal.y()};
}

/// A position as the sensor reports it. Every sample draws the same random numbers whatever the
/// noise is, so that changing one kind of noise does not change the others.
struct Sensed {
  Vec2 position;
  bool lost = false;
};

Sensed sense(const Vec2& true_position, const v1::SceneNoise& noise, Random& random) {
  const Vec2 normal = random.normal_pair();
  const double spike_draw = random.uniform();
  const double direction = 2.0 * kPi * random.uniform();
  const double dropout_draw = random.uniform();
  Sensed sensed{true_position + coloured(normal, noise)};
  if (spike_draw < noise.spike_probability()) {
    sensed.position += noise.spike_m() * Vec2(std::cos(direction), std::sin(direction));
  }
  if (const double step = noise.quantization_m(); step > 0.0) {
    sensed.position = step * (sensed.position / step).array().round().matrix();
  }
  sensed.lost = dropout_draw < noise.dropout_probability();
  return sensed;
}

/// Drift along a patch. A correlation of exp(-distance / length) is that of a Markov chain: each
/// value depends on the one before only.
class Drift {
 public:
  Drift(const v1::SceneProbe& probe, Random& random) : probe_(probe), random_(random) {}

  double at(const Vec2& centre) {
    const double fresh = random_.normal_pair().x();
    const double kept = begun_ && probe_.drift_m() > 0.0
                            ? std::exp(-(centre - last_).norm() / probe_.drift_length_m())
                            : 0.0;
    begun_ = true;
    last_ = centre;
    drift_ = kept * drift_ + std::sqrt(1.0 - kept * kept) * probe_.drift_m() * fresh;
    return drift_;
  }

 private:
  const v1::SceneProbe& probe_;
  Random& random_;
  bool begun_ = false;
  Vec2 last_ = Vec2::Zero();
  double drift_ = 0.0;
};

/// Offset out of the material, by the direction of the normal.
double offset_of(const v1::SceneProbe& probe, const Vec2& outward) {
  double offset = probe.offset_m();
  const double phi = std::atan2(outward.y(), outward.x());
  for (const v1::ProbeHarmonic& lobe : probe.lobes()) {
    offset += lobe.cosine_m() * std::cos(lobe.order() * phi) +
              lobe.sine_m() * std::sin(lobe.order() * phi);
  }
  return offset;
}

/// A place of the tip.
struct TipPlace {
  Vec2 centre;           ///< in the shape's frame
  Vec2 outward;          ///< unit normal out of the material
  double stretch = 1.0;  ///< length of the tip's path divided by that of the surface
};

TipPlace tip_at(const Shape& shape, double t, double side, double radius) {
  const ShapePoint place = point_at(shape, t);
  const Vec2 outward = -side * left_of(place.first.normalized());
  return {place.position + radius * outward, outward, 1.0 + side * radius * curvature(place)};
}

/// What the sensor reports besides the position.
SampleDetail measured(const Vec2& outward, const v1::SceneNoise& noise, Random& random) {
  SampleDetail detail;
  if (noise.normal_sigma_rad() > 0.0) {
    const double off = noise.normal_sigma_rad() * random.normal_pair().x();
    detail.normal = as_unit(Eigen::Rotation2Dd(off) * outward);
    detail.normal_sigma_rad = noise.normal_sigma_rad();
  }
  if (has_covariance(noise) && !noise.hide_sigma()) {
    detail.covariance_m2 = {noise.cov_xx_m2(), noise.cov_xy_m2(), noise.cov_yy_m2()};
  }
  return detail;
}

SimulatedPatch touch(const Scene& scene, const v1::SceneProbe& probe, const v1::ScenePatch& patch,
                     double start_s, Random& random, Random& drift_random, Random& normal_random) {
  const v1::SceneNoise& noise = noise_of(scene.description, probe);
  const double side = material_sign(scene.description);
  PatchWalk walk(scene.shape, probe, patch);
  SimulatedPatch touched;
  touched.side = (side > 0.0) == !patch.backwards() ? MaterialSide::Left : MaterialSide::Right;
  touched.side_is_reported = !probe.hide_material_side();
  touched.start_t = walk.t();
  touched.samples.reserve(walk.count());
  Drift drift(probe, drift_random);
  const double radius = probe.tip_radius_m();
  const double backwards = patch.backwards() ? -1.0 : 1.0;
  for (std::size_t i = 0; i < walk.count(); ++i) {
    if (i > 0) walk.advance();
    touched.end_t = walk.t();
    const TipPlace here = tip_at(scene.shape, walk.t(), side, radius);
    TipPlace reported = here;
    if (probe.lag_m() > 0.0 && here.stretch > 0.0) {
      reported = tip_at(
          scene.shape,
          parameter_at_arc_length(scene.shape, walk.t(), -backwards * probe.lag_m() / here.stretch),
          side, radius);
    }
    const Vec2 outward = scene.world_T_shape.rotate(here.outward);
    const double off = offset_of(probe, outward) + drift.at(here.centre);
    const Sensed sensed =
        sense(scene.world_T_shape * reported.centre + off * outward, noise, random);
    const SampleDetail detail = measured(outward, noise, normal_random);
    const bool coloured = detail.covariance_m2.x() > 0.0;
    const double sigma_m = coloured ? mean_sigma_m(detail.covariance_m2) : noise.sigma_m();
    if (!sensed.lost) {
      touched.samples.push_back({sensed.position, noise.hide_sigma() ? 0.0 : sigma_m,
                                 start_s + static_cast<double>(i) * walk.interval_s(), walk.t(),
                                 detail});
    }
  }
  return touched;
}

double duration_s(const Shape& shape, const v1::SceneProbe& probe, const v1::ScenePatch& patch) {
  const PatchWalk walk(shape, probe, patch);
  return static_cast<double>(walk.count() - 1) * walk.interval_s() +
         or_default(patch.lift_off_s(), kDefaultLiftOffS);
}

}  // namespace

double spacing_of(const v1::SceneProbe& probe, const v1::ScenePatch& patch) {
  return patch.pace_case() == v1::ScenePatch::kSpeedMPerS ? patch.speed_m_per_s() / rate_of(probe)
                                                          : patch.spacing_m();
}

std::vector<SimulatedProbe> simulate_contacts(const Scene& scene, std::uint64_t repetition) {
  std::vector<SimulatedProbe> probes;
  for (int i = 0; i < scene.description.probes_size(); ++i) {
    const v1::SceneProbe& described = scene.description.probes(i);
    const std::uint64_t stream = (repetition << 16) + static_cast<std::uint64_t>(i);
    Random random(scene.description.seed(), stream);
    // A stream of its own, so that a scene without drift keeps its samples.
    constexpr std::uint64_t kDriftStream = std::uint64_t{1} << 63;
    Random drift_random(scene.description.seed(), stream | kDriftStream);
    // Likewise for normals.
    constexpr std::uint64_t kNormalStream = std::uint64_t{1} << 62;
    Random normal_random(scene.description.seed(), stream | kNormalStream);
    SimulatedProbe probe;
    probe.name = described.name();
    probe.tip_radius_m = described.tip_radius_m();
    probe.batch_samples =
        described.batch_samples() > 0 ? described.batch_samples() : kDefaultBatchSamples;
    double start_s = described.start_s();
    for (const v1::ScenePatch& patch : described.patches()) {
      SimulatedPatch touched =
          touch(scene, described, patch, start_s, random, drift_random, normal_random);
      touched.number = static_cast<std::uint32_t>(probe.patches.size());
      start_s += duration_s(scene.shape, described, patch);
      probe.patches.push_back(std::move(touched));
    }
    probes.push_back(std::move(probe));
  }
  return probes;
}

std::string tip_trouble(const v1::Scene& scene, const Shape& shape, const v1::SceneProbe& probe,
                        const v1::ScenePatch& patch) {
  if (!(probe.tip_radius_m() > 0.0)) {
    return {};
  }
  // The tip is on the side without material. It cannot touch where the surface bends around it more
  // tightly than its own radius.
  const double side = material_sign(scene);
  PatchWalk walk(shape, probe, patch);
  for (std::size_t i = 0; i < walk.count(); ++i) {
    if (i > 0) walk.advance();
    const double towards_tip = -side * curvature(point_at(shape, walk.t()));
    if (!(towards_tip * probe.tip_radius_m() < 1.0)) {
      char text[120];
      std::snprintf(text, sizeof text,
                    "at t = %.6g the surface is too hollow for a tip of radius %.6g m", walk.t(),
                    probe.tip_radius_m());
      return text;
    }
  }
  return {};
}

}  // namespace palpate::sim
