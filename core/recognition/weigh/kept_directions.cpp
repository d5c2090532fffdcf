#include "core/recognition/weigh/kept_directions.h"

#include <algorithm>

#include "core/curves/curve.h"

namespace palpate {

bool has_kept_tips(const SmoothModel& smooth) {
  return std::any_of(smooth.sections.begin(), smooth.sections.end(), [&](const auto& section) {
    return section.kept && smooth.reduced.points[section.begin].offset > 0.0;
  });
}

LoneBend set_kept_directions(const CanonicalFit& curve, const SmoothModel& smooth,
                             FitData* touches) {
  LoneBend bend;
  const auto canonical = make_curve(curve.shape.curve_class, curve.shape.values);
  if (!canonical) {
    return bend;
  }
  for (const ReducedSection& section : smooth.sections) {
    if (!section.kept) {
      continue;
    }
    for (std::size_t i = section.begin; i < section.end; ++i) {
      FitPoint& point = touches->points[i];
      const double t = curve.points[i].t;
      const Vec2 along = derivatives(*canonical, t).first;
      if (!(along.squaredNorm() > 0.0)) {
        continue;  // on a cusp
      }
      const Vec2 tangent =
          touches->frame.rotate_back(curve.world_T_curve.rotate(along)).normalized();
      if (point.tangent.isZero()) {
        bend.sum += geometry(*canonical, t).kappa;
      }
      point.tangent = tangent.dot(point.tangent) < 0.0 ? Vec2(-tangent) : tangent;
    }
  }
  return bend;
}

}  // namespace palpate
