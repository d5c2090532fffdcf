#include "sim/scene_check.h"

#include <cmath>
#include <set>
#include <utility>

#include "node/intake/ingest.h"
#include "node/wire/convert.h"
#include "node/wire/topics.h"
#include "sim/contacts.h"

namespace palpate::sim {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

const FieldDescriptor* field_of(const Message& message, const char* name) {
  return message.GetDescriptor()->FindFieldByName(name);
}

double number(const Message& message, const char* name) {
  return message.GetReflection()->GetDouble(message, field_of(message, name));
}

}  // namespace

/// A message and its position in the file.
struct SceneCheck::Place {
  const Message& message;
  const ParseInfoTree* tree;  ///< nullptr if the file does not contain the message
  std::string path;           ///< "probes[0].patches[2]"; empty for the scene itself
  int line = 0;               ///< where the message begins, from 0

  Place child(const char* name, int index = -1) const {
    const FieldDescriptor* field = field_of(message, name);
    const auto* reflection = message.GetReflection();
    const Message& nested = field->is_repeated()
                                ? reflection->GetRepeatedMessage(message, field, index)
                                : reflection->GetMessage(message, field);
    return {nested, tree == nullptr ? nullptr : tree->GetTreeForNested(field, index),
            path_of(name, index), line_of(name, index)};
  }

  std::string path_of(const char* name, int index = -1) const {
    std::string result = path.empty() ? name : path + "." + name;
    return index < 0 ? result : result + "[" + std::to_string(index) + "]";
  }

  /// Line of the field, or of the message if the field is absent.
  int line_of(const char* name, int index = -1) const {
    const FieldDescriptor* field = field_of(message, name);
    // protobuf aborts if GetLocation gets a repeated field without an index.
    if (tree == nullptr || (field->is_repeated() && index < 0)) {
      return line;
    }
    const int at = tree->GetLocation(field, index).line;
    return at < 0 ? line : at;
  }
};

bool SceneCheck::fail(const Place& place, const char* field, const std::string& why) {
  if (error_.empty()) {
    error_ = file_ + ":" + std::to_string(place.line_of(field) + 1) + ": " + place.path_of(field) +
             ": " + why;
  }
  return false;
}

bool SceneCheck::not_negative(const Place& place, const char* field) {
  const double value = number(place.message, field);
  return (value >= 0.0 && std::isfinite(value)) || fail(place, field, "must be a number >= 0");
}

bool SceneCheck::positive(const Place& place, const char* field) {
  const double value = number(place.message, field);
  return (value > 0.0 && std::isfinite(value)) || fail(place, field, "must be a number > 0");
}

bool SceneCheck::probability(const Place& place, const char* field) {
  const double value = number(place.message, field);
  return (value >= 0.0 && value <= 1.0) || fail(place, field, "must be a probability, 0 to 1");
}

std::optional<Shape> SceneCheck::check() {
  const Place scene{scene_, &tree_, "", 0};
  if (!scene_.group().empty() && !is_valid_name(scene_.group())) {
    fail(scene, "group", "must be 1 to 64 of A-Z a-z 0-9 _ . -");
    return std::nullopt;
  }
  if (!scene_.frame().empty() && !is_valid_name(scene_.frame())) {
    fail(scene, "frame", "must be 1 to 64 of A-Z a-z 0-9 _ . -");
    return std::nullopt;
  }
  std::optional<Shape> shape = check_shape(scene);
  if (!shape || !check_pose(scene)) {
    return std::nullopt;
  }
  if (scene_.has_noise() && !check_noise(scene.child("noise"))) {
    return std::nullopt;
  }
  if (scene_.probes_size() == 0) {
    fail(scene, "probes", "there must be at least one");
    return std::nullopt;
  }
  std::set<std::string> names;
  for (int i = 0; i < scene_.probes_size(); ++i) {
    const Place probe = scene.child("probes", i);
    if (!names.insert(scene_.probes(i).name()).second) {
      fail(probe, "name", "\"" + scene_.probes(i).name() + "\" is taken by another probe");
    } else {
      check_probe(probe, *shape);
    }
    if (!error_.empty()) {
      return std::nullopt;
    }
  }
  return shape;
}

std::optional<Shape> SceneCheck::check_shape(const Place& scene) {
  switch (scene_.shape_case()) {
    case v1::Scene::kCurve:
      return check_curve(scene);
    case v1::Scene::kClosedSpline:
      return check_closed_spline(scene);
    case v1::Scene::kSuperellipse: {
      const Place place = scene.child("superellipse");
      const v1::Superellipse& s = scene_.superellipse();
      if (!(s.exponent() >= 2.0 && std::isfinite(s.exponent()))) {
        fail(place, "exponent", "must be a number >= 2");
        return std::nullopt;
      }
      if (!positive(place, "a_m") || !positive(place, "b_m")) return std::nullopt;
      return Superellipse{s.a_m(), s.b_m(), s.exponent()};
    }
    case v1::Scene::kSinusoid: {
      const Place place = scene.child("sinusoid");
      if (!positive(place, "amplitude_m") || !positive(place, "wavelength_m")) return std::nullopt;
      return Sinusoid{scene_.sinusoid().amplitude_m(), scene_.sinusoid().wavelength_m()};
    }
    case v1::Scene::kLogSpiral: {
      const Place place = scene.child("log_spiral");
      if (!positive(place, "radius_m")) return std::nullopt;
      if (!std::isfinite(scene_.log_spiral().growth())) {
        fail(place, "growth", "must be finite");
        return std::nullopt;
      }
      return LogSpiral{scene_.log_spiral().radius_m(), scene_.log_spiral().growth()};
    }
    case v1::Scene::SHAPE_NOT_SET:
      break;
  }
  fail(scene, "curve",
       "the scene has no shape: give curve, closed_spline, superellipse, sinusoid or log_spiral");
  return std::nullopt;
}

std::optional<Shape> SceneCheck::check_curve(const Place& scene) {
  const Place place = scene.child("curve");
  const v1::SceneCurve& described = scene_.curve();
  const CurveClass curve_class = from_wire(described.curve_class());
  if (curve_class == CurveClass::Unclassified) {
    fail(place, "curve_class", "must be one of the classes, such as CURVE_CLASS_ELLIPSE");
    return std::nullopt;
  }
  const Place parameters = place.child("parameters");
  const std::string_view letters = parameter_letters(curve_class);
  const std::string class_name(name_of(curve_class));
  Eigen::Vector3d values = Eigen::Vector3d::Zero();
  Eigen::Index used = 0;
  for (const char* letter : {"a", "b", "c"}) {
    const bool wanted = letters.find(letter[0]) != std::string_view::npos;
    const bool given = described.parameters().GetReflection()->HasField(
        described.parameters(), field_of(described.parameters(), letter));
    if (wanted != given) {
      fail(parameters, letter,
           wanted ? "a " + class_name + " needs it" : "a " + class_name + " has no such parameter");
      return std::nullopt;
    }
    if (wanted) {
      values[used++] = number(described.parameters(), letter);
    }
  }
  const std::optional<Curve> curve = make_curve(curve_class, values);
  if (!curve) {
    fail(place, "parameters",
         "not in the range of the canonical form of a " + class_name + " (see curve.proto)");
    return std::nullopt;
  }
  return *curve;
}

std::optional<Shape> SceneCheck::check_closed_spline(const Place& scene) {
  const Place place = scene.child("closed_spline");
  std::vector<Vec2> points;
  for (int i = 0; i < scene_.closed_spline().control_points_size(); ++i) {
    const v1::ScenePoint& point = scene_.closed_spline().control_points(i);
    if (!std::isfinite(point.x_m()) || !std::isfinite(point.y_m())) {
      fail(place.child("control_points", i), "x_m", "a coordinate is not finite");
      return std::nullopt;
    }
    points.emplace_back(point.x_m(), point.y_m());
  }
  if (points.size() < 4) {
    fail(place, "control_points", "there must be at least four");
    return std::nullopt;
  }
  return ClosedSpline(std::move(points));
}

bool SceneCheck::check_pose(const Place& scene) {
  for (const char* field : {"x_m", "y_m", "theta_rad"}) {
    if (!std::isfinite(number(scene_.pose(), field))) {
      return fail(scene.child("pose"), field, "must be finite");
    }
  }
  return true;
}

bool SceneCheck::check_noise(const Place& noise) {
  constexpr double kMostNormalSigma = kPi;  // as for ContactSample.normal_sigma_rad
  const double normal_sigma = number(noise.message, "normal_sigma_rad");
  if (normal_sigma > kMostNormalSigma || (normal_sigma > 0.0 && normal_sigma < kMinNormalSigma)) {
    return fail(noise, "normal_sigma_rad", "must be 0 or 1e-15 to pi");
  }
  return not_negative(noise, "sigma_m") && probability(noise, "spike_probability") &&
         not_negative(noise, "spike_m") && not_negative(noise, "quantization_m") &&
         probability(noise, "dropout_probability") && not_negative(noise, "normal_sigma_rad") &&
         check_covariance(noise);
}

bool SceneCheck::check_covariance(const Place& noise) {
  const auto& described = static_cast<const v1::SceneNoise&>(noise.message);
  const Eigen::Vector3d covariance(described.cov_xx_m2(), described.cov_xy_m2(),
                                   described.cov_yy_m2());
  if (covariance.isZero(0.0)) return true;
  if (!covariance.allFinite() || !is_covariance(covariance)) {
    return fail(noise, "cov_xx_m2", "cov_xx_m2, cov_xy_m2, cov_yy_m2 must be positive definite");
  }
  return described.sigma_m() == 0.0 ||
         fail(noise, "sigma_m", "must be absent where there is a covariance, which says it");
}

bool SceneCheck::check_probe(const Place& probe, const Shape& shape) {
  const auto& described = static_cast<const v1::SceneProbe&>(probe.message);
  if (!is_valid_name(described.name())) {
    return fail(probe, "name", "must be 1 to 64 of A-Z a-z 0-9 _ . -");
  }
  for (const char* field :
       {"tip_radius_m", "rate_hz", "start_s", "drift_m", "drift_length_m", "lag_m"}) {
    if (!not_negative(probe, field)) return false;
  }
  if (!std::isfinite(described.offset_m())) return fail(probe, "offset_m", "must be a number");
  for (int i = 0; i < described.lobes_size(); ++i) {
    const v1::ProbeHarmonic& lobe = described.lobes(i);
    if (lobe.order() == 0) return fail(probe.child("lobes", i), "order", "must be at least 1");
    for (const char* field : {"cosine_m", "sine_m"}) {
      if (!std::isfinite(number(lobe, field))) {
        return fail(probe.child("lobes", i), field, "must be a number");
      }
    }
  }
  if (described.drift_m() > 0.0 && !(described.drift_length_m() > 0.0)) {
    return fail(probe, "drift_length_m", "must be a number > 0 where there is drift_m");
  }
  if (described.batch_samples() > IngestLimits{}.max_samples_per_batch) {
    return fail(probe, "batch_samples", "more than the recognizer takes in a message");
  }
  if (described.has_noise() && !check_noise(probe.child("noise"))) {
    return false;
  }
  if (described.patches_size() == 0) {
    return fail(probe, "patches", "there must be at least one");
  }
  for (int i = 0; i < described.patches_size(); ++i) {
    const Place patch = probe.child("patches", i);
    if (!check_patch(patch, described)) {
      return false;
    }
    if (const std::string why = tip_trouble(scene_, shape, described, described.patches(i));
        !why.empty()) {
      return fail(patch, "arc_m", why);
    }
  }
  return true;
}

bool SceneCheck::check_patch(const Place& patch, const v1::SceneProbe& probe) {
  const auto& described = static_cast<const v1::ScenePatch&>(patch.message);
  if (described.start_case() == v1::ScenePatch::START_NOT_SET) {
    return fail(patch, "start_t", "give start_t or start_arc_m");
  }
  const bool by_t = described.start_case() == v1::ScenePatch::kStartT;
  const char* start = by_t ? "start_t" : "start_arc_m";
  if (!std::isfinite(number(described, start))) {
    return fail(patch, start, "must be finite");
  }
  if (described.pace_case() == v1::ScenePatch::PACE_NOT_SET) {
    return fail(patch, "spacing_m", "give spacing_m or speed_m_per_s");
  }
  const char* pace =
      described.pace_case() == v1::ScenePatch::kSpacingM ? "spacing_m" : "speed_m_per_s";
  if (!positive(patch, "arc_m") || !positive(patch, pace) || !not_negative(patch, "lift_off_s")) {
    return false;
  }
  samples_ += described.arc_m() / spacing_of(probe, described);
  constexpr double kMostSamples = 1e7;
  if (!(samples_ <= kMostSamples)) {
    return fail(patch, pace, "the scene has more than 10 million samples");
  }
  return true;
}

}  // namespace palpate::sim
