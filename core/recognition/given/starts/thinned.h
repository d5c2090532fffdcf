// Some of many, evenly spaced.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace palpate {

/// All if there are at most `most`; otherwise every k-th, for the least k that leaves no more.
template <typename T>
std::vector<T> thinned(std::span<const T> all, std::size_t most) {
  const std::size_t stride = (all.size() + most - 1) / most;
  std::vector<T> some;
  for (std::size_t i = 0; i < all.size(); i += stride) {
    some.push_back(all[i]);
  }
  return some;
}

}  // namespace palpate
