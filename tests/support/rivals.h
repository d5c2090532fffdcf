// What the recogniser knows of a scene's rivals, as starting points of the margin's own fits.
#pragma once

#include "tests/support/class_margin.h"
#include "tests/support/scene_data.h"

namespace palpate::test {

struct Margin {
  bool determined = false;                        ///< the data determine the class (class_margin.h)
  bool told_apart = false;                        ///< of a curve of no class: long enough to tell
  CurveClass nearest = CurveClass::Unclassified;  ///< the rival that comes nearest to its need
  double chi2 = 0.0;                              ///< that it leaves without noise
  double occam = 0.0;                             ///< occam_against_richer
};

/// From the answers on the points without noise, one class allowed at a time: each is refined here
/// before it counts, so that a poor fit of the recogniser makes no scene determined. A rival that
/// it does not find at all would; that costs the recogniser a failure, never a success.
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
