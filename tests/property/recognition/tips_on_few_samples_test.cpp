// Strokes of few samples by a round tip: neighbours do not tell the directions along which it is
// taken off, and a curve that is found does.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/recognition/recognizer.h"
#include "core/recognition/samples/work_limit.h"
#include "tests/support/answered_touches.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

/// Two strokes over a parabola with the focal length `focal_m` and about its vertex, by centres of
/// the tip outside of it.
Recognition answer_to_strokes(double focal_m, double tip_m, double sigma_m, std::mt19937_64& rng) {
  struct Stroke {
    double from, to;
    int samples;
  };
  RecognizerOptions options;
  options.sigma_m = sigma_m;
  options.touched_from = TouchedFrom::Outside;
  options.patience = kPatienceWithFiles;
  Recognizer recognizer(options);
  const Pose2 pose = test::pose_within(rng, 0.5);
  PatchContext context{0, 0, tip_m};
  for (const Stroke& stroke : {Stroke{0.3, 1.4, 9}, Stroke{-2.3, 0.7, 13}}) {
    std::vector<ContactSample> samples;
    for (int i = 0; i < stroke.samples; ++i) {
      const double t = stroke.from + (stroke.to - stroke.from) * i / (stroke.samples - 1);
      const Vec2 outwards = Vec2(-1.0, t).normalized();
      samples.push_back({pose * (focal_m * Vec2(t * t, 2.0 * t) + tip_m * outwards) +
                             test::normal_pair(rng, sigma_m),
                         0.0, 0});
    }
    recognizer.add(context, samples);
    ++context.patch;
  }
  return recognizer.recognize();
}

/// Where a cubic leads, its directions are those of all samples that show none, and the parabola
/// had no evidence along them: in 2 of 100 parts a spline had all of it.
TEST(TipsOnFewSamples, AreTakenOffAlongEveryClassesOwnDirections) {
  constexpr double kImprobable = 1e-4;
  std::mt19937_64 rng = test::test_rng();
  for (int part = 0; part < test::stress_count(200); ++part) {
    const double focal_m = 1e-3 * test::uniform(rng, 1.3, 2.0);
    const double tip_m = 1e-3 * test::uniform(rng, 2.0, 4.0);
    const double sigma_m = 1e-3 * std::pow(10.0, test::uniform(rng, -3.0, -2.0));
    const Recognition answer = answer_to_strokes(focal_m, tip_m, sigma_m, rng);
    double probability = 0.0;
    for (const Hypothesis& hypothesis : answer.hypotheses) {
      if (hypothesis.shape.curve_class == CurveClass::Parabola) {
        probability = hypothesis.probability;
      }
    }
    EXPECT_GT(probability, kImprobable) << "part " << part << ": " << test::said(answer);
  }
}

}  // namespace
}  // namespace palpate
