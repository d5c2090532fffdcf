// A known artefact: its touches, and the distance of the samples from it.
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

/// One unbroken touch, samples in the order of time.
struct ArtefactStroke {
  std::vector<ContactSample> samples;
  double tip_radius_m = 0.0;  ///< nominal [m]
};

/// Touches of one artefact that did not move: one pose.
struct ArtefactRecording {
  std::vector<ArtefactStroke> strokes;
};

/// A sample in the form that the fit needs. The samples of a stroke are sorted by place.
struct ArtefactSample {
  Vec2 position_m = Vec2::Zero();
  double tip_radius_m = 0.0;
  double arc_m = 0.0;  ///< place along the stroke, increasing
  int travel = 0;      ///< +1 along increasing curve parameter, -1 against it, 0 unknown
  std::size_t recording = 0;
  std::size_t stroke = 0;  ///< within the recording
  std::size_t number = 0;  ///< within the stroke, as given
};

/// +1: the material lies left of increasing curve parameter (the outside of a ring is touched), -1:
/// right (a bore is touched).
using MaterialSign = int;

/// What is qualified on: the artefact, and on which side of it the material lies.
struct Artefact {
  const Curve& curve;
  MaterialSign material = 1;
};

/// Distance of a sample from the artefact at a pose, and how it changes.
struct SampleOnArtefact {
  double distance_m = 0.0;  ///< out of the material, minus the nominal tip radius
  /// of the normal out of the material, in the frame of the samples [rad]
  double normal_angle = 0.0;
  Vec2 normal = Vec2::UnitX();  ///< the unit vector of normal_angle
  double turn_per_m = 0.0;  ///< how the normal turns with travel along the path of the tip [rad/m]
  double by_angle = 0.0;    ///< derivative of the distance by the angle of the pose [m]
};

SampleOnArtefact beside(const Curve& artefact, MaterialSign material, const Pose2& world_T_artefact,
                        const ArtefactSample& sample);

/// The samples of a recording ordered by place, one stroke after another. Strokes of a single touch
/// form one common stroke. That stroke, and strokes whose samples run in no clear direction, are
/// ordered by place and have no direction of travel.
struct PlacedSamples {
  std::vector<ArtefactSample> samples;
  std::vector<StrokePlaces> strokes;
};
PlacedSamples place_samples(const Curve& artefact, const ArtefactRecording& recording,
                            std::size_t number, const Pose2& world_T_artefact);

}  // namespace palpate
