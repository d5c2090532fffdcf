// A known artefact, what touched it, and how far the samples lie from it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/curves/curve.h"
#include "core/curves/pose2.h"
#include "core/qualification/coherent_whitening.h"
#include "core/qualification/normal_offset.h"
#include "core/recognition/samples/contact_sample.h"

namespace palpate {

/// One unbroken touch, in the order of time.
struct ArtefactStroke {
  std::vector<ContactSample> samples;
  double tip_radius_m = 0.0;  ///< nominal [m]
};

/// Touches of one artefact that lay still: one pose.
struct ArtefactRecording {
  std::vector<ArtefactStroke> strokes;
};

/// A sample as the fit needs it, sorted by place within its stroke.
struct ArtefactSample {
  Vec2 position_m = Vec2::Zero();
  double tip_radius_m = 0.0;
  double arc_m = 0.0;  ///< place along the stroke, rising
  int travel = 0;      ///< +1 along increasing curve parameter, -1 against it, 0 not known
  std::size_t recording = 0;
  std::size_t stroke = 0;  ///< of the recording
  std::size_t number = 0;  ///< in the stroke, as it came
};

/// +1: the material lies left of increasing curve parameter (within a ring's outer side), -1: right
/// (round a bore).
using MaterialSign = int;

/// A sample beside the artefact at a pose.
struct SampleOnArtefact {
  double distance_m = 0.0;      ///< out of the material, less the nominal tip radius
  double normal_angle = 0.0;    ///< of the normal out of the material, in the samples' frame [rad]
  Vec2 normal = Vec2::UnitX();  ///< the same
  double turn_per_m = 0.0;      ///< of the normal along travel, on the path of the tip [rad/m]
  double by_angle = 0.0;        ///< derivative of the distance by the pose's angle [m]
};

SampleOnArtefact beside(const Curve& artefact, MaterialSign material, const Pose2& world_T_artefact,
                        const ArtefactSample& sample);

/// Samples in the order of their places, strokes one after the other. Touches alone in their stroke
/// are taken together, and strokes whose samples do not run one way: by place, without direction.
struct PlacedSamples {
  std::vector<ArtefactSample> samples;
  std::vector<StrokePlaces> strokes;
};
PlacedSamples place_samples(const Curve& artefact, const ArtefactRecording& recording,
                            std::size_t number, const Pose2& world_T_artefact);

}  // namespace palpate
