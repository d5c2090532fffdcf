// Strokes of few samples on long arcs, by a probe so good that no polynomial follows them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "core/recognition/recognizer.h"
#include "tests/support/most_of_poisson.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

using Strokes = std::vector<std::vector<Vec2>>;

double uniform(std::mt19937_64& rng, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(rng);
}

/// Places on a curve, the parameter running from `from` to `to`; the steps even or growing.
std::vector<Vec2> stroke(const std::function<Vec2(double)>& curve, double from, double to,
                         int count, bool growing) {
  std::vector<Vec2> places;
  for (int i = 0; i < count; ++i) {
    const double u = static_cast<double>(i) / (count - 1);
    places.push_back(curve(from + (to - from) * (growing ? u * u : u)));
  }
  return places;
}

Recognition answer_to(const Strokes& strokes, double sigma_m, std::mt19937_64& rng) {
  std::normal_distribution<double> noise(0.0, sigma_m);
  Recognizer recognizer;
  for (std::size_t p = 0; p < strokes.size(); ++p) {
    std::vector<ContactSample> samples;
    for (const Vec2& place : strokes[p]) {
      const double x = noise(rng);
      samples.push_back({place + Vec2(x, noise(rng)), sigma_m, 0});
    }
    recognizer.add({.probe = 0, .patch = static_cast<std::uint32_t>(p)}, samples);
  }
  return recognizer.recognize();
}

/// Scenes of one class. RECOGNIZED answers may be wrong as often as their probabilities say.
void expect_honest(const std::string& name, CurveClass truth,
                   const std::function<Strokes(std::mt19937_64&)>& touched) {
  std::mt19937_64 rng = test::test_rng();
  constexpr int kScenes = 100;
  int right = 0;
  int wrong = 0;
  double expected = 0.0;
  for (int i = 0; i < kScenes; ++i) {
    const double sigma = std::pow(10.0, uniform(rng, -6.0, -4.0));
    const Recognition answer = answer_to(touched(rng), sigma, rng);
    if (answer.status == RecognitionStatus::Recognized) {
      const bool is_right = answer.shape.curve_class == truth;
      right += is_right ? 1 : 0;
      wrong += is_right ? 0 : 1;
      expected += 1.0 - answer.hypotheses.front().probability;
    }
  }
  EXPECT_LE(wrong, test::most_of_poisson(expected)) << name << ", expected " << expected;
  // The noise is a ten-thousandth of the size at most, and more samples than parameters speak.
  EXPECT_GE(right, kScenes / 2) << name;
}

TEST(CoarseStrokes, CircleIsNoEllipse) {
  expect_honest("circle", CurveClass::Circle, [](std::mt19937_64& rng) {
    const double begin = uniform(rng, 0.0, 2.0 * kPi);
    const double turn = uniform(rng, 1.5, 6.0);
    const int count = static_cast<int>(uniform(rng, 10.0, 30.0));
    const auto circle = [](double t) { return Vec2(std::cos(t), std::sin(t)); };
    return Strokes{stroke(circle, begin, begin + turn, count, uniform(rng, 0.0, 1.0) < 0.5)};
  });
}

TEST(CoarseStrokes, ParabolaIsNoEllipse) {
  expect_honest("parabola", CurveClass::Parabola, [](std::mt19937_64& rng) {
    const double a = uniform(rng, 0.1, 0.4);
    const int count = static_cast<int>(uniform(rng, 10.0, 30.0));
    const auto parabola = [a](double t) { return Vec2(t * t / (4.0 * a), t); };
    const double end = uniform(rng, 0.6, 1.0);
    return Strokes{stroke(parabola, -1.0, end, count, uniform(rng, 0.0, 1.0) < 0.5)};
  });
}

TEST(CoarseStrokes, SharpEllipseIsAnEllipse) {
  // An eighth as wide as long: round its ends neighbours lie on opposite sides.
  expect_honest("sharp ellipse", CurveClass::Ellipse, [](std::mt19937_64& rng) {
    const double b = uniform(rng, 0.1, 0.2);
    const auto ellipse = [b](double t) { return Vec2(std::cos(t), b * std::sin(t)); };
    Strokes strokes;
    for (const int count : {7, 15, 40, 8}) {
      const double begin = uniform(rng, 0.0, 2.0 * kPi);
      strokes.push_back(stroke(ellipse, begin, begin + uniform(rng, 1.0, 2.5), count, false));
    }
    return strokes;
  });
}

TEST(CoarseStrokes, SemiCubicalParabolaIsNoSpline) {
  // Over the cusp, in even steps of t: slow there, there and back.
  expect_honest("semi-cubical parabola", CurveClass::SemiCubicalParabola, [](std::mt19937_64& rng) {
    const double a = uniform(rng, 0.5, 2.0);
    const double b = uniform(rng, -1.0, 1.0);
    const auto curve = [a, b](double t) { return Vec2(t * t, (a * t + b) * t * t); };
    const int count = static_cast<int>(uniform(rng, 40.0, 500.0));
    return Strokes{stroke(curve, uniform(rng, -1.0, -0.5), uniform(rng, 0.5, 1.0), count, false)};
  });
}

/// There and back along an arc, so many samples each way.
std::vector<Vec2> back_and_forth(const std::function<Vec2(double)>& curve, double from, double to,
                                 int passes, int each) {
  std::vector<Vec2> places;
  for (int i = 0; i <= passes * each; ++i) {
    const double on = std::abs(std::fmod(static_cast<double>(i) / each + 1.0, 2.0) - 1.0);
    places.push_back(curve(from + (to - from) * on));
  }
  return places;
}

TEST(CoarseStrokes, BackAndForthAreOfTheSameClass) {
  const auto passes = [](std::mt19937_64& rng) {
    return static_cast<int>(uniform(rng, 2.0, 11.0));
  };
  const auto each = [](std::mt19937_64& rng) { return static_cast<int>(uniform(rng, 5.0, 13.0)); };
  expect_honest("ellipse", CurveClass::Ellipse, [&](std::mt19937_64& rng) {
    const double b = uniform(rng, 0.5, 0.8);
    const auto ellipse = [b](double t) { return Vec2(std::cos(t), b * std::sin(t)); };
    return Strokes{back_and_forth(ellipse, 0.3, uniform(rng, 2.3, 2.8), passes(rng), each(rng))};
  });
  expect_honest("cubical parabola", CurveClass::CubicalParabola, [&](std::mt19937_64& rng) {
    const double c = uniform(rng, -0.4, -0.2);
    const auto cubical = [c](double t) { return Vec2(t, (0.6 * t * t + c) * t); };
    return Strokes{back_and_forth(cubical, -1.0, uniform(rng, 0.8, 1.0), passes(rng), each(rng))};
  });
}

}  // namespace
}  // namespace palpate
