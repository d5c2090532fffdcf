#include "core/local/spikes/block_survey.h"

#include <cmath>
#include <functional>

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

constexpr std::size_t kOfThird = 4;

/// Third difference of four samples: what a parabola at even steps leaves, times the norm. [m]
Vec2 third_difference(std::span<const Vec2, kOfThird> samples) {
  return samples[3] - samples[0] - 3.0 * (samples[2] - samples[1]);
}

/// Of its coefficients: noise of one coordinate comes so many times larger.
constexpr double kNormOfThird = 4.47213595499957939;  // sqrt(1 + 9 + 9 + 1)

/// Standard deviation of the third difference of four samples, one of which has noise
/// `noise_of(RelativeNoise)`, over kNormOfThird sigma.
template <typename NoiseOf>
double noise_of_third(const SearchedSamples& four, const NoiseOf& noise_of) {
  if (four.noise.empty()) {
    return 1.0;
  }
  const auto variance = [&](std::size_t i) {
    const double noise = noise_of(four.noise_of(i));
    return noise * noise;
  };
  return std::sqrt(variance(0) + 9.0 * (variance(1) + variance(2)) + variance(3)) / kNormOfThird;
}

/// Noise from the third differences across travel. One sample spoils four of them: with a third of
/// the samples spikes, a fifth of the differences, (2/3)^4, are clean, and their 20 % quantile is
/// at most the largest clean one. [m]
double low_noise_of(const SearchedSamples& samples, std::vector<double>& sizes) {
  constexpr double kQuantile = 0.2;
  constexpr double kQuantileOfNormal = 0.2533471031357997;  // of |normal variable|
  sizes.clear();
  for (std::size_t i = 0; i + kOfThird <= samples.size(); ++i) {
    const SearchedSamples four = samples.part(i, kOfThird);
    const Vec2 chord = four.positions_m.back() - four.positions_m.front();
    const Vec2 difference = third_difference(four.positions_m.first<kOfThird>());
    const double length = chord.norm();
    const double noise = noise_of_third(four, std::mem_fn(&RelativeNoise::across));
    sizes.push_back(length > 0.0 ? std::abs(cross(chord, difference)) / (length * noise) : 0.0);
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

/// The largest residuals of a block.
struct Largest {
  double scaled_m = 0.0;  ///< by its noise
  double m = 0.0;         ///< not scaled

  void add(double residual_m, double noise) {
    scaled_m = std::max(scaled_m, residual_m);
    m = std::max(m, noise * residual_m);
  }

  /// In units of the noise, and of what form leaves. (Of two samples, where noise differs: then
  /// none may be off by so much.)
  double over(double sigma_m, double floor_m) const {
    return std::min(scaled_m / sigma_m, m / floor_m);
  }
};

/// Least squares in one block.
struct OfBlock {
  std::size_t start = 0;
  Largest all;
  Largest on_path;       ///< of the samples in the fit
  double floor_m = 0.0;  ///< what form leaves
};

/// Least squares in all blocks of one length.
struct Blocks {
  LocalStatus status = LocalStatus::TooFewSamples;
  double sigma_m = 0.0;
  double extent_m = 0.0;  ///< over the loudest, of the median block: a spike lengthens its own
  double largest = 0.0;   ///< residual, in units of the noise of its own block
  double largest_on_path = 0.0;  ///< likewise, of the samples in the fits
  double backtrack_m = 0.0;      ///< over the loudest of its block
  double end_gap = 0.0;
  /// By more than 45 degrees: so it does to a spike there, and the bend counts as form.
  bool bends_to_end = false;
  std::vector<OfBlock> each;
};

/// Whether a parabola through three of the four samples at an end of a stroke misses the fourth by
/// more than noise, of which none exceeds `limit_m` where it is 1.
bool leaves_at_end(const SearchedSamples& end, double limit_m) {
  return third_difference(end.positions_m.first<kOfThird>()).norm() >
         kNormOfThird * noise_of_third(end, std::mem_fn(&RelativeNoise::larger)) * limit_m;
}

Blocks fit_blocks(const SearchedSamples& samples, std::size_t length, double sigma_m,
                  const CuspEnds& cusps, WorkBudget& work) {
  work.spend(WorkKind::SpikeRow, kBlocksOfSample * samples.size());
  Blocks result;
  ResidualBlock block;
  std::vector<double> sizes, extents;
  sizes.reserve(2 * samples.size());
  for_each_block(samples.size(), length, length / 2, [&](std::size_t start) {
    const SearchedSamples part = samples.part(start, length);
    const LocalStatus status =
        block.fit(part.positions_m, part.on_path, ResidualBlock::kDegree, part.noise);
    if (status != LocalStatus::Ok) {
      result.status = result.status == LocalStatus::Ok ? LocalStatus::Ok : status;
      return;
    }
    result.status = LocalStatus::Ok;
    OfBlock of_block{start, {}, {}, 0.0};
    for (std::size_t i = 0; i < length; ++i) {
      const double size = std::abs(block.studentised(i));
      const double across = part.noise_of(i).across;
      of_block.all.add(size, across);
      if (part.is_on_path(i)) {
        sizes.push_back(size);
        of_block.on_path.add(size, across);
      }
    }
    extents.push_back(block.extent_m() / block.loudest());
    result.backtrack_m = std::max(result.backtrack_m, block.backtrack_m() / block.loudest());
    const bool at_cusp = cusps.touched_by(start, start + length, samples.size());
    const bool first = start == 0;
    const bool last = start + length == samples.size();
    result.end_gap =
        std::max({result.end_gap, first ? block.first_gap() : 0.0, last ? block.last_gap() : 0.0});
    result.bends_to_end = result.bends_to_end || ((first || last) && !at_cusp &&
                                                  block.steepest() > ResidualBlock::kMaxSlope);
    of_block.floor_m = form_noise_m(block, at_cusp);
    result.each.push_back(of_block);
  });
  if (result.status == LocalStatus::Ok) {
    result.extent_m = median_of(extents);
    result.sigma_m = sigma_m > 0.0 ? sigma_m : robust_sigma(sizes);
    for (const OfBlock& of_block : result.each) {
      const auto over = [&](const Largest& largest) {
        return largest.over(result.sigma_m, of_block.floor_m);
      };
      result.largest = std::max(result.largest, over(of_block.all));
      result.largest_on_path = std::max(result.largest_on_path, over(of_block.on_path));
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
    if (block.floor_m > blocks.sigma_m || block.all.scaled_m > threshold * blocks.sigma_m) {
      std::fill_n(flags.begin() + static_cast<std::ptrdiff_t>(block.start), length, 1);
    }
  }
  return flags;
}

/// The samples on the path.
class Path {
 public:
  explicit Path(const SearchedSamples& samples) : noise_(samples.noise.size()) {
    positions_m_.reserve(samples.size());
    std::size_t on_path = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (samples.is_on_path(i)) {
        positions_m_.push_back(samples.positions_m[i]);
        if (!noise_.empty()) {
          noise_[on_path++] = samples.noise[i];
        }
      }
    }
    noise_.resize(on_path);
  }

  SearchedSamples samples() const { return {positions_m_, noise_, {}}; }

 private:
  std::vector<Vec2> positions_m_;
  std::vector<RelativeNoise> noise_;
};

/// Whether a sample off the path is farther from the path's samples before and after it than these
/// are from one another, by more than `limit_m` times the largest noise: along the curve, where no
/// residual shows it, too. `samples.on_path`: as detours_of leaves it, with the first and the last
/// sample.
bool leaves_path(const SearchedSamples& samples, double limit_m) {
  const std::span<const Vec2> at = samples.positions_m;
  std::size_t before = 0;
  for (std::size_t after = 1; after < samples.on_path.size(); ++after) {
    if (samples.on_path[after] == 0) {
      continue;
    }
    const SearchedSamples way = samples.part(before, after - before + 1);
    const double loudest =
        way.noise.empty() ? 1.0 : std::ranges::max(way.noise, {}, &RelativeNoise::larger).larger();
    const double most = (at[after] - at[before]).norm() + loudest * limit_m;
    for (std::size_t i = before + 1; i < after; ++i) {
      if (std::min((at[i] - at[before]).norm(), (at[i] - at[after]).norm()) > most) {
        return true;
      }
    }
    before = after;
  }
  return false;
}

/// How far the nearer halves of the blocks lie from a parabola, as a standard deviation: the median
/// over at most eight blocks; 0 if no block has a parabola. [m]
double parabola_scale_m(const SearchedSamples& samples, std::size_t length,
                        std::vector<double>& sizes, WorkBudget& work) {
  // Bounds the time; the median of so many is good enough (kAboveScale).
  constexpr std::size_t kMostBlocks = 8;
  LeastMedianParabola parabola;
  sizes.clear();
  for_each_block(samples.size(), length, std::max(length, samples.size() / kMostBlocks),
                 [&](std::size_t start) {
                   work.spend(WorkKind::SpikeRow, kRowsOfParabola * length);
                   const SearchedSamples part = samples.part(start, length);
                   if (parabola.fit(part.positions_m, part.noise)) {
                     sizes.push_back(parabola.scale_m());
                   }
                 });
  return sizes.empty() ? 0.0 : median_of(sizes);
}

/// Checks whether spikes have enlarged the noise. Then half of each block lies much nearer to a
/// parabola. The check is made only if a residual is larger than the largest one that noise leaves
/// in 19 of 20 patches, or if the noise exceeds that of the third differences.
void look_for_spiked_noise(const SearchedSamples& samples, double largest, double threshold,
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
    if (length == longest ||
        (scale_m > 0.0 && block_length(samples.positions_m, scale_m) <= length)) {
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
    survey->length = std::min(survey->length, block_length(samples.positions_m, scale_m));
  }
}

}  // namespace

double form_noise_m(const ResidualBlock& block, bool at_cusp) {
  const double slope = std::min(block.steepest(), 1.0);
  return (kFormResolution + kFormFactor * slope * slope * slope * slope +
          (at_cusp ? kCuspFactor * slope : 0.0)) *
         block.extent_m();
}

bool turns_back(const ResidualBlock& block, double sigma_m) {
  return block.backtrack_m() > most_backtrack(block.loudest() * sigma_m);
}

BlockSurvey survey_blocks(const SearchedSamples& samples, double sigma_m, double threshold,
                          const CuspEnds& cusps, WorkBudget& work) {
  BlockSurvey survey;
  survey.length = std::min(kBlock, samples.size());
  Blocks blocks = fit_blocks(samples, survey.length, sigma_m, cusps, work);
  const auto is_resolved = [&] {
    return blocks.status == LocalStatus::Ok &&
           blocks.extent_m > ResidualBlock::kMinExtentSigmas * blocks.sigma_m;
  };
  while (!is_resolved() && survey.length < samples.size()) {
    survey.length = std::min(2 * survey.length, samples.size());
    blocks = fit_blocks(samples, survey.length, sigma_m, cusps, work);
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
    const Path path(samples);
    survey.length = block_length(path.samples().positions_m, low_noise_of(path.samples(), sizes));
    look_for_spiked_noise(path.samples(), blocks.largest_on_path, threshold, &survey, work);
    survey.is_any_off = survey.is_noise_spiked;
    if (!survey.is_noise_spiked) {
      survey.status = LocalStatus::Unresolved;
    }
    return survey;
  }
  // Where noise scatters samples along the axis too, their order on it says nothing.
  const double backtrack_m = most_backtrack(survey.sigma_m);
  const bool is_out_of_order = blocks.end_gap > kLonelyGap || blocks.backtrack_m > backtrack_m ||
                               leaves_path(samples, backtrack_m);
  const double limit_m = threshold * survey.sigma_m;
  const bool leaves = blocks.bends_to_end &&
                      (leaves_at_end(samples.part(0, kOfThird), limit_m) ||
                       leaves_at_end(samples.part(samples.size() - kOfThird, kOfThird), limit_m));
  const bool may_be_anywhere = is_resolved() && (is_out_of_order || leaves);
  survey.is_any_off = blocks.largest > threshold || may_be_anywhere;
  if (survey.is_any_off && !may_be_anywhere) {
    survey.doubtful = in_doubtful_blocks(blocks, threshold, survey.length, samples.size());
  }
  if (!(sigma_m > 0.0)) {
    look_for_spiked_noise(Path(samples).samples(), blocks.largest_on_path, threshold, &survey,
                          work);
  }
  return survey;
}

}  // namespace palpate
