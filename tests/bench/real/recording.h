// A recording of one touch, and palpate's answer to it.
#pragma once

#include <filesystem>
#include <vector>

#include "core/recognition/recognizer.h"

namespace palpate::bench {

/// The contacts of a file in palpate's CSV format with one patch of one probe. Throws
/// std::runtime_error if it cannot be read or has more than one patch.
struct Recording {
  PatchContext context;
  std::vector<Vec2> points;  ///< in the order of travel [m]
};
Recording read_recording(const std::filesystem::path& path);

/// The answer of a new recognizer; the noise is not stated.
Recognition recognise(const PatchContext& context, const std::vector<Vec2>& points,
                      const RecognizerOptions& options = {});

/// The same with each point as a touch of its own: as many patches as points.
Recognition recognise_touches(const PatchContext& context, const std::vector<Vec2>& points,
                              const RecognizerOptions& options = {});

/// "RECOGNIZED", "AMBIGUOUS", "COLLECTING".
std::string_view name_of(RecognitionStatus status);

}  // namespace palpate::bench
