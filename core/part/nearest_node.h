// The node of a polyline that is nearest to a point, without looking at all of them.
#pragma once

#include <cstddef>
#include <vector>

#include "core/curves/pose2.h"

namespace palpate {

/// Circles around runs of nodes, and around pairs of these, and so on: nodes that follow each other
/// lie near each other. O(log nodes) where the polyline does not run over itself.
class NearestNode {
 public:
  explicit NearestNode(std::vector<Vec2> nodes);

  std::size_t count() const { return nodes_.size(); }

  /// The nearest; of several, any.
  std::size_t to(const Vec2& point) const;

 private:
  struct Circle {
    Vec2 centre = Vec2::Zero();
    double radius = 0.0;
  };

  std::vector<Vec2> nodes_;
  /// A heap: around all nodes at 1, around what is in circle i at 2 i and 2 i + 1; the last
  /// leaf_count_ each around a run of nodes.
  std::vector<Circle> circles_;
  std::size_t leaf_count_ = 1;
};

}  // namespace palpate
