// Tangent angle, kappa and kappa_s along a patch while it is touched: every few samples one
// estimate, from a window as long as the data allow.
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
  /// Noise of samples that bring none; 0 = estimate it from the samples. [m]
  double sigma_m = 0.0;
  /// Smooth deviation of the part's surface from its curve, one standard deviation. [m]
  double form_deviation_m = 0.0;
};

/// An estimate at the middle of a window, and the samples of the patch that the window holds.
struct WindowEstimate {
  std::uint64_t first_sample = 0;
  std::uint64_t end_sample = 0;  ///< one past the newest
  LocalResult result;
};

/// One patch. The window reaches back from the newest sample as far as the polynomial of
/// window_fit.h explains the samples; it never starts before the window of the estimate before. The
/// answer of a sample depends on the samples before it only. Cost: bounded whatever the window's
/// length; memory: bounded whatever the patch's length; nothing is allocated in the steady state.
class SlidingWindow {
 public:
  explicit SlidingWindow(const SlidingOptions& options = {});

  /// `sigma_m`: noise of this sample, 0 = not known. The estimate that it completes, if any.
  std::optional<WindowEstimate> add(const Vec2& position_m, double sigma_m = 0.0);

  /// A new patch.
  void reset();

  std::uint64_t count() const { return pyramid_.count(); }

 private:
  WindowEstimate estimate();

  SlidingOptions options_;
  NodePyramid pyramid_;
  RunningNoise noise_;
  std::vector<PathNode> nodes_;
  std::uint64_t first_ = 0;  ///< of the window
  bool stated_ = true;       ///< every sample so far has a noise
  double stated_sigma_m_ = 0.0;
};

}  // namespace palpate
