#include "core/local/spikes/least_median_parabola.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/probability/normal_law.h"

namespace palpate {
namespace {

/// Samples tried in each third, evenly spaced. With three tenths of spikes, a third of the 150 or
/// so triples contain no spike.
constexpr std::size_t kTriedPerThird = 6;

/// Least distance of the middle sample's abscissa from either outer one, as a fraction of their
/// distance. Nearer to an end, the noise of that sample is multiplied by the inverse in the
/// parabola.
constexpr double kLeastShare = 0.15;

/// Largest slope of the parabola at its ends against its chord: 45 degrees.
constexpr double kMaxSlope = 1.0;

/// The best of so many parabolas is nearer to the samples than the true one, by 1 - kFew / samples;
/// for 16 to 64 samples this is right to a tenth (local_hard_cases_test prints it). Below kFewest
/// the factor would vanish.
constexpr double kFew = 9.0;
constexpr double kFewest = 12.0;

}  // namespace

/// Takes the parabola if its nearer half is nearer than that of the best so far.
void LeastMedianParabola::try_curve(double curve, std::size_t half, double* best) {
  const std::size_t n = distances_.size();
  std::size_t farther = 0;
  for (std::size_t i = 0; i < n; ++i) {
    distances_[i] = std::abs(across_[i] - curve * product_[i]);
    farther += distances_[i] < *best ? 0 : 1;
  }
  if (farther > n - half) {
    return;
  }
  best_ = sorted_ = distances_;
  const auto median = sorted_.begin() + static_cast<std::ptrdiff_t>(half - 1);
  std::nth_element(sorted_.begin(), median, sorted_.end());
  *best = *median;
}

/// In the frame of the chord from sample a to sample c, the parabola through them and b is y =
/// curve * x (x - length). The distance of a sample from it is |y - curve * x (x - length)|.
bool LeastMedianParabola::fit(std::span<const Vec2> samples, std::span<const RelativeNoise> noise) {
  const auto precision_of = [&](std::size_t i) {
    return noise.empty() ? 1.0 : 1.0 / noise[i].across;
  };
  const std::size_t n = samples.size();
  const std::size_t half = n / 2;
  const std::size_t third = (n + 2) / 3;
  const std::size_t step = (third + kTriedPerThird - 1) / kTriedPerThird;
  across_.resize(n);
  product_.resize(n);
  distances_.resize(n);
  best_.clear();
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < third; a += step) {
    for (std::size_t c = n - third; c < n; c += step) {
      const Vec2 chord = samples[c] - samples[a];
      const double length = chord.norm();
      if (!(length > 0.0)) {
        continue;
      }
      const Vec2 axis = chord / length;
      for (std::size_t i = 0; i < n; ++i) {
        const Vec2 d = samples[i] - samples[a];
        const double x = axis.dot(d);
        const double precision = precision_of(i);
        across_[i] = precision * cross(axis, d);
        product_[i] = precision * x * (x - length);
      }
      for (std::size_t b = third; b < n - third; b += step) {
        // x (x - length) <= -share (1 - share) length^2: b lies between a and c.
        if (!(product_[b] <=
              -kLeastShare * (1.0 - kLeastShare) * length * length * precision_of(b))) {
          continue;
        }
        const double curve = across_[b] / product_[b];
        if (std::abs(curve) * length <= kMaxSlope) {
          try_curve(curve, half, &best);
        }
      }
    }
  }
  if (best_.empty()) {
    return false;
  }
  const double few = 1.0 / (1.0 - kFew / std::max(static_cast<double>(n), kFewest));
  scale_m_ = few * best / kMedianOfNormal;
  nearer_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    nearer_[i] = best_[i] <= best ? 1 : 0;
  }
  return true;
}

}  // namespace palpate
