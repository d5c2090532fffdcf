#include "core/local/spikes/spikes.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/local/reading_step.h"
#include "core/local/spikes/block_survey.h"
#include "core/local/spikes/jumps.h"
#include "core/local/spikes/spike_search.h"
#include "core/numerics/probability/normal_law.h"

namespace palpate {
namespace {

// The unknowns of a quartic and three residuals.
constexpr std::size_t kFewestSamples = 8;

/// The samples that are not spikes so far, and their indices in the input.
struct Kept {
  std::vector<Vec2> samples;
  std::vector<std::size_t> numbers;

  void drop(std::span<const std::uint8_t> is_spike, std::vector<std::size_t>* dropped) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (is_spike[i] != 0) {
        dropped->push_back(numbers[i]);
      } else {
        samples[kept] = samples[i];
        numbers[kept++] = numbers[i];
      }
    }
    samples.resize(kept);
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

}  // namespace

Spikes find_spikes(std::span<const Vec2> samples, const SpikeOptions& options) {
  Spikes result;
  Kept kept;
  kept.samples.reserve(samples.size());
  kept.numbers.reserve(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i].allFinite()) {
      kept.samples.push_back(samples[i]);
      kept.numbers.push_back(i);
    } else {
      result.indices.push_back(i);
    }
  }
  result.sigma_m = options.sigma_m;
  if (kept.samples.size() < kFewestSamples) {
    return result;
  }
  result.threshold = two_sided_normal_quantile(options.false_alarms_per_patch /
                                               static_cast<double>(kept.samples.size()));
  // Each pass leaves out the spikes found before, which occupied places in the blocks. If it finds
  // none although samples are off, the next pass uses longer blocks: spikes may be the majority of
  // a short one. Once less than one sample a block is found, the noise is told, and the next ones
  // search only where samples are off still.
  constexpr int kMostPasses = 8;  // a bound of time: each but those by longer blocks finds some
  // Spikes in a row that fill a block are a quarter of one that is four times as long: no quartic
  // through the rest goes through them.
  constexpr int kMostDoublings = 2;
  int doublings = 0;
  double sigma_m = options.sigma_m;
  double last_sigma_m = 0.0;
  std::size_t last_found = samples.size();
  BlockSurvey survey;
  std::vector<std::uint8_t> on_path;
  WorkBudget unbounded;
  WorkBudget& work = options.work != nullptr ? *options.work : unbounded;
  for (int pass = 0; pass < kMostPasses && kept.samples.size() >= kFewestSamples; ++pass) {
    if (doublings == 0) {
      on_path = on_path_of(kept.samples);
      survey = survey_blocks(kept.samples, on_path, sigma_m, result.threshold, options.cusps, work);
      if (pass == 0 && !(sigma_m > 0.0)) {
        // Rounded readings may agree to the last digit: their noise is no less than the rounding's.
        const double rounding_m = noise_of_rounding_m(reading_step_m(kept.samples, survey.sigma_m));
        if (survey.sigma_m < rounding_m) {
          sigma_m = rounding_m;
          survey =
              survey_blocks(kept.samples, on_path, sigma_m, result.threshold, options.cusps, work);
        }
      }
    }
    if (pass == 0) {
      result.status = survey.status;
    }
    if (survey.status != LocalStatus::Ok) {
      break;
    }
    result.sigma_m = survey.sigma_m;
    if ((!survey.is_any_off && !survey.is_noise_spiked) || !work.allows()) {
      break;
    }
    BlockSurvey searched = survey;
    searched.length = std::min(survey.length << doublings, kept.samples.size());
    const bool everywhere =
        last_found > kept.samples.size() / survey.length || survey.is_noise_spiked;
    if (everywhere) {
      searched.doubtful.clear();
    } else {
      searched.sigma_m = last_sigma_m;
    }
    SpikeSearch found = search_spikes(kept.samples, on_path, searched, sigma_m > 0.0 || !everywhere,
                                      result.threshold, options.cusps, work);
    last_sigma_m = found.sigma_m;
    if (doublings > 0) {
      spare_runs(static_cast<std::ptrdiff_t>(survey.length / 2), &found.is_spike);
    }
    result.sigma_m = found.sigma_m;
    const std::size_t before = kept.samples.size();
    kept.drop(found.is_spike, &result.indices);
    if (kept.samples.size() < before) {
      last_found = before - kept.samples.size();
      doublings = 0;
    } else if (survey.is_any_off && doublings < kMostDoublings &&
               searched.length < kept.samples.size()) {
      ++doublings;
    } else {
      break;
    }
  }
  spare_ways(samples, &result.indices);
  std::sort(result.indices.begin(), result.indices.end());
  return result;
}

}  // namespace palpate
