#include "sim/scene_file.h"

#include <google/protobuf/io/tokenizer.h>

#include <fstream>
#include <sstream>
#include <utility>

#include "sim/scene_check.h"

namespace palpate::sim {
namespace {

/// Keeps the first error of protobuf's text parser.
class FirstError : public google::protobuf::io::ErrorCollector {
 public:
  explicit FirstError(std::string file) : file_(std::move(file)) {}

  void AddError(int line, int column, const std::string& message) override {
    if (text_.empty()) {
      text_ = file_ + ":" + std::to_string(line + 1) + ":" + std::to_string(column + 1) + ": " +
              message;
    }
  }

  const std::string& text() const { return text_; }

 private:
  std::string file_;
  std::string text_;
};

}  // namespace

Result<Scene> parse_scene(const std::string& text, const std::string& name) {
  using Loaded = Result<Scene>;
  v1::Scene description;
  FirstError first_error(name);
  google::protobuf::TextFormat::ParseInfoTree tree;
  google::protobuf::TextFormat::Parser parser;
  parser.RecordErrorsTo(&first_error);
  parser.WriteLocationsTo(&tree);
  if (!parser.ParseFromString(text, &description)) {
    return Loaded::fail(first_error.text().empty() ? name + ": not a scene" : first_error.text());
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
  std::ifstream in(path);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) {
    return Result<Scene>::fail(path + ": cannot be read");
  }
  return parse_scene(text.str(), path);
}

}  // namespace palpate::sim
