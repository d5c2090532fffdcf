// Where a path of samples turns back.
#pragma once

#include <cstddef>
#include <vector>

#include "core/curves/pose2.h"

namespace palpate {

/// The farthest points of a path where it turns back: having gone on by more than `far`, it comes
/// back by as much along the way it came, however far beside it: the arms of a cusp soon part. (A
/// bend wider than `far` turns the way with it.) `at(i)`: point i, of [begin, end). Ascending.
/// O(points).
template <typename At>
std::vector<std::size_t> turning_points(std::size_t begin, std::size_t end, double far,
                                        const At& at) {
  std::vector<std::size_t> turns;
  std::size_t behind = begin;  // so far from `head` that the two show the way
  std::size_t head = begin;    // the farthest point on it
  for (std::size_t i = begin + 1; i < end; ++i) {
    const Vec2 way = at(head) - at(behind);
    const double length = way.norm();
    if (!(length > far)) {
      head = i;
      continue;
    }
    const double on = (at(i) - at(head)).dot(way) / length;
    if (on < -far) {
      turns.push_back(head);
      behind = head;
      head = i;
    } else if (on > 0.0) {
      head = i;
      while ((at(head) - at(behind + 1)).norm() > far) {
        ++behind;
      }
    }
  }
  return turns;
}

}  // namespace palpate
