#include "node/check/straight_ends.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/local/noise.h"
#include "core/local/spikes/spikes.h"
#include "core/numerics/quantile.h"

namespace palpate {
namespace {

/// Fewer samples do not show that they are straight: of six, a line leaves four degrees of freedom.
/// Up to seven in a row are set aside as spikes in any case, less than half of a block of 16.
constexpr std::size_t kFewestStraight = 6;
/// Part of a stroke: what is longer is an edge of the part.
constexpr std::size_t kStraightOneIn = 4;

/// A probe in free air may tremble more than one that is held by the part.
constexpr double kAirNoise = 2.0;  // in units of the noise along the part
/// White noise exceeds three deviations once in 370 samples, and six never.
constexpr double kWideOfLine = 3.0;
constexpr double kLeastNoise = 1e-9;  ///< of the best touch probes [m]

/// A part is approached along its normal, give or take 30 degrees. What turns less may be the
/// part's own bend, what turns farther a stroke that goes back, as over a cusp.
constexpr double kLeastCorner = std::numbers::pi / 3.0;       // [rad]
constexpr double kMostCorner = std::numbers::pi * 2.0 / 3.0;  // [rad]
/// Between neighbours, as the rest of the stroke turns.
constexpr double kTimesSharper = 3.0;

/// Least squares of a line through consecutive samples, in the direction of travel.
class StraightLine {
 public:
  explicit StraightLine(std::span<const Vec2> samples) : samples_(samples) {
    for (const Vec2& p : samples_) mean_ += p - samples_.front();
    mean_ = samples_.front() + mean_ / count();
    double xx = 0.0, xy = 0.0, yy = 0.0;
    for (const Vec2& p : samples_) {
      const Vec2 d = p - mean_;
      xx += d.x() * d.x();
      xy += d.x() * d.y();
      yy += d.y() * d.y();
    }
    const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
    direction_ = Vec2(std::cos(angle), std::sin(angle));
    if (direction_.dot(samples_.back() - samples_.front()) < 0.0) direction_ = -direction_;
    const double spread = 0.5 * (xx + yy);
    const double stretch = std::hypot(0.5 * (xx - yy), xy);
    along_squares_ = spread + stretch;
    across_squares_ = std::max(spread - stretch, 0.0);
  }

  const Vec2& direction() const { return direction_; }
  double along(const Vec2& p) const { return direction_.dot(p - mean_); }
  double across(const Vec2& p) const { return cross(direction_, p - mean_); }
  double length() const { return along(samples_.back()) - along(samples_.front()); }
  double end() const { return along(samples_.back()); }

  /// Standard deviation of the samples about it, and its own relative one.
  double sigma() const { return std::sqrt(across_squares_ / (count() - 2.0)); }
  double deviation_of_sigma() const { return 1.0 / std::sqrt(2.0 * (count() - 2.0)); }

  /// Standard deviation of another sample's distance from it, in units of the noise.
  double deviation_at(const Vec2& p) const {
    const double u = along(p);
    return std::sqrt(1.0 + 1.0 / count() + u * u / along_squares_);
  }

  struct Sagitta {
    double size_m = 0.0;
    double deviation = 0.0;  ///< its standard deviation, in units of the noise
  };

  /// By which the parabola of least squares bends over the samples.
  Sagitta sagitta() const {
    double u2 = 0.0, u3 = 0.0, u4 = 0.0, u2v = 0.0;
    for (const Vec2& p : samples_) {
      const double u = along(p);
      u2 += u * u;
      u3 += u * u * u;
      u4 += u * u * u * u;
      u2v += u * u * across(p);
    }
    // u^2 without what a line explains of it; the line leaves no mean and no slope of v.
    const double squares = u4 - u2 * u2 / count() - u3 * u3 / u2;
    const double of_bend = 0.25 * length() * length();
    return {of_bend * std::abs(u2v) / squares, of_bend / std::sqrt(squares)};
  }

 private:
  double count() const { return static_cast<double>(samples_.size()); }

  std::span<const Vec2> samples_;
  Vec2 mean_ = Vec2::Zero();
  Vec2 direction_ = Vec2::Zero();
  double along_squares_ = 0.0;
  double across_squares_ = 0.0;
};

/// Whether a line goes on to that sample. A way back, as behind a cusp, is another line.
bool leads_to(const StraightLine& line, const Vec2& p, double limit_m) {
  return std::abs(line.across(p)) <= limit_m * line.deviation_at(p) &&
         line.along(p) >= line.end() - limit_m;
}

/// How many of the first samples lie on one line; 0 if too few do, or so many that they are no end.
std::size_t samples_on_line(std::span<const Vec2> samples, double sigma_m) {
  const std::size_t most = samples.size() / kStraightOneIn;
  std::size_t count = kFewestStraight;
  while (count <= most) {
    // Fitted anew when it has grown by an eighth: a long edge would else cost its square.
    const StraightLine line(samples.first(count));
    const std::size_t until = std::min(count + 1 + count / 8, most + 1);
    const double most_deviations = kWideOfLine * kAirNoise;
    while (count < until && leads_to(line, samples[count], most_deviations * sigma_m)) ++count;
    if (count < until) break;
  }
  // The first samples of the rest may lie that near to the line, but not nearer.
  while (count > kFewestStraight && !leads_to(StraightLine(samples.first(count - 1)),
                                              samples[count - 1], kWideOfLine * sigma_m)) {
    --count;
  }
  return count <= most ? count : 0;
}

/// The first sample from `i` on, in steps of 1 or -1, that lies so far from sample `i`; the number
/// of samples if there is none within reach.
std::size_t sample_beyond(std::span<const Vec2> samples, std::size_t i, std::ptrdiff_t step,
                          double distance_m, std::size_t reach) {
  const Vec2& from = samples[i];
  for (std::size_t k = 0; k < reach && i < samples.size(); ++k) {
    if ((samples[i] - from).norm() >= distance_m) return i;
    i += static_cast<std::size_t>(step);  // below 0 it wraps to a number beyond all
  }
  return samples.size();
}

/// The largest turn between two chords of that length, one after the other.
double sharpest_turn(std::span<const Vec2> samples, double chord_m) {
  // A third of a chord apart, so that dwells and dense samples take no longer than others. A stroke
  // that wanders for so many of them within one chord goes nowhere.
  constexpr double kApart = 1.0 / 3.0;
  constexpr std::size_t kReach = 64;
  std::vector<Vec2> moved;
  for (const Vec2& p : samples) {
    if (moved.empty() || (p - moved.back()).norm() >= kApart * chord_m) moved.push_back(p);
  }
  double sharpest = 0.0;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const std::size_t before = sample_beyond(moved, i, -1, chord_m, kReach);
    const std::size_t after = sample_beyond(moved, i, 1, chord_m, kReach);
    if (before == moved.size() || after == moved.size()) continue;
    sharpest = std::max(sharpest,
                        std::abs(turn_between(moved[i] - moved[before], moved[after] - moved[i])));
  }
  return sharpest;
}

/// The rest of a stroke, in whose turns between neighbours an end's corner is judged.
struct RestOfStroke {
  std::vector<Vec2> samples;  ///< without spikes
  double step_m = 0.0;        ///< the median one
  double chord_m = 0.0;   ///< from neighbour to neighbour: a step, or longer if noise hides steps
  double turn_rad = 0.0;  ///< the largest between chords
};

RestOfStroke rest_of(std::span<const Vec2> samples, double sigma_m) {
  RestOfStroke rest;
  SpikeOptions options;
  options.sigma_m = sigma_m;
  std::vector<std::size_t> spikes = find_spikes(samples, options).indices;
  // Several next to an end may be a fillet or a cusp, of whose block of 16 samples most lie on a
  // straight edge. The flags begin and end with those of no sample.
  constexpr std::size_t kBlock = 16;
  std::vector<bool> is_spike(samples.size() + 2, false);
  for (const std::size_t i : spikes) is_spike[i + 1] = true;
  std::erase_if(spikes, [&](std::size_t i) {
    return (i < kBlock || i + kBlock >= samples.size()) && (is_spike[i] || is_spike[i + 2]);
  });
  auto spike = spikes.begin();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (spike != spikes.end() && *spike == i) {
      ++spike;
    } else {
      rest.samples.push_back(samples[i]);
    }
  }
  std::vector<double> steps;
  for (std::size_t i = 1; i < rest.samples.size(); ++i) {
    steps.push_back((rest.samples[i] - rest.samples[i - 1]).norm());
  }
  std::erase(steps, 0.0);
  if (!steps.empty()) rest.step_m = median_of(steps);
  // A turn is the sum of two differences of three samples, whose variance is six. Of hundreds the
  // largest is 3.5 deviations: they are to be so much less than the smallest
  // corner.
  constexpr double kLargestOfHundreds = 3.5;
  const double by_noise =
      kLargestOfHundreds * std::sqrt(6.0) * sigma_m / (kLeastCorner / kTimesSharper);
  rest.chord_m = std::max(by_noise, rest.step_m);
  rest.turn_rad = sharpest_turn(rest.samples, rest.chord_m);
  return rest;
}

/// Whether a line is straight, and surely straighter than an arm of a cusp whose two arms turn by
/// so much: an arm y = c x^1.5 whose chord has the slope s has a sagitta of s / 7 of its length
/// (that of its parabola of least squares), and both arms turn by pi - 2 atan(s). Of the classes'
/// curves that bend within a step, it is the straightest.
bool is_straight(const StraightLine& line, double corner_rad, double sigma_m) {
  constexpr double kSagittaOfSlope = 1.0 / 7.0;
  constexpr double kSurely = 4.0;  // deviations, which white noise exceeds once in 16,000 ends
  const double of_cusp =
      kSagittaOfSlope * std::tan(0.5 * (std::numbers::pi - corner_rad)) * line.length();
  const StraightLine::Sagitta sagitta = line.sagitta();
  const double by_noise = kSurely * sagitta.deviation * sigma_m;
  return sagitta.size_m <= by_noise && sagitta.size_m + by_noise <= of_cusp;
}

/// Judges an end, in the order from the air to the part. `rest` comes next to it, in that order.
StraightEnd judged(std::span<const Vec2> end, std::span<const Vec2> samples,
                   const RestOfStroke& rest, double sigma_m) {
  if (end.empty()) return {};
  const StraightLine line(end);
  const double most_by_noise = 1.0 + kWideOfLine * line.deviation_of_sigma();
  if (line.sigma() > most_by_noise * kAirNoise * sigma_m) return {};
  // Slower samples are a dwell (core/recognition/samples/dwells.cpp has the same fraction).
  constexpr double kSlowest = 0.25;
  if (line.length() < kSlowest * (kFewestStraight - 1) * rest.step_m) return {};
  // Longer chords would take the bend of a fillet for a corner.
  constexpr double kMostSteps = 3.0;
  if (rest.chord_m > kMostSteps * rest.step_m) return {};
  const std::size_t after = sample_beyond(samples, 0, 1, rest.chord_m, samples.size());
  if (after == samples.size()) return {};
  const double corner = std::abs(turn_between(line.direction(), samples[after] - samples.front()));
  if (corner < kLeastCorner || corner > kMostCorner) return {};
  if (corner < kTimesSharper * rest.turn_rad) return {};
  if (!is_straight(line, corner, std::max(sigma_m, line.sigma()))) return {};
  return {end.size(), corner};
}

}  // namespace

StraightEnds straight_ends(std::span<const Vec2> positions_m) {
  const std::size_t count = positions_m.size();
  if (count < kStraightOneIn * kFewestStraight) return {};
  // Both ends may be in the air: the middle half is not.
  const NoiseEstimate noise = estimate_noise(
      positions_m.subspan(count / kStraightOneIn, count - 2 * (count / kStraightOneIn)));
  if (noise.status != LocalStatus::Ok) return {};
  const double sigma_m = std::max(noise.sigma_m, kLeastNoise);
  const std::vector<Vec2> backwards(positions_m.rbegin(), positions_m.rend());
  const std::size_t first = samples_on_line(positions_m, sigma_m);
  const std::size_t last = samples_on_line(backwards, sigma_m);
  if (first == 0 && last == 0) return {};

  const RestOfStroke rest = rest_of(positions_m.subspan(first, count - first - last), sigma_m);
  if (rest.samples.empty()) return {};
  const std::vector<Vec2> rest_backwards(rest.samples.rbegin(), rest.samples.rend());
  return {judged(positions_m.first(first), rest.samples, rest, sigma_m),
          judged(std::span(backwards).first(last), rest_backwards, rest, sigma_m)};
}

}  // namespace palpate
