// The noise of a path whose samples do not state it, while they arrive.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/curves/pose2.h"

namespace palpate {

/// estimate_noise (core/local/noise.h) of one chunk of samples after another, pooled: a spike harms
/// a chunk and not the answer. Bounded memory, O(1) a sample in the mean.
class RunningNoise {
 public:
  /// Samples of a chunk: some 20 degrees of freedom, so that a chunk's own scatter is 16 %.
  static constexpr std::size_t kChunk = 32;
  /// Degrees of freedom that are remembered: 2,000 of them know sigma to 1.6 %, and a noise that
  /// changes is followed.
  static constexpr double kMostDof = 2000.0;

  RunningNoise() { chunk_.reserve(kChunk); }

  void add(const Vec2& position_m);
  void clear();

  /// One coordinate's standard deviation, enlarged by what so few residuals leave unknown of it
  /// (the variance of a Student variable); nullopt where nothing can be said yet. [m]
  std::optional<double> sigma_m() const;

 private:
  std::vector<Vec2> chunk_;
  double squares_ = 0.0;  ///< dof * variance of whole chunks
  double dof_ = 0.0;
};

}  // namespace palpate
