#include "core/recognition/touches/shortest_way.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/recognition/fit/starts/farthest_first.h"

namespace palpate {
namespace {

using Indices = std::vector<std::size_t>;

/// A spanning tree: the parent of each point; the first point is its own parent.
struct Tree {
  Indices parents;
  Indices order;  ///< every point comes after its parent
  double length = 0.0;
};

Tree shortest_tree_of(std::span<const Vec2> points) {
  Tree tree{Indices(points.size(), 0), {0}, 0.0};
  std::vector<double> squares(points.size(), std::numeric_limits<double>::infinity());
  std::vector<bool> in_tree(points.size(), false);
  std::size_t last = 0;
  in_tree[last] = true;
  while (tree.order.size() < points.size()) {
    std::size_t next = last;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (in_tree[i]) {
        continue;
      }
      if (const double square = (points[i] - points[last]).squaredNorm(); square < squares[i]) {
        squares[i] = square;
        tree.parents[i] = last;
      }
      if (squares[i] < nearest) {
        nearest = squares[i];
        next = i;
      }
    }
    tree.length += std::sqrt(nearest);
    in_tree[next] = true;
    tree.order.push_back(next);
    last = next;
  }
  return tree;
}

/// The longest way in a tree.
Indices longest_way(const Tree& tree, std::span<const Vec2> points) {
  // The point farthest from any point is an end of the longest way; the point farthest from that is
  // the other end.
  std::vector<Indices> joined(points.size());
  for (const std::size_t i : tree.order) {
    if (tree.parents[i] != i) {
      joined[i].push_back(tree.parents[i]);
      joined[tree.parents[i]].push_back(i);
    }
  }
  Indices from(points.size());
  const auto farthest = [&](std::size_t start) {
    std::vector<double> away(points.size(), 0.0);
    Indices open = {start};
    from[start] = start;
    std::size_t best = start;
    while (!open.empty()) {
      const std::size_t i = open.back();
      open.pop_back();
      best = away[i] > away[best] ? i : best;
      for (const std::size_t next : joined[i]) {
        if (next != from[i]) {
          from[next] = i;
          away[next] = away[i] + (points[next] - points[i]).norm();
          open.push_back(next);
        }
      }
    }
    return best;
  };
  const std::size_t end = farthest(farthest(0));
  Indices way = {end};
  while (from[way.back()] != way.back()) {
    way.push_back(from[way.back()]);
  }
  return way;
}

/// A way through all points: the tree's longest way, with each other point inserted where it adds
/// least length.
Indices way_through(const Tree& tree, std::span<const Vec2> points) {
  Indices way = longest_way(tree, points);
  std::vector<bool> on_way(points.size(), false);
  for (const std::size_t i : way) {
    on_way[i] = true;
  }
  for (const std::size_t i : tree.order) {
    if (on_way[i]) {
      continue;
    }
    const auto distance = [&](std::size_t k) { return (points[way[k]] - points[i]).norm(); };
    std::size_t before = 0;  // index of the place before which it is inserted
    double least = distance(0);
    for (std::size_t k = 1; k <= way.size(); ++k) {
      const double longer = k < way.size() ? distance(k - 1) + distance(k) -
                                                 (points[way[k]] - points[way[k - 1]]).norm()
                                           : distance(k - 1);
      if (longer < least) {
        least = longer;
        before = k;
      }
    }
    way.insert(way.begin() + static_cast<std::ptrdiff_t>(before), i);
  }
  return way;
}

/// A way of straight steps, with its directions at the vertices.
struct Polygon {
  std::vector<Vec2> vertices;
  std::vector<double> along;   ///< length of the way to each vertex
  std::vector<double> angles;  ///< at each vertex, unwrapped [rad]

  std::size_t steps() const { return vertices.size() - 1; }
  Vec2 step(std::size_t k) const { return vertices[k + 1] - vertices[k]; }
};

Polygon polygon_of(std::vector<Vec2> vertices) {
  Polygon way;
  way.vertices = std::move(vertices);
  std::vector<double> directions;  // of the steps
  way.along = {0.0};
  for (std::size_t k = 0; k < way.steps(); ++k) {
    const Vec2 step = way.step(k);
    const Vec2 before = k > 0 ? way.step(k - 1) : Vec2(1.0, 0.0);
    directions.push_back((k > 0 ? directions.back() : 0.0) + turn_between(before, step));
    way.along.push_back(way.along.back() + step.norm());
  }
  // Direction of the circle through a vertex and its neighbours; at the ends that circle continues.
  const std::size_t last = way.steps();
  way.angles.resize(way.vertices.size());
  for (std::size_t k = 1; k < last; ++k) {
    const double before = way.along[k] - way.along[k - 1];
    const double after = way.along[k + 1] - way.along[k];
    way.angles[k] = (directions[k - 1] * after + directions[k] * before) / (before + after);
  }
  way.angles[0] = last > 1 ? 2.0 * directions[0] - way.angles[1] : directions[0];
  way.angles[last] =
      last > 1 ? 2.0 * directions[last - 1] - way.angles[last - 1] : directions[last - 1];
  return way;
}

/// The foot of a place on the two steps at its nearest vertex, and its distance.
std::pair<OnWay, double> foot_on(const Polygon& way, std::size_t nearest, const Vec2& place) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::pair<OnWay, double> best{{}, kInfinity};
  for (std::size_t k = nearest > 0 ? nearest - 1 : 0; k <= nearest && k < way.steps(); ++k) {
    const Vec2 step = way.step(k);
    // Beyond its ends the way continues straight.
    const double low = k > 0 ? 0.0 : -kInfinity;
    const double high = k + 1 < way.steps() ? 1.0 : kInfinity;
    const double share =
        std::clamp((place - way.vertices[k]).dot(step) / step.squaredNorm(), low, high);
    const double off = (place - way.vertices[k] - share * step).norm();
    if (off < best.second) {
      const auto [least, most] = std::minmax(way.angles[k], way.angles[k + 1]);
      const double turn = way.angles[k + 1] - way.angles[k];
      best = {{0, way.along[k] + share * (way.along[k + 1] - way.along[k]), least, most,
               way.angles[k] + share * turn, turn},
              off};
    }
  }
  return best;
}

}  // namespace

std::optional<std::vector<OnWay>> shortest_way(std::span<const Vec2> places, double least_step) {
  // Enough for a full turn with 0.05 rad per step; one radian would do (kMostOff).
  constexpr std::size_t kMostVertices = 128;
  // At most every second place is a vertex, so that of two places close together by chance one is
  // left out.
  constexpr std::size_t kThinned = 2;
  const Spread spread =
      spread_widest(places, std::min(kMostVertices, places.size() / kThinned), least_step);
  constexpr std::size_t kFewest = 3;
  if (spread.chosen.size() < kFewest) {
    return std::nullopt;
  }
  std::vector<Vec2> vertices;
  for (const std::size_t k : spread.chosen) {
    vertices.push_back(places[k]);
  }
  const Tree tree = shortest_tree_of(vertices);
  std::vector<Vec2> in_order;
  Indices turn_of(vertices.size());  // of each vertex, its position on the way
  for (const std::size_t k : way_through(tree, vertices)) {
    turn_of[k] = in_order.size();
    in_order.push_back(vertices[k]);
  }
  if (length_of(in_order) > kDetour * tree.length) {
    return std::nullopt;
  }
  const Polygon way = polygon_of(std::move(in_order));
  // A path that turns by a radian from vertex to vertex lies an eighth of a step off. Arms closer
  // together than this limit have been taken for one.
  constexpr double kMostOff = 0.25;
  std::vector<OnWay> result;
  for (std::size_t i = 0; i < places.size(); ++i) {
    auto [on_way, off] = foot_on(way, turn_of[spread.nearest[i]], places[i]);
    if (off > kMostOff * spread.apart) {
      return std::nullopt;
    }
    on_way.place = i;
    result.push_back(on_way);
  }
  std::sort(result.begin(), result.end(),
            [](const OnWay& a, const OnWay& b) { return a.along < b.along; });
  // In units of the least distance between vertices, which is about the mean distance of neighbours
  // where half of the places are vertices. Of places spread by chance a gap of 8 is the wider in
  // one step of e^7.5; and over a shorter one the way does not go on from the far end of twelve
  // touches, the fewest of a run.
  constexpr double kGap = 8.0;
  for (std::size_t i = 1; i < result.size(); ++i) {
    result[i].after_gap = result[i].along - result[i - 1].along > kGap * spread.apart;
  }
  return result;
}

double shortest_tree(std::span<const Vec2> points) { return shortest_tree_of(points).length; }

double length_of(std::span<const Vec2> path) {
  double length = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    length += (path[i] - path[i - 1]).norm();
  }
  return length;
}

}  // namespace palpate
