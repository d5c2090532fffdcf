#include "core/curves/rounded_corner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "tests/support/test_rng.h"

namespace palpate {
namespace {

RoundedCorner any_corner(std::mt19937_64& rng) {
  return {{test::uniform(rng, -1.0, 1.0), test::uniform(rng, -1.0, 1.0)},
          test::uniform(rng, -kPi, kPi),
          test::uniform(rng, 0.1, 0.5 * kPi),
          test::uniform(rng, 0.1, 1.0)};
}

Vec2 towards(double angle) { return {std::cos(angle), std::sin(angle)}; }

/// Both edges, three long, and the arc.
std::vector<Vec2> places_of(const RoundedCorner& corner, int steps) {
  std::vector<Vec2> places;
  for (const double side : {-1.0, 1.0}) {
    const Vec2 normal = towards(corner.bisector + side * corner.half_turn);
    const Vec2 along = side * left_of(normal);
    for (int i = 0; i <= steps; ++i) {
      places.push_back(corner.centre + corner.radius * normal + 3.0 * i / steps * along);
      const double angle = corner.bisector + side * corner.half_turn * i / steps;
      places.push_back(corner.centre + corner.radius * towards(angle));
    }
  }
  return places;
}

// Points whose nearest places are not beyond those that are compared.
TEST(RoundedCorner, DistanceIsThatOfTheNearestPlace) {
  std::mt19937_64 rng = test::test_rng();
  constexpr int kSteps = 3000;  // a thousandth apart: no nearer than half of it
  for (int i = 0; i < test::stress_count(50); ++i) {
    const RoundedCorner corner = any_corner(rng);
    const std::vector<Vec2> places = places_of(corner, kSteps);
    for (int k = 0; k < 20; ++k) {
      const Vec2 on = places[rng() % places.size()];
      if ((on - corner.centre).norm() > 2.0) {
        continue;
      }
      const double off = test::uniform(rng, -0.9, 1.0) * corner.radius;
      const Vec2 away = towards(test::uniform(rng, -kPi, kPi));
      const Vec2 point = on + off * away;
      const double distance = corner.distance(point).value;
      double nearest = std::numeric_limits<double>::infinity();
      for (const Vec2& place : places) {
        nearest = std::min(nearest, (place - point).norm());
      }
      EXPECT_NEAR(std::abs(distance), nearest, 1e-3) << i << " " << k;
    }
  }
}

TEST(RoundedCorner, TangentGoesAboutTheCentreAcrossTheDistance) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < test::stress_count(50); ++i) {
    const RoundedCorner corner = any_corner(rng);
    for (const Vec2& place : places_of(corner, 20)) {
      const Vec2 tangent = corner.tangent(place);
      EXPECT_NEAR(tangent.norm(), 1.0, 1e-14);
      EXPECT_NEAR(corner.distance(place).gradient.head<2>().dot(tangent), 0.0, 1e-14);
      EXPECT_GT(cross(place - corner.centre, tangent), 0.0);
    }
  }
}

TEST(RoundedCorner, IsItsOwnPlaces) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < test::stress_count(50); ++i) {
    const RoundedCorner corner = any_corner(rng);
    for (const Vec2& place : places_of(corner, 20)) {
      EXPECT_NEAR(corner.distance(place).value, 0.0, 1e-14);
    }
  }
}

TEST(RoundedCorner, GradientIsThatOfTheDistance) {
  std::mt19937_64 rng = test::test_rng();
  constexpr double kStep = 1e-6;  // errors of 1e-12, and of rounding, 1e-10
  for (int i = 0; i < test::stress_count(200); ++i) {
    const RoundedCorner corner = any_corner(rng);
    const Vec2 point(test::uniform(rng, -3.0, 3.0), test::uniform(rng, -3.0, 3.0));
    const RoundedCorner::Distance distance = corner.distance(point);
    for (int k = 0; k < 5; ++k) {
      const auto moved = [&](double by) {
        RoundedCorner other = corner;
        double* const values[] = {&other.centre.x(), &other.centre.y(), &other.bisector,
                                  &other.half_turn, &other.radius};
        *values[k] += by;
        return other.distance(point);
      };
      const RoundedCorner::Distance ahead = moved(kStep);
      const RoundedCorner::Distance behind = moved(-kStep);
      if (ahead.part == behind.part) {
        EXPECT_NEAR(distance.gradient[k], (ahead.value - behind.value) / (2.0 * kStep), 1e-8)
            << i << " " << k;
      }
    }
  }
}

}  // namespace
}  // namespace palpate
