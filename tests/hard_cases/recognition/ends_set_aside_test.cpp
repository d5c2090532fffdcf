// Coarse strokes that leave a straight edge with their last samples, beside a dense one on it:
// round a corner of the part, or with the probe in the air.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "core/recognition/recognizer.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kNoiseOfEdge_m = 20e-6;

ContactSample touched_at(const Vec2& place_m, std::mt19937_64& rng) {
  std::normal_distribution<double> noise(0.0, kNoiseOfEdge_m);
  return {place_m + Vec2(noise(rng), noise(rng)), kNoiseOfEdge_m, 0};
}

/// `s_m`: along the edge y = 0, and from 0 on round a quarter of a circle that ends it, and down.
Vec2 round_corner(double s_m, double radius_m) {
  const double angle = std::clamp(s_m / radius_m, 0.0, 0.5 * kPi);
  return Vec2(std::min(s_m, 0.0), 0.0) + radius_m * Vec2(std::sin(angle), std::cos(angle) - 1.0) -
         Vec2(0.0, std::max(s_m - 0.5 * kPi * radius_m, 0.0));
}

Recognition answer_to(const std::vector<ContactSample>& dense,
                      const std::vector<ContactSample>& coarse) {
  Recognizer recognizer;
  recognizer.add({0, 0}, dense);
  recognizer.add({0, 1}, coarse);
  return recognizer.recognize();
}

std::vector<ContactSample> along_edge(double from_m, double to_m, int count, std::mt19937_64& rng) {
  std::vector<ContactSample> stroke;
  for (int i = 0; i < count; ++i) {
    stroke.push_back(touched_at({from_m + (to_m - from_m) * i / (count - 1), 0.0}, rng));
  }
  return stroke;
}

/// Three samples and more that leave the edge by five deviations of the noise show that the part is
/// no line. (Two may be spikes.)
TEST(EndsSetAside, RoundACornerMakeNoPartALine) {
  std::mt19937_64 rng = test::test_rng();
  int told = 0;
  for (const int count : {12, 16, 20}) {
    for (int i = 0; i < test::stress_count(200); ++i) {
      const double length_m = test::uniform(rng, 20e-3, 40e-3);
      const double radius_m = test::uniform(rng, 4e-3, 8e-3);
      const double from_m = -test::uniform(rng, 12e-3, 28e-3);
      const double to_m = test::uniform(rng, 4e-3, 20e-3);
      std::vector<ContactSample> coarse;
      int off = 0;
      for (int k = 0; k < count; ++k) {
        const Vec2 place_m = round_corner(from_m + (to_m - from_m) * k / (count - 1), radius_m);
        off += place_m.y() < -5.0 * kNoiseOfEdge_m ? 1 : 0;
        coarse.push_back(touched_at(place_m, rng));
      }
      if (off < 3) {
        continue;
      }
      const Recognition answer =
          answer_to(along_edge(-length_m, -0.3 * length_m, 150, rng), coarse);
      ++told;
      EXPECT_FALSE(answer.status == RecognitionStatus::Recognized &&
                   answer.shape.curve_class == CurveClass::Line)
          << count << " samples, scene " << i << ", " << off << " round the corner";
    }
  }
  EXPECT_GT(told, 0);
}

/// The probe leaves the edge at right angles: as well an edge and a corner. Nothing tells which.
TEST(EndsSetAside, InTheAirAreDoubted) {
  std::mt19937_64 rng = test::test_rng();
  for (const int in_air : {3, 4, 6}) {
    for (int i = 0; i < test::stress_count(20); ++i) {
      std::vector<ContactSample> coarse = along_edge(0.0, 20e-3, 16, rng);
      for (int k = 1; k <= in_air; ++k) {
        coarse.push_back(touched_at({20e-3, 1e-3 * k}, rng));
      }
      const Recognition answer = answer_to(along_edge(-20e-3, -5e-3, 150, rng), coarse);
      EXPECT_FALSE(answer.status == RecognitionStatus::Recognized &&
                   answer.shape.curve_class == CurveClass::Line)
          << in_air << " in the air, scene " << i;
    }
  }
}

}  // namespace
}  // namespace palpate
