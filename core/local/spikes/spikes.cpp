#include "core/local/spikes/spikes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/local/reading_step.h"
#include "core/local/spikes/block_survey.h"
#include "core/local/spikes/jumps.h"
#include "core/local/spikes/spike_search.h"
#include "core/local/spikes/spikes_at_ends.h"
#include "core/numerics/probability/normal_law.h"

namespace palpate {
namespace {

// The unknowns of a quartic and three residuals.
constexpr std::size_t kFewestSamples = 8;

/// The samples that are not spikes so far, and their indices in the input.
struct Kept {
  std::vector<Vec2> samples;
  std::vector<RelativeNoise> noise;  ///< empty: 1
  std::vector<std::size_t> numbers;

  void drop(std::span<const std::uint8_t> is_spike, std::vector<std::size_t>* dropped) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (is_spike[i] != 0) {
        dropped->push_back(numbers[i]);
      } else {
        samples[kept] = samples[i];
        if (!noise.empty()) {
          noise[kept] = noise[i];
        }
        numbers[kept++] = numbers[i];
      }
    }
    samples.resize(kept);
    noise.resize(std::min(noise.size(), kept));
    numbers.resize(kept);
  }
};

/// Calls `visit(begin, end)` for each run of flagged samples.
template <typename Visit>
void for_each_run(std::span<const std::uint8_t> flags, const Visit& visit) {
  for (auto begin = std::find(flags.begin(), flags.end(), 1); begin != flags.end();) {
    const auto end = std::find(begin, flags.end(), 0);
    visit(begin - flags.begin(), end - flags.begin());
    begin = std::find(end, flags.end(), 1);
  }
}

/// A run of at least `shortest` neighbours is form: no short block would have condemned them.
void spare_runs(std::ptrdiff_t shortest, std::vector<std::uint8_t>* is_spike) {
  for_each_run(*is_spike, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    if (end - begin >= shortest) {
      std::fill(is_spike->begin() + begin, is_spike->begin() + end, std::uint8_t{0});
    }
  });
}

/// Leaves out the runs that go a way of their own: these are form, however many passes took them
/// for spikes. So many spikes in a row by chance do not follow one another.
void spare_ways(std::span<const Vec2> samples, std::vector<std::size_t>* indices) {
  constexpr std::ptrdiff_t kShortestWay = 8;  // samples: half of a short block
  constexpr std::ptrdiff_t kJumpOneIn = 2;    // of a run that is no way
  if (std::ssize(*indices) < kShortestWay) {
    return;
  }
  std::vector<std::uint8_t> is_left_out(samples.size());
  for (const std::size_t i : *indices) {
    is_left_out[i] = 1;
  }
  std::vector<Vec2> finite;
  std::vector<std::size_t> numbers;
  std::vector<std::uint8_t> is_spike;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i].allFinite()) {
      finite.push_back(samples[i]);
      numbers.push_back(i);
      is_spike.push_back(is_left_out[i]);
    }
  }
  const std::vector<std::uint8_t> jumps = jumps_of(finite);
  for_each_run(is_spike, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    const auto jumping = std::count(jumps.begin() + begin, jumps.begin() + end, 1);
    if (end - begin >= kShortestWay && kJumpOneIn * jumping < end - begin) {
      std::for_each(numbers.begin() + begin, numbers.begin() + end,
                    [&](std::size_t i) { is_left_out[i] = 0; });
    }
  });
  std::erase_if(*indices, [&](std::size_t i) { return is_left_out[i] == 0; });
}

/// Which samples the steps of the stroke do not tell to be off its path; empty: all of them, or so
/// few that they are no path.
std::vector<std::uint8_t> on_path_of(std::span<const Vec2> samples) {
  std::vector<std::uint8_t> flags = detours_of(samples);
  for (std::uint8_t& flag : flags) {
    flag = flag == 0 ? 1 : 0;
  }
  const auto count = static_cast<std::size_t>(std::ranges::count(flags, 1));
  return count < samples.size() && count >= kFewestSamples ? flags : std::vector<std::uint8_t>{};
}

/// The samples that are finite; the others are dropped.
Kept finite_of(std::span<const Vec2> samples, std::span<const RelativeNoise> noise,
               std::vector<std::size_t>* dropped) {
  Kept kept;
  kept.samples.reserve(samples.size());
  kept.numbers.reserve(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i].allFinite()) {
      kept.samples.push_back(samples[i]);
      kept.numbers.push_back(i);
      if (!noise.empty()) {
        kept.noise.push_back(noise[i]);
      }
    } else {
      dropped->push_back(i);
    }
  }
  return kept;
}

/// Passes over a patch. Each leaves out the spikes found before, which occupied places in the
/// blocks. If it finds none although samples are off, the next pass uses longer blocks: spikes may
/// be the majority of a short one. Once less than one sample a block is found, the noise is told,
/// and the next ones search only where samples are off still.
class SpikePasses {
 public:
  SpikePasses(Kept kept, const SpikeOptions& options, WorkBudget& work, Spikes* result)
      : kept_(std::move(kept)),
        cusps_(options.cusps),
        work_(work),
        result_(result),
        sigma_m_(options.sigma_m),
        last_found_(kept_.samples.size()) {}

  void run() {
    search_all();
    if (survey_.status == LocalStatus::Ok && kept_.samples.size() >= kFewestSamples) {
      drop_at_ends();
    }
  }

 private:
  void search_all() {
    constexpr int kMostPasses = 8;  // a bound of time: each but those by longer blocks finds some
    for (int pass = 0; pass < kMostPasses && kept_.samples.size() >= kFewestSamples; ++pass) {
      if (doublings_ == 0) {
        survey(pass == 0);
      }
      if (survey_.status != LocalStatus::Ok) {
        return;
      }
      result_->sigma_m = survey_.sigma_m;
      if ((!survey_.is_any_off && !survey_.is_noise_spiked) || !work_.allows() ||
          !may_find_more(search())) {
        return;
      }
    }
  }

  void drop_at_ends() {
    const std::size_t count = kept_.samples.size();
    const SpikesAtEnds found =
        find_spikes_at_ends({kept_.samples, kept_.noise, {}}, survey_.length, result_->sigma_m,
                            result_->threshold, cusps_, work_);
    if (found.first + found.last > 0) {
      std::vector<std::uint8_t> is_spike(count);
      std::fill_n(is_spike.begin(), found.first, 1);
      std::fill_n(is_spike.rbegin(), found.last, 1);
      kept_.drop(is_spike, &result_->indices);
    }
  }

  BlockSurvey surveyed() const {
    return survey_blocks({kept_.samples, kept_.noise, on_path_}, sigma_m_, result_->threshold,
                         cusps_, work_);
  }

  /// Where samples are off, and what the noise is. The first survey is that of all samples.
  void survey(bool is_first) {
    on_path_ = on_path_of(kept_.samples);
    survey_ = surveyed();
    if (is_first && !(sigma_m_ > 0.0)) {
      // Rounded readings may agree to the last digit: their noise is no less than the rounding's.
      const double rounding_m = noise_of_rounding_m(reading_step_m(kept_.samples, survey_.sigma_m));
      if (survey_.sigma_m < rounding_m) {
        sigma_m_ = rounding_m;
        survey_ = surveyed();
      }
    }
    if (is_first) {
      result_->status = survey_.status;
    }
  }

  std::size_t block_length() const {
    return std::min(survey_.length << doublings_, kept_.samples.size());
  }

  /// One flag per sample that is left: 1 for a spike.
  std::vector<std::uint8_t> search() {
    BlockSurvey searched = survey_;
    searched.length = block_length();
    const bool everywhere =
        last_found_ > kept_.samples.size() / survey_.length || survey_.is_noise_spiked;
    if (everywhere) {
      searched.doubtful.clear();
    } else {
      searched.sigma_m = last_sigma_m_;
    }
    SpikeSearch found =
        search_spikes({kept_.samples, kept_.noise, on_path_}, searched,
                      sigma_m_ > 0.0 || !everywhere, result_->threshold, cusps_, work_);
    last_sigma_m_ = found.sigma_m;
    result_->sigma_m = found.sigma_m;
    if (doublings_ > 0) {
      spare_runs(static_cast<std::ptrdiff_t>(survey_.length / 2), &found.is_spike);
    }
    return std::move(found.is_spike);
  }

  /// Drops what a search has found. Whether the next one may find more: among the rest, or in
  /// longer blocks.
  bool may_find_more(std::span<const std::uint8_t> is_spike) {
    // Spikes in a row that fill a block are a quarter of one that is four times as long: no quartic
    // through the rest goes through them.
    constexpr int kMostDoublings = 2;
    const std::size_t before = kept_.samples.size();
    kept_.drop(is_spike, &result_->indices);
    if (kept_.samples.size() < before) {
      last_found_ = before - kept_.samples.size();
      doublings_ = 0;
      return true;
    }
    const bool may_be_longer =
        survey_.is_any_off && doublings_ < kMostDoublings && block_length() < kept_.samples.size();
    doublings_ += may_be_longer ? 1 : 0;
    return may_be_longer;
  }

  Kept kept_;
  CuspEnds cusps_;
  WorkBudget& work_;
  Spikes* result_;
  double sigma_m_;                     ///< of the noise, where it is known; else 0
  double last_sigma_m_ = 0.0;          ///< of the search before
  std::size_t last_found_;             ///< by the last search that found any
  int doublings_ = 0;                  ///< of the surveyed blocks
  BlockSurvey survey_ = {};            ///< of the samples that are left
  std::vector<std::uint8_t> on_path_;  ///< likewise
};

}  // namespace

Spikes find_spikes(std::span<const Vec2> samples, const SpikeOptions& options) {
  Spikes result;
  result.sigma_m = options.sigma_m;
  assert(options.noise.empty() || options.noise.size() == samples.size());
  Kept kept = finite_of(samples, options.noise, &result.indices);
  if (kept.samples.size() < kFewestSamples) {
    return result;
  }
  result.threshold = two_sided_normal_quantile(options.false_alarms_per_patch /
                                               static_cast<double>(kept.samples.size()));
  WorkBudget unbounded;
  SpikePasses(std::move(kept), options, options.work != nullptr ? *options.work : unbounded,
              &result)
      .run();
  spare_ways(samples, &result.indices);
  std::sort(result.indices.begin(), result.indices.end());
  return result;
}

}  // namespace palpate
