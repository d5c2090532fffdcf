#include "core/recognition/samples/cleaned/chained_touches.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace palpate {
namespace {

/// A chain with a side longer than this, in units of what two touches of one place reach, is not of
/// one place: noise puts two of ten thousand touches so far apart once in 20,000 times.
constexpr double kTooLong = 2.0;

/// A touch whose noise is stated.
struct Touch {
  std::size_t patch = 0;
  Vec2 position_m = Vec2::Zero();
  double sigma_m = 0.0;
};

std::vector<Touch> touches_of(const std::vector<StoredPatch>& patches, double default_sigma_m) {
  std::vector<Touch> touches;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const StoredSample& sample = patches[p].samples.front();
    if (patches[p].samples.size() == 1 && sigma_m_of(sample, default_sigma_m) > 0.0) {
      touches.push_back({p, sample.position_m, deviation_m(sample, default_sigma_m)});
    }
  }
  return touches;
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

/// The element that stands for the set of `i` in a forest of parents.
std::size_t root_of(std::vector<std::size_t>* parents, std::size_t i) {
  std::vector<std::size_t>& up = *parents;
  while (up[i] != i) {
    up[i] = up[up[i]];
    i = up[i];
  }
  return i;
}

std::vector<std::size_t> each_alone(std::size_t count) {
  std::vector<std::size_t> parents(count);
  std::iota(parents.begin(), parents.end(), std::size_t{0});
  return parents;
}

/// Sets of touches that hang together, with the box about each and its widest noise.
class Chains {
 public:
  explicit Chains(const std::vector<Touch>& touches) : parents_(each_alone(touches.size())) {
    for (const Touch& touch : touches) {
      extents_.push_back({touch.position_m, touch.position_m, touch.sigma_m});
    }
  }

  std::size_t root(std::size_t i) { return root_of(&parents_, i); }

  void unite(std::size_t a, std::size_t b) {
    a = root(a);
    b = root(b);
    if (a == b) {
      return;
    }
    parents_[b] = a;
    Extent& all = extents_[a];
    const Extent& other = extents_[b];
    all.low_m = all.low_m.cwiseMin(other.low_m);
    all.high_m = all.high_m.cwiseMax(other.high_m);
    all.widest_m = std::max(all.widest_m, other.widest_m);
    all.is_too_long = all.is_too_long || other.is_too_long ||
                      (all.high_m - all.low_m).maxCoeff() >
                          kTooLong * kOnePlace * std::hypot(all.widest_m, all.widest_m);
  }

  bool is_too_long(std::size_t i) { return extents_[root(i)].is_too_long; }

 private:
  struct Extent {
    Vec2 low_m, high_m;
    double widest_m = 0.0;
    bool is_too_long = false;
  };
  std::vector<std::size_t> parents_;
  std::vector<Extent> extents_;  // of the chains, by root
};

/// Sorts by x or y, whichever the touches spread along more, so that few are beside each other.
/// Returns the axis.
Eigen::Index sort_along(std::vector<Touch>* touches) {
  Vec2 low = touches->front().position_m;
  Vec2 high = low;
  for (const Touch& touch : *touches) {
    low = low.cwiseMin(touch.position_m);
    high = high.cwiseMax(touch.position_m);
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  std::sort(touches->begin(), touches->end(), [axis](const Touch& a, const Touch& b) {
    return a.position_m[axis] < b.position_m[axis] ||
           (a.position_m[axis] == b.position_m[axis] && a.patch < b.patch);
  });
  return axis;
}

}  // namespace

double deviation_m(const StoredSample& touch, double default_sigma_m) {
  return sigma_m_of(touch, default_sigma_m) / std::sqrt(touch.weight);
}

std::vector<std::vector<std::size_t>> chained_touches(const std::vector<StoredPatch>& patches,
                                                      double default_sigma_m) {
  std::vector<Touch> touches = touches_of(patches, default_sigma_m);
  if (touches.size() < 2) {
    return {};
  }
  const Eigen::Index axis = sort_along(&touches);
  double widest_m = 0.0;
  for (const Touch& touch : touches) widest_m = std::max(widest_m, touch.sigma_m);
  const auto hang_together = [&](const Touch& a, const Touch& b) {
    return (a.position_m - b.position_m).norm() <= kOnePlace * std::hypot(a.sigma_m, b.sigma_m) &&
           has_same_tip(patches[a.patch], patches[b.patch]) &&
           have_one_normal(patches[a.patch], patches[b.patch]);
  };
  Chains chains(touches);
  // From each touch, the next that no chain that is too long has taken. Another of such a chain
  // need not be compared with these: among n touches within the noise of each other, n pairs tell.
  std::vector<std::size_t> next_open = each_alone(touches.size() + 1);
  for (std::size_t k = 0; k < touches.size(); ++k) {
    const double reach_m =
        touches[k].position_m[axis] + kOnePlace * std::hypot(touches[k].sigma_m, widest_m);
    bool is_too_long = chains.is_too_long(k);
    const auto after = [&](std::size_t j) {
      return is_too_long ? root_of(&next_open, j + 1) : j + 1;
    };
    for (std::size_t j = after(k); j < touches.size() && touches[j].position_m[axis] <= reach_m;
         j = after(j)) {
      if (!hang_together(touches[k], touches[j])) {
        continue;
      }
      chains.unite(k, j);
      is_too_long = chains.is_too_long(k);
      if (is_too_long) next_open[j] = j + 1;
    }
  }
  std::vector<std::vector<std::size_t>> of_root(touches.size());
  for (std::size_t k = 0; k < touches.size(); ++k) {
    if (!chains.is_too_long(k)) of_root[chains.root(k)].push_back(touches[k].patch);
  }
  std::erase_if(of_root, [](const auto& chain) { return chain.size() < 2; });
  for (std::vector<std::size_t>& chain : of_root) std::sort(chain.begin(), chain.end());
  return of_root;
}

}  // namespace palpate
