// The part of the plane that a picture shows.
#pragma once

#include "node/tool/contact_groups.h"
#include "node/tool/drawing/drawing.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate {

/// A rectangle parallel to the axes. [m]
struct Extent {
  Vec2 low;
  Vec2 high;
};

/// Contains everything that was touched, and the curve with its frame. Of a curve that is much
/// larger than what was touched (such as an arc that is not determined yet), it contains only the
/// part nearby. nullopt if there is nothing to show.
std::optional<Extent> shown_extent(const ContactGroup& group, const v1::Recognition& answer,
                                   const Drawing& drawing);

}  // namespace palpate
