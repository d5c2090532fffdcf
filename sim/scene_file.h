// Reads and checks scene files.
#pragma once

#include <string>

#include "core/curves/pose2.h"
#include "node/files/result.h"
#include "palpate/v1/scene.pb.h"
#include "sim/shape.h"

namespace palpate::sim {

struct Scene {
  std::string name;  ///< of the file
  v1::Scene description;
  Shape shape;
  Pose2 world_T_shape;
};

/// Reads and checks a scene. An error reads "FILE:LINE: FIELD: what is wrong".
Result<Scene> read_scene(const std::string& path);

/// The same from text; `name` stands for the file in errors.
Result<Scene> parse_scene(const std::string& text, const std::string& name);

}  // namespace palpate::sim
