// The sliding window's fit to samples of equal noise, all in one window.
#pragma once

#include <span>
#include <vector>

#include "core/local/stream/window_fit.h"

namespace palpate::test {

inline LocalResult fit_samples(std::span<const Vec2> samples, double sigma_m) {
  std::vector<PathNode> nodes;
  nodes.reserve(samples.size());
  for (const Vec2& p : samples) {
    nodes.push_back({p, 1.0});
  }
  return fit_window(nodes, sigma_m, 0.0);
}

}  // namespace palpate::test
