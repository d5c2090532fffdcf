#include "core/qualification/explained_samples.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/numerics/probability/normal_law.h"
#include "core/numerics/quantile.h"

namespace palpate {
namespace {

/// Probability that a recording without spikes loses a sample to spike detection.
constexpr double kFalseSpikes = 0.01;

double median_size(const Eigen::VectorXd& values) {
  std::vector<double> sizes(values.data(), values.data() + values.size());
  for (double& size : sizes) size = std::abs(size);
  return median_of(sizes);
}

Ground ground_of(const Curve& artefact, std::span<const ArtefactRecording> recordings,
                 const std::vector<Pose2>& poses) {
  Ground ground;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const PlacedSamples placed = place_samples(artefact, recordings[i], i, poses[i]);
    const auto begin = static_cast<Eigen::Index>(ground.samples.size());
    for (const StrokePlaces& stroke : placed.strokes) {
      ground.strokes.push_back({begin + stroke.begin, begin + stroke.end});
    }
    ground.samples.insert(ground.samples.end(), placed.samples.begin(), placed.samples.end());
  }
  for (const ArtefactSample& sample : ground.samples) ground.arc_m.push_back(sample.arc_m);
  return ground;
}

/// One flag per sample: 1 unless its residual exceeds normal noise with the size of the median
/// residual.
std::vector<char> within_noise(const Eigen::VectorXd& residuals, double least_scale,
                               double false_probability) {
  const double scale = std::max(median_size(residuals) / kMedianOfNormal, least_scale);
  const double most =
      scale * two_sided_normal_quantile(false_probability / static_cast<double>(residuals.size()));
  std::vector<char> used;
  for (const double residual : residuals) used.push_back(std::abs(residual) <= most ? 1 : 0);
  return used;
}

/// First guess of the set-up of each recording: its median residual.
void guess_setups(const Ground& ground, const Eigen::VectorXd& residual_m,
                  OffsetUnknowns& unknowns) {
  for (std::size_t r = 0; r < unknowns.setup_m.size(); ++r) {
    std::vector<double> own;
    for (std::size_t i = 0; i < ground.samples.size(); ++i) {
      if (ground.samples[i].recording == r) {
        own.push_back(residual_m[static_cast<Eigen::Index>(i)]);
      }
    }
    unknowns.setup_m[r] += median_of(own);
  }
}

/// Of samples without any noise: the rounding of positions of their size. [m]
double least_scale_m(const std::vector<ArtefactSample>& samples) {
  double size_m = 0.0;
  for (const ArtefactSample& sample : samples) {
    size_m = std::max(size_m, sample.position_m.cwiseAbs().maxCoeff());
  }
  return 1e-12 * size_m;
}

}  // namespace

void set_order(OffsetUnknowns& unknowns, int order) {
  const Eigen::VectorXd before = unknowns.offset.coefficients_m;
  const Eigen::Index count = offset_coefficients(order);
  unknowns.offset.order = order;
  unknowns.offset.coefficients_m = Eigen::VectorXd::Zero(count);
  const Eigen::Index kept = std::min(count, before.size());
  unknowns.offset.coefficients_m.head(kept) = before.head(kept);
}

std::optional<ExplainedSamples> explained_samples(const Artefact& artefact,
                                                  std::span<const ArtefactRecording> recordings,
                                                  std::vector<Pose2> poses, double scale_m,
                                                  bool same_setup) {
  ExplainedSamples found;
  found.ground = ground_of(artefact.curve, recordings, poses);
  found.unknowns.poses = std::move(poses);
  const auto count = static_cast<int>(found.ground.samples.size());
  found.highest_order =
      std::clamp((count / 4 - 3 * static_cast<int>(recordings.size())) / 2 + 1, 1, kHighestOrder);
  found.least_scale_m = least_scale_m(found.ground.samples);
  set_order(found.unknowns, found.highest_order);
  if (!same_setup) found.unknowns.setup_m.assign(recordings.size(), 0.0);
  const auto residuals = [&] {
    return residuals_about(artefact.curve, artefact.material, found.ground.samples, found.unknowns,
                           found.highest_order);
  };
  OffsetResiduals about;
  // The scale of the first round is that of the residuals at the start; the second round has that
  // of the noise.
  constexpr int kRobustRounds = 3;
  for (int round = 0; round < kRobustRounds; ++round) {
    scale_m = std::max(scale_m, found.least_scale_m);
    if (!fit_robustly(artefact.curve, artefact.material, found.ground.samples, scale_m,
                      {4.0 * scale_m}, found.unknowns)) {
      return std::nullopt;
    }
    found.ground = ground_of(artefact.curve, recordings, found.unknowns.poses);
    about = residuals();
    if (found.unknowns.setup_m.size() > 1) {
      guess_setups(found.ground, about.residual_m, found.unknowns);
      about = residuals();
    }
    scale_m = median_size(about.residual_m) / kMedianOfNormal;
  }
  found.used = within_noise(about.residual_m, found.least_scale_m, kFalseSpikes);
  return found;
}

}  // namespace palpate
