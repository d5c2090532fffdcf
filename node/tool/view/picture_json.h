// JSON of what a browser draws. It is sent with every answer, as fast as the browser draws. Text
// from the bus is escaped here and shown as a text node in the browser, so it cannot become markup.
#pragma once

#include <cstdint>
#include <vector>

#include "node/tool/drawing/drawing.h"
#include "node/tool/view/json_text.h"
#include "node/tool/view/live_state.h"
#include "node/tool/view/step_coordinates.h"

namespace palpate {

/// Size of the curve and the touched places. [m]
double drawn_size_m(const Drawing& drawing, const LiveGroup& group);

/// Coordinate steps that are fine enough for the drawing.
StepCoordinates coordinates_of(const Drawing& drawing, const LiveGroup& group);

/// Writes curve, band, rivals, contacts and frame of a group's answer; coordinates in steps from
/// its origin. `drawing` must be that of the group.
void write_picture(const LiveGroup& group, const Drawing& drawing, JsonText& json);

/// The samples of a group that a browser already has.
struct SentSamples {
  std::uint64_t generation = 0;
  std::vector<std::size_t> of_run;
};

/// True if the browser lacks samples or has another generation of them.
bool has_news(const LiveGroup& group, const SentSamples& sent);

/// Writes the samples that the browser lacks, continuing the runs, and updates `sent`.
void write_samples(const LiveGroup& group, SentSamples& sent, JsonText& json);

}  // namespace palpate
