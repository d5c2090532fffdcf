#include "core/part/pair_starts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

/// 24 places a segment, half of what foot points are searched from: Gauss-Newton makes up for a
/// start that is off by a whole node, a foot for none.
constexpr std::size_t kNodesBetweenStarts = 2;
static_assert(ScaledPart::kNodesPerSegment % kNodesBetweenStarts == 0);

/// Where the centre of a tip lies that touches at each node; the node itself without a tip.
std::vector<Vec2> centres_at_nodes(const ScaledPart& part, double offset) {
  std::vector<Vec2> centres;
  centres.reserve(static_cast<std::size_t>(part.node_count()));
  for (int i = 0; i < part.node_count(); ++i) {
    const CurveDerivatives d = part.spline().derivatives(ScaledPart::node_t(i));
    const double speed = d.first.norm();  // 0 at a cusp of the part: there a tip has no one normal
    const Vec2 left = speed > 0.0 ? Vec2(left_of(d.first) / speed) : Vec2(0.0, 0.0);
    centres.push_back(d.position + part.outside() * offset * left);
  }
  return centres;
}

/// The pose that lays `from` on `part_from` and turns `part_to` into the direction of `to`.
Pose2 laid(const Vec2& from, const Vec2& to, const Vec2& part_from, const Vec2& part_to) {
  return pose_carrying(turn_between(part_to - part_from, to - from), part_from, from);
}

}  // namespace

std::vector<Pose2> pair_starts(const ScaledPart& part, std::span<const FitPoint> points,
                               const FitPoint& reference) {
  std::vector<Pose2> starts;
  const Vec2& from = reference.position;
  const auto distance = [&](const FitPoint& point) { return (point.position - from).norm(); };
  const auto other = std::max_element(
      points.begin(), points.end(),
      [&](const FitPoint& a, const FitPoint& b) { return distance(a) < distance(b); });
  const double apart = other == points.end() ? 0.0 : distance(*other);
  if (!(apart > 0.0)) {
    return starts;
  }
  const std::vector<Vec2> from_nodes = centres_at_nodes(part, reference.offset);
  const std::vector<Vec2> to_nodes = centres_at_nodes(part, other->offset);
  const std::size_t n = from_nodes.size();
  double least = std::numeric_limits<double>::infinity();
  Pose2 nearest;
  std::vector<double> excess(n);  // of the distance to each node over that of the touches
  for (std::size_t i = 0; i < n; i += kNodesBetweenStarts) {
    const Vec2& at = from_nodes[i];
    const double way = (from_nodes[(i + kNodesBetweenStarts) % n] - at).norm();
    for (std::size_t j = 0; j < n; ++j) {
      excess[j] = (to_nodes[j] - at).norm() - apart;
    }
    for (std::size_t j = 0; j < n; ++j) {
      const std::size_t next = (j + 1) % n;
      const std::size_t before = (j + n - 1) % n;
      const double here = excess[j];
      if ((here <= 0.0) != (excess[next] <= 0.0)) {
        const double share = here / (here - excess[next]);
        starts.push_back(
            laid(from, other->position, at, to_nodes[j] + share * (to_nodes[next] - to_nodes[j])));
        continue;
      }
      // A distance that comes near without being reached: by noise, or because it is reached by a
      // reference between those tried. From one of these to the next it changes by no more than the
      // reference's way.
      const bool is_nearest = std::abs(here) <= std::abs(excess[next]) &&
                              std::abs(here) <= std::abs(excess[before]) &&
                              (here <= 0.0) == (excess[before] <= 0.0);
      if (is_nearest && std::abs(here) <= way) {
        starts.push_back(laid(from, other->position, at, to_nodes[j]));
      }
      if (std::abs(here) < least) {
        least = std::abs(here);
        nearest = laid(from, other->position, at, to_nodes[j]);
      }
    }
  }
  if (starts.empty()) {
    starts.push_back(nearest);  // the part is too small: it says how badly that fits
  }
  return starts;
}

}  // namespace palpate
