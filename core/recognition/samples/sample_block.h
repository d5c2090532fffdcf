// Consecutive samples of a stroke as one: their mean, how far they scatter, and whether in order.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/curves/pose2.h"
#include "core/numerics/quantile.h"
#include "core/recognition/samples/step_ratio.h"
#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// Consecutive samples, or blocks of them.
struct SampleBlock {
  std::size_t begin = 0;
  std::size_t end = 0;
  Vec2 mean = Vec2::Zero();
  double square = 0.0;  ///< mean square distance from the mean
};

inline Vec2 place_of(const StoredSample& sample) { return sample.position_m; }
inline Vec2 place_of(const SampleBlock& block) { return block.mean; }

/// The median of each coordinate, of some samples.
inline Vec2 median_place(std::span<const StoredSample> samples) {
  std::vector<double> x;
  std::vector<double> y;
  for (const StoredSample& sample : samples) {
    x.push_back(sample.position_m.x());
    y.push_back(sample.position_m.y());
  }
  return {median_of(x), median_of(y)};
}

/// Mean, and mean square distance from it. Two passes: far from the origin, squares of coordinates
/// have no digits left for the scatter.
template <typename Places>
SampleBlock block_of(const Places& places, std::size_t begin, std::size_t end) {
  SampleBlock block{begin, end};
  const Vec2 any = place_of(places[begin]);
  for (std::size_t i = begin; i < end; ++i) {
    block.mean += place_of(places[i]) - any;
  }
  const double n = static_cast<double>(end - begin);
  block.mean = any + block.mean / n;
  for (std::size_t i = begin; i < end; ++i) {
    block.square += (place_of(places[i]) - block.mean).squaredNorm();
  }
  block.square /= n;
  return block;
}

/// Whether the places show an order (step_ratio.h). `of`: their block.
template <typename Places>
double ratio_of(const Places& places, const SampleBlock& of) {
  return step_ratio([&](std::size_t i) { return place_of(places[i]); }, of.begin, of.end,
                    of.square);
}

}  // namespace palpate
