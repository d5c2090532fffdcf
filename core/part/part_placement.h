// One placement of a known part: refined on all samples, with its covariance and the place of each.
#pragma once

#include <span>
#include <vector>

#include "core/part/part_slides.h"
#include "core/part/segment_match.h"
#include "core/recognition/samples/fit_data.h"
#include "core/recognition/smooth/smooth_model.h"

namespace palpate {

inline constexpr int kPoseDegrees = 3;

/// What a placement is of. Refers to what it is made of.
struct MatchedSamples {
  std::span<const StoredPatch> given;
  const std::vector<std::vector<bool>>& is_spike;  ///< one flag per given sample
  const FitData& data;                             ///< of the others
  const SmoothModel& smooth;                       ///< of the data
};

/// The candidate refined on all points, with the places of all samples. `reference`: the point
/// whose place along the part the placement's slide is about.
PartPlacement placement_of(const MatchedSamples& samples, const ScaledPart& part,
                           const PartCandidate& candidate, const FitPoint& reference);

}  // namespace palpate
