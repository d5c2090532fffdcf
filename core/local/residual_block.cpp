#include "core/local/residual_block.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

/// 1 - leverage >= kMinFreedom: below it, the sample alone determines the fit there and has no
/// residual.
constexpr double kMinFreedom = 1e-9;

/// Least mean square of the part of a polynomial that the lower degrees leave, for abscissae in
/// [-1, 1]. Below it, rounding determines the result.
constexpr double kMinPivot = 1e4 * std::numeric_limits<double>::epsilon();

/// length > kLengthRounding * rounding: below it, rounding alone determines the axis.
constexpr double kLengthRounding = 16.0;

}  // namespace

/// Abscissae and ordinates in a frame along the samples in use, from the mean of their first half
/// to the mean of their second half. For a window that hardly bends this is the principal axis too.
LocalStatus ResidualBlock::place(std::span<const Vec2> samples, std::span<const std::uint8_t> use,
                                 std::span<const RelativeNoise> noise) {
  const auto is_used = [&](std::size_t i) { return use.empty() || use[i] != 0; };
  size_ = samples.size();
  const auto used =
      use.empty()
          ? size_
          : static_cast<std::size_t>(std::ranges::count_if(use, [](auto u) { return u != 0; }));
  if (used <= kUnknowns) {
    return LocalStatus::TooFewSamples;
  }
  // Differences to one sample are exact up to the rounding of the coordinates.
  const Vec2& reference = samples[size_ / 2];
  const std::size_t half = used / 2;
  Vec2 first = Vec2::Zero();
  Vec2 all = Vec2::Zero();
  Vec2 largest = Vec2::Zero();
  std::size_t next = 0;
  for (std::size_t i = 0; i < size_; ++i) {
    if (!is_used(i)) {
      continue;
    }
    const Vec2 d = samples[i] - reference;
    if (next++ == half) {
      first = all;
    }
    all += d;
    largest = largest.cwiseMax(d.cwiseAbs());
  }
  const Vec2 chord =
      (all - first) / static_cast<double>(used - half) - first / static_cast<double>(half);
  const double length = chord.norm();
  if (!std::isfinite(length * length)) {
    return LocalStatus::NotFinite;
  }
  const double rounding_m = std::numeric_limits<double>::epsilon() *
                            std::max(reference.cwiseAbs().maxCoeff(), largest.maxCoeff());
  if (!(length > kLengthRounding * rounding_m)) {
    return LocalStatus::NoExtent;
  }
  const Vec2 axis = chord / length;
  lanes_.resize((size_ + kWidth - 1) / kWidth);
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  backtrack_m_ = 0.0;
  std::array<double, 2> begin{};
  std::array<double, 2> end{};
  loudest_ = noise.empty() ? 1.0 : 0.0;
  next = 0;
  for (std::size_t i = 0; i < lanes_.size() * kWidth; ++i) {
    const std::size_t sample = std::min(i, size_ - 1);
    const Vec2 d = samples[sample] - reference;
    const double u = axis.dot(d);
    Lane& lane = lanes_[i / kWidth];
    const auto k = static_cast<Eigen::Index>(i % kWidth);
    lane.u[k] = u;
    lane.residual_m[k] = cross(axis, d);
    lane.use[k] = i < size_ && is_used(i) ? 1.0 : 0.0;
    lane.precision[k] = noise.empty() ? 1.0 : 1.0 / noise[sample].across;
    lane.weight[k] = lane.use[k] * lane.precision[k] * lane.precision[k];
    if (i < size_ && is_used(i)) {
      loudest_ = noise.empty() ? loudest_ : std::max(loudest_, noise[i].larger());
      lowest = std::min(lowest, u);
      highest = std::max(highest, u);
      backtrack_m_ = std::max(backtrack_m_, highest - u);
      if (next < 2) {
        begin[next] = u;
      }
      ++next;
      end[0] = end[1];
      end[1] = u;
    }
  }
  extent_m_ = highest - lowest;
  first_gap_ = std::abs(begin[1] - begin[0]) / extent_m_;
  last_gap_ = std::abs(end[1] - end[0]) / extent_m_;
  const double middle = 0.5 * (lowest + highest);
  const double per_metre = 2.0 / extent_m_;
  for (Lane& lane : lanes_) {
    lane.u = (lane.u - middle) * per_metre;
  }
  return LocalStatus::Ok;
}

LocalStatus ResidualBlock::fit(std::span<const Vec2> samples, std::span<const std::uint8_t> use,
                               int degree, std::span<const RelativeNoise> noise) {
  const LocalStatus status = place(samples, use, noise);
  if (status != LocalStatus::Ok) {
    return status;
  }
  // p_{k+1} = (u - alpha_k) p_k - beta_k p_{k-1}, alpha_k = <u p_k, p_k> / <p_k, p_k>,
  // beta_k = <p_k, p_k> / <p_{k-1}, p_{k-1}>, and its derivative.
  Pair squares = Pair::Zero();  // <p_k, p_k>
  Pair scores = Pair::Zero();   // <p_k, residual>
  Pair shifts = Pair::Zero();   // <u p_k, p_k>
  for (Lane& lane : lanes_) {
    lane.p.setOnes();
    lane.p_before.setZero();
    lane.d.setZero();
    lane.d_before.setZero();
    lane.slope.setZero();
    lane.leverage.setZero();
    squares += lane.weight;
    scores += lane.weight * lane.residual_m;
    shifts += lane.weight * lane.u;
  }
  double square_before = 0.0;
  for (int k = 0; k <= degree; ++k) {
    const double square = squares.sum();
    // Negated so that NaN is rejected too.
    if (!(square > kMinPivot * square_before)) {
      return LocalStatus::Unresolved;
    }
    const double per_square = 1.0 / square;
    const double score = per_square * scores.sum();
    const double alpha = per_square * shifts.sum();
    const double beta = k > 0 ? square / square_before : 0.0;
    square_before = square;
    squares.setZero();
    scores.setZero();
    shifts.setZero();
    for (Lane& lane : lanes_) {
      lane.residual_m -= score * lane.p;
      lane.slope += score * lane.d;
      lane.leverage += per_square * lane.p.square();
      const Pair shifted = lane.u - alpha;
      const Pair p = shifted * lane.p - beta * lane.p_before;
      const Pair d = lane.p + shifted * lane.d - beta * lane.d_before;
      lane.p_before = lane.p;
      lane.d_before = lane.d;
      lane.p = p;
      lane.d = d;
      const Pair weighted = lane.weight * p;
      squares += weighted * p;
      scores += weighted * lane.residual_m;
      shifts += weighted * p * lane.u;
    }
  }
  const double per_metre = 2.0 / extent_m_;
  Pair steepest = Pair::Zero();
  const double most_leverage = kMaxExtrapolation * loudest_ * loudest_;
  for (Lane& lane : lanes_) {
    const Pair slope = per_metre * lane.slope;
    lane.residual_m /= (1.0 + slope.square()).sqrt();
    // 1 - h in use, 1 + h otherwise.
    const Pair freedom = 1.0 + lane.precision.square() * lane.leverage * (1.0 - 2.0 * lane.use);
    lane.studentised_m =
        (freedom < kMinFreedom)
            .select(0.0, lane.precision * lane.residual_m / freedom.max(kMinFreedom).sqrt());
    lane.studentised_m = (lane.use == 0.0 && lane.leverage > most_leverage)
                             .select(std::numeric_limits<double>::infinity(), lane.studentised_m);
    steepest = steepest.max(lane.use * slope.abs());
  }
  steepest_ = steepest.maxCoeff();
  return LocalStatus::Ok;
}

}  // namespace palpate
