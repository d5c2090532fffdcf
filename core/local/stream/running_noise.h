// Estimates the noise of a path while its samples arrive, for samples that do not state it.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/curves/pose2.h"
#include "core/local/noise.h"

namespace palpate {

/// Pools estimate_noise (core/local/noise.h) over consecutive chunks of samples. A spike spoils its
/// chunk only. Bounded memory, allocated at once; O(1) per sample on average.
class RunningNoise {
 public:
  /// Samples per chunk: about 20 degrees of freedom, so a single chunk has a relative error of 16
  /// %.
  static constexpr std::size_t kChunk = 32;
  /// Degrees of freedom that count. 2,000 determine sigma to 1.6 %, and a change of the noise is
  /// still followed.
  static constexpr double kMostDof = 2000.0;

  RunningNoise() {
    chunk_.reserve(kChunk);
    scratch_.reserve(kChunk);
  }

  void add(const Vec2& position_m);
  void clear();

  /// Standard deviation of one coordinate, enlarged for the uncertainty of so few residuals (by the
  /// variance of a Student variable); nullopt if nothing is known yet. [m]
  std::optional<double> sigma_m();

 private:
  std::vector<Vec2> chunk_;
  NoiseScratch scratch_;
  double squares_ = 0.0;  ///< dof * variance, summed over chunks
  double dof_ = 0.0;
};

}  // namespace palpate
