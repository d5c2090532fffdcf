// What a browser draws, as JSON: it comes with every answer, as fast as the browser draws. Every
// text from the bus stays text: it is escaped here and becomes a text node there.
#pragma once

#include <cstdint>
#include <vector>

#include "node/tool/drawing/drawing.h"
#include "node/tool/view/json_text.h"
#include "node/tool/view/live_state.h"
#include "node/tool/view/step_coordinates.h"

namespace palpate {

/// Size of curve and touched places. [m]
double drawn_size_m(const Drawing& drawing, const LiveGroup& group);

/// Steps as fine as the drawing needs.
StepCoordinates coordinates_of(const Drawing& drawing, const LiveGroup& group);

/// Curve, band, rivals, contacts and frame of a group's answer; coordinates in steps from its
/// origin. `drawing` is that of the group.
void write_picture(const LiveGroup& group, const Drawing& drawing, JsonText& json);

/// Which of a group's samples a browser has.
struct SentSamples {
  std::uint64_t generation = 0;
  std::vector<std::size_t> of_run;
};

/// Whether there are samples that it has not, or another generation of them.
bool has_news(const LiveGroup& group, const SentSamples& sent);

/// The samples that it has not, runs continued where they ended. Brings `sent` up to date.
void write_samples(const LiveGroup& group, SentSamples& sent, JsonText& json);

}  // namespace palpate
