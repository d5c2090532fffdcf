#include "core/recognition/samples/patch_queue.h"

#include <algorithm>
#include <utility>

namespace palpate {

PatchQueue::Stroke PatchQueue::stroke_of(const PatchContext& context) {
  return {context.probe, context.patch, context.tip_radius_m};
}

void PatchQueue::close_gap() {
  const auto gap = static_cast<std::ptrdiff_t>(gap_);
  patches_.erase(patches_.begin(), patches_.begin() + gap);
  numbers_.erase(numbers_.begin(), numbers_.begin() + gap);
  gap_ = 0;
}

StoredPatch* PatchQueue::find(const PatchContext& context) {
  const auto [from, to] = by_stroke_.equal_range(stroke_of(context));
  for (auto entry = from; entry != to; ++entry) {
    const auto number = std::lower_bound(numbers_.begin() + static_cast<std::ptrdiff_t>(gap_),
                                         numbers_.end(), entry->second);
    StoredPatch& patch = patches_[static_cast<std::size_t>(number - numbers_.begin())];
    if (is_of_one_stroke(patch.context, context)) {
      return &patch;
    }
  }
  return nullptr;
}

StoredPatch* PatchQueue::begin(const PatchContext& context) {
  if (gap_ > size()) {  // then as many were taken out as are moved
    close_gap();
  }
  by_stroke_.emplace(stroke_of(context), next_);
  numbers_.push_back(next_++);
  StoredPatch& patch = patches_.emplace_back();
  patch.context = context;
  return &patch;
}

StoredPatch PatchQueue::take_oldest(bool lone, StoredPatch** growing) {
  const auto first = patches_.begin() + static_cast<std::ptrdiff_t>(gap_);
  const auto oldest = std::find_if(first, patches_.end(), [&](const StoredPatch& patch) {
    return &patch != *growing && (patch.samples.size() == 1) == lone;
  });
  const auto first_number = numbers_.begin() + static_cast<std::ptrdiff_t>(gap_);
  const auto number = first_number + (oldest - first);
  const auto [from, to] = by_stroke_.equal_range(stroke_of(oldest->context));
  by_stroke_.erase(
      std::find_if(from, to, [&](const auto& entry) { return entry.second == *number; }));
  StoredPatch taken = std::move(*oldest);
  std::move_backward(first, oldest, oldest + 1);
  std::move_backward(first_number, number, number + 1);
  if (*growing < &*oldest) {
    ++*growing;
  }
  ++gap_;
  return taken;
}

}  // namespace palpate
