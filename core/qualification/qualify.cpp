#include "core/qualification/qualify.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/numerics/probability/normal_law.h"
#include "core/numerics/quantile.h"
#include "core/qualification/artefact_guess.h"
#include "core/qualification/estimated_tip.h"
#include "core/qualification/offset_evidence.h"
#include "core/qualification/offset_fit.h"
#include "core/qualification/setup_constants.h"

namespace palpate {
namespace {

/// The bending of a stylus and the three legs of a trigger sensor cause lobes of order 2, 3 and 6;
/// their overtones fall off.
constexpr int kHighestOrder = 8;
/// Gap between normals beyond which a direction counts as not touched. Twelve touches evenly around
/// leave no gap, whatever their noise. [rad]
constexpr double kGap = 1.01 * kPi / 6.0;
/// Probability that a recording without spikes loses a sample to spike detection.
constexpr double kFalseSpikes = 0.01;

double median_size(const Eigen::VectorXd& values) {
  std::vector<double> sizes(values.data(), values.data() + values.size());
  for (double& size : sizes) size = std::abs(size);
  return median_of(sizes);
}

bool is_usable(std::span<const ArtefactRecording> recordings) {
  for (const ArtefactRecording& recording : recordings) {
    for (const ArtefactStroke& stroke : recording.strokes) {
      if (!(std::isfinite(stroke.tip_radius_m) && stroke.tip_radius_m >= 0.0)) return false;
      for (const ContactSample& sample : stroke.samples) {
        if (!sample.position_m.allFinite()) return false;
      }
    }
  }
  return true;
}

/// The samples of all recordings in one sequence.
struct Ground {
  std::vector<ArtefactSample> samples;
  std::vector<StrokePlaces> strokes;
  std::vector<double> arc_m;
};

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

void set_order(OffsetUnknowns& unknowns, int order) {
  const Eigen::VectorXd before = unknowns.offset.coefficients_m;
  const Eigen::Index count = offset_coefficients(order);
  unknowns.offset.order = order;
  unknowns.offset.coefficients_m = Eigen::VectorXd::Zero(count);
  const Eigen::Index kept = std::min(count, before.size());
  unknowns.offset.coefficients_m.head(kept) = before.head(kept);
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

bool runs_both_ways(const std::vector<ArtefactSample>& samples) {
  // An even share determines the lag to 0.6 of the error of this one.
  constexpr double kLeastShare = 0.1;
  double forth = 0.0;
  double back = 0.0;
  for (const ArtefactSample& sample : samples) {
    forth += sample.travel > 0 ? 1.0 : 0.0;
    back += sample.travel < 0 ? 1.0 : 0.0;
  }
  return std::min(forth, back) > kLeastShare * static_cast<double>(samples.size());
}

/// [from, to] of every gap between neighbouring directions that is wider than kGap.
std::vector<std::pair<double, double>> gaps_between(std::vector<double> angles) {
  std::vector<std::pair<double, double>> gaps;
  std::sort(angles.begin(), angles.end());
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double next = i + 1 < angles.size() ? angles[i + 1] : angles.front() + 2.0 * kPi;
    if (next - angles[i] > kGap) gaps.emplace_back(angles[i], next);
  }
  return gaps;
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

/// Moves the common part of all recordings' constants into the offset.
void settle_setups(const Eigen::VectorXd& constants_m, double common_m, OffsetUnknowns& unknowns) {
  for (std::size_t r = 0; r < unknowns.setup_m.size(); ++r) {
    unknowns.setup_m[r] = constants_m[static_cast<Eigen::Index>(r)] - common_m;
  }
  unknowns.offset.coefficients_m[0] = common_m;
}

/// Median radius of curvature of the artefact over the touches.
double radius_of(const Curve& artefact, const Ground& ground, const std::vector<Pose2>& poses) {
  std::vector<double> bends;
  for (const ArtefactSample& sample : ground.samples) {
    const FootPoint foot =
        foot_point(artefact, poses[sample.recording].to_local(sample.position_m));
    bends.push_back(std::abs(geometry(artefact, foot.t).kappa));
  }
  return 1.0 / median_of(bends);
}

Estimate rate_of(std::size_t count, std::size_t of) {
  // Jeffreys' prior: a recording without spikes does not show that there are none.
  const double mean = (static_cast<double>(count) + 0.5) / (static_cast<double>(of) + 1.0);
  return {mean, std::sqrt(mean * (1.0 - mean) / (static_cast<double>(of) + 2.0))};
}

/// An artefact that is larger or smaller than stated moves the samples as an offset does.
bool is_rather_another_size(const Qualification& result) {
  // The usual tips differ by a fifth from one size to the next (diameters of 5 and 6 mm). Beyond
  // half of that the samples are nearer to those of another tip than of the stated one.
  constexpr double kMostOffTip = 0.1;
  return !result.tip_is_estimated && result.probe.tip_radius_m > 0.0 &&
         std::abs(result.probe.offset.coefficients_m[0]) > kMostOffTip * result.probe.tip_radius_m;
}

QualificationStatus verdict_of(const Qualification& result) {
  if (result.rather_another_size ||
      !(result.worst_offset_deviation_m <= result.probe.sigma_m.value)) {
    return QualificationStatus::Insufficient;
  }
  return result.untouched.empty() ? QualificationStatus::Sufficient : QualificationStatus::Partial;
}

Qualification failed(QualificationStatus status) {
  Qualification result;
  result.status = status;
  return result;
}

}  // namespace

std::string_view name_of(QualificationStatus status) {
  switch (status) {
    case QualificationStatus::Sufficient:
      return "sufficient";
    case QualificationStatus::Partial:
      return "partial";
    case QualificationStatus::Insufficient:
      return "insufficient";
    case QualificationStatus::NotFinite:
      return "not finite";
    case QualificationStatus::BadArtefact:
      return "bad artefact";
    case QualificationStatus::TooFewSamples:
      return "too few samples";
    case QualificationStatus::NotTheArtefact:
      return "not the artefact";
  }
  return "unknown";
}

Qualification qualify(const Curve& artefact, std::span<const ArtefactRecording> recordings,
                      const QualificationOptions& options) {
  if (!is_usable(recordings)) return failed(QualificationStatus::NotFinite);
  if (class_of(artefact) == CurveClass::Line) return failed(QualificationStatus::BadArtefact);
  // Three of a pose, the constant, the noise, and about as many again to test them.
  constexpr std::size_t kFewest = 12;
  std::vector<std::vector<ArtefactSample>> thin;
  for (const ArtefactRecording& recording : recordings) {
    constexpr std::size_t kEnoughForPose = 1000;  // leaves a thirtieth of the noise
    thin.push_back(thinned(recording, kEnoughForPose));
    if (thin.back().size() < kFewest) return failed(QualificationStatus::TooFewSamples);
  }
  if (thin.empty()) return failed(QualificationStatus::TooFewSamples);

  OffsetUnknowns unknowns;
  for (const auto& samples : thin) {
    const std::optional<Pose2> pose = rough_pose(artefact, samples);
    if (!pose) return failed(QualificationStatus::NotTheArtefact);
    unknowns.poses.push_back(*pose);
  }
  const MaterialSign material =
      side_of(artefact, unknowns.poses.front(), thin.front(), options.bore);

  // Spikes: with as many harmonics as possible, so that no harmonic is taken for spikes.
  Ground ground = ground_of(artefact, recordings, unknowns.poses);
  const auto count = static_cast<int>(ground.samples.size());
  const int highest =
      std::clamp((count / 4 - 3 * static_cast<int>(recordings.size())) / 2 + 1, 1, kHighestOrder);
  double scale = 0.0;
  for (std::size_t i = 0; i < thin.size(); ++i) {
    scale = std::max(scale, scatter(artefact, material, unknowns.poses[i], thin[i]));
  }
  // For samples without any noise: the rounding of positions of that size.
  double size = 0.0;
  for (const ArtefactSample& sample : ground.samples) {
    size = std::max(size, sample.position_m.cwiseAbs().maxCoeff());
  }
  const double least_scale = 1e-12 * size;
  set_order(unknowns, highest);
  if (!options.same_setup) unknowns.setup_m.assign(recordings.size(), 0.0);
  OffsetResiduals about;
  // The scale of the first round is that of the residuals at the start; the second round has that
  // of the noise.
  constexpr int kRobustRounds = 3;
  for (int round = 0; round < kRobustRounds; ++round) {
    scale = std::max(scale, least_scale);
    if (!fit_robustly(artefact, material, ground.samples, scale, {4.0 * scale}, unknowns)) {
      return failed(QualificationStatus::NotTheArtefact);
    }
    ground = ground_of(artefact, recordings, unknowns.poses);
    about = residuals_about(artefact, material, ground.samples, unknowns, highest);
    if (unknowns.setup_m.size() > 1) {
      guess_setups(ground, about.residual_m, unknowns);
      about = residuals_about(artefact, material, ground.samples, unknowns, highest);
    }
    scale = median_size(about.residual_m) / kMedianOfNormal;
  }
  const std::vector<char> used = within_noise(about.residual_m, least_scale, kFalseSpikes);

  Qualification result;
  result.both_directions = runs_both_ways(ground.samples);
  OffsetEvidence evidence;
  double lag_variance = 0.0;
  // The prior that served to compare the orders must not pull the result towards 0. Ten times as
  // wide, it reduces a harmonic of that size by at most a tenth of its standard deviation.
  constexpr double kWide = 10.0;
  constexpr int kRounds = 2;  // the second has a lag, if there are harmonics to show it
  for (int round = 0; round < kRounds; ++round) {
    about = residuals_about(artefact, material, ground.samples, unknowns, highest);
    const Eigen::Index known = offset_coefficients(unknowns.offset.order);
    const auto weighed = weigh_offsets(
        {about.residual_m + about.basis.leftCols(known) * unknowns.offset.coefficients_m,
         about.flat, about.basis, ground.strokes, ground.arc_m, used, least_scale});
    if (!weighed) return failed(QualificationStatus::NotTheArtefact);
    evidence = *weighed;
    set_order(unknowns, evidence.order);
    const bool lag = result.both_directions && evidence.order > 0;
    unknowns.lag_m = lag ? std::optional(unknowns.lag_m.value_or(0.0)) : std::nullopt;
    const KnownNoise noise{evidence.sigma_m.value, evidence.coherence, ground.strokes, ground.arc_m,
                           used};
    const auto fitted = fit_under_noise(artefact, material, ground.samples, noise,
                                        {kWide * evidence.harmonic_m}, unknowns);
    if (!fitted) return failed(QualificationStatus::NotTheArtefact);
    lag_variance = *fitted;
    if (options.same_setup) continue;
    about = residuals_about(artefact, material, ground.samples, unknowns, evidence.order);
    const SetupConstants constants =
        constants_of({about.residual_m, about.flat, about.basis, ground.strokes, ground.arc_m, used,
                      least_scale},
                     evidence.coherence, evidence.sigma_m.value, unknowns.offset.coefficients_m,
                     unknowns.setup_m, kWide * evidence.harmonic_m);
    // The constants of set-ups are expected to differ by as much as the offset does between
    // directions and along a stroke: nothing else is known beforehand.
    const SetupSpread setups =
        spread_of(constants, std::hypot(evidence.harmonic_m, evidence.deviation_m.value));
    settle_setups(constants.value_m, setups.constant_m, unknowns);
    result.probe.setup_m = setups.elsewhere_m;
  }
  unknowns.offset.covariance_m2 += evidence.spread_m2;
  about = residuals_about(artefact, material, ground.samples, unknowns, unknowns.offset.order);
  // With an offset and a noise of its own size, a ring of another size, a wrong unit or no curve at
  // all fits anything. No probe is as bad as a tenth of that.
  constexpr double kMostOff = 0.1;
  // With lobes of its own size, a circle is any oval. A probe whose lobes are a hundredth of what
  // it touches measures nothing there: no answer is RECOGNIZED with such a noise.
  constexpr double kLargestLobe = 0.01;
  const double radius = radius_of(artefact, ground, unknowns.poses);
  if (std::abs(unknowns.offset.coefficients_m[0]) > kMostOff * radius ||
      evidence.sigma_m.value > kMostOff * radius ||
      largest_lobe_m(unknowns.offset) > kLargestLobe * radius) {
    return failed(QualificationStatus::NotTheArtefact);
  }

  result.probe.tip_radius_m = ground.samples.front().tip_radius_m;
  result.probe.offset = unknowns.offset;
  result.probe.sigma_m = evidence.sigma_m;
  result.probe.deviation_m = evidence.deviation_m;
  result.probe.deviation_length_m = evidence.deviation_length_m;
  const auto spikes = static_cast<std::size_t>(std::count(used.begin(), used.end(), 0));
  result.probe.spike_probability = rate_of(spikes, used.size());
  if (unknowns.lag_m) result.probe.lag_m = Estimate{*unknowns.lag_m, std::sqrt(lag_variance)};
  const double nominal_m = result.probe.tip_radius_m;
  result.probe = with_estimated_tip(std::move(result.probe));
  const double estimated_m = result.probe.tip_radius_m - nominal_m;
  result.tip_is_estimated = estimated_m > 0.0;
  result.poses = unknowns.poses;
  result.order_probabilities = evidence.probabilities;
  result.bore = material < 0;
  std::vector<double> touched;
  for (std::size_t i = 0; i < ground.samples.size(); ++i) {
    const ArtefactSample& sample = ground.samples[i];
    const double residual = about.residual_m[static_cast<Eigen::Index>(i)];
    const double offset =
        setup_of(unknowns, sample) +
        about.basis.row(static_cast<Eigen::Index>(i)).dot(unknowns.offset.coefficients_m);
    result.samples.push_back({sample.recording, sample.stroke, sample.number, about.normal_angle[i],
                              residual + offset - estimated_m, residual, used[i] == 0});
    if (used[i] != 0) {
      touched.push_back(about.normal_angle[i]);
      result.worst_offset_deviation_m =
          std::max(result.worst_offset_deviation_m,
                   offset_deviation_at(unknowns.offset, about.normal_angle[i]));
    }
  }
  result.untouched = gaps_between(std::move(touched));
  result.rather_another_size = is_rather_another_size(result);
  result.status = verdict_of(result);
  return result;
}

}  // namespace palpate
