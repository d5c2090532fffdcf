#include "sim/truth.h"

#include <google/protobuf/util/json_util.h>

#include <algorithm>

#include "node/wire/convert.h"

namespace palpate::sim {
namespace {

/// Sets class, parameters and pose, which SceneTruth and PatchTruth both have.
template <typename Truth>
void describe(const Scene& scene, const std::optional<ClassifiedPiece>& piece, Truth& truth) {
  if (!piece) {
    truth.set_curve_class(v1::CURVE_CLASS_UNCLASSIFIED);
    return;
  }
  const CurveClass curve_class = class_of(piece->curve);
  truth.set_curve_class(to_wire(curve_class));
  to_wire(ShapeParameters{curve_class, parameters(piece->curve)}, *truth.mutable_parameters());
  to_wire(scene.world_T_shape * piece->shape_T_curve, *truth.mutable_pose());
}

/// The piece that contains all patches; nullopt if it is not of one class.
std::optional<ClassifiedPiece> common_piece(const Scene& scene,
                                            std::span<const SimulatedProbe> probes) {
  double lower = std::numeric_limits<double>::infinity();
  double upper = -lower;
  for (const SimulatedProbe& probe : probes) {
    for (const SimulatedPatch& patch : probe.patches) {
      lower = std::min({lower, patch.start_t, patch.end_t});
      upper = std::max({upper, patch.start_t, patch.end_t});
    }
  }
  return classified_piece(scene.shape, lower, upper);
}

v1::SceneTruth truth_of(const Scene& scene, std::span<const SimulatedProbe> probes,
                        const std::string& group, std::uint64_t object) {
  v1::SceneTruth truth;
  truth.set_scene(scene.name);
  truth.set_group(group);
  truth.set_object(object);
  const std::optional<ClassifiedPiece> piece = common_piece(scene, probes);
  describe(scene, piece, truth);
  if (piece) {
    truth.set_pose_symmetry(static_cast<std::uint32_t>(pose_symmetry(class_of(piece->curve))));
  }
  std::size_t sample_count = 0;
  for (const SimulatedProbe& probe : probes) {
    for (const SimulatedPatch& patch : probe.patches) {
      v1::PatchTruth& patch_truth = *truth.add_patches();
      patch_truth.set_probe(probe.name);
      patch_truth.set_patch(patch.number);
      patch_truth.set_start_t(patch.start_t);
      patch_truth.set_end_t(patch.end_t);
      patch_truth.set_sample_count(patch.samples.size());
      describe(scene, classified_piece(scene.shape, patch.start_t, patch.end_t), patch_truth);
      sample_count += patch.samples.size();
    }
  }
  truth.set_sample_count(sample_count);
  return truth;
}

}  // namespace

std::vector<v1::SceneTruth> scene_truths(const Scene& scene, std::span<const SimulatedProbe> probes,
                                         std::uint64_t object) {
  const std::string& group = scene.description.group();
  std::vector<v1::SceneTruth> truths;
  if (!group.empty()) {
    truths.push_back(truth_of(scene, probes, group, object));
    return truths;
  }
  for (std::size_t i = 0; i < probes.size(); ++i) {
    truths.push_back(truth_of(scene, probes.subspan(i, 1), probes[i].name, object));
  }
  return truths;
}

std::string to_json(const v1::SceneTruth& truth) {
  google::protobuf::util::JsonPrintOptions options;
  options.preserve_proto_field_names = true;
  options.always_print_primitive_fields = true;
  std::string text;
  // Cannot fail, because the message has no Any.
  (void)google::protobuf::util::MessageToJsonString(truth, &text, options);
  return text;
}

}  // namespace palpate::sim
