// From a scene to the samples of its probes: pure, and the same for the same seed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/recognition/samples/contact_sample.h"
#include "core/recognition/samples/sample_detail.h"
#include "palpate/v1/scene.pb.h"
#include "sim/scene_file.h"

namespace palpate::sim {

struct SimulatedSample {
  Vec2 position_m = Vec2::Zero();  ///< as the sensor reports it, in the world frame
  double sigma_m = 0.0;            ///< as the sensor reports it; 0 = not known
  double time_s = 0.0;             ///< since the start of the scene
  double t = 0.0;                  ///< curve parameter of the touched point: the truth
  SampleDetail detail = {};        ///< as the sensor reports it
};

/// One unbroken touch.
struct SimulatedPatch {
  std::uint32_t number = 0;
  MaterialSide side = MaterialSide::Left;  ///< of the direction of travel: the truth
  bool side_is_reported = true;
  double start_t = 0.0;  ///< curve parameters at the first and last place, dropouts or not
  double end_t = 0.0;
  std::vector<SimulatedSample> samples;
};

struct SimulatedProbe {
  std::string name;
  double tip_radius_m = 0.0;
  std::size_t batch_samples = 0;
  std::vector<SimulatedPatch> patches;
};

/// All contacts of the scene. Sample i of a patch touches the surface at arc length i * spacing
/// from the patch's start. `repetition` gives the same touches with other noise. O(samples).
std::vector<SimulatedProbe> simulate_contacts(const Scene& scene, std::uint64_t repetition = 0);

/// Distance between two samples of a patch. [m]
double spacing_of(const v1::SceneProbe& probe, const v1::ScenePatch& patch);

/// Why a probe's round tip cannot be where the patch wants it (it would cut into the material), or
/// an empty string. Looked at every sample.
std::string tip_trouble(const v1::Scene& scene, const Shape& shape, const v1::SceneProbe& probe,
                        const v1::ScenePatch& patch);

}  // namespace palpate::sim
