// Tangent angle, kappa and kappa_s along a patch while it is being touched: an estimate every few
// samples, from a window as long as the data allow.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/local/local_status.h"
#include "core/local/stream/node_pyramid.h"
#include "core/local/stream/running_noise.h"

namespace palpate {

struct SlidingOptions {
  int shift = 4;  ///< samples from one estimate to the next
  /// Noise of samples that state none; 0 = estimate it from the samples. [m]
  double sigma_m = 0.0;
  /// Smooth deviation of the part's surface from the ideal curve, one standard deviation. [m]
  double form_deviation_m = 0.0;
};

/// An estimate at the middle of a window, and the range of the patch's samples in that window.
struct WindowEstimate {
  std::uint64_t first_sample = 0;
  std::uint64_t end_sample = 0;  ///< one past the newest
  LocalResult result;
};

/// The estimator of one patch. The window reaches back from the newest sample as far as the
/// polynomial of window_fit.h explains the samples. It never begins before the previous window did.
/// An estimate depends on earlier samples only. The cost per sample does not grow with the window,
/// nor the memory with the patch. Nothing is allocated in the steady state.
class SlidingWindow {
 public:
  explicit SlidingWindow(const SlidingOptions& options = {});

  /// Adds a sample with noise `sigma_m`; 0 = unknown. [m] Returns the estimate that this sample
  /// completes, if any.
  std::optional<WindowEstimate> add(const Vec2& position_m, double sigma_m = 0.0);

  /// Starts a new patch.
  void reset();

  std::uint64_t count() const { return pyramid_.count(); }

 private:
  WindowEstimate estimate();

  SlidingOptions options_;
  NodePyramid pyramid_;
  RunningNoise noise_;
  std::vector<PathNode> nodes_;
  std::uint64_t first_ = 0;  ///< first sample of the window
  bool stated_ = true;       ///< the first sample of the patch states its noise
  double stated_sigma_m_ = 0.0;
};

}  // namespace palpate
