// The truth about a scene: how it should be recognised.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "palpate/v1/scene.pb.h"
#include "sim/contacts.h"

namespace palpate::sim {

/// One message per group: the scene's group, or each probe if the scene has none. `object`: the
/// number published.
std::vector<v1::SceneTruth> scene_truths(const Scene& scene, std::span<const SimulatedProbe> probes,
                                         std::uint64_t object);

/// protobuf's JSON, one line, without a line feed.
std::string to_json(const v1::SceneTruth& truth);

}  // namespace palpate::sim
