#include "core/recognition/weigh/tip_directions.h"

#include <algorithm>
#include <cmath>

#include "core/curves/curve.h"
#include "core/recognition/samples/tip_sides.h"

namespace palpate {
namespace {

/// The curve's direction at the foot of a point, in the points' frame; zero on a cusp.
Vec2 direction_at(const Curve& curve, const CanonicalFit& fit, std::size_t i, const Pose2& frame) {
  const Vec2 along = derivatives(curve, fit.points[i].t).first;
  const double length = along.norm();
  return length > 0.0 ? Vec2(frame.rotate_back(fit.world_T_curve.rotate(along)) / length)
                      : Vec2(0.0, 0.0);
}

/// Whether a patch was travelled as the curve's parameter rises (1) or falls (-1): as most of the
/// samples that `path` stands for have it. A patch runs along its curve one way, whatever the
/// direction that noise gave to one of its points. 0 where no point of `path` has a direction.
double sense_of(const Curve& curve, const CanonicalFit& fit, const FitData& path,
                const PatchSpan& patch) {
  double sum = 0.0;
  for (std::size_t i = patch.begin; i < patch.end; ++i) {
    const FitPoint& point = path.points[i];
    sum += point.inverse_sigma * point.inverse_sigma *
           direction_at(curve, fit, i, path.frame).dot(point.tangent);
  }
  return sum < 0.0 ? -1.0 : (sum > 0.0 ? 1.0 : 0.0);
}

/// The angle between two directions; pi where there was none. [rad]
double turned_by(const Vec2& before, const Vec2& after) {
  return before.isZero() ? kPi : std::abs(std::atan2(cross(before, after), before.dot(after)));
}

}  // namespace

bool has_kept_tips(const SmoothModel& smooth) {
  return std::any_of(smooth.sections.begin(), smooth.sections.end(), [&](const auto& section) {
    return section.kept && smooth.reduced.points[section.begin].offset > 0.0;
  });
}

bool has_uncertain_bends(const SmoothModel& smooth) {
  for (std::size_t p = 0; p < smooth.reduced.patches.size(); ++p) {
    const auto patch = smooth.reduced.patch(p);
    if (!patch.empty() && patch.front().offset > 0.0 && !certain_turn(patch)) {
      return true;
    }
  }
  return false;
}

double set_directions(DirectionsOf which, const CanonicalFit& fit, const SmoothModel& smooth,
                      FitData* touches) {
  const auto curve = make_curve(fit.shape.curve_class, fit.shape.values);
  double largest = 0.0;
  if (!curve) {
    return largest;
  }
  auto section = smooth.sections.begin();
  for (const PatchSpan& patch : touches->patches) {
    // As the smooth model saw it travelled: sides are told by that, and a sense that followed each
    // round's curve could turn about within some rounds.
    double sense = sense_of(*curve, fit, smooth.reduced, patch);
    if (sense == 0.0) sense = sense_of(*curve, fit, *touches, patch) < 0.0 ? -1.0 : 1.0;
    for (; section != smooth.sections.end() && section->begin < patch.end; ++section) {
      if (which == DirectionsOf::KeptPoints && !section->kept) {
        continue;
      }
      for (std::size_t i = section->begin; i < section->end; ++i) {
        const Vec2 along = sense * direction_at(*curve, fit, i, touches->frame);
        if (!along.isZero()) {
          largest = std::max(largest, turned_by(touches->points[i].tangent, along));
          touches->points[i].tangent = along;
        }
      }
    }
  }
  return largest;
}

std::vector<double> bends_of(const CanonicalFit& fit, const FitData& touches) {
  std::vector<double> bends = turns_of(touches);
  const auto curve = make_curve(fit.shape.curve_class, fit.shape.values);
  if (!curve) {
    return bends;
  }
  for (std::size_t p = 0; p < bends.size(); ++p) {
    if (certain_turn(touches.patch(p))) {
      continue;
    }
    double sum = 0.0;
    for (std::size_t i = touches.patches[p].begin; i < touches.patches[p].end; ++i) {
      sum += geometry(*curve, fit.points[i].t).kappa;
    }
    bends[p] = sense_of(*curve, fit, touches, touches.patches[p]) < 0.0 ? -sum : sum;
  }
  return bends;
}

}  // namespace palpate
