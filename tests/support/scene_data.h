// Converts random scenes to inputs of the recognizer.
#pragma once

#include "core/recognition/recognizer.h"
#include "core/recognition/samples/fit_data.h"
#include "tests/support/random_scene.h"

namespace palpate::test {

/// Adds samples [begin, end) of a patch.
inline void add_samples(const Scene& scene, double sigma_m, std::size_t patch, std::size_t begin,
                        std::size_t end, Recognizer* recognizer) {
  std::vector<ContactSample> samples;
  for (std::size_t i = begin; i < end; ++i) {
    samples.push_back({scene.patches[patch][i], sigma_m, 0});
  }
  PatchContext context;
  context.patch = static_cast<std::uint32_t>(patch);
  recognizer->add(context, samples);
}

/// Adds every patch. `sigma_m`: stated by the samples; 0 = not known.
inline void add_scene(const Scene& scene, double sigma_m, Recognizer* recognizer) {
  for (std::size_t p = 0; p < scene.patches.size(); ++p) {
    add_samples(scene, sigma_m, p, 0, scene.patches[p].size(), recognizer);
  }
}

/// Adds every patch, and lets the recognizer answer twice while the last one is still being
/// touched: before its last two tenths. The next answer follows these.
inline void add_scene_followed(const Scene& scene, double sigma_m, Recognizer* recognizer) {
  const std::size_t last = scene.patches.size() - 1;
  for (std::size_t p = 0; p < last; ++p) {
    add_samples(scene, sigma_m, p, 0, scene.patches[p].size(), recognizer);
  }
  const std::size_t whole = scene.patches[last].size();
  const std::size_t tenth = whole / 10;
  add_samples(scene, sigma_m, last, 0, whole - 2 * tenth, recognizer);
  recognizer->recognize();
  add_samples(scene, sigma_m, last, whole - 2 * tenth, whole - tenth, recognizer);
  recognizer->recognize();
  add_samples(scene, sigma_m, last, whole - tenth, whole, recognizer);
}

inline Recognition recognise(const Scene& scene, double sigma_m,
                             const RecognizerOptions& options = {}) {
  Recognizer recognizer(options);
  add_scene(scene, sigma_m, &recognizer);
  return recognizer.recognize();
}

inline std::vector<StoredPatch> stored_patches(const Scene& scene, double sigma_m) {
  std::vector<StoredPatch> patches;
  for (const auto& samples : scene.patches) {
    StoredPatch patch;
    patch.context.patch = static_cast<std::uint32_t>(patches.size());
    for (const Vec2& position : samples) {
      patch.samples.push_back({position, sigma_m, 1.0});
    }
    patches.push_back(patch);
  }
  return patches;
}

inline FitData fit_data(const Scene& scene, double sigma_m) {
  return make_fit_data(stored_patches(scene, sigma_m), 0.0);
}

inline const Hypothesis* hypothesis_of(const Recognition& answer, CurveClass curve_class) {
  for (const Hypothesis& hypothesis : answer.hypotheses) {
    if (hypothesis.shape.curve_class == curve_class) {
      return &hypothesis;
    }
  }
  return nullptr;
}

/// Error of [shape; x; y; theta], modulo the pose symmetry (2-fold only).
inline Eigen::VectorXd error_of(const Hypothesis& hypothesis, const Scene& scene) {
  const auto letters = static_cast<Eigen::Index>(parameter_letters(scene.curve_class).size());
  Eigen::VectorXd error(letters + 3);
  error.head(letters) = hypothesis.shape.values.head(letters) - scene.values.head(letters);
  error[letters] = hypothesis.world_T_curve.x - scene.world_T_curve.x;
  error[letters + 1] = hypothesis.world_T_curve.y - scene.world_T_curve.y;
  const double turn = hypothesis.world_T_curve.theta - scene.world_T_curve.theta;
  error[letters + 2] = std::remainder(turn, pose_symmetry(scene.curve_class) == 2 ? kPi : 2 * kPi);
  return error;
}

}  // namespace palpate::test
