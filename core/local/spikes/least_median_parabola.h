// A parabola through a block of samples that spikes cannot bend: the start of the search for
// spikes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/curves/pose2.h"
#include "core/local/residual_block.h"

namespace palpate {

/// What its triples, 150 at most, cost beside one fit of a quartic to the same samples (callgrind).
inline constexpr std::size_t kRowsOfParabola = 16;

/// Least median of squares (P. J. Rousseeuw, "Least median of squares regression", 1984): of the
/// parabolas through three samples, one from each third of the block, that one whose distance to
/// the nearer half of the samples is least, each in units of its noise. Up to half of the samples
/// may be anywhere.
class LeastMedianParabola {
 public:
  /// `noise`: by sample; empty: 1. Returns false if no three samples follow each other in order
  /// within 45 degrees. O(samples).
  bool fit(std::span<const Vec2> samples, std::span<const RelativeNoise> noise = {});

  /// Sigma, the noise of a sample whose relative noise is 1, from the largest distance within the
  /// nearer half. For 16 samples it is right to a factor of two; it is too large if more than a few
  /// samples are spikes. [m]
  double scale_m() const { return scale_m_; }

  /// One flag per sample: 1 if it belongs to the half that is nearer to the parabola.
  std::span<const std::uint8_t> nearer_half() const { return nearer_; }

 private:
  void try_curve(double curve, std::size_t half, double* best);

  double scale_m_ = 0.0;
  std::vector<std::uint8_t> nearer_;
  std::vector<double> across_, product_, distances_, best_, sorted_;
};

}  // namespace palpate
