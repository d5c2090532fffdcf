#include "core/local/aligned_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

/// backtrack <= kMaxBacktrack (of the half extent) if the noise is estimated from the residuals: a
/// window that turns back on itself has large residuals too, and these must not excuse it.
constexpr double kMaxBacktrack = 0.1;

/// extent > kExtentRounding * rounding: below it, rounding alone determines the axis.
constexpr double kExtentRounding = 16.0;

}  // namespace

AlignedFrameResult aligned_frame(std::span<const Vec2> samples) {
  AlignedFrameResult result;
  if (samples.size() < 2) {
    return result;
  }
  // Differences to one sample are exact up to the rounding of the coordinates, so an origin far
  // away costs no more digits than it cost the samples.
  const Vec2 reference = samples[samples.size() / 2];
  const auto count = static_cast<double>(samples.size());
  Vec2 sum = Vec2::Zero();
  double largest = 0.0;
  bool finite = true;
  for (const Vec2& p : samples) {
    const Vec2 d = p - reference;
    finite = finite && std::isfinite(d.x()) && std::isfinite(d.y());
    sum += d;
    largest = std::max({largest, std::abs(d.x()), std::abs(d.y())});
  }
  if (!finite || !std::isfinite(largest * largest * count)) {
    result.status = LocalStatus::NotFinite;
    return result;
  }
  const double size = std::max(reference.cwiseAbs().maxCoeff(), largest);
  const double rounding_m = std::numeric_limits<double>::epsilon() * size;
  if (largest <= kExtentRounding * rounding_m) {
    result.status = LocalStatus::NoExtent;
    return result;
  }

  const Vec2 mean = sum / count;
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  Vec2 drift = Vec2::Zero();  // correlation of position with order: the direction of travel
  double order = -0.5 * (count - 1.0);
  for (const Vec2& p : samples) {
    const Vec2 d = (p - reference - mean) / largest;
    xx += d.x() * d.x();
    xy += d.x() * d.y();
    yy += d.y() * d.y();
    drift += order * d;
    order += 1.0;
  }
  const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
  Vec2 axis(std::cos(angle), std::sin(angle));
  if (axis.dot(drift) < 0.0) {
    axis = -axis;
  }

  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  double backtrack = 0.0;
  for (const Vec2& p : samples) {
    const double u = axis.dot(p - reference);
    lowest = std::min(lowest, u);
    highest = std::max(highest, u);
    backtrack = std::max(backtrack, highest - u);
  }
  const double half_extent = 0.5 * (highest - lowest);
  if (half_extent <= kExtentRounding * rounding_m) {
    result.status = LocalStatus::NoExtent;
    return result;
  }
  AlignedFrame& frame = result.frame;
  frame.axis = axis;
  frame.half_extent_m = half_extent;
  frame.origin = reference + 0.5 * (lowest + highest) * axis + cross(axis, mean) * left_of(axis);
  frame.first_u = frame.to_frame(samples.front()).x();
  frame.last_u = frame.to_frame(samples.back()).x();
  frame.backtrack = backtrack / half_extent;
  frame.rounding = rounding_m / half_extent;
  result.status = LocalStatus::Ok;
  return result;
}

LocalStatus check_backtrack(const AlignedFrame& frame, double sigma_given, double sigma_seen) {
  const auto explains = [&](double sigma) {
    return frame.backtrack <= most_backtrack(sigma) + kExtentRounding * frame.rounding;
  };
  const bool ok =
      explains(sigma_given) || (explains(sigma_seen) && frame.backtrack <= kMaxBacktrack);
  return ok ? LocalStatus::Ok : LocalStatus::DoublesBack;
}

}  // namespace palpate
