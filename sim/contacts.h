// Computes the samples of a scene's probes. Pure: the same seed gives the same samples.
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
  double t = 0.0;                  ///< true curve parameter of the touched point
  SampleDetail detail = {};        ///< as the sensor reports it
};

/// One unbroken touch.
struct SimulatedPatch {
  std::uint32_t number = 0;
  MaterialSide side = MaterialSide::Left;  ///< true side, seen along travel
  bool side_is_reported = true;
  /// Curve parameters of the first and last place, even if these samples were lost.
  double start_t = 0.0;
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
/// from the start of the patch. Another `repetition` gives the same touches with other noise.
/// O(samples).
std::vector<SimulatedProbe> simulate_contacts(const Scene& scene, std::uint64_t repetition = 0);

/// Distance between two samples of a patch. [m]
double spacing_of(const v1::SceneProbe& probe, const v1::ScenePatch& patch);

/// Why the round tip of a probe cannot follow the patch (it would cut into the material); an empty
/// string if it can. Checked at every sample.
std::string tip_trouble(const v1::Scene& scene, const Shape& shape, const v1::SceneProbe& probe,
                        const v1::ScenePatch& patch);

}  // namespace palpate::sim
