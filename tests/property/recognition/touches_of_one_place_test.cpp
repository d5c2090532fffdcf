// Parts touched at few places, at each of them several times.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <random>
#include <vector>

#include "tests/support/answered_touches.h"
#include "tests/support/most_of_poisson.h"
#include "tests/support/parts_of_no_class.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kExtentOfPart = 0.025;               // half of it [m]
constexpr double kTouchSigma = 1e-3 * kExtentOfPart;  // [m]

/// Its distance from the middle in a direction, in half extents.
using Radius = std::function<double(double)>;

/// Every place so many times, in no order.
std::vector<Vec2> touched_again(const std::vector<Vec2>& places, int times, double sigma_m,
                                std::mt19937_64& rng) {
  std::vector<Vec2> touches;
  for (const Vec2& place : places) {
    for (int k = 0; k < times; ++k) {
      touches.push_back(place + test::normal_pair(rng, sigma_m));
    }
  }
  std::shuffle(touches.begin(), touches.end(), rng);
  return touches;
}

std::vector<Vec2> places_around(const Radius& radius, int count, std::mt19937_64& rng) {
  const Pose2 pose = test::pose_within(rng, 0.5);
  std::vector<Vec2> places;
  for (const double t : test::angles_around(count, rng)) {
    places.push_back(pose * Vec2(kExtentOfPart * radius(t) * Vec2(std::cos(t), std::sin(t))));
  }
  return places;
}

TEST(TouchesOfOnePlace, OfAPartOfNoClassDoNotMakeItOne) {
  // A class is RECOGNIZED from six places at the least, whatever is seen there.
  constexpr int kFewestPlacesOfAll = 6;
  std::mt19937_64 rng = test::test_rng();
  const int scenes = test::stress_count(10);
  int wrong = 0;
  double stated = 0.0;
  for (const auto& [name, radius] : test::parts_of_no_class()) {
    for (const int places : {4, 5, 6, 7}) {
      for (const int times : {2, 3, 4, 5}) {
        for (int i = 0; i < scenes; ++i) {
          const auto touches =
              touched_again(places_around(radius, places, rng), times, kTouchSigma, rng);
          const Recognition answer = test::answer_to_touches(touches, kTouchSigma);
          const bool recognized = test::is_recognized(answer);
          EXPECT_FALSE(recognized && places < kFewestPlacesOfAll)
              << name << " at " << places << " places, " << times
              << " times: " << name_of(answer.shape.curve_class);
          wrong += recognized ? 1 : 0;
          stated += recognized ? test::stated_doubt(answer) : 0.0;
        }
      }
    }
  }
  std::cout << "RECOGNIZED " << wrong << ", stated doubt " << stated << "\n";
  EXPECT_LE(wrong, test::most_of_poisson(stated)) << "stated " << stated;
}

/// The mean of each place as one touch, of as many times less variance.
TEST(TouchesOfOnePlace, SayWhatTheirMeanSays) {
  std::mt19937_64 rng = test::test_rng();
  const int scenes = test::stress_count(10);
  const auto ellipse = [](double t) { return 0.6 / std::hypot(0.6 * std::cos(t), std::sin(t)); };
  // Fits end within a hundredth of a deviation, and log odds so: of probabilities a quarter of
  // that.
  constexpr double kSame = 0.25 * 0.01;
  int compared = 0;
  for (const int count : {5, 7, 10}) {
    for (const int times : {2, 3, 5}) {
      for (int i = 0; i < scenes; ++i) {
        const std::vector<Vec2> places = places_around(ellipse, count, rng);
        std::vector<Vec2> touches;
        std::vector<Vec2> means(places.size(), Vec2::Zero());
        for (int k = 0; k < times; ++k) {  // round and round
          for (std::size_t p = 0; p < places.size(); ++p) {
            touches.push_back(places[p] + test::normal_pair(rng, kTouchSigma));
            means[p] += touches.back() / times;
          }
        }
        const Recognition answer = test::answer_to_touches(touches, kTouchSigma);
        const Recognition of_means =
            test::answer_to_touches(means, kTouchSigma / std::sqrt(static_cast<double>(times)));
        EXPECT_EQ(answer.sample_count, touches.size());
        if (answer.dwelling_count != touches.size() - places.size()) {
          continue;  // noise put a touch elsewhere
        }
        ++compared;
        EXPECT_EQ(answer.status, of_means.status);
        for (const Hypothesis& hypothesis : of_means.hypotheses) {
          const CurveClass curve_class = hypothesis.shape.curve_class;
          const Hypothesis* same = test::hypothesis_of(answer, curve_class);
          ASSERT_NE(same, nullptr);
          EXPECT_NEAR(same->probability, hypothesis.probability, kSame)
              << count << " places " << times << " times: " << name_of(curve_class);
        }
      }
    }
  }
  // Of two touches of a place one in a thousand is elsewhere, of five one in a hundred: of all
  // places less than a tenth of these parts.
  EXPECT_GE(compared, 9 * scenes * 8 / 10);
}

}  // namespace
}  // namespace palpate
