#include "core/local/spikes/spikes_at_ends.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/local/residual_block.h"
#include "core/local/spikes/jumps.h"
#include "core/numerics/probability/negligible.h"

namespace palpate {
namespace {

/// The samples from an end of the patch inwards, compared with polynomials through those behind the
/// first ones.
class EndOfPatch {
 public:
  EndOfPatch(const SearchedSamples& inwards, double sigma_m, double threshold, WorkBudget& work)
      : inwards_(inwards),
        use_(inwards.size(), 1),
        sigma_m_(sigma_m),
        threshold_(threshold),
        work_(work) {}

  /// How many of the first samples are spikes; nullopt where no polynomial follows the others.
  std::optional<std::size_t> spikes() {
    for (std::size_t first = 0; first <= kLongestRunOfSpikes && work_.allows(); ++first) {
      use_[first] = 0;
      const auto degree = degree_that_follows(first + 1);
      if (!degree) {
        return std::nullopt;
      }
      if (!is_off(first)) {
        return first;
      }
      // What a curve has of the next order grows most at its end, as a spike there would.
      constexpr int kMore = 2;
      if (!fit(*degree + kMore)) {
        return std::nullopt;
      }
      if (!is_off(first)) {
        return first;
      }
    }
    return std::nullopt;
  }

 private:
  bool fit(int degree) {
    work_.spend(WorkKind::SpikeRow, inwards_.size());
    return block_.fit(inwards_.positions_m, use_, degree, inwards_.noise) == LocalStatus::Ok &&
           block_.steepest() <= ResidualBlock::kMaxSlope && !turns_back(block_, sigma_m_) &&
           form_noise_m(block_, false) <= sigma_m_;
  }

  bool is_off(std::size_t i) const {
    return std::abs(block_.studentised(i)) > threshold_ * sigma_m_;
  }

  /// The lower degree of two that leaves no more than noise of the samples from `begin` on.
  std::optional<int> degree_that_follows(std::size_t begin) {
    for (const int degree : {ResidualBlock::kDegree / 2, ResidualBlock::kDegree}) {
      if (!fit(degree)) {
        return std::nullopt;
      }
      double squares = 0.0;
      double largest = 0.0;
      for (std::size_t i = begin; i < inwards_.size(); ++i) {
        const double size = std::abs(block_.studentised(i)) / sigma_m_;
        squares += size * size;
        largest = std::max(largest, size);
      }
      if (largest <= threshold_ &&
          can_be_noise(squares, static_cast<double>(inwards_.size() - begin))) {
        return degree;
      }
    }
    return std::nullopt;
  }

  SearchedSamples inwards_;
  std::vector<std::uint8_t> use_;
  double sigma_m_;
  double threshold_;
  WorkBudget& work_;
  ResidualBlock block_;
};

/// By the longest block that a polynomial follows; 0 where none follows any.
std::size_t spikes_before(const SearchedSamples& inwards, std::size_t length_of_blocks,
                          double sigma_m, double threshold, WorkBudget& work) {
  std::size_t before = length_of_blocks;  // judged before
  for (const std::size_t times : {8, 4, 2}) {
    const std::size_t length = std::min(times * length_of_blocks, inwards.size());
    if (length != std::exchange(before, length) && work.allows()) {
      EndOfPatch end(inwards.part(0, length), sigma_m, threshold, work);
      if (const auto found = end.spikes()) {
        return *found;
      }
    }
  }
  return 0;
}

}  // namespace

SpikesAtEnds find_spikes_at_ends(const SearchedSamples& samples, std::size_t length_of_blocks,
                                 double sigma_m, double threshold, const CuspEnds& cusps,
                                 WorkBudget& work) {
  const std::vector<Vec2> positions_m(samples.positions_m.rbegin(), samples.positions_m.rend());
  const std::vector<RelativeNoise> noise(samples.noise.rbegin(), samples.noise.rend());
  const auto found = [&](bool at_cusp, const SearchedSamples& inwards) {
    return at_cusp ? 0 : spikes_before(inwards, length_of_blocks, sigma_m, threshold, work);
  };
  return {found(cusps.first, {samples.positions_m, samples.noise, {}}),
          found(cusps.last, {positions_m, noise, {}})};
}

}  // namespace palpate
