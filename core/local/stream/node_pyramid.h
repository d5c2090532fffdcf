// The samples of a path at every scale: blocks of 1, 2, 4, 8 ... samples. Each block is replaced by
// two points that act on the fit of any smooth curve as the samples do. A window of any length is a
// few dozen such points.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/curves/pose2.h"

namespace palpate {

/// A weighted point that replaces samples.
struct PathNode {
  Vec2 position_m = Vec2::Zero();
  double weight = 0.0;  ///< sum of the weights of the samples
};

/// Two points that replace many: the Gauss quadrature of their abscissae along the principal axis,
/// on their regression line. They preserve, up to rounding, the weight, both first moments, the
/// second and third moment along the axis, and the first product of both coordinates. This is all
/// that a least-squares fit sees of a short block, up to terms of the fourth order in block /
/// window.
std::array<PathNode, 2> two_nodes(std::span<const PathNode> nodes);

/// Bounded memory for a path of any length: it keeps only the newest blocks of each scale. Every
/// block is formed once, from the two below it. So no running sum accumulates rounding. O(1) per
/// sample (one merge on average); no allocation after construction.
class NodePyramid {
 public:
  /// A window has at most this many blocks of its coarsest scale, and at least half as many. A
  /// block of a window of 16 has fourth-order terms of (1/16)^4.
  static constexpr std::size_t kBlocksPerWindow = 32;
  /// Number of scales. The largest block has 2^(kLevels - 1) samples, the longest window 32 times
  /// as many.
  static constexpr std::size_t kLevels = 16;

  NodePyramid();

  void add(const Vec2& position_m, double weight);
  void clear();

  /// Number of samples added.
  std::uint64_t count() const { return count_; }

  /// First sample of the longest window, ending at the newest sample, that is still in memory.
  std::uint64_t oldest() const;

  /// The newest samples, from `first` on, as nodes in their order; at most kMostNodes. The window
  /// begins with a whole block: the return value is the sample that it begins with, the first
  /// possible one that is not before `first`.
  static constexpr std::size_t kMostNodes = 2 * kBlocksPerWindow + 2 * kLevels + 2;
  std::uint64_t window(std::uint64_t first, std::vector<PathNode>* nodes) const;

 private:
  using Block = std::array<PathNode, 2>;
  /// Blocks kept per scale: those of a window, and one that the next scale has begun.
  static constexpr std::size_t kHeld = 64;

  const Block& block(std::size_t level, std::uint64_t index) const {
    return levels_[level][index % kHeld];
  }

  std::vector<std::array<Block, kHeld>> levels_;
  std::uint64_t count_ = 0;
};

}  // namespace palpate
