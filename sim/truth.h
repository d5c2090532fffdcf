// What a scene should be recognised as.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "palpate/v1/scene.pb.h"
#include "sim/contacts.h"

namespace palpate::sim {

/// One for each group: the scene's, or each probe's own. `object`: the number published.
std::vector<v1::SceneTruth> scene_truths(const Scene& scene, std::span<const SimulatedProbe> probes,
                                         std::uint64_t object);

/// In protobuf's JSON, one line, no line end.
std::string to_json(const v1::SceneTruth& truth);

}  // namespace palpate::sim
