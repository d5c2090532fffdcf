// Where round tips touch, if no probe and no normal tells their side: what samples cannot show is
// not RECOGNIZED, and what is stated holds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/curves/pose2.h"
#include "core/numerics/probability/negligible.h"
#include "core/recognition/given/given_class.h"
#include "core/recognition/posterior/likelihood.h"
#include "core/recognition/recognizer.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kSigmaM = 1e-5;
constexpr double kTipM = 0.003;
constexpr double kCentresM = 0.030;  // radius of the circle of the tips' centres

Vec2 on_circle(double angle) {
  return Vec2(0.2, -0.1) + kCentresM * Vec2(std::cos(angle), std::sin(angle));
}

RecognizerOptions options_with(TouchedFrom touched_from) {
  RecognizerOptions options;
  options.touched_from = touched_from;
  return options;
}

/// Three strokes, or `touches` single touches, all round a circle, by a tip of untold side.
Recognition touched_circle(TouchedFrom touched_from, int touches,
                           MaterialSide side = MaterialSide::Unspecified) {
  auto rng = test::test_rng();
  std::normal_distribution<double> normal(0.0, kSigmaM);
  Recognizer recognizer(options_with(touched_from));
  const int patches = touches > 0 ? touches : 3;
  const int samples = touches > 0 ? 1 : 60;
  for (int patch = 0; patch < patches; ++patch) {
    std::vector<ContactSample> stroke;
    for (int i = 0; i < samples; ++i) {
      const double angle = 2.0 * kPi * (patch + 0.7 * i / samples) / patches;
      stroke.push_back({on_circle(angle) + Vec2(normal(rng), normal(rng)), kSigmaM, 0});
    }
    recognizer.add({0, static_cast<std::uint32_t>(patch), kTipM, side}, stroke);
  }
  return recognizer.recognize();
}

TEST(TouchedFrom, ACircleIsAPinOrABore) {
  for (const int touches : {0, 8, 12, 60}) {
    SCOPED_TRACE(touches);
    const Recognition untold = touched_circle(TouchedFrom::Unknown, touches);
    ASSERT_EQ(untold.shape.curve_class, CurveClass::Circle);
    EXPECT_EQ(untold.status, RecognitionStatus::Ambiguous);
    EXPECT_EQ(untold.doubt, Doubt::TwoShapes) << name_of(untold.doubt);
    EXPECT_NEAR(untold.shape.values[0], kCentresM - kTipM, 10.0 * kSigmaM);
    for (const bool inside : {false, true}) {
      const Recognition told =
          touched_circle(inside ? TouchedFrom::Inside : TouchedFrom::Outside, touches);
      ASSERT_EQ(told.shape.curve_class, CurveClass::Circle);
      EXPECT_EQ(told.status, RecognitionStatus::Recognized) << name_of(told.doubt);
      EXPECT_NEAR(told.shape.values[0], kCentresM + (inside ? kTipM : -kTipM), 10.0 * kSigmaM);
    }
  }
}

// The centres' directions put the surface of a thin pin far off, so that it was of no class, and
// the bore of the same centres was certain, against what was said.
TEST(TouchedFrom, APinThinnerThanTheTipIsNoBore) {
  constexpr double kPinM = 0.004;
  constexpr double kWideTipM = 0.008;
  constexpr double kLoudM = 2e-5;
  auto rng = test::test_rng();
  std::normal_distribution<double> normal(0.0, kLoudM);
  const int scenes = test::stress_count(100);
  int right = 0;
  for (int i = 0; i < scenes; ++i) {
    std::vector<std::vector<ContactSample>> strokes(2);
    for (std::size_t patch = 0; patch < strokes.size(); ++patch) {
      for (int k = 0; k < 100; ++k) {
        const double angle = 2.5 * static_cast<double>(patch) + 0.012 * k;
        const Vec2 centre = (kPinM + kWideTipM) * Vec2(std::cos(angle), std::sin(angle));
        const double x = normal(rng);
        strokes[patch].push_back({centre + Vec2(x, normal(rng)), kLoudM, 0});
      }
    }
    const auto answer_with = [&](TouchedFrom touched_from) {
      Recognizer recognizer(options_with(touched_from));
      for (std::size_t patch = 0; patch < strokes.size(); ++patch) {
        recognizer.add({0, static_cast<std::uint32_t>(patch), kWideTipM}, strokes[patch]);
      }
      return recognizer.recognize();
    };
    EXPECT_NE(answer_with(TouchedFrom::Unknown).status, RecognitionStatus::Recognized) << i;
    const Recognition told = answer_with(TouchedFrom::Outside);
    if (told.status == RecognitionStatus::Recognized) {
      EXPECT_NEAR(told.shape.values[0], kPinM,
                  kNegligibleDeviations * std::sqrt(told.covariance(0, 0)))
          << i;
      ++right;
    }
  }
  if (test::counts_tell()) {
    EXPECT_GE(right, 0.92 * scenes);  // what is asked of all curves that the samples determine
  }
}

/// Two strokes on either side of an ellipse, by centres of tips outside of it.
std::vector<std::vector<ContactSample>> strokes_outside_ellipse(std::mt19937_64& rng) {
  std::normal_distribution<double> normal(0.0, kSigmaM);
  const double first = test::uniform(rng, 0.0, 2.0 * kPi);
  std::vector<std::vector<ContactSample>> strokes(2);
  for (std::size_t patch = 0; patch < strokes.size(); ++patch) {
    for (int i = 0; i < 40; ++i) {
      const double t = first + 3.0 * static_cast<double>(patch) + 1.2 * i / 40.0;
      const Vec2 outwards = Vec2(0.02 * std::cos(t), 0.03 * std::sin(t)).normalized();
      const Vec2 place(0.03 * std::cos(t), 0.02 * std::sin(t));
      const double x = normal(rng);
      strokes[patch].push_back({place + kTipM * outwards + Vec2(x, normal(rng)), kSigmaM, 0});
    }
  }
  return strokes;
}

// Where a conic has all centres outside its bends, as is said, nothing is sought inside: that is
// half of all work, and an answer on few samples may take little.
TEST(TouchedFrom, SparesTheSearchOnTheOtherSide) {
  auto rng = test::test_rng();
  double work_if_said = 0.0;
  double work_if_not = 0.0;
  for (int part = 0; part < test::stress_count(20); ++part) {
    Recognizer said(options_with(TouchedFrom::Outside));
    Recognizer not_said(options_with(TouchedFrom::Unknown));
    std::uint32_t patch = 0;
    for (std::vector<ContactSample>& stroke : strokes_outside_ellipse(rng)) {
      said.add({0, patch, kTipM}, stroke);
      not_said.add({0, patch++, kTipM}, stroke);
    }
    const Recognition answer = said.recognize();
    EXPECT_EQ(answer.shape.curve_class, CurveClass::Ellipse);
    EXPECT_EQ(answer.status, RecognitionStatus::Recognized) << name_of(answer.doubt);
    work_if_said += answer.work.spent();
    work_if_not += not_said.recognize().work.spent();
  }
  EXPECT_LT(work_if_said, 0.6 * work_if_not);
}

// Strokes that travel against one another would lie on one side of their travel inside a bend and
// outside another: that is not what was said either.
TEST(TouchedFrom, SparesItHoweverStrokesTravel) {
  auto rng = test::test_rng();
  double work_along = 0.0;
  double work_against = 0.0;
  for (int part = 0; part < test::stress_count(20); ++part) {
    Recognizer along(options_with(TouchedFrom::Outside));
    Recognizer against(options_with(TouchedFrom::Outside));
    std::uint32_t patch = 0;
    for (std::vector<ContactSample>& stroke : strokes_outside_ellipse(rng)) {
      along.add({0, patch, kTipM}, stroke);
      if (patch == 1) {
        std::reverse(stroke.begin(), stroke.end());
      }
      against.add({0, patch++, kTipM}, stroke);
    }
    work_along += along.recognize().work.spent();
    work_against += against.recognize().work.spent();
  }
  // The same curves are fitted to the same points; searched the other way they end a step apart.
  EXPECT_LT(work_against, 1.1 * work_along);
}

/// Strokes whose sides are stated, then the first touch of the next one, as in every live stream:
/// with the wall that the strokes are on, the other side of the touch is not sought. 20 of 20 were
/// AMBIGUOUS by the limit of work until the new stroke had grown.
TEST(TouchedFrom, AStatedSideTellsThatOfTheNextTouch) {
  constexpr double kRadius = 1e-3, kSigma = 2e-5;  // [m]
  auto rng = test::test_rng();
  for (int part = 0; part < test::stress_count(20); ++part) {
    Recognizer recognizer;
    PatchContext context{0, 0, kRadius, MaterialSide::Left};
    const auto touch = [&](double from, double to, int samples) {
      std::vector<ContactSample> stroke;
      for (int i = 0; i < samples; ++i) {
        const double t = from + (to - from) * i / std::max(samples - 1, 1);
        const Vec2 outwards = Vec2(0.007 * std::cos(t), 0.012 * std::sin(t)).normalized();
        stroke.push_back({Vec2(0.012 * std::cos(t), 0.007 * std::sin(t)) + kRadius * outwards +
                              test::normal_pair(rng, kSigma),
                          kSigma, 0});
      }
      recognizer.add(context, stroke);
      ++context.patch;
    };
    touch(0.2, 1.6, 60);
    touch(2.5, 3.7, 60);
    touch(4.9, 4.9, 1);
    const Recognition answer = recognizer.recognize();
    EXPECT_EQ(answer.shape.curve_class, CurveClass::Ellipse);
    EXPECT_NE(answer.doubt, Doubt::WorkLimit) << part;
  }
}

TEST(TouchedFrom, AStatedSideHoldsAgainstIt) {
  // Against the clock, material on the right: a bore.
  const Recognition bore = touched_circle(TouchedFrom::Outside, 0, MaterialSide::Right);
  EXPECT_EQ(bore.status, RecognitionStatus::Recognized) << name_of(bore.doubt);
  EXPECT_NEAR(bore.shape.values[0], kCentresM + kTipM, 10.0 * kSigmaM);
}

// However its strokes travel, and however short they are: with them on either side, ways by the
// bends of their noise may leave one that fits and none that is its mirror image.
TEST(TouchedFrom, AnEdgeUnderShortStrokesHasNoOutside) {
  auto rng = test::test_rng();
  std::normal_distribution<double> normal(0.0, kSigmaM);
  for (int part = 0; part < test::stress_count(240); ++part) {
    RecognizerOptions options;
    options.sigma_m = part % 2 == 0 ? kSigmaM : 0.0;
    Recognizer recognizer(options);
    const int strokes = std::uniform_int_distribution(6, 13)(rng);
    const int readings = std::uniform_int_distribution(1, 5)(rng);
    for (int patch = 0; patch < strokes; ++patch) {
      std::vector<ContactSample> stroke;
      for (int place = 0; place < 2; ++place) {
        const double along_m =
            0.08 * (patch + 0.5 * place + test::uniform(rng, 0.0, 0.4)) / strokes;
        for (int i = 0; i < readings; ++i) {
          stroke.push_back({Vec2(along_m, kTipM) + Vec2(normal(rng), normal(rng)), 0.0, 0});
        }
      }
      if (test::random_sign(rng) < 0.0) {
        std::reverse(stroke.begin(), stroke.end());
      }
      recognizer.add({0, static_cast<std::uint32_t>(patch), kTipM}, stroke);
    }
    const Recognition answer = recognizer.recognize();
    EXPECT_FALSE(answer.status == RecognitionStatus::Recognized &&
                 answer.shape.curve_class == CurveClass::Line)
        << part;
  }
}

/// One side of a hyperbola, strokes by a tip outside of it. The wall two radii off, inside of the
/// bend, is one that fits as well, and of a shape that is more probable beforehand by as much as
/// touches from inside are less so: that was RECOGNIZED, of 35 of 40 noises.
TEST(TouchedFrom, HowProbableAShapeIsTellsNoSide) {
  constexpr double kA = 0.0468, kB = 0.0202, kRadius = 0.0157, kSigma = 6.5e-7;  // [m]
  auto rng = test::test_rng();
  int two_shapes = 0;
  constexpr int kNoises = 20;
  for (int noise = 0; noise < kNoises; ++noise) {
    Recognizer recognizer;
    PatchContext context{0, 0, kRadius};
    for (const double from : {1.18, 1.49, 1.79}) {
      std::vector<ContactSample> stroke;
      for (int i = 0; i < 60; ++i) {
        const double t = from + 0.25 * i / 59;
        const Vec2 outwards = Vec2(-kB * std::cosh(t), kA * std::sinh(t)).normalized();
        stroke.push_back({Vec2(kA * std::cosh(t), kB * std::sinh(t)) + kRadius * outwards +
                              test::normal_pair(rng, kSigma),
                          kSigma, 0});
      }
      recognizer.add(context, stroke);
      ++context.patch;
    }
    const Recognition answer = recognizer.recognize();
    EXPECT_NE(answer.status, RecognitionStatus::Recognized) << noise;
    two_shapes += answer.doubt == Doubt::TwoShapes ? 1 : 0;
  }
  EXPECT_GT(two_shapes, kNoises / 2);
}

TEST(TouchedFrom, ALineHasNoOutside) {
  for (const TouchedFrom from : {TouchedFrom::Unknown, TouchedFrom::Outside, TouchedFrom::Inside}) {
    auto rng = test::test_rng();
    std::normal_distribution<double> normal(0.0, kSigmaM);
    Recognizer recognizer(options_with(from));
    for (std::uint32_t patch = 0; patch < 3; ++patch) {
      std::vector<ContactSample> stroke;
      for (int i = 0; i < 60; ++i) {
        stroke.push_back(
            {Vec2(0.03 * patch + 3e-4 * i, 0.0) + Vec2(normal(rng), normal(rng)), kSigmaM, 0});
      }
      recognizer.add({0, patch, kTipM}, stroke);
    }
    const Recognition answer = recognizer.recognize();
    ASSERT_EQ(answer.shape.curve_class, CurveClass::Line);
    EXPECT_NE(answer.status, RecognitionStatus::Recognized);
    EXPECT_EQ(answer.doubt, Doubt::TwoShapes) << name_of(answer.doubt);
  }
}

/// Tips' centres along an ellipse of 40 and 20 mm, touched from one side.
std::vector<GivenPoint> touched_ellipse(bool inside, double noise_m, double stated_m) {
  auto rng = test::test_rng();
  std::normal_distribution<double> normal(0.0, noise_m);
  std::vector<GivenPoint> points;
  for (int i = 0; i < 40; ++i) {
    const double t = 2.0 * kPi * i / 40;
    const Vec2 place(0.040 * std::cos(t), 0.020 * std::sin(t));
    const Vec2 out = Vec2(0.020 * std::cos(t), 0.040 * std::sin(t)).normalized();
    GivenPoint& point = points.emplace_back();
    point.position_m = place + (inside ? -kTipM : kTipM) * out + Vec2(normal(rng), normal(rng));
    point.sigma_m = stated_m;
    point.tip_radius_m = kTipM;
  }
  return points;
}

TEST(GivenTouchedFrom, ResidualsTellTheSideOrDoNot) {
  const double needed = log_odds(0.95);
  for (const bool inside : {false, true}) {
    for (const double stated_m : {0.0, 1e-5}) {
      const auto points = touched_ellipse(inside, 1e-5, stated_m);
      const GivenFit fit = fit_given_class(CurveClass::Ellipse, points);
      ASSERT_EQ(fit.status, GivenStatus::Fitted);
      EXPECT_NEAR(fit.shape.values[1], 0.020, 1e-4);
      EXPECT_GT(fit.side_log_odds, needed);
      EXPECT_TRUE(std::isfinite(fit.side_log_odds));
    }
    // Noise of 2 mm hides which side it is.
    const auto coarse = touched_ellipse(inside, 2e-3, 2e-3);
    EXPECT_LT(fit_given_class(CurveClass::Ellipse, coarse).side_log_odds, needed);
    const GivenFit told = fit_given_class(
        CurveClass::Ellipse, coarse, {0.0, inside ? TouchedFrom::Inside : TouchedFrom::Outside});
    EXPECT_EQ(told.side_log_odds, std::numeric_limits<double>::infinity());
    EXPECT_NEAR(told.shape.values[1], 0.020, 0.002);
  }
}

TEST(GivenTouchedFrom, ACircleFitsAlikeOnBothSides) {
  for (const double stated_m : {0.0, 1e-6}) {
    for (int count = 4; count < 24; ++count) {
      std::vector<GivenPoint> points(static_cast<std::size_t>(count));
      for (int i = 0; i < count; ++i) {
        GivenPoint& point = points[static_cast<std::size_t>(i)];
        point.position_m = on_circle(0.3 + 2.0 * kPi * i / count);
        point.sigma_m = stated_m;
        point.tip_radius_m = kTipM;
      }
      const GivenFit untold = fit_given_class(CurveClass::Circle, points);
      EXPECT_NEAR(untold.shape.values[0], kCentresM - kTipM, 1e-12);
      EXPECT_LT(std::abs(untold.side_log_odds), 0.01 * count);
      const GivenFit bore = fit_given_class(CurveClass::Circle, points, {0.0, TouchedFrom::Inside});
      EXPECT_NEAR(bore.shape.values[0], kCentresM + kTipM, 1e-12);
      EXPECT_EQ(bore.side_log_odds, std::numeric_limits<double>::infinity());
      // What a point says of the material holds against the option.
      points.front().into_material = points.front().position_m - Vec2(0.2, -0.1);
      const GivenFit stated =
          fit_given_class(CurveClass::Circle, points, {0.0, TouchedFrom::Outside});
      EXPECT_NEAR(stated.shape.values[0], kCentresM + kTipM, 1e-12);
    }
  }
}

}  // namespace
}  // namespace palpate
