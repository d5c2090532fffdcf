// How much of the plane a picture shows.
#pragma once

#include "node/tool/contact_groups.h"
#include "node/tool/drawing/drawing.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate {

/// A rectangle along the axes. [m]
struct Extent {
  Vec2 low;
  Vec2 high;
};

/// What was touched, and the curve with its frame: all of a curve that is not far larger than what
/// was touched; of another one, as of an arc that is not yet determined, what is near. nullopt
/// where there is nothing to show.
std::optional<Extent> shown_extent(const ContactGroup& group, const v1::Recognition& answer,
                                   const Drawing& drawing);

}  // namespace palpate
