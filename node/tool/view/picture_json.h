// What a browser draws, as JSON: it comes with every answer, as fast as the browser draws. Every
// text from the bus stays text: it is escaped here and becomes a text node there.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "node/tool/drawing/drawing.h"
#include "node/tool/view/json_numbers.h"
#include "node/tool/view/live_state.h"

namespace palpate {

/// Size of curve and touched places. [m]
double drawn_size_m(const Drawing& drawing, const LiveGroup& group);

/// Steps as fine as the drawing needs.
StepCoordinates coordinates_of(const Drawing& drawing, const LiveGroup& group);

/// Curve, band, rivals, contacts and frame of a group's answer; coordinates in steps from its
/// origin.
nlohmann::json picture_json(const LiveGroup& group);

/// Which of a group's samples a browser has.
struct SentSamples {
  std::uint64_t generation = 0;
  std::vector<std::size_t> of_run;
};

/// The samples that it has not, runs continued where they ended; null where it has them all. Brings
/// `sent` up to date.
nlohmann::json samples_json(const LiveGroup& group, SentSamples& sent);

/// As text; what is not UTF-8 is replaced.
std::string to_text(const nlohmann::json& message);

}  // namespace palpate
