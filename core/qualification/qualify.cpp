#include "core/qualification/qualify.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/numerics/quantile.h"
#include "core/qualification/artefact_guess.h"
#include "core/qualification/estimated_tip.h"
#include "core/qualification/explained_samples.h"
#include "core/qualification/offset_evidence.h"
#include "core/qualification/offset_fit.h"
#include "core/qualification/setup_constants.h"

namespace palpate {
namespace {

/// Gap between normals beyond which a direction counts as not touched. Twelve touches evenly around
/// leave no gap, whatever their noise. [rad]
constexpr double kGap = 1.01 * kPi / 6.0;

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

/// A probe has one tip, and its file one radius.
bool is_of_one_tip(std::span<const ArtefactRecording> recordings) {
  std::optional<double> radius_m;
  for (const ArtefactRecording& recording : recordings) {
    for (const ArtefactStroke& stroke : recording.strokes) {
      if (radius_m.value_or(stroke.tip_radius_m) != stroke.tip_radius_m) return false;
      radius_m = stroke.tip_radius_m;
    }
  }
  return true;
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

/// A part of each recording's samples, enough for its pose. nullopt if one has too few.
std::optional<std::vector<std::vector<ArtefactSample>>> thinned(
    std::span<const ArtefactRecording> recordings) {
  // Three of a pose, the constant, the noise, and about as many again to test them.
  constexpr std::size_t kFewest = 12;
  constexpr std::size_t kEnoughForPose = 1000;  // leaves a thirtieth of the noise
  std::vector<std::vector<ArtefactSample>> thin;
  for (const ArtefactRecording& recording : recordings) {
    thin.push_back(thinned(recording, kEnoughForPose));
    if (thin.back().size() < kFewest) return std::nullopt;
  }
  return thin.empty() ? std::nullopt : std::optional(std::move(thin));
}

/// nullopt if one of them does not lie on the artefact.
std::optional<std::vector<Pose2>> rough_poses(
    const Curve& artefact, const std::vector<std::vector<ArtefactSample>>& thin) {
  std::vector<Pose2> poses;
  for (const auto& samples : thin) {
    const std::optional<Pose2> pose = rough_pose(artefact, samples);
    if (!pose) return std::nullopt;
    poses.push_back(*pose);
  }
  return poses;
}

/// How far samples are off the artefact at most, in the mean of a recording. [m]
double largest_scatter_m(const Artefact& artefact, const std::vector<Pose2>& poses,
                         const std::vector<std::vector<ArtefactSample>>& thin) {
  double scale_m = 0.0;
  for (std::size_t i = 0; i < thin.size(); ++i) {
    scale_m = std::max(scale_m, scatter(artefact.curve, artefact.material, poses[i], thin[i]));
  }
  return scale_m;
}

/// What the samples tell of the probe, beside the unknowns of the fit.
struct WeighedOffset {
  OffsetEvidence evidence;
  double lag_variance_m2 = 0.0;
  Estimate setup_m;              ///< 0 of one set-up
  bool both_directions = false;  ///< of travel: a lag shows
};

/// Takes the order of the offset, and its noise, from its evidence, and fits offset, lag and
/// set-ups under that noise. nullopt where a fit fails.
std::optional<WeighedOffset> weighed(const Artefact& artefact, bool same_setup,
                                     ExplainedSamples* on) {
  OffsetUnknowns& unknowns = on->unknowns;
  const std::vector<ArtefactSample>& samples = on->ground.samples;
  const auto residuals = [&](int order) {
    return residuals_about(artefact.curve, artefact.material, samples, unknowns, order);
  };
  const auto told = [&](Eigen::VectorXd residual_m, const OffsetResiduals& about) {
    return OffsetModel{std::move(residual_m), about.flat, about.basis,      on->ground.strokes,
                       on->ground.arc_m,      on->used,   on->least_scale_m};
  };
  // The prior that served to compare the orders must not pull the result towards 0. Ten times as
  // wide, it reduces a harmonic of that size by at most a tenth of its standard deviation.
  constexpr double kWide = 10.0;
  constexpr int kRounds = 2;  // the second has a lag, if there are harmonics to show it
  WeighedOffset result;
  result.both_directions = runs_both_ways(samples);
  for (int round = 0; round < kRounds; ++round) {
    const OffsetResiduals about = residuals(on->highest_order);
    const Eigen::Index known = offset_coefficients(unknowns.offset.order);
    auto evidence = weigh_offsets(told(
        about.residual_m + about.basis.leftCols(known) * unknowns.offset.coefficients_m, about));
    if (!evidence) return std::nullopt;
    result.evidence = *std::move(evidence);
    set_order(unknowns, result.evidence.order);
    const bool lag = result.both_directions && result.evidence.order > 0;
    unknowns.lag_m = lag ? std::optional(unknowns.lag_m.value_or(0.0)) : std::nullopt;
    const KnownNoise noise{result.evidence.sigma_m.value, result.evidence.coherence,
                           on->ground.strokes, on->ground.arc_m, on->used};
    const double wide_m = kWide * result.evidence.harmonic_m;
    const auto lag_variance_m2 =
        fit_under_noise(artefact.curve, artefact.material, samples, noise, {wide_m}, unknowns);
    if (!lag_variance_m2) return std::nullopt;
    result.lag_variance_m2 = *lag_variance_m2;
    if (same_setup) continue;
    const OffsetResiduals left = residuals(result.evidence.order);
    const SetupConstants constants = constants_of(
        told(left.residual_m, left), result.evidence.coherence, result.evidence.sigma_m.value,
        unknowns.offset.coefficients_m, unknowns.setup_m, wide_m);
    // The constants of set-ups are expected to differ by as much as the offset does between
    // directions and along a stroke: nothing else is known beforehand.
    const SetupSpread setups = spread_of(
        constants, std::hypot(result.evidence.harmonic_m, result.evidence.deviation_m.value));
    settle_setups(constants.value_m, setups.constant_m, unknowns);
    result.setup_m = setups.elsewhere_m;
  }
  unknowns.offset.covariance_m2 = over_all_orders(unknowns.offset.covariance_m2, result.evidence);
  return result;
}

/// With an offset and a noise of its own size, a ring of another size, a wrong unit or no curve at
/// all fits anything.
bool can_be(const Curve& artefact, const ExplainedSamples& on, double sigma_m) {
  constexpr double kMostOff = 0.1;  // no probe is as bad
  // With lobes of its own size, a circle is any oval. A probe whose lobes are a hundredth of what
  // it touches measures nothing there: no answer is RECOGNIZED with such a noise.
  constexpr double kLargestLobe = 0.01;
  const double radius_m = radius_of(artefact, on.ground, on.unknowns.poses);
  return std::abs(on.unknowns.offset.coefficients_m[0]) <= kMostOff * radius_m &&
         sigma_m <= kMostOff * radius_m &&
         largest_lobe_m(on.unknowns.offset) <= kLargestLobe * radius_m;
}

/// The probe as its samples tell it, the tip as stated.
ProbeCharacter probe_of(const ExplainedSamples& on, const WeighedOffset& weighed) {
  ProbeCharacter probe;
  probe.setup_m = weighed.setup_m;
  probe.tip_radius_m = on.ground.samples.front().tip_radius_m;
  probe.offset = on.unknowns.offset;
  probe.sigma_m = weighed.evidence.sigma_m;
  probe.deviation_m = weighed.evidence.deviation_m;
  probe.deviation_length_m = weighed.evidence.deviation_length_m;
  const auto spikes = static_cast<std::size_t>(std::count(on.used.begin(), on.used.end(), 0));
  probe.spike_probability = rate_of(spikes, on.used.size());
  if (on.unknowns.lag_m) {
    probe.lag_m = Estimate{*on.unknowns.lag_m, std::sqrt(weighed.lag_variance_m2)};
  }
  return probe;
}

/// Tells each sample's offset and residual, and how well the directions are covered. `estimated_m`:
/// what was added to the tip's radius.
void tell_samples(const Artefact& artefact, const ExplainedSamples& on, double estimated_m,
                  Qualification* result) {
  const OffsetUnknowns& unknowns = on.unknowns;
  const OffsetResiduals about = residuals_about(artefact.curve, artefact.material,
                                                on.ground.samples, unknowns, unknowns.offset.order);
  std::vector<double> touched;
  for (std::size_t i = 0; i < on.ground.samples.size(); ++i) {
    const ArtefactSample& sample = on.ground.samples[i];
    const double residual = about.residual_m[static_cast<Eigen::Index>(i)];
    const double offset =
        setup_of(unknowns, sample) +
        about.basis.row(static_cast<Eigen::Index>(i)).dot(unknowns.offset.coefficients_m);
    result->samples.push_back({sample.recording, sample.stroke, sample.number,
                               about.normal_angle[i], residual + offset - estimated_m, residual,
                               on.used[i] == 0});
    if (on.used[i] != 0) {
      touched.push_back(about.normal_angle[i]);
      result->worst_offset_deviation_m =
          std::max(result->worst_offset_deviation_m,
                   offset_deviation_at(unknowns.offset, about.normal_angle[i]));
    }
  }
  result->untouched = gaps_between(std::move(touched));
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
    case QualificationStatus::SeveralTips:
      return "several tips";
  }
  return "unknown";
}

Qualification qualify(const Curve& artefact, std::span<const ArtefactRecording> recordings,
                      const QualificationOptions& options) {
  if (!is_usable(recordings)) return failed(QualificationStatus::NotFinite);
  if (!is_of_one_tip(recordings)) return failed(QualificationStatus::SeveralTips);
  if (class_of(artefact) == CurveClass::Line) return failed(QualificationStatus::BadArtefact);
  const auto thin = thinned(recordings);
  if (!thin) return failed(QualificationStatus::TooFewSamples);
  auto poses = rough_poses(artefact, *thin);
  if (!poses) return failed(QualificationStatus::NotTheArtefact);
  const Artefact on{artefact, side_of(artefact, poses->front(), thin->front(), options.bore)};
  const double scale_m = largest_scatter_m(on, *poses, *thin);
  auto found = explained_samples(on, recordings, *std::move(poses), scale_m, options.same_setup);
  const auto told = found ? weighed(on, options.same_setup, &*found) : std::nullopt;
  if (!told || !can_be(artefact, *found, told->evidence.sigma_m.value)) {
    return failed(QualificationStatus::NotTheArtefact);
  }
  Qualification result;
  const ProbeCharacter stated = probe_of(*found, *told);
  result.probe = with_estimated_tip(stated);
  const double estimated_m = result.probe.tip_radius_m - stated.tip_radius_m;
  result.tip_is_estimated = estimated_m > 0.0;
  result.both_directions = told->both_directions;
  result.poses = found->unknowns.poses;
  result.order_probabilities = told->evidence.probabilities;
  result.bore = on.material < 0;
  tell_samples(on, *found, estimated_m, &result);
  result.rather_another_size = is_rather_another_size(result);
  result.status = verdict_of(result);
  return result;
}

}  // namespace palpate
