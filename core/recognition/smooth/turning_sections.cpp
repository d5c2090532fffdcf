#include "core/recognition/smooth/turning_sections.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/numerics/quantile.h"
#include "core/recognition/samples/cleaned/turning_points.h"
#include "core/recognition/smooth/longest_variance.h"

namespace palpate {
namespace {

/// Largest turn of a section, so that it is a graph over its chord. [rad]
constexpr double kLongestTurn = 1.0;

/// Shortest chord, in standard deviations of the distance between its ends. Its direction is then
/// known to a sixth of a radian, and two such directions differ by a radian once in 30,000 times.
constexpr double kFewestDeviations = 6.0;

/// The mean of some consecutive samples.
struct Block {
  PatchSpan points;
  Vec2 mean = Vec2::Zero();
  double stated = 0.0;  ///< variance of the mean, by the noise that is stated; 0 = none is
};

Block block_of(const FitData& data, const PatchSpan& points, bool sigma_known) {
  Block block{points};
  for (std::size_t i = points.begin; i < points.end; ++i) {
    block.mean += data.points[i].position;
    block.stated += sigma_known ? longest_variance(data, i) : 0.0;
  }
  const auto n = static_cast<double>(points.size());
  block.mean /= n;
  block.stated /= n * n;
  return block;
}

/// Variance across the best line through the block's samples; the line takes two degrees of
/// freedom.
double scatter_of(const FitData& data, const Block& block) {
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  for (std::size_t i = block.points.begin; i < block.points.end; ++i) {
    const Vec2 off = data.points[i].position - block.mean;
    squares += off * off.transpose();
  }
  const double least =
      0.5 * squares.trace() - std::hypot(0.5 * (squares(0, 0) - squares(1, 1)), squares(0, 1));
  return std::max(least, 0.0) / std::max(static_cast<double>(block.points.size()) - 2.0, 1.0);
}

/// Variance of the noise of samples in the direction in which it is largest, by how neighbours go
/// to and fro: second differences, which a path leaves only where it bends within a few samples.
double to_and_fro_of(const FitData& data, const Block& block) {
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  double count = 0.0;
  for (std::size_t i = block.points.begin + 1; i + 1 < block.points.end; ++i) {
    const Vec2 second =
        data.points[i - 1].position - 2.0 * data.points[i].position + data.points[i + 1].position;
    squares += second * second.transpose();
    count += 1.0;
  }
  constexpr double kOfNoise = 6.0;  // 1 + 4 + 1 variances
  const double most =
      0.5 * squares.trace() + std::hypot(0.5 * (squares(0, 0) - squares(1, 1)), squares(0, 1));
  return count > 0.0 ? most / (kOfNoise * count) : 0.0;
}

/// Noise variance of the samples: that of the median block, which a few bends do not change, or the
/// stated one if that is larger. (Samples that stay at one place show no noise.) Noise across the
/// path alone, larger than the samples' distances, is along the blocks' lines and not across them:
/// where neighbours go to and fro by much more, that is the noise.
double typical_variance(const FitData& data, const PatchSpan& patch,
                        const std::vector<Block>& blocks, bool sigma_known) {
  std::vector<double> scatters;
  std::vector<double> to_and_fro;
  for (const Block& block : blocks) {
    scatters.push_back(scatter_of(data, block));
    to_and_fro.push_back(to_and_fro_of(data, block));
  }
  constexpr double kMuchMore = 4.0;  // noise alike in all directions seldom shows so much more
  const double across = median_of(scatters);
  const double most = median_of(to_and_fro);
  const double typical = most > kMuchMore * across ? most : across;
  double least_stated = std::numeric_limits<double>::infinity();
  for (std::size_t i = patch.begin; sigma_known && i < patch.end; ++i) {
    least_stated = std::min(least_stated, longest_variance(data, i));
  }
  return sigma_known ? std::max(typical, std::min(least_stated, kLargestNoise * kLargestNoise))
                     : typical;
}

/// Variance of the distance between the means of two blocks, if samples typically have the variance
/// `typical`. Where these two state more, it is what they state: noise that is longer along the
/// path than across it, or larger there than elsewhere, turns chords as well.
double variance_between(const Block& a, const Block& b, double typical) {
  const double of_means =
      1.0 / static_cast<double>(a.points.size()) + 1.0 / static_cast<double>(b.points.size());
  return std::max(typical * of_means, a.stated + b.stated);
}

/// Where a patch is cut that is travelled from its first block on: each section is as long as its
/// turn allows. Turns are those of chords longer than kFewestDeviations of the noise of their ends;
/// of all chords, without a `typical` variance of the noise.
std::vector<std::size_t> cuts_of_chords(std::size_t samples, const std::vector<Block>& blocks,
                                        std::optional<double> typical) {
  std::vector<std::size_t> cuts;
  std::size_t begin = 0;
  std::size_t at = 0;
  double angle = 0.0;
  double least = 0.0;
  double most = 0.0;
  const Block* last = &blocks.front();
  std::optional<Vec2> before;
  for (const Block& block : blocks) {
    const std::size_t here = at;
    at += block.points.size();
    const Vec2 chord = block.mean - last->mean;
    const double noise = typical ? variance_between(block, *last, *typical) : 0.0;
    if (!(chord.squaredNorm() > kFewestDeviations * kFewestDeviations * noise)) {
      continue;
    }
    if (before) {
      angle += turn_between(*before, chord);
      least = std::min(least, angle);
      most = std::max(most, angle);
    }
    if (most - least > kLongestTurn && here - begin >= kFewestOfSection &&
        samples - here >= kFewestOfSection) {
      cuts.push_back(here);
      begin = here;
      angle = least = most = 0.0;
    }
    before = chord;
    last = &block;
  }
  return cuts;
}

/// Cuts half way between where the one and the other direction of travel cut: a path has the same
/// sections whichever way it is travelled, and none is a short remainder. If one of the two needs
/// fewer sections, it alone.
std::vector<PatchSpan> cut_by_chords(const FitData& data, const PatchSpan& patch,
                                     const std::vector<Block>& blocks,
                                     std::optional<double> typical) {
  std::vector<std::size_t> cuts = cuts_of_chords(patch.size(), blocks, typical);
  std::vector<std::size_t> back =
      cuts_of_chords(patch.size(), {blocks.rbegin(), blocks.rend()}, typical);
  std::reverse(back.begin(), back.end());
  for (std::size_t& cut : back) {
    cut = patch.size() - cut;
  }
  if (back.size() != cuts.size()) {
    cuts = back =
        std::min(cuts, back, [](const auto& a, const auto& b) { return a.size() < b.size(); });
  }
  std::vector<PatchSpan> sections;
  std::size_t begin = patch.begin;
  for (std::size_t k = 0; k < cuts.size(); ++k) {
    const std::size_t end = half_way(data, patch.begin + cuts[k], patch.begin + back[k]);
    sections.push_back({begin, end});
    begin = end;
  }
  sections.push_back({begin, patch.end});
  return sections;
}

/// Cuts at cusps: where the path turns back by more than noise of the variance does. No graph leads
/// round a cusp, and one sample of the other arm bends a polynomial by more than the noise. The
/// farthest sample may be of either arm: it is cut out, with the farther of its neighbours, which
/// shows its direction and is of the same arm where samples are even. A sample out of order, a
/// spike along the curve, turns the path back twice at once: it cuts nothing.
std::vector<std::size_t> cut_at_cusps(const FitData& data, const PatchSpan& patch,
                                      double variance) {
  // Of a thousand samples at one place, noise puts any two ten standard deviations apart once in a
  // million times (pairs by the tail of a normal law); across their best line they show 0.8 of it.
  constexpr double kFar = 12.0;
  constexpr std::size_t kFewest = 2;  // samples that show a direction
  std::vector<std::size_t> cuts;
  const auto cut = [&](std::size_t i) {
    if (i >= (cuts.empty() ? patch.begin : cuts.back()) + kFewest && i + kFewest <= patch.end) {
      cuts.push_back(i);
    }
  };
  const std::vector<std::size_t> turns =
      turning_points(patch.begin, patch.end, kFar * std::sqrt(variance),
                     [&](std::size_t i) -> const Vec2& { return data.points[i].position; });
  for (std::size_t k = 0; k < turns.size(); ++k) {
    const bool after_another = k > 0 && turns[k] - turns[k - 1] < kFewestOfSection;
    const bool before_another = k + 1 < turns.size() && turns[k + 1] - turns[k] < kFewestOfSection;
    if (!after_another && !before_another) {
      const std::size_t middle_of_both = half_way(data, turns[k], turns[k] + 1);
      cut(middle_of_both - 1);
      cut(middle_of_both + 1);
    }
  }
  return cuts;
}

std::vector<Block> blocks_of(const FitData& data, const PatchSpan& patch, bool sigma_known) {
  // A block has at least four samples, so that its mean has half of their noise. With 47 blocks a
  // patch that goes all the way round has seven per radian. An odd number of them has one in the
  // middle, and so the same blocks from either end.
  constexpr std::size_t kMostBlocks = 47;
  const std::size_t n = patch.size();
  const std::size_t most = std::clamp<std::size_t>(n / 4, 1, kMostBlocks);
  const std::size_t count = most % 2 == 1 ? most : most - 1;
  std::vector<Block> blocks;
  blocks.reserve(count);
  const auto before = [&](std::size_t b) {
    return 2 * b < count ? b * n / count : n - (count - b) * n / count;
  };
  for (std::size_t b = 0; b < count; ++b) {
    blocks.push_back(
        block_of(data, {patch.begin + before(b), patch.begin + before(b + 1)}, sigma_known));
  }
  return blocks;
}

}  // namespace

std::size_t half_way(const FitData& data, std::size_t a, std::size_t b) {
  const std::size_t middle = (a + b) / 2;
  if ((a + b) % 2 == 0) {
    return middle;
  }
  const Vec2& at = data.points[middle].position;
  return (at - data.points[middle - 1].position).squaredNorm() <
                 (data.points[middle + 1].position - at).squaredNorm()
             ? middle + 1
             : middle;
}

std::vector<PatchSpan> sections_of(const FitData& data, const PatchSpan& patch, bool sigma_known) {
  const std::vector<Block> blocks = blocks_of(data, patch, sigma_known);
  std::vector<PatchSpan> sections = cut_by_chords(data, patch, blocks, std::nullopt);
  // A long chord is a sum of short ones and turns no more: a patch that these leave whole stays
  // whole, unless single samples go back.
  if (sections.size() == 1 && cut_at_cusps(data, patch, 0.0).empty()) {
    return sections;
  }
  const double variance = typical_variance(data, patch, blocks, sigma_known);
  std::vector<std::size_t> ends = cut_at_cusps(data, patch, variance);
  if (ends.empty()) {
    return sections.size() == 1 ? sections : cut_by_chords(data, patch, blocks, variance);
  }
  ends.push_back(patch.end);
  sections.clear();
  std::size_t begin = patch.begin;
  for (const std::size_t end : ends) {
    const PatchSpan arm{begin, end};
    const auto of_arm = cut_by_chords(data, arm, blocks_of(data, arm, sigma_known), variance);
    sections.insert(sections.end(), of_arm.begin(), of_arm.end());
    begin = end;
  }
  return sections;
}

}  // namespace palpate
