// The patches of a memory in the order in which they were begun: found by their stroke, forgotten
// from the oldest on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// Pointers to its patches hold until another one is begun or forgotten.
class PatchQueue {
 public:
  std::size_t size() const { return patches_.size() - gap_; }
  std::span<const StoredPatch> patches() const { return std::span(patches_).subspan(gap_); }

  /// The oldest patch that such samples continue; nullptr if none. O(log patches).
  StoredPatch* find(const PatchContext& context);

  /// A new patch, still empty. Amortised O(log patches).
  StoredPatch* begin(const PatchContext& context);

  /// Takes out the oldest of a kind, single touches or longer patches, but not `*growing`, which
  /// may move. There must be one. O(log patches), and O(older ones of the other kind).
  StoredPatch take_oldest(bool lone, StoredPatch** growing);

 private:
  /// Probe, patch and tip radius. More than one patch may have them: their sides differ.
  using Stroke = std::tuple<std::uint32_t, std::uint32_t, double>;
  /// How many patches were begun before it: unlike its place it stays when others are forgotten.
  using Number = std::uint64_t;
  static Stroke stroke_of(const PatchContext& context);

  void close_gap();

  /// Those taken out leave a gap at the front: what is older moves up, not what is younger down,
  /// as the oldest of all is mostly the one to go.
  std::size_t gap_ = 0;
  std::vector<StoredPatch> patches_;
  std::vector<Number> numbers_;  ///< one per patch, increasing
  Number next_ = 0;
  std::multimap<Stroke, Number> by_stroke_;  ///< of one stroke by age
};

}  // namespace palpate
