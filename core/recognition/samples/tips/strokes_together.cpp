#include "core/recognition/samples/tips/strokes_together.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/numerics/probability/negligible.h"

namespace palpate {
namespace {

/// Least clearance of a tip between two walls, over its radius.
constexpr double kLeastClearance = 0.1;

/// Where a path passes a point.
struct Passing {
  double distance = 0.0;
  Vec2 tangent = Vec2::Zero();
  double sigma = 0.0;  ///< of the path's nearest point
};

/// The place of a step of a path that lies beside a point, on the cubic through its two ends and
/// their tangents (off a circle by a 384th of the fourth power of the turn, in radii).
std::optional<Passing> passing(const FitPoint& from, const FitPoint& to, const Vec2& point) {
  const Vec2 chord = to.position - from.position;
  const double length2 = chord.squaredNorm();
  if (!(length2 > 0.0) || from.tangent.isZero() || to.tangent.isZero()) {
    return std::nullopt;
  }
  const double u = (point - from.position).dot(chord) / length2;
  if (u < 0.0 || u > 1.0) {
    return std::nullopt;
  }
  const double length = std::sqrt(length2);
  const double v = 1.0 - u;
  const Vec2 place = v * v * (1.0 + 2.0 * u) * from.position +
                     u * u * (1.0 + 2.0 * v) * to.position +
                     u * v * length * (v * from.tangent - u * to.tangent);
  const Vec2 tangent = (6.0 * u * v * chord + length * v * (1.0 - 3.0 * u) * from.tangent +
                        length * u * (1.0 - 3.0 * v) * to.tangent)
                           .normalized();
  return Passing{std::abs(cross(tangent, point - place)), tangent,
                 1.0 / (u < 0.5 ? from : to).inverse_sigma};
}

/// Where the path passes the point nearest to it; nullopt if it ends before.
std::optional<Passing> nearest_passing(std::span<const FitPoint> path, const Vec2& point) {
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (const double distance2 = (path[i].position - point).squaredNorm(); distance2 < least) {
      least = distance2;
      nearest = i;
    }
  }
  const auto before = nearest > 0 ? passing(path[nearest - 1], path[nearest], point) : std::nullopt;
  const auto after =
      nearest + 1 < path.size() ? passing(path[nearest], path[nearest + 1], point) : std::nullopt;
  return before && (!after || before->distance < after->distance) ? before : after;
}

/// Centres of a stroke that are asked, spread over it; of these must be on the path at least: two
/// paths that cross or touch share one place.
constexpr std::size_t kAsked = 16;
constexpr std::size_t kLeast = 3;

/// +1 or -1 if the stroke runs along the path, with or against it; 0 if it does not.
int sense_along(std::span<const FitPoint> path, std::span<const FitPoint> stroke) {
  constexpr double kAlongside = 0.75;  // of those that the path does not end before
  std::size_t beside = 0;
  std::size_t with = 0;
  std::size_t against = 0;
  std::optional<Vec2> first;
  double stretch = 0.0;
  const std::size_t asked = std::min(kAsked, stroke.size());
  for (std::size_t i = 0; i < asked; ++i) {
    const FitPoint& point = stroke[asked > 1 ? i * (stroke.size() - 1) / (asked - 1) : 0];
    const auto passes = nearest_passing(path, point.position);
    if (!passes || point.tangent.isZero()) {
      continue;
    }
    ++beside;
    const double noise =
        kNegligibleDeviations * std::hypot(1.0 / point.inverse_sigma, passes->sigma);
    if (noise < point.offset &&
        passes->distance <= std::max(noise, kLeastClearance * point.offset)) {
      ++(passes->tangent.dot(point.tangent) > 0.0 ? with : against);
      first = first.value_or(point.position);
      stretch = std::max(stretch, (point.position - *first).norm());
    }
  }
  const std::size_t most = std::max(with, against);
  // Over a radius a path that crosses at more than a fifth of a radian has left the clearance.
  if (most < kLeast || static_cast<double>(most) < kAlongside * static_cast<double>(beside) ||
      stretch < stroke.front().offset) {
    return 0;
  }
  return with > against ? 1 : -1;
}

/// A pass with a tip, and its box.
struct Path {
  using Box = Eigen::AlignedBox2d;
  std::size_t patch;
  std::span<const FitPoint> points;
  Box box;

  Path(std::size_t index, std::span<const FitPoint> centres) : patch(index), points(centres) {
    for (const FitPoint& point : points) {
      box.extend(point.position);
    }
  }

  /// A path of more points is one that no polynomial follows.
  bool tells_sides() const {
    constexpr std::size_t kMostPoints = 128;
    return points.size() >= kLeast && points.size() <= kMostPoints && points.front().offset > 0.0;
  }

  double length() const { return box.diagonal().norm(); }

  bool may_meet(const Path& other) const {
    const double radius = points.front().offset;
    const Vec2 reach(radius, radius);
    return other.points.front().offset == radius &&
           Box(box.min() - reach, box.max() + reach).intersects(other.box);
  }
};

}  // namespace

std::vector<Alongside> strokes_together(std::span<const StoredPatch> patches,
                                        const FitData& centres, WorkBudget& work) {
  std::vector<Alongside> strokes(centres.patches.size());
  std::vector<Path> paths;  // the longest pass of each stroke
  std::size_t p = 0;
  const StoredPatch* before = nullptr;
  for (const StoredPatch& patch : patches) {
    if (patch.samples.empty()) {
      continue;
    }
    const bool same_stroke = before != nullptr && before->context.probe == patch.context.probe &&
                             before->context.patch == patch.context.patch;
    strokes[p].first = same_stroke ? strokes[p - 1].first : p;
    const Path path(p, centres.patch(p));
    if (path.tells_sides()) {
      if (same_stroke && !paths.empty() && strokes[paths.back().patch].first == strokes[p].first) {
        paths.back() = path.length() > paths.back().length() ? path : paths.back();
      } else {
        paths.push_back(path);
      }
    }
    before = &patch;
    ++p;
  }
  for (std::size_t b = 1; b < paths.size(); ++b) {
    for (std::size_t a = 0; a < b && work.allows(); ++a) {
      const Alongside of_a = strokes[paths[a].patch];
      const Alongside of_b = strokes[paths[b].patch];
      if (of_a.first == of_b.first || !paths[a].may_meet(paths[b])) {
        continue;
      }
      work.spend(WorkKind::PlacedRow, 2 * kAsked);
      // To compare two distances takes a third of a row.
      work.spend(WorkKind::AxisRow, kAsked * (paths[a].points.size() + paths[b].points.size()) / 3);
      int sense = sense_along(paths[a].points, paths[b].points);
      sense = sense != 0 ? sense : sense_along(paths[b].points, paths[a].points);
      if (sense == 0) {
        continue;
      }
      // All that ran with the one run with the other's from now on.
      const std::size_t first = std::min(of_a.first, of_b.first);
      const std::size_t last = std::max(of_a.first, of_b.first);
      for (Alongside& stroke : strokes) {
        if (stroke.first == last) {
          stroke = {first, of_a.sense * sense * of_b.sense * stroke.sense};
        }
      }
    }
  }
  return strokes;
}

}  // namespace palpate
