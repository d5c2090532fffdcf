// Cuts strokes that turn back over themselves into passes of one direction each.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// Where a stroke turns back: indices of the samples after the turns, ascending.
struct Reversals {
  /// It leads back over the path that it came: a new pass, of at least 6 samples (4 where
  /// stated noise does not reach from one to the next), begins. A stroke that turns back beside its
  /// path (a cusp, the end of a needle) begins none.
  std::vector<std::size_t> returns;
  /// It turns back beside its path, for at least 6 samples. (A spike turns a stroke back twice.)
  std::vector<std::size_t> cusps;

  bool operator==(const Reversals&) const = default;
};

/// A turn by no more than the samples' own noise is none, nor is one of spikes. `default_sigma_m`:
/// noise of samples that state none; 0 = not known. O(samples).
Reversals reversals_of(std::span<const StoredSample> samples, double default_sigma_m);

/// Cuts the patch before each of these samples. Every second pass is reversed, so that all passes
/// have the direction of the first and the material on the same side of travel.
std::vector<StoredPatch> passes_of(const StoredPatch& patch, std::span<const std::size_t> returns);

}  // namespace palpate
