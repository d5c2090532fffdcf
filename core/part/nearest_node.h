// Search for the node of a polyline that is nearest to a point.
#pragma once

#include <cstddef>
#include <vector>

#include "core/curves/pose2.h"

namespace palpate {

/// A binary tree of circles: the leaves enclose short runs of consecutive nodes, every other circle
/// encloses its two children. Consecutive nodes lie close together, so a search takes O(log nodes)
/// if the polyline does not overlap itself.
class NearestNode {
 public:
  explicit NearestNode(std::vector<Vec2> nodes);

  std::size_t count() const { return nodes_.size(); }

  /// Index of the nearest node; any one of several equally near.
  std::size_t to(const Vec2& point) const;

 private:
  struct Circle {
    Vec2 centre = Vec2::Zero();
    double radius = 0.0;
  };

  std::vector<Vec2> nodes_;
  /// The tree as a heap: circle 1 encloses all nodes, circle i what 2 i and 2 i + 1 enclose. The
  /// last leaf_count_ circles enclose one run of nodes each.
  std::vector<Circle> circles_;
  std::size_t leaf_count_ = 1;
};

}  // namespace palpate
