#include "core/recognition/samples/dwells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/numerics/quantile.h"
#include "core/recognition/samples/sample_block.h"
#include "core/recognition/samples/step_ratio.h"

namespace palpate {
namespace {

/// True if a step tends to go back on the step before it. Of places in random order the mean
/// product of successive steps is -1/2 of their mean square; on a way there and back, as over a
/// cusp, it is at least 1/2, though ratio_of() may be 1: half way is the limit.
bool goes_back_and_forth(std::span<const SampleBlock> blocks) {
  double products = 0.0;
  for (std::size_t b = 2; b < blocks.size(); ++b) {
    products += (blocks[b].mean - blocks[b - 1].mean).dot(blocks[b - 1].mean - blocks[b - 2].mean);
  }
  return products < 0.0;
}

constexpr std::size_t kBlock = 8;

/// Fewer blocks show no order by their means. Six evenly spaced ones have the ratio 6 / 35.
constexpr std::size_t kFewestBlocks = 6;

/// How far apart samples of one place lie at most, in units of the spread of pure noise. Motion
/// over six standard deviations gives as much.
constexpr double kSpread = 1.6;

/// Standard deviation of a sample as it is stated; 0 = not known. [m]
double deviation_m(const StoredSample& sample, double default_sigma_m) {
  return sigma_m_of(sample, default_sigma_m) / std::sqrt(sample.weight);
}

/// Whether samples lie about one place as their stated noise lets them, each by its own: a few loud
/// ones do not let the others lie anywhere. nullopt if the noise of any is not stated.
std::optional<bool> lie_as_stated(std::span<const StoredSample> samples, double default_sigma_m) {
  double least_m = std::numeric_limits<double>::infinity();
  for (const StoredSample& sample : samples) {
    least_m = std::min(least_m, deviation_m(sample, default_sigma_m));
  }
  if (!(least_m > 0.0)) {
    return std::nullopt;
  }
  const Vec2 any = samples.front().position_m;
  Vec2 sum = Vec2::Zero();
  double weights = 0.0;
  for (const StoredSample& sample : samples) {
    const double share = least_m / deviation_m(sample, default_sigma_m);
    sum += share * share * (sample.position_m - any);
    weights += share * share;
  }
  const Vec2 mean = any + sum / weights;
  double squares = 0.0;
  for (const StoredSample& sample : samples) {
    squares += ((sample.position_m - mean) / deviation_m(sample, default_sigma_m)).squaredNorm();
  }
  return squares <= 2.0 * kSpread * kSpread * static_cast<double>(samples.size());
}

/// Consecutive blocks of a stroke in which it moves slowly.
class SlowStretch {
 public:
  SlowStretch(std::span<const StoredSample> samples, std::span<const SampleBlock> blocks,
              double default_sigma_m)
      : samples_(samples), blocks_(blocks), default_sigma_m_(default_sigma_m) {}

  /// Adds the dwells of this stretch: the whole stretch, or the dwells of its two parts, cut at the
  /// longest step. After 16 such cuts (a stroke that slows down gradually) it is cut in the middle
  /// instead: that bounds the time.
  void add_to(std::vector<PatchSpan>* dwells, int cuts = 0) const {
    constexpr int kMostByStep = 16;
    if (blocks_.size() < 2) {
      return;
    }
    if (is_still()) {
      if (const PatchSpan span = trimmed(); span.size() >= kBlock) {
        dwells->push_back(span);
      }
      return;
    }
    std::size_t after = std::max<std::size_t>(blocks_.size() / 2, 1);
    double longest = 0.0;
    for (std::size_t b = 1; b < blocks_.size() && cuts < kMostByStep; ++b) {
      const double step = (blocks_[b].mean - blocks_[b - 1].mean).squaredNorm();
      if (step > longest) {
        longest = step;
        after = b;
      }
    }
    SlowStretch(samples_, blocks_.first(after), default_sigma_m_).add_to(dwells, cuts + 1);
    SlowStretch(samples_, blocks_.subspan(after), default_sigma_m_).add_to(dwells, cuts + 1);
  }

 private:
  SampleBlock whole() const {
    return block_of(samples_, blocks_.front().begin, blocks_.back().end);
  }

  /// A jitter that neighbouring samples share shows no order from block to block.
  bool is_still() const {
    const SampleBlock all = whole();
    return ratio_of(samples_, all) > kNoOrder ||
           (blocks_.size() >= kFewestBlocks && may_be_jitter(all) && goes_back_and_forth(blocks_) &&
            ratio_of(blocks_, block_of(blocks_, 0, blocks_.size())) > kNoOrder);
  }

  /// Whether the stated noise, which contains a jitter, is as large. A few means on the way over a
  /// cusp, slow on one arm, show as little order.
  bool may_be_jitter(const SampleBlock& all) const {
    return lie_as_stated(samples_.subspan(all.begin, all.end - all.begin), default_sigma_m_)
        .value_or(true);
  }

  /// The dwell's exact range: drops samples at the ends that lie farther off than the others, and
  /// adds neighbours that do not. The ends of the blocks are not the ends of the dwell.
  PatchSpan trimmed() const {
    PatchSpan span{blocks_.front().begin, blocks_.back().end};
    const auto lies_by = [&](std::size_t i, std::size_t begin, std::size_t end) {
      // Times the root mean square: noise exceeds it once in 8,000 times.
      constexpr double kFarthest = 3.0;
      const SampleBlock others = block_of(samples_, begin, end);
      return (samples_[i].position_m - others.mean).squaredNorm() <=
             kFarthest * kFarthest * others.square;
    };
    for (std::size_t i = 0; i < kBlock && !lies_by(span.begin, span.begin + 1, span.end); ++i) {
      ++span.begin;
    }
    for (std::size_t i = 1; i < kBlock && !lies_by(span.end - 1, span.begin, span.end - 1); ++i) {
      --span.end;
    }
    while (span.begin > 0 && span.begin + kBlock > blocks_.front().begin &&
           lies_by(span.begin - 1, span.begin, span.end)) {
      --span.begin;
    }
    while (span.end < samples_.size() && span.end < blocks_.back().end + kBlock &&
           lies_by(span.end, span.begin, span.end)) {
      ++span.end;
    }
    return span;
  }

  std::span<const StoredSample> samples_;
  std::span<const SampleBlock> blocks_;
  double default_sigma_m_;
};

}  // namespace

std::vector<PatchSpan> dwells_of(std::span<const StoredSample> samples, double default_sigma_m) {
  // In units of a block's length at the mean speed. At that speed, without noise, a block scatters
  // by 0.29 of this length about its mean. Slower blocks are examined further.
  constexpr double kSlow = 0.25;
  std::vector<PatchSpan> dwells;
  const std::size_t count = samples.size() / kBlock;
  if (count < 2) {
    return dwells;
  }
  std::vector<SampleBlock> blocks;
  blocks.reserve(count);
  double way = 0.0;
  Vec2 before = Vec2::Zero();
  for (std::size_t b = 0; b < count; ++b) {
    blocks.push_back(
        block_of(samples, b * samples.size() / count, (b + 1) * samples.size() / count));
    // A spike, which moves the mean by an eighth of its height, would make the stroke look fast and
    // the rest of it slow.
    const Vec2 middle =
        median_place(samples.subspan(blocks.back().begin, blocks.back().end - blocks.back().begin));
    way += b > 0 ? (middle - before).norm() : 0.0;
    before = middle;
  }
  const double slow = kSlow * way / static_cast<double>(count);
  for (std::size_t b = 0; b < count;) {
    std::size_t end = b;
    while (end < count && blocks[end].square < slow * slow) {
      ++end;
    }
    SlowStretch(samples, std::span(blocks).subspan(b, end - b), default_sigma_m).add_to(&dwells);
    b = std::max(end, b + 1);
  }
  // Ranges that were widened may overlap. What is left a single sample, or none, has nothing to
  // merge.
  std::vector<PatchSpan> apart;
  for (PatchSpan dwell : dwells) {
    dwell.begin = std::max(dwell.begin, apart.empty() ? 0 : apart.back().end);
    if (dwell.begin + 1 < dwell.end) {
      apart.push_back(dwell);
    }
  }
  return apart;
}

std::vector<PatchSpan> repeats_of(std::span<const StoredSample> samples) {
  // Steps of pure noise are as short once in 8,000 times.
  constexpr double kRepeated = 1e-2;  // in units of the mean step
  std::vector<PatchSpan> repeats;
  double way = 0.0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    way += (samples[i].position_m - samples[i - 1].position_m).norm();
  }
  const double farthest = kRepeated * way / static_cast<double>(samples.size());
  for (std::size_t i = 0; i < samples.size();) {
    std::size_t end = i + 1;
    while (end < samples.size() &&
           (samples[end].position_m - samples[i].position_m).squaredNorm() < farthest * farthest) {
      ++end;
    }
    if (end - i > 1) {
      repeats.push_back({i, end});
    }
    i = end;
  }
  return repeats;
}

std::vector<PatchSpan> held_places(std::span<const StoredSample> samples) {
  // Of two samples of one place; noise makes a step so long once in exp(16 log 2), 65,000 times.
  constexpr double kLong = 4.0;   // median steps
  constexpr double kApart = 3.0;  // of the scatter: six deviations of a coordinate
  if (samples.size() < 2 * kBlock) {
    return {};
  }
  std::vector<double> steps;
  steps.reserve(samples.size());
  for (std::size_t i = 1; i < samples.size(); ++i) {
    steps.push_back((samples[i].position_m - samples[i - 1].position_m).norm());
  }
  std::vector<double> sorted = steps;
  const double long_m = kLong * median_of(sorted);
  std::vector<PatchSpan> places;
  std::size_t held = 0;
  SampleBlock before;
  for (std::size_t begin = 0; begin < samples.size();) {
    std::size_t end = begin + 1;
    while (end < samples.size() && steps[end - 1] <= long_m) {
      ++end;
    }
    if (end - begin >= kBlock) {
      const SampleBlock here = block_of(samples, begin, end);
      const bool is_apart = places.empty() || (here.mean - before.mean).squaredNorm() >
                                                  kApart * kApart * (here.square + before.square);
      if (!is_apart || !(ratio_of(samples, here) > kNoOrder)) {
        return {};
      }
      places.push_back({begin, end});
      held += end - begin;
      before = here;
    }
    begin = end;
  }
  // (one that is all of them is is_one_place()'s)
  const bool moved = !places.empty() && places.front().size() < samples.size();
  return moved && 2 * held >= samples.size() ? places : std::vector<PatchSpan>{};
}

bool is_one_place(std::span<const StoredSample> samples, double default_sigma_m,
                  double half_extent_m) {
  if (samples.size() < 2) {
    return false;
  }
  constexpr double kSmall = 1e-2;
  // Over it a curve that bends by the part's size is off a chord by half a millionth of that: means
  // are as good as what they stand for, and so few samples know no direction better.
  constexpr double kTiny = 1e-3;
  const bool may_show_order = samples.size() >= kFewestInOrder;
  const bool must_show_order = samples.size() >= 2 * kFewestInOrder;
  const double n = static_cast<double>(samples.size());
  const double half_square = half_extent_m * half_extent_m;
  const double small = may_show_order ? kSmall * kSmall * half_square : 0.0;
  const double tiny = must_show_order ? 0.0 : kTiny * kTiny * half_square;
  // Two samples alone, if so far apart, make the mean square as large: a quick test.
  const StoredSample& middle = samples[samples.size() / 2];
  const double across = (middle.position_m - samples.front().position_m).stableNorm();
  const double of_both = std::hypot(deviation_m(samples.front(), default_sigma_m),
                                    deviation_m(middle, default_sigma_m));
  const bool may_be_noise = across <= std::sqrt(2.0 * n) * kSpread * of_both;
  if (!may_be_noise && across * across > 2.0 * n * std::max(small, tiny)) {
    return false;
  }
  if (may_be_noise && lie_as_stated(samples, default_sigma_m).value_or(false)) {
    return true;
  }
  const SampleBlock all = block_of(samples, 0, samples.size());
  return all.square <= tiny || (all.square <= small && ratio_of(samples, all) > kNoOrder);
}

}  // namespace palpate
