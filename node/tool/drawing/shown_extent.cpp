#include "node/tool/drawing/shown_extent.h"

#include <algorithm>
#include <limits>

namespace palpate {

std::optional<Extent> shown_extent(const ContactGroup& group, const v1::Recognition& answer,
                                   const Drawing& drawing) {
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity());
  Vec2 high = -low;
  const auto include = [&](const Vec2& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  };
  for (const ContactRun& run : group.runs) {
    for (const ContactSample& sample : run.samples) include(sample.position_m);
  }
  // Samples may have been lost on their way or belong to another program; contacts come with the
  // answer.
  for (const v1::LocalizedContact& contact : answer.contacts()) {
    const Vec2 place(contact.x_m(), contact.y_m());
    if (place.allFinite()) include(place);
  }
  if (!(low.x() <= high.x())) return std::nullopt;
  if (!drawing.curve) return Extent{low, high};
  const double size = (high - low).maxCoeff();
  const Vec2 centre = 0.5 * (low + high);
  const auto distance = [&](const Vec2& p) { return (p - centre).cwiseAbs().maxCoeff() / size; };
  constexpr double kWhole = 3.0;  // in units of the size of what was touched
  constexpr double kNear = 1.0;
  double furthest = 0.0;
  for (const CurvePlace& place : drawing.curve->places) {
    furthest = std::max(furthest, distance(place.position));
  }
  const double shown = furthest < kWhole ? kWhole : kNear;
  for (const CurvePlace& place : drawing.curve->places) {
    if (distance(place.position) < shown) include(place.position);
  }
  const Vec2 origin(answer.pose().x_m(), answer.pose().y_m());
  if (answer.curve_class() != v1::CURVE_CLASS_LINE && distance(origin) < shown) include(origin);
  return Extent{low, high};
}

}  // namespace palpate
