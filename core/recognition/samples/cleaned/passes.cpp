#include "core/recognition/samples/cleaned/passes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/local/noise.h"
#include "core/local/spikes/jumps.h"
#include "core/numerics/probability/normal_law.h"
#include "core/numerics/quantile.h"
#include "core/recognition/samples/cleaned/turning_points.h"
#include "core/recognition/samples/stroke_order.h"

namespace palpate {
namespace {

/// Samples of a pass, and of an arm of a cusp: fewer show no path of their own beside which spikes
/// are seen.
constexpr std::size_t kFewestOfPass = 6;

/// Samples of a pass of a coarse stroke: a run of spikes is shorter.
constexpr std::size_t kFewestOfShortPass = kLongestRunOfSpikes + 1;

std::vector<Vec2> positions_of(std::span<const StoredSample> samples) {
  std::vector<Vec2> positions;
  positions.reserve(samples.size());
  for (const StoredSample& sample : samples) positions.push_back(sample.position_m);
  return positions;
}

/// The samples on the path of the stroke, by index: spikes turn it back too.
std::vector<std::size_t> on_path(std::span<const StoredSample> samples) {
  const std::vector<std::uint8_t> is_off = detours_of(positions_of(samples));
  std::vector<std::size_t> kept;
  kept.reserve(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (is_off[i] == 0) kept.push_back(i);
  }
  return kept;
}

/// True if the stroke steps back anywhere, over a few samples: a quick test. Noise may do so too.
bool steps_back(std::span<const StoredSample> samples) {
  constexpr std::size_t kFew = kFewestOfShortPass / 2;
  for (std::size_t i = 2 * kFew; i < samples.size(); ++i) {
    const Vec2 before = samples[i - kFew].position_m - samples[i - 2 * kFew].position_m;
    const Vec2 after = samples[i].position_m - samples[i - kFew].position_m;
    if (before.dot(after) < 0.0) {
      return true;
    }
  }
  return false;
}

struct Lengths {
  /// Noise does not move a sample so far off its path, nor does the path bend so far away from the
  /// way between two samples.
  double beside_m = 0.0;
  /// Noise does not put two samples so far apart. At least four median steps, because where the
  /// noise is as large as a patch, its estimate means nothing.
  double far_m = 0.0;
  /// Nor does it reach so far from a turn: one step where it is stated.
  double clear_m = 0.0;
  /// The noise is stated, and does not reach from one sample to the next.
  bool is_coarse = false;
};

/// The median second difference of the path, which places where it turns back, and single spikes,
/// do not change: of noise, of the bend of the way, or of both. [m]
double second_difference_m(std::span<const Vec2> positions) {
  std::vector<double> sizes;
  for (std::size_t i = 1; i + 1 < positions.size(); ++i) {
    sizes.push_back((positions[i - 1] - 2.0 * positions[i] + positions[i + 1]).norm());
  }
  return sizes.empty() ? 0.0 : median_of(sizes);
}

/// From the samples themselves and from their stated noise, whichever is more: where nothing but
/// the whole stroke, there and back, is much longer than its noise, samples show none, or too
/// little. nullopt if they do not and it is not stated.
std::optional<Lengths> lengths_of(std::span<const StoredSample> samples, double default_sigma_m) {
  constexpr double kFarDeviations = 10.0;
  constexpr double kFarSteps = 4.0;  // if the samples are noise alone, seven standard deviations
  const std::vector<Vec2> positions = positions_of(samples);
  std::vector<double> steps;
  steps.reserve(samples.size());
  for (std::size_t i = 1; i < positions.size(); ++i) {
    steps.push_back((positions[i] - positions[i - 1]).norm());
  }
  const NoiseEstimate noise = estimate_noise(positions);
  // 0 where either is not known.
  const double stated_m = std::sqrt(stated_variance_m2(samples, default_sigma_m).value_or(0.0));
  // Passes of few samples, shorter than the blocks by which noise is estimated, are no noise: it
  // makes second differences of 1 + 4 + 1 variances, the median of whose root is kMedianInPlane.
  const double second_m = second_difference_m(positions);
  const double shown_m = stated_m > 0.0
                             ? std::min(noise.sigma_m, second_m / (kMedianInPlane * std::sqrt(6.0)))
                             : noise.sigma_m;
  const double sigma_m = std::max(shown_m, stated_m);
  if (noise.status != LocalStatus::Ok && sigma_m == 0.0) {
    return std::nullopt;
  }
  const double noise_m = kFarDeviations * sigma_m;
  const double step_m = median_of(steps);
  const double bend_m = second_m / 4.0;  // a chord's height is an eighth of it: twice that
  return Lengths{std::max(noise_m, bend_m), std::max(noise_m, kFarSteps * step_m),
                 std::max(noise_m, (stated_m > 0.0 ? 1.0 : kFarSteps) * step_m),
                 stated_m > 0.0 && noise_m < step_m};
}

/// Distance from a place to the nearest step of a path through samples; nullopt if the nearest
/// point is the beginning of the path. [m]
std::optional<double> distance_from(std::span<const StoredSample> way, const Vec2& place) {
  double least = std::numeric_limits<double>::infinity();
  bool at_beginning = false;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Vec2 step = way[i].position_m - way[i - 1].position_m;
    const Vec2 to = place - way[i - 1].position_m;
    const double square = step.squaredNorm();
    const double share = square > 0.0 ? std::clamp(to.dot(step) / square, 0.0, 1.0) : 0.0;
    const double distance = (to - share * step).norm();
    if (distance < least) {
      least = distance;
      at_beginning = i == 1 && share == 0.0;
    }
  }
  return at_beginning ? std::nullopt : std::optional(least);
}

/// Of a pass after a reversal, so many places are compared with the pass before.
constexpr std::size_t kPlaces = 8;

struct Compared {
  std::size_t places = 0;  ///< farther from the turn than noise reaches, as far as both passes do
  std::size_t on = 0;      ///< of these, those on the pass before
  std::size_t beyond = 0;  ///< beyond where that began
};

Compared compared(std::span<const StoredSample> before, std::span<const StoredSample> after,
                  const Lengths& lengths) {
  constexpr double kBeside = 0.02;  // of the distance from the turn
  const Vec2 turn = before.back().position_m;
  Compared result;
  for (std::size_t k = 1; k <= kPlaces; ++k) {
    const Vec2& place = after[k * (after.size() - 1) / kPlaces].position_m;
    const double off = (place - turn).norm();
    const auto beside = distance_from(before, place);
    result.beyond += beside ? 0 : 1;
    if (beside && off > lengths.clear_m) {
      ++result.places;
      result.on += *beside <= std::max(lengths.beside_m, kBeside * off) ? 1 : 0;
    }
  }
  return result;
}

/// True if the pass after a reversal leads back over the one before. As far as both reach, it must
/// lie within the noise of it, or within the play and drag of a probe. One compared place in four
/// may be a spike. At least half of the places must be farther from the turn than noise reaches.
bool leads_back(std::span<const StoredSample> before, std::span<const StoredSample> after,
                const Lengths& lengths, std::size_t fewest) {
  Compared at = compared(before, after, lengths);
  // It goes on beyond where the other began: its first half, or that half's.
  while (2 * at.places < kPlaces && at.beyond > 0 && after.size() >= 2 * fewest) {
    after = after.first(after.size() / 2);
    at = compared(before, after, lengths);
  }
  return 2 * at.places >= kPlaces && 4 * at.on >= 3 * at.places;
}

/// Reversals by more than `far_m`, to passes of at least `fewest` samples.
Reversals reversals_by(std::span<const StoredSample> samples, const Lengths& lengths, double far_m,
                       std::size_t fewest) {
  Reversals turns;
  const std::vector<std::size_t> reversals =
      turning_points(0, samples.size(), far_m,
                     [&](std::size_t i) -> const Vec2& { return samples[i].position_m; });
  std::size_t begin = 0;   // of this pass
  std::size_t before = 0;  // the turn before this one, whatever it is
  for (std::size_t r = 0; r < reversals.size(); ++r) {
    // The sample at the turn ends one pass; the next pass begins after it.
    const std::size_t turn = reversals[r] + 1;
    std::size_t next = r + 1;
    const bool goes_on = next == reversals.size() || reversals[next] + 1 >= turn + fewest;
    while (next < reversals.size() && reversals[next] + 1 < turn + fewest) {
      ++next;
    }
    const std::size_t end = next < reversals.size() ? reversals[next] + 1 : samples.size();
    // Compares the way back with at most four times as many samples: that bounds the time.
    const std::size_t from = turn - std::min(turn - begin, 4 * (end - turn));
    const bool is_long = end - turn >= fewest;
    if (is_long && turn - begin >= fewest &&
        leads_back(samples.subspan(from, turn - from), samples.subspan(turn, end - turn), lengths,
                   fewest)) {
      turns.returns.push_back(turn);
      begin = turn;
    } else if (is_long && goes_on && turn - before >= fewest) {
      turns.cusps.push_back(turn);
    }
    before = turn;
  }
  return turns;
}

/// reversals_of, of samples without spikes.
Reversals reversals_of_path(std::span<const StoredSample> samples, double default_sigma_m) {
  const auto lengths = samples.size() >= 2 * kFewestOfShortPass
                           ? lengths_of(samples, default_sigma_m)
                           : std::nullopt;
  if (!lengths) {
    return {};
  }
  Reversals turns = reversals_by(samples, *lengths, lengths->far_m, kFewestOfPass);
  if (!lengths->is_coarse || !show_order(positions_of(samples))) {
    return turns;  // touches to and fro all over a part have no passes
  }
  // What few samples leave of a cusp is not told from spikes: passes alone.
  Reversals short_passes{
      reversals_by(samples, *lengths, lengths->clear_m, kFewestOfShortPass).returns, {}};
  return short_passes.returns.size() > turns.returns.size() ? short_passes : turns;
}

}  // namespace

Reversals reversals_of(std::span<const StoredSample> samples, double default_sigma_m) {
  if (samples.size() < 2 * kFewestOfShortPass || !steps_back(samples)) {
    return {};
  }
  const std::vector<std::size_t> kept = on_path(samples);
  std::vector<StoredSample> path;
  path.reserve(kept.size());
  for (const std::size_t i : kept) path.push_back(samples[i]);
  Reversals turns = reversals_of_path(path, default_sigma_m);
  for (std::size_t& turn : turns.returns) turn = kept[turn - 1] + 1;
  for (std::size_t& turn : turns.cusps) turn = kept[turn - 1] + 1;
  return turns;
}

std::vector<StoredPatch> passes_of(const StoredPatch& patch, std::span<const std::size_t> returns) {
  std::vector<std::size_t> ends(returns.begin(), returns.end());
  ends.push_back(patch.samples.size());
  std::vector<StoredPatch> passes;
  const auto part = [](const auto& all, std::size_t begin, std::size_t end) {
    using Distance = std::ptrdiff_t;
    return std::vector(all.begin() + static_cast<Distance>(begin),
                       all.begin() + static_cast<Distance>(end));
  };
  StoredPatch none = patch;
  none.samples.clear();
  none.details.clear();
  std::size_t begin = 0;
  for (const std::size_t end : ends) {
    StoredPatch pass = none;
    pass.samples = part(patch.samples, begin, end);
    if (!patch.details.empty()) pass.details = part(patch.details, begin, end);
    if (end < patch.samples.size()) {
      pass.newest_m = pass.samples.back().position_m;
    }
    if (passes.size() % 2 == 1) {
      std::reverse(pass.samples.begin(), pass.samples.end());
      std::reverse(pass.details.begin(), pass.details.end());
    }
    passes.push_back(std::move(pass));
    begin = end;
  }
  return passes;
}

}  // namespace palpate
