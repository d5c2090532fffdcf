#include "core/local/spikes/spike_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/local/spikes/jumps.h"
#include "core/local/spikes/least_median_parabola.h"
#include "core/numerics/probability/normal_law.h"

namespace palpate {
namespace {

/// Standard deviation of normal variables, from the absolute values of those within `limit`; at
/// most the limit.
double sigma_within(const std::vector<double>& sizes, double limit) {
  double sum = 0.0;
  for (const double size : sizes) {
    sum += size * size;
  }
  const double kept = std::sqrt(sum / static_cast<double>(sizes.size()));
  // Each step reduces the error to 0.08, 0.43 or 0.85 of itself if the limit is 3, 2 or 1 standard
  // deviations. If the limit is smaller, the values within it determine no standard deviation, and
  // the limit is returned.
  constexpr int kIterations = 20;
  double sigma = kept;
  for (int i = 0; i < kIterations && sigma > 0.0 && sigma < limit; ++i) {
    sigma = kept / std::sqrt(mean_square_within(limit / sigma));
  }
  return std::min(sigma, limit);
}

struct Block {
  std::size_t start = 0;
  std::vector<std::uint8_t> use;   ///< one flag per sample: whether it belongs to the fit
  std::vector<std::uint8_t> half;  ///< the half nearest to a parabola; empty if not needed so far
  std::size_t used = 0;
  bool is_settled = false;
};

/// How many samples at an end of a block, where the stroke goes on, the block does not judge: up to
/// its outermost inlier, and farther in where the stroke may have left the form that the quartic
/// has. Samples beyond a bend are off, but for those that lie on the quartic by chance; with one of
/// these alone outside of them, they were all taken for spikes. `use`, `end`, `jump`: from that end
/// inwards.
template <typename Flag>
std::size_t beyond_form(Flag use, const Flag end, Flag jump) {
  constexpr double kSpikes = 0.3;  // of samples, as many as are found (least_median_parabola.cpp)
  // To an order: what they weigh against each other decides between two samples and three.
  constexpr double kBend = 0.1;         // probability beforehand that a block goes beyond a bend
  constexpr double kOnByChance = 0.1;   // of samples beyond one
  constexpr double kMayBeBeyond = 0.1;  // a sample that is so probably beyond: others judge it
  const auto first = static_cast<std::size_t>(std::find(use, end, 1) - use);
  std::vector<double> of_bends;  // by how many samples are beyond it
  double of_bend = kBend;
  double all = 1.0 - kBend;
  for (; use != end; ++use, ++jump) {
    if (*use != 0) {
      of_bend *= kOnByChance / (1.0 - kSpikes);
    } else if (*jump == 0) {  // a spike anywhere else
      of_bend *= (1.0 - kOnByChance) / kSpikes;
    }
    all += of_bend;
    of_bends.push_back(of_bend);
  }
  std::size_t beyond = of_bends.size();
  for (double of_farther = 0.0; beyond > first; --beyond) {
    of_farther += of_bends[beyond - 1];
    if (of_farther > kMayBeBeyond * all) {
      break;
    }
  }
  return beyond;
}

class Search {
 public:
  Search(const SearchedSamples& samples, const BlockSurvey& survey, double threshold,
         const CuspEnds& cusps, WorkBudget& work)
      : samples_(samples),
        doubtful_(survey.doubtful),
        jumps_(jumps_of(samples.positions_m)),
        threshold_(threshold),
        length_(survey.length),
        sigma_m_(survey.sigma_m),
        cusps_(cusps),
        work_(work) {
    for_each_block(
        samples.size(), length_, std::max<std::size_t>(length_ / 4, 1), [&](std::size_t start) {
          if (doubtful_.empty() || std::ranges::count(doubtful_.subspan(start, length_), 1) > 0) {
            blocks_.emplace_back();
            blocks_.back().start = start;
          }
        });
    settle_blocks();
  }

  double sigma_m() const { return sigma_m_; }

  /// Estimates the noise from the samples that joined, and repeats the search with it.
  void refine_noise() {
    std::vector<double> sizes;
    for (const Block& block : blocks_) {
      if (block.is_settled && fit(block) == LocalStatus::Ok) {
        for (std::size_t i = 0; i < length_; ++i) {
          if (block.use[i] != 0) {
            sizes.push_back(std::abs(residuals_.studentised(i)));
          }
        }
      }
    }
    if (sizes.empty()) {
      return;
    }
    sigma_m_ = sigma_within(sizes, threshold_ * sigma_m_);
    settle_blocks();
  }

  std::vector<std::uint8_t> judge() const {
    std::vector<Verdict> verdicts(samples_.size());
    for (const Block& block : blocks_) {
      if (block.is_settled) {
        judge_by(block, &verdicts);
      }
    }
    std::vector<std::uint8_t> is_spike(samples_.size());
    for (std::size_t i = 0; i < is_spike.size(); ++i) {
      // Others, not all blocks of which were fitted, are no spikes.
      const bool is_judged = doubtful_.empty() || doubtful_[i] != 0;
      is_spike[i] = is_judged && verdicts[i].is_spike ? 1 : 0;
    }
    return is_spike;
  }

 private:
  struct Verdict {
    std::size_t lost = std::numeric_limits<std::size_t>::max();
    std::size_t off_centre = 0;
    bool is_spike = false;
  };

  SearchedSamples part(const Block& block) const { return samples_.part(block.start, length_); }

  /// A quartic; a cubic if more than a quarter is removed: too few samples do not hold the ends of
  /// a quartic, which then bend to a spike.
  LocalStatus fit(const Block& block) {
    constexpr int kDegreeOfFew = 3;
    work_.spend(WorkKind::SpikeRow, length_);
    const auto used = static_cast<std::size_t>(std::ranges::count(block.use, 1));
    const int degree = 4 * used >= 3 * length_ ? ResidualBlock::kDegree : kDegreeOfFew;
    const SearchedSamples samples = part(block);
    return residuals_.fit(samples.positions_m, block.use, degree, samples.noise);
  }

  /// Starts from the samples on the path; if too many would leave, from the half that lies nearest
  /// to a parabola.
  void settle_blocks() {
    for (Block& block : blocks_) {
      const SearchedSamples samples = part(block);
      block.use.assign(samples.on_path.begin(), samples.on_path.end());
      block.use.resize(length_, 1);
      block.is_settled = false;
      if (!work_.allows()) {
        continue;
      }
      block.is_settled = settle(&block, length_ / 8) && !turns_back(residuals_, sigma_m_);
      if (block.is_settled) {
        continue;
      }
      work_.spend(WorkKind::SpikeRow, block.half.empty() ? kRowsOfParabola * length_ : 0);
      if (block.half.empty() && parabola_.fit(samples.positions_m, samples.noise)) {
        const auto half = parabola_.nearer_half();
        block.half.assign(half.begin(), half.end());
      }
      if (!block.half.empty()) {
        block.use = block.half;
        block.is_settled = settle(&block, length_);
      }
    }
  }

  /// The residual beyond which a sample is off its block's quartic. It allows for noise, and for
  /// form that no quartic can follow, which is as large where noise is low. [m]
  double limit_m(const Block& block, std::size_t i, double form_m) const {
    return threshold_ * std::max(sigma_m_, form_m / samples_.noise_of(block.start + i).across);
  }

  /// The worst sample leaves until none is off; then those that are not off join. Returns false if
  /// more than `most_leave` would leave, or if no quartic within 45 degrees explains more than half
  /// of the block.
  bool settle(Block* block, std::size_t most_leave) {
    // A bound of time: a sample may leave and join alternately. The block is judged as it then is.
    constexpr int kMostReturns = 6;
    std::size_t left = 0;
    int returns = 0;
    const bool at_cusp = cusps_.touched_by(block->start, block->start + length_, samples_.size());
    bool may_be_lonely[] = {block->start == 0, block->start + length_ == samples_.size()};
    while (true) {
      if (left > most_leave || fit(*block) != LocalStatus::Ok) {
        return false;
      }
      const double form_m = form_noise_m(residuals_, at_cusp);
      std::size_t worst = length_;
      double largest = 1.0;
      for (std::size_t i = 0; i < length_; ++i) {
        const double size = std::abs(residuals_.studentised(i)) / limit_m(*block, i, form_m);
        if (block->use[i] != 0 && size > largest) {
          largest = size;
          worst = i;
        }
      }
      if (worst < length_) {
        block->use[worst] = 0;
        ++left;
        continue;
      }
      bool any = false;
      for (std::size_t i = 0; i < length_ && returns < kMostReturns; ++i) {
        if (block->use[i] == 0 &&
            std::abs(residuals_.studentised(i)) <= limit_m(*block, i, form_m)) {
          block->use[i] = 1;
          any = true;
        }
      }
      if (any) {
        ++returns;
      } else if (may_be_lonely[0] && residuals_.first_gap() > kLonelyGap) {
        may_be_lonely[0] = false;
        block->use[first_of(*block)] = 0;
        returns = kMostReturns;  // otherwise it would join again
        ++left;
      } else if (may_be_lonely[1] && residuals_.last_gap() > kLonelyGap) {
        may_be_lonely[1] = false;
        block->use[last_of(*block)] = 0;
        returns = kMostReturns;
        ++left;
      } else {
        break;
      }
    }
    block->used = static_cast<std::size_t>(std::ranges::count(block->use, 1));
    return 2 * block->used > length_ && residuals_.steepest() <= ResidualBlock::kMaxSlope;
  }

  static std::size_t first_of(const Block& block) {
    return static_cast<std::size_t>(std::ranges::find(block.use, 1) - block.use.begin());
  }

  static std::size_t last_of(const Block& block) {
    std::size_t last = block.use.size() - 1;
    while (block.use[last] == 0) {
      --last;
    }
    return last;
  }

  /// Among the blocks that remove more than an eighth of their samples, the one that removes fewest
  /// judges a sample. Among the others, the one that has the sample nearest to its middle.
  void judge_by(const Block& block, std::vector<Verdict>* verdicts) const {
    const std::size_t lost = length_ - block.used;
    const std::size_t counted = lost > length_ / 8 ? lost : 0;
    const std::span<const std::uint8_t> use(block.use);
    const auto jumps = std::span<const std::uint8_t>(jumps_).subspan(block.start, length_);
    // Round a cusp the stroke goes on too.
    const bool comes = block.start > 0 || cusps_.first;
    const bool goes_on = block.start + length_ < samples_.size() || cusps_.last;
    const std::size_t begin = comes ? beyond_form(use.begin(), use.end(), jumps.begin()) : 0;
    const std::size_t end =
        length_ - (goes_on ? beyond_form(use.rbegin(), use.rend(), jumps.rbegin()) : 0);
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t off_centre = 2 * i > length_ ? 2 * i - length_ : length_ - 2 * i;
      Verdict& verdict = (*verdicts)[block.start + i];
      if (counted < verdict.lost || (counted == verdict.lost && off_centre < verdict.off_centre)) {
        verdict = {counted, off_centre, block.use[i] == 0};
      }
    }
  }

  SearchedSamples samples_;
  std::span<const std::uint8_t> doubtful_;
  std::vector<std::uint8_t> jumps_;
  double threshold_;
  std::size_t length_;
  double sigma_m_;
  CuspEnds cusps_;
  WorkBudget& work_;
  std::vector<Block> blocks_;
  ResidualBlock residuals_;
  LeastMedianParabola parabola_;
};

}  // namespace

SpikeSearch search_spikes(const SearchedSamples& samples, const BlockSurvey& survey,
                          bool noise_is_known, double threshold, const CuspEnds& cusps,
                          WorkBudget& work) {
  Search search(samples, survey, threshold, cusps, work);
  if (!noise_is_known) {
    search.refine_noise();
  }
  return {search.judge(), search.sigma_m()};
}

}  // namespace palpate
