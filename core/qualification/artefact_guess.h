// Where an artefact lies and from which side it is touched, roughly: where the joint fit starts.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/qualification/artefact.h"

namespace palpate {

/// The samples of a recording, at most `most` of them, evenly selected.
std::vector<ArtefactSample> thinned(const ArtefactRecording& recording, std::size_t most);

/// Median deviation of the samples' distances from their median: how badly a pose fits.
double scatter(const Curve& artefact, MaterialSign material, const Pose2& pose,
               const std::vector<ArtefactSample>& samples);

/// Rough pose of the artefact: its class is fitted with a free shape; of the orientations that the
/// symmetries leave open, the one that fits the samples best.
std::optional<Pose2> rough_pose(const Curve& artefact, const std::vector<ArtefactSample>& samples);

/// The side of the tips' centres: the one where the nominal radius leaves smaller residuals.
/// Samples without a tip do not tell; then `bore` does.
MaterialSign side_of(const Curve& artefact, const Pose2& pose,
                     const std::vector<ArtefactSample>& samples, bool bore);

}  // namespace palpate
