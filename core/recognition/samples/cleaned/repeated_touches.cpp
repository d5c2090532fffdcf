#include "core/recognition/samples/cleaned/repeated_touches.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/recognition/samples/cleaned/chained_touches.h"
#include "core/recognition/samples/merged_samples.h"

namespace palpate {
namespace {

using Indices = std::vector<std::size_t>;

const StoredSample& touch_of(const StoredPatch& patch) { return patch.samples.front(); }

/// Whether touches scatter about their mean no more than their noise lets them.
bool is_one_place(std::span<const StoredPatch> patches, const Indices& touches,
                  double default_sigma_m) {
  double weight = 0.0;
  Vec2 mean = Vec2::Zero();
  const Vec2 origin = touch_of(patches[touches.front()]).position_m;
  for (const std::size_t p : touches) {
    const StoredSample& touch = touch_of(patches[p]);
    const double sigma_m = deviation_m(touch, default_sigma_m);
    weight += 1.0 / (sigma_m * sigma_m);
    mean += (touch.position_m - origin) / (sigma_m * sigma_m);
  }
  mean = origin + mean / weight;
  double chi2 = 0.0;
  for (const std::size_t p : touches) {
    const StoredSample& touch = touch_of(patches[p]);
    chi2 += ((touch.position_m - mean) / deviation_m(touch, default_sigma_m)).squaredNorm();
  }
  // Noise leaves more less than once in a thousand times: that of two touches follows an
  // exponential law, and what more touches add is below the bound of B. Laurent and P. Massart
  // (2000, lemma 1).
  constexpr double kLogOfRare = 0.5 * kOnePlace * kOnePlace;
  const double dof = 2.0 * static_cast<double>(touches.size() - 2);
  return chi2 <= dof + 2.0 * std::sqrt(dof * kLogOfRare) + 2.0 * kLogOfRare;
}

/// Their mean in place of the first.
StoredPatch mean_of(std::span<const StoredPatch> patches, const Indices& touches) {
  StoredPatch mean = patches[touches.front()];
  SampleDetail detail = first_detail(mean);
  bool is_detailed = !mean.details.empty();
  for (auto p = touches.begin() + 1; p != touches.end(); ++p) {
    detail = merged(touch_of(mean), detail, touch_of(patches[*p]), first_detail(patches[*p]));
    mean.samples.front() = merged(touch_of(mean), touch_of(patches[*p]));
    is_detailed = is_detailed || !patches[*p].details.empty();
  }
  if (is_detailed) {
    mean.details.assign(1, detail);
  }
  return mean;
}

}  // namespace

void merge_repeated_touches(double default_sigma_m, std::vector<StoredPatch>* moved,
                            std::vector<StoredPatch>* clean) {
  assert(moved->size() == clean->size());
  std::vector<StoredPatch> touches;
  Indices patch_of;
  for (std::size_t p = 0; p < moved->size(); ++p) {
    if ((*moved)[p].samples.size() == 1 && (*clean)[p].samples.size() == 1) {
      touches.push_back((*clean)[p]);
      patch_of.push_back(p);
    }
  }
  std::vector<bool> is_taken(moved->size(), false);  // by the mean of others
  for (const Indices& chain : chained_touches(touches, default_sigma_m)) {
    if (!is_one_place(touches, chain, default_sigma_m)) {
      continue;
    }
    for (const std::size_t touch : chain) is_taken[patch_of[touch]] = true;
    const std::size_t first = patch_of[chain.front()];
    is_taken[first] = false;
    (*moved)[first] = (*clean)[first] = mean_of(touches, chain);
  }
  for (std::vector<StoredPatch>* patches : {moved, clean}) {
    std::size_t kept = 0;
    for (std::size_t p = 0; p < patches->size(); ++p) {
      if (!is_taken[p]) {
        if (kept != p) (*patches)[kept] = std::move((*patches)[p]);
        ++kept;
      }
    }
    patches->resize(kept);
  }
}

}  // namespace palpate
