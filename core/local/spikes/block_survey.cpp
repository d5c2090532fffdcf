#include "core/local/spikes/block_survey.h"

#include <cmath>

#include "core/local/aligned_frame.h"
#include "core/local/noise.h"
#include "core/local/spikes/least_median_parabola.h"
#include "core/numerics/probability/normal_law.h"
#include "core/numerics/quantile.h"

namespace palpate {
namespace {

// Blocks overlap by half.
constexpr std::size_t kBlocksOfSample = 2;

/// Half of it determines a quartic with three samples to spare.
constexpr std::size_t kBlock = 16;

/// The noise counts as at least kFormFactor * slope^4 * extent. This is what a quartic leaves of a
/// curve that turns by `slope` either way and whose curvature doubles along the block: its
/// fifth-degree term 15 kappa^2 kappa_s / 5! contains 8/63 of P_5, which is 0.8 % of slope^4
/// extents.
constexpr double kFormFactor = 0.01;
/// ... and as at least this fraction of the extent: no touched part follows a quartic more
/// precisely.
constexpr double kFormResolution = 1e-5;

/// An arm of a cusp runs as x^(3/2), which no polynomial follows to its end: of 16 even steps, the
/// first sample half a step from the cusp, a quartic leaves so much of its largest slope times its
/// extent.
constexpr double kCuspFactor = 2e-3;

/// What form leaves of a quartic, counted as noise. [m]
double noise_floor(const ResidualBlock& block, bool at_cusp) {
  const double slope = std::min(block.steepest(), 1.0);
  return (kFormResolution + kFormFactor * slope * slope * slope * slope +
          (at_cusp ? kCuspFactor * slope : 0.0)) *
         block.extent_m();
}

/// Third difference of four samples: what a parabola at even steps leaves, times the norm. [m]
Vec2 third_difference(std::span<const Vec2, 4> samples) {
  return samples[3] - samples[0] - 3.0 * (samples[2] - samples[1]);
}

/// Of its coefficients: noise of one coordinate comes so many times larger.
constexpr double kNormOfThird = 4.47213595499957939;  // sqrt(1 + 9 + 9 + 1)

/// Noise from the third differences across travel. One sample spoils four of them: with a third of
/// the samples spikes, a fifth of the differences, (2/3)^4, are clean, and their 20 % quantile is
/// at most the largest clean one. [m]
double low_noise_of(std::span<const Vec2> samples, std::vector<double>& sizes) {
  constexpr double kQuantile = 0.2;
  constexpr double kQuantileOfNormal = 0.2533471031357997;  // of |normal variable|
  sizes.clear();
  for (std::size_t i = 0; i + 3 < samples.size(); ++i) {
    const Vec2 chord = samples[i + 3] - samples[i];
    const Vec2 difference = third_difference(samples.subspan(i).first<4>());
    const double length = chord.norm();
    sizes.push_back(length > 0.0 ? std::abs(cross(chord, difference)) / length : 0.0);
  }
  return quantile_of(sizes, kQuantile) / (kQuantileOfNormal * kNormOfThird);
}

/// The length of blocks for that noise, from the lower quartile of their chords, because spikes at
/// the ends lengthen chords.
std::size_t block_length(std::span<const Vec2> samples, double sigma_m) {
  std::vector<double> chords;
  std::size_t length = kBlock;
  for (; length < samples.size(); length *= 2) {
    chords.clear();
    for (std::size_t i = 0; i + length <= samples.size(); i += length / 2) {
      chords.push_back((samples[i + length - 1] - samples[i]).norm());
    }
    if (quantile_of(chords, 0.25) > ResidualBlock::kMinExtentSigmas * sigma_m) {
      break;
    }
  }
  return std::min(length, samples.size());
}

/// Least squares in one block.
struct OfBlock {
  std::size_t start = 0;
  double largest_m = 0.0;          ///< residual
  double largest_on_path_m = 0.0;  ///< likewise, of the samples in the fit
  double floor_m = 0.0;            ///< what form leaves
};

/// Least squares in all blocks of one length.
struct Blocks {
  LocalStatus status = LocalStatus::TooFewSamples;
  double sigma_m = 0.0;
  double extent_m = 0.0;         ///< of the median block: a spike lengthens its own
  double largest = 0.0;          ///< residual, in units of the noise of its own block
  double largest_on_path = 0.0;  ///< likewise, of the samples in the fits
  double backtrack_m = 0.0;
  double end_gap = 0.0;
  /// By more than 45 degrees: so it does to a spike there, and the bend counts as form.
  bool bends_to_end = false;
  std::vector<OfBlock> each;

  double noise_of(const OfBlock& block) const { return std::max(sigma_m, block.floor_m); }
};

/// Whether a parabola through three of the four samples at an end of a stroke misses the fourth by
/// more than noise, of which none exceeds `limit_m`.
bool leaves_at_end(std::span<const Vec2, 4> end, double limit_m) {
  return third_difference(end).norm() > kNormOfThird * limit_m;
}

Blocks fit_blocks(std::span<const Vec2> samples, std::span<const std::uint8_t> on_path,
                  std::size_t length, double sigma_m, const CuspEnds& cusps, WorkBudget& work) {
  work.spend(WorkKind::SpikeRow, kBlocksOfSample * samples.size());
  Blocks result;
  ResidualBlock block;
  std::vector<double> sizes, extents;
  sizes.reserve(2 * samples.size());
  for_each_block(samples.size(), length, length / 2, [&](std::size_t start) {
    const std::span<const std::uint8_t> use = flags_of(on_path, start, length);
    const LocalStatus status = block.fit(samples.subspan(start, length), use);
    if (status != LocalStatus::Ok) {
      result.status = result.status == LocalStatus::Ok ? LocalStatus::Ok : status;
      return;
    }
    result.status = LocalStatus::Ok;
    OfBlock of_block{start, block.largest(), 0.0, 0.0};
    for (std::size_t i = 0; i < length; ++i) {
      if (use.empty() || use[i] != 0) {
        sizes.push_back(std::abs(block.studentised(i)));
        of_block.largest_on_path_m = std::max(of_block.largest_on_path_m, sizes.back());
      }
    }
    extents.push_back(block.extent_m());
    result.backtrack_m = std::max(result.backtrack_m, block.backtrack_m());
    const bool at_cusp = cusps.touched_by(start, start + length, samples.size());
    const bool first = start == 0;
    const bool last = start + length == samples.size();
    result.end_gap =
        std::max({result.end_gap, first ? block.first_gap() : 0.0, last ? block.last_gap() : 0.0});
    result.bends_to_end = result.bends_to_end || ((first || last) && !at_cusp &&
                                                  block.steepest() > ResidualBlock::kMaxSlope);
    of_block.floor_m = noise_floor(block, at_cusp);
    result.each.push_back(of_block);
  });
  if (result.status == LocalStatus::Ok) {
    result.extent_m = median_of(extents);
    result.sigma_m = sigma_m > 0.0 ? sigma_m : robust_sigma(sizes);
    for (const OfBlock& of_block : result.each) {
      const double unit_m = result.noise_of(of_block);
      result.largest = std::max(result.largest, of_block.largest_m / unit_m);
      result.largest_on_path =
          std::max(result.largest_on_path, of_block.largest_on_path_m / unit_m);
    }
  }
  return result;
}

/// By sample: whether it lies in a block of which one is off, or whose quartic bends so much that
/// form hides what is off: spikes may bend it.
std::vector<std::uint8_t> in_doubtful_blocks(const Blocks& blocks, double threshold,
                                             std::size_t length, std::size_t samples) {
  std::vector<std::uint8_t> flags(samples);
  for (const OfBlock& block : blocks.each) {
    if (block.floor_m > blocks.sigma_m || block.largest_m > threshold * blocks.sigma_m) {
      std::fill_n(flags.begin() + static_cast<std::ptrdiff_t>(block.start), length, 1);
    }
  }
  return flags;
}

/// The samples on the path.
std::vector<Vec2> flagged(std::span<const Vec2> samples, std::span<const std::uint8_t> on_path) {
  std::vector<Vec2> path;
  path.reserve(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (on_path.empty() || on_path[i] != 0) {
      path.push_back(samples[i]);
    }
  }
  return path;
}

/// Whether a sample off the path is farther from the path's samples before and after it than these
/// are from one another, by more than `limit_m`: along the curve, where no residual shows it, too.
/// `on_path`: as detours_of leaves it, with the first and the last sample.
bool leaves_path(std::span<const Vec2> samples, std::span<const std::uint8_t> on_path,
                 double limit_m) {
  std::size_t before = 0;
  for (std::size_t after = 1; after < on_path.size(); ++after) {
    if (on_path[after] == 0) {
      continue;
    }
    const double most = (samples[after] - samples[before]).norm() + limit_m;
    for (std::size_t i = before + 1; i < after; ++i) {
      if (std::min((samples[i] - samples[before]).norm(), (samples[i] - samples[after]).norm()) >
          most) {
        return true;
      }
    }
    before = after;
  }
  return false;
}

/// How far the nearer halves of the blocks lie from a parabola, as a standard deviation: the median
/// over at most eight blocks; 0 if no block has a parabola. [m]
double parabola_scale_m(std::span<const Vec2> samples, std::size_t length,
                        std::vector<double>& sizes, WorkBudget& work) {
  // Bounds the time; the median of so many is good enough (kAboveScale).
  constexpr std::size_t kMostBlocks = 8;
  LeastMedianParabola parabola;
  sizes.clear();
  for_each_block(samples.size(), length, std::max(length, samples.size() / kMostBlocks),
                 [&](std::size_t start) {
                   work.spend(WorkKind::SpikeRow, kRowsOfParabola * length);
                   if (parabola.fit(samples.subspan(start, length))) {
                     sizes.push_back(parabola.scale_m());
                   }
                 });
  return sizes.empty() ? 0.0 : median_of(sizes);
}

/// Checks whether spikes have enlarged the noise. Then half of each block lies much nearer to a
/// parabola. The check is made only if a residual is larger than the largest one that noise leaves
/// in 19 of 20 patches, or if the noise exceeds that of the third differences.
void look_for_spiked_noise(std::span<const Vec2> samples, double largest, double threshold,
                           BlockSurvey* survey, WorkBudget& work) {
  constexpr double kAlarms = 0.05;  // of patches, which then cost a look
  // Three standard deviations of the quantile for 111 samples: sqrt(q (1 - q) / m) over its density
  // and itself is 2.0 / sqrt(m), and what neighbouring differences share makes it 2.3 / sqrt(m).
  // Beyond it a patch costs a look.
  constexpr double kAboveDifferences = 1.7;
  // Three standard deviations of the median of seven blocks' scales; a scale from 16 samples has a
  // relative error of 0.36.
  constexpr double kAboveScale = 1.5;
  std::vector<double> sizes;
  const double quiet = two_sided_normal_quantile(kAlarms / static_cast<double>(samples.size()));
  if (largest <= quiet && survey->sigma_m <= kAboveDifferences * low_noise_of(samples, sizes)) {
    return;
  }
  // Spikes lengthen the chords and what is taken for noise: the shortest blocks that resolve their
  // own scale.
  const std::size_t longest = std::min(survey->length, samples.size());
  double scale_m = 0.0;
  for (std::size_t length = std::min(kBlock, longest);; length *= 2) {
    length = std::min(length, longest);
    scale_m = parabola_scale_m(samples, length, sizes, work);
    if (length == longest || (scale_m > 0.0 && block_length(samples, scale_m) <= length)) {
      break;
    }
  }
  if (!(scale_m > 0.0)) {
    return;
  }
  survey->is_noise_spiked = survey->sigma_m > kAboveScale * scale_m;
  if (survey->is_noise_spiked) {
    // A starting value so small that spikes close to the noise stay outside, but not so small that
    // noise removes more than one sample of a block. The search enlarges it.
    constexpr double kLost = 1.0 / static_cast<double>(kBlock);
    survey->sigma_m = two_sided_normal_quantile(kLost) / threshold * scale_m;
    survey->length = std::min(survey->length, block_length(samples, scale_m));
  }
}

}  // namespace

double residual_limit(const ResidualBlock& block, double sigma_m, double threshold, bool at_cusp) {
  return threshold * std::max(sigma_m, noise_floor(block, at_cusp));
}

bool turns_back(const ResidualBlock& block, double sigma_m) {
  return block.backtrack_m() > most_backtrack(sigma_m);
}

BlockSurvey survey_blocks(std::span<const Vec2> samples, std::span<const std::uint8_t> on_path,
                          double sigma_m, double threshold, const CuspEnds& cusps,
                          WorkBudget& work) {
  BlockSurvey survey;
  survey.length = std::min(kBlock, samples.size());
  Blocks blocks = fit_blocks(samples, on_path, survey.length, sigma_m, cusps, work);
  const auto is_resolved = [&] {
    return blocks.status == LocalStatus::Ok &&
           blocks.extent_m > ResidualBlock::kMinExtentSigmas * blocks.sigma_m;
  };
  while (!is_resolved() && survey.length < samples.size()) {
    survey.length = std::min(2 * survey.length, samples.size());
    blocks = fit_blocks(samples, on_path, survey.length, sigma_m, cusps, work);
  }
  survey.status = blocks.status;
  survey.sigma_m = blocks.sigma_m;
  if (survey.status != LocalStatus::Ok) {
    return survey;
  }
  if (!is_resolved() && !(sigma_m > 0.0)) {
    // The noise is as large as the patch, or spikes pass for noise. Then the third differences
    // determine how long blocks must be, and half of each block lies near a parabola.
    std::vector<double> sizes;
    const std::vector<Vec2> path = flagged(samples, on_path);
    survey.length = block_length(path, low_noise_of(path, sizes));
    look_for_spiked_noise(path, blocks.largest_on_path, threshold, &survey, work);
    survey.is_any_off = survey.is_noise_spiked;
    if (!survey.is_noise_spiked) {
      survey.status = LocalStatus::Unresolved;
    }
    return survey;
  }
  // Where noise scatters samples along the axis too, their order on it says nothing.
  const double backtrack_m = most_backtrack(survey.sigma_m);
  const bool is_out_of_order = blocks.end_gap > kLonelyGap || blocks.backtrack_m > backtrack_m ||
                               leaves_path(samples, on_path, backtrack_m);
  const double limit_m = threshold * survey.sigma_m;
  const bool leaves = blocks.bends_to_end && (leaves_at_end(samples.first<4>(), limit_m) ||
                                              leaves_at_end(samples.last<4>(), limit_m));
  const bool may_be_anywhere = is_resolved() && (is_out_of_order || leaves);
  survey.is_any_off = blocks.largest > threshold || may_be_anywhere;
  if (survey.is_any_off && !may_be_anywhere) {
    survey.doubtful = in_doubtful_blocks(blocks, threshold, survey.length, samples.size());
  }
  if (!(sigma_m > 0.0)) {
    look_for_spiked_noise(flagged(samples, on_path), blocks.largest_on_path, threshold, &survey,
                          work);
  }
  return survey;
}

}  // namespace palpate
