#include "core/part/nearest_node.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace palpate {
namespace {

/// Nodes in a leaf. A node costs about as much time as a circle.
constexpr std::size_t kLeafNodes = 8;

}  // namespace

NearestNode::NearestNode(std::vector<Vec2> nodes) : nodes_(std::move(nodes)) {
  assert(!nodes_.empty());
  while (leaf_count_ * kLeafNodes < nodes_.size()) {
    leaf_count_ *= 2;
  }
  circles_.resize(2 * leaf_count_);
  for (std::size_t i = circles_.size() - 1; i > 0; --i) {
    // The leaves below circle i, left to right.
    std::size_t first = i;
    std::size_t last = i;
    while (first < leaf_count_) {
      first = 2 * first;
      last = 2 * last + 1;
    }
    const auto clipped = [&](std::size_t leaf) {
      return std::min((leaf - leaf_count_) * kLeafNodes, nodes_.size());
    };
    const std::size_t begin = clipped(first);
    const auto within = std::span(nodes_).subspan(begin, clipped(last + 1) - begin);
    Circle& circle = circles_[i];
    for (const Vec2& node : within) {
      circle.centre += node / static_cast<double>(within.size());
    }
    circle.radius = within.empty() ? -std::numeric_limits<double>::infinity() : 0.0;
    for (const Vec2& node : within) {
      circle.radius = std::max(circle.radius, (node - circle.centre).norm());
    }
  }
}

std::size_t NearestNode::to(const Vec2& point) const {
  const auto least_distance = [&](std::size_t i) {
    return (circles_[i].centre - point).norm() - circles_[i].radius;
  };
  struct Waiting {
    std::size_t circle = 1;
    double least = 0.0;  ///< lower bound of the distance to anything in the circle
  };
  // One circle waits at each level, and one more at the last.
  std::array<Waiting, 64> waiting;
  std::size_t count = 1;
  waiting[0] = {1, -std::numeric_limits<double>::infinity()};
  std::size_t nearest = 0;
  double least2 = std::numeric_limits<double>::infinity();
  while (count > 0) {
    const Waiting next = waiting[--count];
    if (next.least > 0.0 && next.least * next.least >= least2) {
      continue;
    }
    if (next.circle >= leaf_count_) {
      const std::size_t begin = (next.circle - leaf_count_) * kLeafNodes;
      const std::size_t end = std::min(begin + kLeafNodes, nodes_.size());
      for (std::size_t i = begin; i < end; ++i) {
        const double distance2 = (nodes_[i] - point).squaredNorm();
        if (distance2 < least2) {
          least2 = distance2;
          nearest = i;
        }
      }
      continue;
    }
    Waiting left{2 * next.circle, least_distance(2 * next.circle)};
    Waiting right{2 * next.circle + 1, least_distance(2 * next.circle + 1)};
    if (left.least > right.least) {
      std::swap(left, right);
    }
    waiting[count++] = right;  // the nearer child is examined first
    waiting[count++] = left;
  }
  return nearest;
}

}  // namespace palpate
