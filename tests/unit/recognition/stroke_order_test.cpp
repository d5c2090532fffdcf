#include "core/recognition/samples/stroke_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <vector>

#include "core/recognition/recognizer.h"
#include "tests/support/answered_touches.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kExtent = 0.072;  // of the ellipse: the diagonal of its box [m]

/// Places on an ellipse, at these shares of a turn.
std::vector<Vec2> around(const std::vector<double>& turns) {
  std::vector<Vec2> places;
  for (const double turn : turns) {
    const double t = 2.0 * kPi * turn;
    places.push_back({0.03 * std::cos(t), 0.02 * std::sin(t)});
  }
  return places;
}

std::vector<double> evenly(int count) {
  std::vector<double> turns;
  for (int i = 0; i < count; ++i) turns.push_back(static_cast<double>(i) / count);
  return turns;
}

TEST(StrokeOrder, OnceRoundIsAStroke) {
  for (const int count : {5, 6, 7, 8, 12, 40, 400}) {
    EXPECT_FALSE(leads_to_and_fro(around(evenly(count)), kExtent)) << count;
  }
}

TEST(StrokeOrder, ThereAndBackIsAStroke) {
  std::vector<double> turns;
  for (int k = 0; k < 4; ++k) {
    for (int i = 0; i < 10; ++i) turns.push_back(0.05 * (k % 2 == 0 ? i : 9 - i));
  }
  EXPECT_FALSE(leads_to_and_fro(around(turns), kExtent));
}

// As one touches a ring by hand: each time across it.
TEST(StrokeOrder, OppositePlacesInTurnAreNoStroke) {
  std::vector<double> turns;
  for (int i = 0; i < 6; ++i) {
    turns.push_back(i / 12.0);
    turns.push_back(0.5 + i / 12.0);
  }
  EXPECT_TRUE(leads_to_and_fro(around(turns), kExtent));
}

// By the samples themselves it has no order, and is no longer than their noise.
TEST(StrokeOrder, AShortStrokeOfMuchNoiseIsOne) {
  std::mt19937_64 rng = test::test_rng();
  std::vector<Vec2> places;
  for (int i = 0; i < 20; ++i) places.push_back(Vec2(7e-5 * i, 0.0) + test::normal_pair(rng, 3e-4));
  EXPECT_FALSE(leads_to_and_fro(places, kExtent));
}

TEST(StrokeOrder, TouchesThatAreEachToldTwiceAreNone) {
  std::mt19937_64 rng = test::test_rng();
  std::vector<Vec2> places = around(evenly(20));
  std::shuffle(places.begin(), places.end(), rng);
  std::vector<Vec2> twice;
  for (const Vec2& place : places) twice.insert(twice.end(), 2, place);
  EXPECT_TRUE(leads_to_and_fro(twice, kExtent));
}

TEST(StrokeOrder, SpikesInAThirdOfDenseSamplesMakeNone) {
  std::mt19937_64 rng = test::test_rng();
  std::vector<Vec2> places = around(evenly(90));
  for (Vec2& place : places) {
    if (rng() % 3 == 0) place += test::normal_pair(rng, 0.03);
  }
  EXPECT_FALSE(leads_to_and_fro(places, kExtent));
}

// Von Neumann's ratio of n places in random order has the mean n / (n - 1) and less than the
// variance 1 / n: from twelve on the limit lies two deviations below it, and more.
TEST(StrokeOrder, RandomOrderIsNoStroke) {
  std::mt19937_64 rng = test::test_rng();
  constexpr int kScenes = 1000;
  for (const int count : {12, 20, 40}) {
    int seen = 0;
    for (int i = 0; i < kScenes; ++i) {
      std::vector<Vec2> places = around(evenly(count));
      std::shuffle(places.begin(), places.end(), rng);
      seen += leads_to_and_fro(places, kExtent) ? 1 : 0;
    }
    EXPECT_GE(seen, 975 * kScenes / 1000) << count;
  }
}

// A node gets them so from whoever numbers no touches.
TEST(StrokeOrder, TouchesSentAsOneStrokeAreNotRecognizedByTheirPath) {
  std::mt19937_64 rng = test::test_rng();
  const int scenes = test::stress_count(100);
  int recognized = 0;
  int in_no_order = 0;
  for (int i = 0; i < scenes; ++i) {
    const bool stated = i % 2 == 0;
    constexpr double kSigma = 5e-6;  // [m]
    std::vector<Vec2> places = around(evenly(8 + static_cast<int>(rng() % 33)));
    std::shuffle(places.begin(), places.end(), rng);
    if (!leads_to_and_fro(places, kExtent)) continue;
    ++in_no_order;
    std::vector<ContactSample> samples;
    for (const Vec2& place : places) {
      samples.push_back({place + test::normal_pair(rng, kSigma), stated ? kSigma : 0.0, 0});
    }
    Recognizer recognizer;
    recognizer.add({}, samples);
    const Recognition answer = recognizer.recognize();
    if (answer.status == RecognitionStatus::Recognized) {
      ++recognized;
      EXPECT_TRUE(stated);
      EXPECT_EQ(answer.shape.curve_class, CurveClass::Ellipse) << test::said(answer);
    }
  }
  std::cout << "touches sent as one stroke: RECOGNIZED " << recognized << " of " << in_no_order
            << "\n";
  EXPECT_GE(in_no_order, scenes / 2);
}

}  // namespace
}  // namespace palpate
