// The samples of a path at every scale: blocks of 1, 2, 4, 8 ... samples, each replaced by two
// points that say the same to any smooth curve. A window of any length is a few dozen such points.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/curves/pose2.h"

namespace palpate {

/// A weighted point that stands for samples.
struct PathNode {
  Vec2 position_m = Vec2::Zero();
  double weight = 0.0;  ///< sum of the samples' weights
};

/// Two points in place of many: the Gauss quadrature of their abscissae along the principal axis,
/// on their straight line of regression. Weight, both first moments, the second and third along the
/// axis and the first product of both coordinates are kept to rounding: all that a least-squares
/// fit sees of a short block up to terms of the fourth order in block over window.
std::array<PathNode, 2> two_nodes(std::span<const PathNode> nodes);

/// Bounded memory whatever the path's length: of each scale the newest blocks only. Every block is
/// formed once, from the two below it, so that no sum runs on and no rounding gathers. O(1) a
/// sample (one merge in the mean), nothing allocated after construction.
class NodePyramid {
 public:
  /// Blocks of the coarsest scale that a window is given as, at least half as many: a block of a
  /// window of 16 has the terms (1/16)^4 of the fourth order.
  static constexpr std::size_t kBlocksPerWindow = 32;
  /// Scales: samples of the largest block are 2^(kLevels - 1), of the longest window 32 times that.
  static constexpr std::size_t kLevels = 16;

  NodePyramid();

  void add(const Vec2& position_m, double weight);
  void clear();

  /// Samples added.
  std::uint64_t count() const { return count_; }

  /// First sample of the longest window up to the newest sample that is still held.
  std::uint64_t oldest() const;

  /// The newest samples from `first` on as nodes in their order, at most kMostNodes. The first
  /// block is a whole one: returns the sample that it begins with, the first that is no earlier
  /// than `first`.
  static constexpr std::size_t kMostNodes = 2 * kBlocksPerWindow + 2 * kLevels + 2;
  std::uint64_t window(std::uint64_t first, std::vector<PathNode>* nodes) const;

 private:
  using Block = std::array<PathNode, 2>;
  /// Blocks held of a scale: those of a window, and one that the next scale has begun.
  static constexpr std::size_t kHeld = 64;

  const Block& block(std::size_t level, std::uint64_t index) const {
    return levels_[level][index % kHeld];
  }

  std::vector<std::array<Block, kHeld>> levels_;
  std::uint64_t count_ = 0;
};

}  // namespace palpate
