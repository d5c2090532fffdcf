#include "core/local/stream/sliding_window.h"

#include <algorithm>
#include <cmath>

#include "core/local/stream/window_fit.h"

namespace palpate {
namespace {

/// The fraction that a window that is too long is shortened to. 0.9: on average a window is 5 %
/// shorter than necessary, and a window that must be halved takes seven steps, once.
constexpr double kShrink = 0.9;

}  // namespace

SlidingWindow::SlidingWindow(const SlidingOptions& options) : options_(options) {
  nodes_.reserve(NodePyramid::kMostNodes);
}

void SlidingWindow::reset() {
  pyramid_.clear();
  noise_.clear();
  first_ = 0;
  stated_ = true;
}

std::optional<WindowEstimate> SlidingWindow::add(const Vec2& position_m, double sigma_m) {
  const double sigma = sigma_m > 0.0 ? sigma_m : options_.sigma_m;
  if (!(sigma > 0.0)) {
    noise_.add(position_m);
  }
  if (pyramid_.count() == 0) {
    stated_ = sigma > 0.0;
    stated_sigma_m_ = sigma;
  }
  // Weights are relative to the noise of the first sample; 1 if it is unknown. Only ratios matter
  // until the noise is estimated.
  const double relative = stated_ && sigma > 0.0 ? sigma / stated_sigma_m_ : 1.0;
  pyramid_.add(position_m, 1.0 / (relative * relative));
  const auto shift = static_cast<std::uint64_t>(std::max(options_.shift, 1));
  if (pyramid_.count() < kFewestWindowNodes ||
      (pyramid_.count() - kFewestWindowNodes) % shift != 0) {
    return std::nullopt;
  }
  return estimate();
}

WindowEstimate SlidingWindow::estimate() {
  WindowEstimate answer;
  const std::uint64_t end = pyramid_.count();
  answer.end_sample = end;
  const std::optional<double> noise = stated_ ? stated_sigma_m_ : noise_.sigma_m();
  if (!noise) {
    answer.first_sample = first_;
    return answer;
  }
  while (true) {
    first_ = pyramid_.window(first_, &nodes_);
    answer.first_sample = first_;
    const auto length = static_cast<double>(end - first_);
    const std::uint64_t shorter = end - static_cast<std::uint64_t>(kShrink * length);
    const bool shortest = end - shorter < kFewestWindowNodes;
    answer.result = fit_window(nodes_, *noise, options_.form_deviation_m, shortest && !stated_);
    if (answer.result || shortest) {
      answer.result.estimate.window_samples = static_cast<int>(end - first_);
      return answer;
    }
    first_ = shorter;
  }
}

}  // namespace palpate
