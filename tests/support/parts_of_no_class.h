// Closed outlines that are of none of the eight classes, in half extents.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

#include "core/curves/pose2.h"

namespace palpate::test {

struct NoClassPart {
  std::string name;
  std::function<double(double)> radius;  ///< from the middle, by its angle [rad]

  Vec2 at(double angle) const { return radius(angle) * Vec2(std::cos(angle), std::sin(angle)); }
};

/// A convex polygon, given by its sides' normals over their distances from the middle, whose
/// corners are rounded: the tenth root of a sum of tenth powers instead of the largest.
inline double radius_within(std::initializer_list<Vec2> sides, double angle) {
  constexpr int kPower = 10;
  double sum = 0.0;
  for (const Vec2& side : sides) {
    sum += std::pow(std::max(side.dot(Vec2(std::cos(angle), std::sin(angle))), 0.0), kPower);
  }
  return std::pow(sum, -1.0 / kPower);
}

inline std::vector<NoClassPart> parts_of_no_class() {
  const auto superellipse = [](double angle) {
    return std::pow(std::pow(std::cos(angle), 4) + std::pow(std::sin(angle) / 0.7, 4), -0.25);
  };
  const auto rectangle = [](double angle) {
    return radius_within({{1.0, 0.0}, {0.0, 1.5}, {-1.0, 0.0}, {0.0, -1.5}}, angle);
  };
  const auto triangle = [](double angle) {
    const double half = std::sqrt(3.0);
    return radius_within({{-2.0, 0.0}, {1.0, half}, {1.0, -half}}, angle);
  };
  return {{"superellipse", superellipse},
          {"rounded rectangle", rectangle},
          {"rounded triangle", triangle}};
}

}  // namespace palpate::test
