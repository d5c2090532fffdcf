#include "core/local/stream/node_pyramid.h"

#include <algorithm>
#include <cmath>

namespace palpate {

std::array<PathNode, 2> two_nodes(std::span<const PathNode> nodes) {
  double weight = 0.0;
  Vec2 sum = Vec2::Zero();
  const Vec2 reference = nodes.front().position_m;
  for (const PathNode& node : nodes) {
    weight += node.weight;
    sum += node.weight * (node.position_m - reference);
  }
  if (!(weight > 0.0)) {
    return {};
  }
  const Vec2 mean = sum / weight;
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (const PathNode& node : nodes) {
    const Vec2 d = node.position_m - reference - mean;
    xx += node.weight * d.x() * d.x();
    xy += node.weight * d.x() * d.y();
    yy += node.weight * d.y() * d.y();
  }
  // Eigenvector of the larger eigenvalue, from cosine and sine of the half angle, without
  // cancellation.
  const double half = 0.5 * (xx - yy);
  const double root = std::hypot(half, xy);
  const Vec2 direction = half >= 0.0 ? Vec2(half + root, xy) : Vec2(xy, root - half);
  const double norm = direction.norm();
  const Vec2 centre = reference + mean;
  if (!(norm > 0.0)) {
    return {PathNode{centre, 0.5 * weight}, PathNode{centre, 0.5 * weight}};
  }
  Vec2 axis = direction / norm;
  if (axis.dot(nodes.back().position_m - nodes.front().position_m) < 0.0) {
    axis = -axis;
  }
  double second = 0.0;
  double third = 0.0;
  double product = 0.0;
  for (const PathNode& node : nodes) {
    const Vec2 d = node.position_m - reference - mean;
    const double u = axis.dot(d);
    second += node.weight * u * u;
    third += node.weight * u * u * u;
    product += node.weight * u * cross(axis, d);
  }
  // The two nodes x with the moments 0, m2, m3: x^2 - (m3 / m2) x - m2 = 0.
  const double skew = third / second;
  const double spread = std::sqrt(skew * skew + 4.0 * second / weight);
  const double early = 0.5 * (skew - spread);
  const double late = 0.5 * (skew + spread);
  const Vec2 line = axis + product / second * left_of(axis);
  return {PathNode{centre + early * line, weight * late / spread},
          PathNode{centre + late * line, -weight * early / spread}};
}

NodePyramid::NodePyramid() : levels_(kLevels) {}

void NodePyramid::clear() { count_ = 0; }

void NodePyramid::add(const Vec2& position_m, double weight) {
  // A single sample is a block of two points, one of which has no weight.
  levels_[0][count_ % kHeld] = {PathNode{position_m, weight}, PathNode{position_m, 0.0}};
  ++count_;
  for (std::size_t level = 1; level < kLevels && count_ % (1ULL << level) == 0; ++level) {
    const std::uint64_t index = (count_ >> level) - 1;
    const Block& first = block(level - 1, 2 * index);
    const Block& second = block(level - 1, 2 * index + 1);
    Block& merged = levels_[level][index % kHeld];
    if (level == 1) {
      merged = {first[0], second[0]};
    } else {
      const std::array<PathNode, 4> four = {first[0], first[1], second[0], second[1]};
      merged = two_nodes(four);
    }
  }
}

std::uint64_t NodePyramid::oldest() const {
  const std::uint64_t longest = kBlocksPerWindow << (kLevels - 1);
  return count_ > longest ? count_ - longest : 0;
}

std::uint64_t NodePyramid::window(std::uint64_t first, std::vector<PathNode>* nodes) const {
  nodes->clear();
  first = std::clamp(first, oldest(), count_);
  std::size_t level = 0;
  while (level + 1 < kLevels && ((count_ - first) >> level) > kBlocksPerWindow) {
    ++level;
  }
  const std::uint64_t block_samples = 1ULL << level;
  const std::uint64_t start = (first + block_samples - 1) >> level << level;
  std::uint64_t next = start;
  // Whole blocks of this scale, then of ever finer scales up to the newest sample.
  for (std::size_t scale = level + 1; scale-- > 0;) {
    while (next + (1ULL << scale) <= count_) {
      for (const PathNode& node : block(scale, next >> scale)) {
        if (node.weight > 0.0) {
          nodes->push_back(node);
        }
      }
      next += 1ULL << scale;
    }
  }
  return start;
}

}  // namespace palpate
