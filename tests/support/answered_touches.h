// Single touches, as places in the order in which they came, with the recognizer's answer.
#pragma once

#include <random>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "core/recognition/recognizer.h"
#include "tests/support/test_rng.h"

namespace palpate::test {

/// Each as a patch of its own. `sigma_m`: stated by every touch; 0 = not known.
inline Recognition answer_to_touches(std::span<const Vec2> touches_m, double sigma_m,
                                     const RecognizerOptions& options = {}) {
  Recognizer recognizer(options);
  PatchContext context;
  for (const Vec2& touch_m : touches_m) {
    const ContactSample sample{touch_m, sigma_m, 0};
    recognizer.add(context, {&sample, 1});
    ++context.patch;
  }
  return recognizer.recognize();
}

inline Vec2 normal_pair(std::mt19937_64& rng, double sigma) {
  std::normal_distribution<double> law(0.0, sigma);
  const double x = law(rng);
  return {x, law(rng)};
}

inline Pose2 pose_within(std::mt19937_64& rng, double most_m) {
  const double x = uniform(rng, -most_m, most_m);
  const double y = uniform(rng, -most_m, most_m);
  return {x, y, uniform(rng, -kPi, kPi)};
}

/// So many angles all around, evenly but for half a step at most. [rad]
inline std::vector<double> angles_around(int count, std::mt19937_64& rng) {
  std::vector<double> angles;
  for (int i = 0; i < count; ++i) {
    angles.push_back(2.0 * kPi * (i + uniform(rng, -0.25, 0.25)) / count);
  }
  return angles;
}

/// Whether RECOGNIZED as one of the eight classes.
inline bool is_recognized(const Recognition& answer) {
  return answer.status == RecognitionStatus::Recognized &&
         answer.shape.curve_class != CurveClass::Unclassified;
}

/// How probable it is that the most probable class is not the true one, as the answer says.
inline double stated_doubt(const Recognition& answer) {
  return answer.hypotheses.empty() ? 1.0 : 1.0 - answer.hypotheses.front().probability;
}

/// Status, doubt, noise, and the classes with their probabilities and chi-squares, for messages.
inline std::string said(const Recognition& answer) {
  std::ostringstream text;
  text << (answer.status == RecognitionStatus::Recognized ? "RECOGNIZED" : name_of(answer.doubt))
       << ", noise " << answer.sigma_m << " m, " << answer.outlier_count << " set aside";
  for (const Hypothesis& hypothesis : answer.hypotheses) {
    if (hypothesis.probability > 1e-4) {
      text << "; " << name_of(hypothesis.shape.curve_class) << " " << hypothesis.probability << ", "
           << hypothesis.chi2 << " of " << hypothesis.dof;
    }
  }
  return text.str();
}

}  // namespace palpate::test
