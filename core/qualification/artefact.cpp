#include "core/qualification/artefact.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate {
namespace {

/// Arc length of a closed curve; 0 for an open one.
double length_around(const Curve& artefact) {
  const ParameterDomain range = domain(artefact);
  return range.period > 0.0 ? std::abs(arc_length(artefact, 0.0, range.period)) : 0.0;
}

/// Places of consecutive samples; not wrapped where the curve closes.
struct Run {
  std::vector<double> arc_m;
  int travel = 0;
};

Run run_of(const Curve& artefact, const ArtefactStroke& stroke, const Pose2& pose, double around) {
  Run run;
  double forth = 0.0;
  double way = 0.0;
  double last = 0.0;
  for (std::size_t i = 0; i < stroke.samples.size(); ++i) {
    const FootPoint foot = foot_point(artefact, pose.to_local(stroke.samples[i].position_m));
    double arc = arc_length(artefact, 0.0, foot.t);
    if (i > 0) {
      double step = arc - last;
      if (around > 0.0) step = std::remainder(step, around);
      arc = run.arc_m.back() + step;
      forth += step;
      way += std::abs(step);
    }
    run.arc_m.push_back(arc);
    last = around > 0.0 ? std::remainder(arc, around) : arc;
  }
  // Noise along the path makes dense samples step back and forth, but a stroke still advances.
  constexpr double kLeastProgress = 0.05;
  if (way > 0.0 && std::abs(forth) > kLeastProgress * way) run.travel = forth > 0.0 ? 1 : -1;
  return run;
}

/// Appends samples in the order of their places, as one stroke.
void add_stroke(std::vector<ArtefactSample> samples, PlacedSamples& placed) {
  std::stable_sort(
      samples.begin(), samples.end(),
      [](const ArtefactSample& a, const ArtefactSample& b) { return a.arc_m < b.arc_m; });
  const auto begin = static_cast<Eigen::Index>(placed.samples.size());
  placed.samples.insert(placed.samples.end(), samples.begin(), samples.end());
  placed.strokes.push_back({begin, static_cast<Eigen::Index>(placed.samples.size())});
}

}  // namespace

SampleOnArtefact beside(const Curve& artefact, MaterialSign material, const Pose2& world_T_artefact,
                        const ArtefactSample& sample) {
  const FootPoint foot = foot_point(artefact, world_T_artefact.to_local(sample.position_m));
  const LocalGeometry local = geometry(artefact, foot.t);
  SampleOnArtefact beside;
  beside.distance_m = -material * foot.distance - sample.tip_radius_m;
  beside.normal_angle =
      wrap_angle(local.tangent_angle + world_T_artefact.theta - material * 0.5 * kPi);
  beside.normal = {std::cos(beside.normal_angle), std::sin(beside.normal_angle)};
  beside.turn_per_m =
      sample.travel * local.kappa / (1.0 + material * sample.tip_radius_m * local.kappa);
  // By the envelope theorem the motion of the foot does not change the distance.
  beside.by_angle = -beside.normal.dot(left_of(sample.position_m - world_T_artefact.translation()));
  return beside;
}

PlacedSamples place_samples(const Curve& artefact, const ArtefactRecording& recording,
                            std::size_t number, const Pose2& pose) {
  const double around = length_around(artefact);
  PlacedSamples placed;
  std::vector<ArtefactSample> alone;
  for (std::size_t s = 0; s < recording.strokes.size(); ++s) {
    const ArtefactStroke& stroke = recording.strokes[s];
    const Run run = run_of(artefact, stroke, pose, around);
    std::vector<ArtefactSample> samples;
    for (std::size_t i = 0; i < stroke.samples.size(); ++i) {
      double arc = run.arc_m[i];
      if (run.travel == 0 && around > 0.0) arc = std::remainder(arc, around);
      samples.push_back(
          {stroke.samples[i].position_m, stroke.tip_radius_m, arc, run.travel, number, s, i});
    }
    if (samples.size() == 1) {
      alone.push_back(samples.front());
    } else {
      add_stroke(std::move(samples), placed);
    }
  }
  if (!alone.empty()) add_stroke(std::move(alone), placed);
  return placed;
}

}  // namespace palpate
