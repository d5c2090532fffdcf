#include "sim/scene_file.h"

#include <utility>

#include "node/files/text_format.h"
#include "sim/scene_check.h"

namespace palpate::sim {

Result<Scene> parse_scene(const std::string& text, const std::string& name) {
  using Loaded = Result<Scene>;
  v1::Scene description;
  google::protobuf::TextFormat::ParseInfoTree tree;
  if (std::string error = parse_text(text, name, description, &tree); !error.empty()) {
    return Loaded::fail(std::move(error));
  }
  SceneCheck check(description, tree, name);
  std::optional<Shape> shape = check.check();
  if (!shape) {
    return Loaded::fail(check.error());
  }
  const v1::Pose2& pose = description.pose();
  const Pose2 world_T_shape{pose.x_m(), pose.y_m(), pose.theta_rad()};
  return Loaded::ok({name, std::move(description), std::move(*shape), world_T_shape});
}

Result<Scene> read_scene(const std::string& path) {
  const Result<std::string> text = read_file(path);
  return text ? parse_scene(*text.value, path) : Result<Scene>::fail(text.error);
}

}  // namespace palpate::sim
