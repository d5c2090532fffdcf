// The margin of a scene, computed from the recognizer's fits of the rival classes as starting
// points.
#pragma once

#include "tests/support/class_margin.h"
#include "tests/support/scene_data.h"

namespace palpate::test {

struct Margin {
  bool determined = false;  ///< the data determine the class (class_margin.h)
  bool told_apart = false;  ///< for a curve of no class: long enough to exclude all classes
  CurveClass nearest = CurveClass::Unclassified;  ///< the rival closest to fitting well enough
  double chi2 = 0.0;                              ///< of that rival, without noise
  double occam = 0.0;                             ///< occam_against_richer
};

/// Starts from the recognizer's answers on the points without noise, with one class allowed at a
/// time. Each is refined here, so that a poor fit of the recognizer does not make a scene count as
/// determined. A rival that the recognizer does not find at all would do so; but that can only add
/// failures to the recognizer's record, never successes.
inline Margin margin_of(const PriorScene& prior_scene) {
  const CurveClass truth = prior_scene.scene.curve_class;
  Scene exact = prior_scene.scene;
  exact.patches = prior_scene.exact_patches;
  Margin margin;
  margin.determined = true;
  margin.chi2 = std::numeric_limits<double>::infinity();
  double nearest = std::numeric_limits<double>::infinity();
  for (const CurveClass rival : kCurveClasses) {
    if (rival == truth || has_as_limit(rival, truth)) {
      continue;
    }
    RecognizerOptions options;
    options.classes = 1U << static_cast<unsigned>(rival);
    const Recognition answer = recognise(exact, exact.sigma_m, options);
    const Hypothesis* found = hypothesis_of(answer, rival);
    double chi2 = std::numeric_limits<double>::infinity();
    if (found != nullptr && found->covariance.size() > 0) {
      const PlacedShape start{rival, found->shape.values, found->world_T_curve};
      chi2 = least_chi2(prior_scene, std::span(&start, 1));
    } else if (found != nullptr && answer.outlier_count == 0) {
      chi2 = found->chi2;
    }
    const int extra = degrees_of_freedom(truth) - degrees_of_freedom(rival);
    const double need =
        truth == CurveClass::Unclassified ? kToldFromEveryClass : needed_chi2(extra);
    if (chi2 / need < nearest) {
      nearest = chi2 / need;
      margin.nearest = rival;
      margin.chi2 = chi2;
    }
  }
  margin.occam = occam_against_richer(prior_scene);
  margin.told_apart = truth == CurveClass::Unclassified && nearest > 1.0;
  margin.determined =
      truth != CurveClass::Unclassified && nearest > 1.0 && margin.occam >= kOccamFactor;
  return margin;
}

}  // namespace palpate::test
