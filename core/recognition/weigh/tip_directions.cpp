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
  for (const ReducedSection& section : smooth.sections) {
    if (which == DirectionsOf::KeptPoints && !section.kept) {
      continue;
    }
    for (std::size_t i = section.begin; i < section.end; ++i) {
      FitPoint& point = touches->points[i];
      const Vec2 tangent = direction_at(*curve, fit, i, touches->frame);
      if (tangent.isZero()) {
        continue;
      }
      const Vec2 turned = tangent.dot(point.tangent) < 0.0 ? Vec2(-tangent) : tangent;
      largest = std::max(largest, point.tangent.isZero()
                                      ? kPi
                                      : std::abs(std::atan2(cross(point.tangent, turned),
                                                            point.tangent.dot(turned))));
      point.tangent = turned;
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
      const double along =
          direction_at(*curve, fit, i, touches.frame).dot(touches.points[i].tangent);
      sum += (along < 0.0 ? -1.0 : 1.0) * geometry(*curve, fit.points[i].t).kappa;
    }
    bends[p] = sum;
  }
  return bends;
}

}  // namespace palpate
