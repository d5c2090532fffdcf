// Checks a scene and finds the place of an error in its file.
#pragma once

#include <google/protobuf/text_format.h>

#include <optional>
#include <string>

#include "palpate/v1/scene.pb.h"
#include "sim/shape.h"

namespace palpate::sim {

using ParseInfoTree = google::protobuf::TextFormat::ParseInfoTree;

/// Holds the scene, the positions of its fields in the file, and the first error found.
class SceneCheck {
 public:
  SceneCheck(const v1::Scene& scene, const ParseInfoTree& tree, std::string file)
      : scene_(scene), tree_(tree), file_(std::move(file)) {}

  /// The shape of the scene if the scene is valid; else nullopt, and error() says why.
  std::optional<Shape> check();

  const std::string& error() const { return error_; }

 private:
  struct Place;

  std::optional<Shape> check_shape(const Place& scene);
  std::optional<Shape> check_curve(const Place& scene);
  std::optional<Shape> check_closed_spline(const Place& scene);
  bool check_pose(const Place& scene);
  bool check_noise(const Place& noise);
  bool check_covariance(const Place& noise);
  bool check_probe(const Place& probe, const Shape& shape);
  bool check_patch(const Place& patch, const v1::SceneProbe& probe);

  bool fail(const Place& place, const char* field, const std::string& why);
  bool not_negative(const Place& place, const char* field);
  bool positive(const Place& place, const char* field);
  bool probability(const Place& place, const char* field);

  const v1::Scene& scene_;
  const ParseInfoTree& tree_;
  std::string file_;
  std::string error_;
  double samples_ = 0.0;  // of the patches checked so far
};

}  // namespace palpate::sim
