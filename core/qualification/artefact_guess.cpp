#include "core/qualification/artefact_guess.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/quantile.h"
#include "core/recognition/given/given_class.h"

namespace palpate {

std::vector<ArtefactSample> thinned(const ArtefactRecording& recording, std::size_t most) {
  std::vector<ArtefactSample> all;
  for (const ArtefactStroke& stroke : recording.strokes) {
    for (const ContactSample& sample : stroke.samples) {
      ArtefactSample& added = all.emplace_back();
      added.position_m = sample.position_m;
      added.tip_radius_m = stroke.tip_radius_m;
    }
  }
  if (all.size() <= most) return all;
  std::vector<ArtefactSample> some;
  for (std::size_t i = 0; i < most; ++i) some.push_back(all[i * all.size() / most]);
  return some;
}

double scatter(const Curve& artefact, MaterialSign material, const Pose2& pose,
               const std::vector<ArtefactSample>& samples) {
  std::vector<double> distances;
  distances.reserve(samples.size());
  for (const ArtefactSample& sample : samples) {
    distances.push_back(beside(artefact, material, pose, sample).distance_m);
  }
  const double middle = median_of(distances);
  for (double& distance : distances) distance = std::abs(distance - middle);
  return median_of(distances);
}

std::optional<Pose2> rough_pose(const Curve& artefact, const std::vector<ArtefactSample>& samples) {
  std::vector<GivenPoint> points;
  for (const ArtefactSample& sample : samples) {
    points.emplace_back().position_m = sample.position_m;
  }
  const GivenFit fit = fit_given_class(class_of(artefact), points);
  if (!has_curve(fit)) {
    return std::nullopt;
  }
  std::optional<Pose2> best;
  double least = std::numeric_limits<double>::infinity();
  for (const double turn : {0.0, 0.5 * kPi}) {
    Pose2 pose = fit.world_T_curve;
    pose.theta = wrap_angle(pose.theta + turn);
    const double here = scatter(artefact, 1, pose, samples);
    if (here < least) {
      least = here;
      best = pose;
    }
  }
  return best;
}

MaterialSign side_of(const Curve& artefact, const Pose2& pose,
                     const std::vector<ArtefactSample>& samples, bool bore) {
  std::vector<double> outside;
  std::vector<double> inside;
  bool tips = false;
  for (const ArtefactSample& sample : samples) {
    outside.push_back(std::abs(beside(artefact, 1, pose, sample).distance_m));
    inside.push_back(std::abs(beside(artefact, -1, pose, sample).distance_m));
    tips = tips || sample.tip_radius_m > 0.0;
  }
  if (!tips) return bore ? -1 : 1;
  return median_of(outside) <= median_of(inside) ? 1 : -1;
}

}  // namespace palpate
