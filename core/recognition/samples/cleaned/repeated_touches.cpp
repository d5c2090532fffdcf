#include "core/recognition/samples/cleaned/repeated_touches.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/recognition/samples/merged_samples.h"

namespace palpate {
namespace {

using Indices = std::vector<std::size_t>;

const StoredSample& touch_of(const StoredPatch& patch) { return patch.samples.front(); }

/// Standard deviation of the stored touch. [m]
double deviation_m(const StoredSample& touch, double default_sigma_m) {
  return sigma_m_of(touch, default_sigma_m) / std::sqrt(touch.weight);
}

bool has_same_tip(const StoredPatch& a, const StoredPatch& b) {
  return a.context.tip_radius_m == b.context.tip_radius_m &&
         a.context.material_side == b.context.material_side;
}

/// Whether measured normals of both, if any, are one direction by their noise. A touch with one and
/// a touch without stay apart: their mean would have none.
bool have_one_normal(const StoredPatch& a, const StoredPatch& b) {
  const SampleDetail of_a = first_detail(a);
  const SampleDetail of_b = first_detail(b);
  const bool has_a = of_a.normal_sigma_rad > 0.0;
  const bool has_b = of_b.normal_sigma_rad > 0.0;
  return has_a == has_b &&
         (!has_a || std::abs(turn_between(of_a.normal, of_b.normal)) <=
                        kOnePlace * std::hypot(of_a.normal_sigma_rad, of_b.normal_sigma_rad));
}

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

/// One round: each touch with those about it.
std::vector<StoredPatch> merged_once(std::vector<StoredPatch> patches, double default_sigma_m) {
  Indices along_x;
  double widest_m = 0.0;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    if (patches[p].samples.size() == 1 && sigma_m_of(touch_of(patches[p]), default_sigma_m) > 0.0) {
      along_x.push_back(p);
      widest_m = std::max(widest_m, deviation_m(touch_of(patches[p]), default_sigma_m));
    }
  }
  const auto x_of = [&](std::size_t p) { return touch_of(patches[p]).position_m.x(); };
  std::sort(along_x.begin(), along_x.end(), [&](std::size_t a, std::size_t b) {
    return x_of(a) < x_of(b) || (x_of(a) == x_of(b) && a < b);
  });
  if (along_x.size() < 2) {
    return patches;
  }
  std::vector<Indices> places(patches.size());  // by the first touch of each
  std::vector<bool> is_taken(patches.size(), false);
  for (std::size_t k = 0; k < along_x.size(); ++k) {
    const std::size_t seed = along_x[k];
    if (is_taken[seed]) {
      continue;
    }
    const double sigma_m = deviation_m(touch_of(patches[seed]), default_sigma_m);
    const double reach_m = kOnePlace * std::hypot(sigma_m, widest_m);
    Indices near{seed};
    for (std::size_t j = k + 1; j < along_x.size() && x_of(along_x[j]) <= x_of(seed) + reach_m;
         ++j) {
      const std::size_t other = along_x[j];
      const double apart_m =
          (touch_of(patches[other]).position_m - touch_of(patches[seed]).position_m).norm();
      const double most_m =
          kOnePlace * std::hypot(sigma_m, deviation_m(touch_of(patches[other]), default_sigma_m));
      if (!is_taken[other] && apart_m <= most_m && has_same_tip(patches[seed], patches[other]) &&
          have_one_normal(patches[seed], patches[other])) {
        near.push_back(other);
      }
    }
    if (near.size() > 1 && is_one_place(patches, near, default_sigma_m)) {
      std::sort(near.begin(), near.end());
      for (const std::size_t p : near) {
        is_taken[p] = true;
      }
      places[near.front()] = std::move(near);
    }
  }
  if (std::find(is_taken.begin(), is_taken.end(), true) == is_taken.end()) {
    return patches;
  }
  std::vector<StoredPatch> result;
  result.reserve(patches.size());
  for (std::size_t p = 0; p < patches.size(); ++p) {
    if (!places[p].empty()) {
      result.push_back(mean_of(patches, places[p]));
    } else if (!is_taken[p]) {
      result.push_back(patches[p]);
    }
  }
  return result;
}

}  // namespace

std::vector<StoredPatch> without_repeated_touches(std::vector<StoredPatch> patches,
                                                  double default_sigma_m) {
  // A touch that noise has taken from those about which it was sought may still be of their mean.
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    const std::size_t before = patches.size();
    patches = merged_once(std::move(patches), default_sigma_m);
    if (patches.size() == before) {
      break;
    }
  }
  return patches;
}

}  // namespace palpate
