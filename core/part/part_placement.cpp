#include "core/part/part_placement.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/part/part_fit.h"

namespace palpate {
namespace {

/// Whether t increases over the samples of a patch, across joints and the seam.
bool runs_up(std::span<const SamplePlace> places, std::size_t segments) {
  const auto period = static_cast<double>(segments);
  double run = 0.0;
  for (std::size_t i = 1; i < places.size(); ++i) {
    const auto t = [&](std::size_t k) {
      return static_cast<double>(places[k].segment) + places[k].u;
    };
    run += std::remainder(t(i) - t(i - 1), period);
  }
  return run >= 0.0;
}

/// Refers to what it is made of.
class Placing {
 public:
  Placing(const MatchedSamples& samples, const ScaledPart& part) : samples_(samples), part_(part) {}

  /// The placement refined on all points, with the places of all samples.
  PartPlacement refined(const PartCandidate& candidate, const FitPoint& reference) const {
    const PartFit fit = fit_part(part_, samples_.data.points, candidate.fit.data_T_part);
    PartPlacement placement;
    placement.probability = candidate.probability;
    placement.chi2 = fit.chi2;
    placement.dof = static_cast<int>(static_cast<double>(samples_.data.points.size()) /
                                     samples_.smooth.noise_time) -
                    kPoseDegrees;
    placement.misfit_chi2 = std::max(0.0, fit.chi2 - samples_.smooth.chi2);
    placement.misfit_dof = samples_.smooth.parameters - kPoseDegrees;
    const Pose2& pose = fit.data_T_part;
    placement.world_T_part = samples_.data.frame * Pose2{samples_.data.scale * pose.x,
                                                         samples_.data.scale * pose.y, pose.theta};
    // The motions turn about the origin of the data, the pose about that of the part.
    Eigen::Matrix3d by_motion = Eigen::Matrix3d::Identity();
    by_motion.col(2).head<2>() = left_of(pose.translation());
    const Eigen::Matrix3d covariance =
        by_motion * Eigen::Matrix3d(fit.information).inverse() * by_motion.transpose();
    Eigen::Matrix3d to_world = Eigen::Matrix3d::Identity();
    to_world.col(0).head<2>() = samples_.data.scale * samples_.data.frame.rotate(Vec2(1.0, 0.0));
    to_world.col(1).head<2>() = samples_.data.scale * samples_.data.frame.rotate(Vec2(0.0, 1.0));
    placement.covariance = to_world * covariance * to_world.transpose();
    judge_slide(fit, covariance, reference, &placement);
    place_samples(pose, &placement);
    return placement;
  }

 private:
  /// How far the reference can slide along the part, and whether chi-square rises there as the
  /// covariance of the pose (in the frame of the data) predicts.
  void judge_slide(const PartFit& fit, const Eigen::Matrix3d& covariance, const FitPoint& reference,
                   PartPlacement* placement) const {
    const Pose2& pose = fit.data_T_part;
    Vec2 tangent = reference.tangent;
    if (tangent.isZero()) {
      const double foot = part_.foot_of(pose.to_local(reference.position));
      tangent = pose.rotate(part_.spline().derivatives(foot).first).normalized();
    }
    const Eigen::Vector3d slide(tangent.x(), tangent.y(),
                                tangent.dot(left_of(reference.position - pose.translation())));
    const double variance = slide.dot(covariance * slide);
    if (!(variance > 0.0)) {
      placement->slide_sd_m = placement->nonlinearity = std::numeric_limits<double>::infinity();
      return;
    }
    placement->slide_sd_m = samples_.data.scale * std::sqrt(variance);
    constexpr double kDeviations = 2.0;  // about 95 % of placements lie within
    const Eigen::Vector3d step = kDeviations / std::sqrt(variance) * (covariance * slide);
    for (const double sign : {1.0, -1.0}) {
      const Eigen::Vector3d moved = Eigen::Vector3d(pose.x, pose.y, pose.theta) + sign * step;
      double chi2 = 0.0;
      for (const FitPoint& point : samples_.data.points) {
        const double residual =
            place_on_part(part_, {moved.x(), moved.y(), moved.z()}, point).residual;
        chi2 += residual * residual;
      }
      const double rise = (chi2 - fit.chi2) / (kDeviations * kDeviations);
      placement->nonlinearity = std::max(placement->nonlinearity, std::abs(rise - 1.0));
    }
  }

  void place_samples(const Pose2& pose, PartPlacement* placement) const {
    std::size_t next = 0;  // index of the next point of the data
    for (std::size_t p = 0; p < samples_.given.size(); ++p) {
      const StoredPatch& patch = samples_.given[p];
      PatchOnPart place;
      std::vector<std::size_t> votes(part_.spline().size(), 0);
      for (std::size_t i = 0; i < patch.samples.size(); ++i) {
        SamplePlace sample;
        sample.is_outlier = samples_.is_spike[p][i];
        FitPoint point;
        if (sample.is_outlier) {
          point.position =
              samples_.data.frame.to_local(patch.samples[i].position_m) / samples_.data.scale;
          point.offset = patch.context.tip_radius_m / samples_.data.scale;
          point.inverse_sigma = 1.0 / rms_sigma(samples_.data);
        } else {
          point = samples_.data.points[next++];
        }
        const PartFoot foot = place_on_part(part_, pose, point);
        const ClosedSpline::Place at = part_.spline().place_at(foot.t);
        sample.segment = at.segment;
        sample.u = at.u;
        sample.residual = foot.residual * std::sqrt(samples_.smooth.noise_time);
        ++votes[at.segment];
        place.samples.push_back(sample);
      }
      place.segment =
          static_cast<std::size_t>(std::max_element(votes.begin(), votes.end()) - votes.begin());
      place.along_increasing_t = runs_up(place.samples, part_.spline().size());
      for (std::size_t i = 0; i < place.samples.size(); ++i) {
        if (place.samples[i].segment != place.segment) {
          place.beyond.push_back(i);
        }
      }
      placement->patches.push_back(std::move(place));
    }
  }

  const MatchedSamples& samples_;
  const ScaledPart& part_;
};

}  // namespace

PartPlacement placement_of(const MatchedSamples& samples, const ScaledPart& part,
                           const PartCandidate& candidate, const FitPoint& reference) {
  return Placing(samples, part).refined(candidate, reference);
}

}  // namespace palpate
