#include "core/part/touch_posterior.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/probability/log_add.h"
#include "core/numerics/probability/negligible.h"
#include "core/part/pair_starts.h"
#include "core/part/part_slide.h"
#include "core/recognition/fit/starts/farthest_first.h"

namespace palpate {
namespace {

/// The points that are used to find optima: all, or those farthest apart. They only find valleys;
/// all points weigh them. Those of a closed part lie 1/64 of its way apart or closer, less than a
/// sixth of a segment if it has up to ten.
std::vector<FitPoint> searched_points(std::span<const FitPoint> points) {
  constexpr std::size_t kMostSearched = 64;
  if (points.size() <= kMostSearched) {
    return {points.begin(), points.end()};
  }
  std::vector<Vec2> positions;
  positions.reserve(points.size());
  for (const FitPoint& point : points) {
    positions.push_back(point.position);
  }
  std::vector<FitPoint> searched;
  for (const std::size_t i : farthest_first(positions, kMostSearched)) {
    searched.push_back(points[i]);
  }
  return searched;
}

/// Poses under which a touch is laid on the part, and the valleys of chi-square through them.
class Valleys {
 public:
  Valleys(const ScaledPart& part, std::span<const FitPoint> points, const FitPoint& reference)
      : part_(part), points_(points), reference_(reference) {
    by_segment_.assign(part.spline().size(), kLogOfZero);
  }

  void add_optima() {
    const std::vector<FitPoint> searched = searched_points(points_);
    std::vector<PartFit> found;
    for (const Pose2& start : pair_starts(part_, searched, reference_)) {
      // Where the part fits, these are enough.
      constexpr int kMostIterations = 10;
      const PartFit fit = fit_part(part_, searched, start, {}, kMostIterations);
      if (std::isfinite(fit.chi2) &&
          std::none_of(found.begin(), found.end(),
                       [&](const PartFit& other) { return is_same(other, fit); })) {
        found.push_back(fit);
      }
    }
    std::sort(found.begin(), found.end(),
              [](const PartFit& a, const PartFit& b) { return a.chi2 < b.chi2; });
    for (const PartFit& fit : found) {
      // More points only raise chi-square: what is negligible for these is so for all.
      const PartFit refined = fit_part(part_, searched, fit.data_T_part);
      if (refined.chi2 < best_ + kNegligibleRise) {
        add(refined.data_T_part);
      }
    }
    std::erase_if(candidates_, [&](const PartCandidate& candidate) {
      return !(candidate.fit.chi2 < best_ + kNegligibleRise);
    });
  }

  SlidePosterior posterior() {
    // Of points that all miss by so many deviations, in the mean, chi-square varies from step to
    // step by more than a valley is deep: what is the least bad placement its bottom tells.
    const bool is_hopeless =
        best_ > kNegligibleDeviations * kNegligibleDeviations * static_cast<double>(points_.size());
    for (std::size_t c = 0; c < candidates_.size(); ++c) {  // grows, where a barrier is crossed
      log_masses_.push_back(kLogOfZero);
      for (const double sign : {1.0, -1.0}) {
        if (is_hopeless) {
          add_bottom(c);
        } else {
          follow(c, sign);
        }
      }
    }
    SlidePosterior posterior;
    posterior.candidates = std::move(candidates_);
    set_probabilities(log_masses_, by_segment_, &posterior);
    return posterior;
  }

 private:
  /// The reference with the tangent of increasing t, for a part that lies so at t.
  FitPoint reference_at(double t, double turn) const {
    FitPoint reference = reference_;
    reference.tangent = Pose2{0.0, 0.0, turn}.rotate(part_.spline().derivatives(t).first);
    reference.tangent.normalize();
    return reference;
  }

  SlideScan scan_at(double t, double turn) const {
    return {part_, points_, reference_at(t, turn), 1};
  }

  /// The pose that turns the part so and lays its place t at this height over the reference.
  Pose2 pose_at(double t, double turn, double height) const {
    const SlideScan scan = scan_at(t, turn);
    return pose_carrying(turn, part_.spline().position(t), scan.surface() + height * scan.left());
  }

  double height_of(double t, const Pose2& pose) const {
    const SlideScan scan = scan_at(t, pose.theta);
    return scan.left().dot(pose * part_.spline().position(t) - scan.surface());
  }

  PartSlide slide_from(double t, const Pose2& start) const {
    return scan_at(t, start.theta).from(t, start);
  }

  /// Adds the optimum that is reached from `start`, if it is new.
  void add(const Pose2& start) {
    PartCandidate candidate;
    candidate.t = part_.foot_of(start.to_local(reference_.position));
    PartMotions motions;
    motions.pivot = scan_at(candidate.t, start.theta).surface();
    candidate.fit = fit_part(part_, points_, start, motions);
    candidate.t = part_.foot_of(candidate.fit.data_T_part.to_local(reference_.position));
    if (std::isfinite(candidate.fit.chi2) && candidate.fit.chi2 < best_ + kNegligibleRise &&
        std::none_of(candidates_.begin(), candidates_.end(), [&](const PartCandidate& other) {
          return is_same(other.fit, candidate.fit);
        })) {
      best_ = std::min(best_, candidate.fit.chi2);
      candidates_.push_back(candidate);
    }
  }

  /// How far the reference's foot may move, in t, and how the part turns with it: the standard
  /// deviation of t and the regression of the turn on t.
  struct Pace {
    double deviation = std::numeric_limits<double>::infinity();
    double turn_by_t = 0.0;
  };

  Pace pace_of(const PartCandidate& candidate) const {
    const Vec2 velocity =
        candidate.fit.data_T_part.rotate(part_.spline().derivatives(candidate.t).first);
    const double speed = velocity.norm();
    const Eigen::Matrix3d covariance = Eigen::Matrix3d(candidate.fit.information).inverse();
    // A motion of the part by m along its tangent moves the foot by -m; turns about the reference
    // leave it where it is.
    const Eigen::Vector3d along(velocity.x() / speed, velocity.y() / speed, 0.0);
    const double variance = along.dot(covariance * along);
    if (!(variance > 0.0) || !std::isfinite(variance)) {
      return {};
    }
    const double turn_by_s = -along.dot(covariance.col(2)) / variance;
    return {std::sqrt(variance) / speed, turn_by_s * speed};
  }

  /// Integrates over the valley of a candidate, to one side, up to its barrier.
  void follow(std::size_t number, double sign) {
    const PartCandidate candidate = candidates_[number];
    constexpr double kLongestStep = 1.0 / ScaledPart::kNodesPerSegment;
    const double shortest_step = 1e-12 * static_cast<double>(part_.spline().size());  // rounding
    const Pace pace = pace_of(candidate);
    // Half a standard deviation raises chi-square by a quarter.
    double step = std::min(0.5 * pace.deviation, kLongestStep);
    double turn_by_t = pace.turn_by_t;
    PartSlide here = slide_from(candidate.t, candidate.fit.data_T_part);
    const double end = static_cast<double>(part_.spline().size());
    double way = 0.0;
    while (way < end && step > shortest_step && here.chi2 < best_ + kNegligibleRise) {
      const double t = here.t + sign * step;
      const double turn = here.data_T_part.theta + sign * step * turn_by_t;
      const PartSlide next = slide_from(t, pose_at(t, turn, height_of(here.t, here.data_T_part)));
      const double rise = next.chi2 - here.chi2;
      if (!(std::abs(rise) < kTrapezoidStep)) {
        step *= 0.5;
        continue;
      }
      if (rise < -kTolerance * (1.0 + here.chi2) && way > 0.0) {
        add(next.data_T_part);
        return;
      }
      add_mass(number, here, next, step);
      way += step;
      turn_by_t = wrap_angle(next.data_T_part.theta - here.data_T_part.theta) / (sign * step);
      step = std::min(std::abs(rise) < 0.25 * kTrapezoidStep ? 2.0 * step : step, kLongestStep);
      here = next;
    }
    if (way == 0.0) {
      add_bottom(number);  // chi-square varied more than any step can resolve
    }
  }

  /// A half valley by its bottom, as if it were a normal law.
  void add_bottom(std::size_t number) {
    const PartCandidate candidate = candidates_[number];
    const double deviation = pace_of(candidate).deviation;
    const PartSlide bottom = slide_from(candidate.t, candidate.fit.data_T_part);
    if (std::isfinite(bottom.chi2) && std::isfinite(deviation)) {
      add_mass(number, bottom, bottom, std::sqrt(0.5 * kPi) * deviation);
    }
  }

  void add_mass(std::size_t number, const PartSlide& a, const PartSlide& b, double step) {
    const double log_half_step = std::log(0.5 * step);
    const double log_piece = log_half_step + log_add(a.log_density(), b.log_density());
    log_masses_[number] = log_add(log_masses_[number], log_piece);
    double& log_segment = by_segment_[part_.spline().segment_at(0.5 * (a.t + b.t))];
    log_segment = log_add(log_segment, log_piece);
  }

  /// Relative; what the fits leave of chi-square above its minimum.
  static constexpr double kTolerance = 1e-8;

  const ScaledPart& part_;
  std::span<const FitPoint> points_;
  const FitPoint& reference_;
  double best_ = std::numeric_limits<double>::infinity();
  std::vector<PartCandidate> candidates_;
  std::vector<double> log_masses_;
  std::vector<double> by_segment_;
};

}  // namespace

SlidePosterior touch_posterior(const ScaledPart& part, std::span<const FitPoint> points,
                               const FitPoint& reference) {
  Valleys valleys(part, points, reference);
  valleys.add_optima();
  return valleys.posterior();
}

}  // namespace palpate
