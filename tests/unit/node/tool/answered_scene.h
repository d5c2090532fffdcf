// A random scene as the tool's pictures take it: its contacts and the message of its answer.
#pragma once

#include <cstdint>
#include <string>

#include "core/recognition/recognition.h"
#include "node/tool/contact_groups.h"
#include "node/wire/convert.h"
#include "palpate/v1/recognition.pb.h"
#include "tests/support/random_scene.h"

namespace palpate {

inline v1::Recognition message_of(const Recognition& answer) {
  v1::Recognition message;
  to_wire(
      answer,
      [](std::uint32_t, std::uint32_t patch) {
        return ContactSource{"probe", patch};
      },
      message);
  return message;
}

inline ContactGroup group_of(const test::Scene& scene, const std::string& file = "scene") {
  ContactGroup group{file, "part", 1, {"probe"}, {}};
  for (const auto& patch : scene.patches) {
    ContactRun run;
    run.context.patch = static_cast<std::uint32_t>(group.runs.size());
    for (const Vec2& position : patch) run.samples.push_back({position, scene.sigma_m, 0});
    group.runs.push_back(run);
  }
  return group;
}

}  // namespace palpate
