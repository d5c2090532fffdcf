#include "core/recognition/modes/reference_point.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace palpate {
namespace {

/// Lengths that differ by rounding are the same. Relative: of a sum that runs the other way.
constexpr double kSameLength = 1e-9;

/// Whether a patch goes on at one of its points the way it came, over two points either way.
bool goes_on(std::span<const FitPoint> patch, std::size_t i) {
  constexpr std::size_t kPoints = 2;  // the next one may be the other of two at a tip
  const Vec2& before = patch[i - std::min(i, kPoints)].position;
  const Vec2& after = patch[std::min(i + kPoints, patch.size() - 1)].position;
  const Vec2& here = patch[i].position;
  return (here - before).dot(after - here) >= 0.0;
}

Vec2 centre_of(std::span<const FitPoint> points) {
  Vec2 sum = Vec2::Zero();
  for (const FitPoint& point : points) {
    sum += point.position;
  }
  return sum / static_cast<double>(points.size());
}

/// Of places alike in all else, the one nearer to the centre is taken.
struct Reference {
  std::size_t index = 0;
  double length = -1.0;      ///< of its stretch
  double off_middle = 0.0;   ///< along the stretch
  double from_centre = 0.0;  ///< of all points, squared

  bool is_better_than(const Reference& other) const {
    const double same = kSameLength * std::max(length, other.length);
    if (std::abs(length - other.length) > same) {
      return length > other.length;
    }
    if (std::abs(off_middle - other.off_middle) > same) {
      return off_middle < other.off_middle;
    }
    return from_centre < other.from_centre;
  }
};

/// The middle of one stretch, [begin, end) of all points.
Reference middle_of(std::span<const FitPoint> points, std::size_t begin, std::size_t end,
                    const Vec2& centre) {
  const auto step_to = [&](std::size_t i) {
    return i > begin ? (points[i].position - points[i - 1].position).norm() : 0.0;
  };
  double length = 0.0;
  for (std::size_t i = begin; i < end; ++i) {
    length += step_to(i);
  }
  Reference middle;
  double along = 0.0;
  for (std::size_t i = begin; i < end; ++i) {
    along += step_to(i);
    const Reference here{i, length, std::abs(along - 0.5 * length),
                         (points[i].position - centre).squaredNorm()};
    if (i == begin || here.is_better_than(middle)) {
      middle = here;
    }
  }
  return middle;
}

}  // namespace

std::size_t reference_point(const FitData& data) {
  const std::span<const FitPoint> points(data.points);
  const Vec2 centre = centre_of(points);
  Reference best;
  for (const PatchSpan& span : data.patches) {
    const std::span<const FitPoint> patch = points.subspan(span.begin, span.size());
    std::size_t begin = 0;  // of a stretch
    for (std::size_t i = 0; i <= patch.size(); ++i) {
      if (i < patch.size() && goes_on(patch, i)) {
        continue;
      }
      if (i > begin) {
        const Reference middle = middle_of(points, span.begin + begin, span.begin + i, centre);
        if (middle.is_better_than(best)) {
          best = middle;
        }
      }
      begin = i + 1;
    }
  }
  return best.index;
}

}  // namespace palpate
