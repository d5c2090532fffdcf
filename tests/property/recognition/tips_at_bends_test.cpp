// Strokes of a round tip about the bend of a spline that is far sharper than the tip.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <iostream>
#include <random>
#include <vector>

#include "core/curves/cubic_spline.h"
#include "core/numerics/probability/negligible.h"
#include "core/recognition/recognizer.h"
#include "core/recognition/samples/work_limit.h"
#include "tests/support/answered_touches.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kTipRadius = 3e-3;  // [m]

/// Where the centre of the tip is as it touches places of even spacing along the outside of the
/// bend, left of rising t.
std::vector<Vec2> centres_about(const CubicSpline& spline, double t_begin, double t_end,
                                std::size_t samples) {
  constexpr int kSteps = 20000;
  const auto at = [&](int i) { return t_begin + (t_end - t_begin) * i / kSteps; };
  std::vector<double> length = {0.0};
  for (int i = 1; i <= kSteps; ++i) {
    length.push_back(length.back() + (spline.position(at(i)) - spline.position(at(i - 1))).norm());
  }
  std::vector<Vec2> centres;
  for (std::size_t k = 0; k < samples; ++k) {
    const double due = length.back() * static_cast<double>(k) / static_cast<double>(samples - 1);
    const auto i = std::lower_bound(length.begin(), length.end(), due) - length.begin();
    const double t = at(static_cast<int>(i));
    centres.emplace_back(spline.position(t) +
                         kTipRadius * left_of(spline.derivatives(t).first).normalized());
  }
  return centres;
}

/// One stroke of a probe that is driven from place to place of the surface, as along a drawing:
/// about a bend of a fifteenth to a twenty-fifth of the tip's radius its centre takes long steps.
Recognition stroked_about(std::mt19937_64& rng) {
  constexpr double kSigma = 1e-5;  // [m]
  constexpr std::size_t kSamples = 200;
  const double root = std::sqrt(1e-3);  // of a millimetre
  const CubicSpline spline{test::uniform(rng, 0.31, 0.34) / root, test::uniform(rng, -1.0, -0.85),
                           test::uniform(rng, 0.5, 0.6) * root};
  const Pose2 pose = test::pose_within(rng, 0.2);
  std::vector<ContactSample> samples;
  for (const Vec2& centre : centres_about(spline, -0.35 * root, 2.3 * root, kSamples)) {
    samples.push_back({pose * centre + test::normal_pair(rng, kSigma), kSigma, 0});
  }
  PatchContext context;
  context.tip_radius_m = kTipRadius;
  context.material_side = MaterialSide::Right;
  RecognizerOptions options;
  options.patience = kPatienceWithFiles;
  Recognizer recognizer(options);
  recognizer.add(context, samples);
  return recognizer.recognize();
}

TEST(TipsAtBends, StrokesAreOfTheirClass) {
  std::mt19937_64 rng = test::test_rng();
  const int scenes = test::stress_count(200);
  int right = 0;
  for (int i = 0; i < scenes; ++i) {
    const Recognition answer = stroked_about(rng);
    const Hypothesis* truth = test::hypothesis_of(answer, CurveClass::CubicSpline);
    // A true class has less in no more than so many scenes: in one of these, never.
    EXPECT_GT(truth == nullptr ? 0.0 : truth->probability, kNegligibleProbability)
        << i << ": " << test::said(answer);
    right += truth != nullptr && truth == answer.hypotheses.data() ? 1 : 0;
  }
  std::cout << "of " << scenes << " the spline is the most probable in " << right << "\n";
}

}  // namespace
}  // namespace palpate
