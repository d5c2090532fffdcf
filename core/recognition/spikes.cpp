#include "core/recognition/spikes.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/recognition/normal_quantile.h"

namespace palpate {
namespace {

constexpr std::size_t kReach = 7;  // neighbours on each side, fewer at the ends
constexpr std::size_t kFewestSamples = 12;
constexpr double kMedianOfMagnitude = 0.6745;  // of a standard normal

double quantile(std::span<double> values, double fraction) {
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size()));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

double median(std::span<double> values) { return quantile(values, 0.5); }

/// Whether any of these lengths is beyond what Gaussian samples leave.
bool has_unusual(std::vector<double>& lengths) {
  // A spike touches five fourth differences, so that with a third of spikes only (2/3)^5 of them,
  // 13 %, are clean: compare with a low quantile. A thousand Gaussian samples reach about 8 times
  // this one.
  constexpr double kLowQuantile = 0.1;
  constexpr double kUnusual = 12.0;
  const double longest = *std::max_element(lengths.begin(), lengths.end());
  return longest > kUnusual * quantile(lengths, kLowQuantile);
}

/// Whether there is any unusually long second difference, and fourth one: a spike cannot but cause
/// both. A sharp bend has long second differences, and exact samples have fourth ones of every
/// size.
bool anything_unusual(std::span<const StoredSample> samples) {
  const auto at = [&](std::size_t k) -> const Vec2& { return samples[k].position_m; };
  std::vector<double> lengths;
  lengths.reserve(samples.size());
  for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
    lengths.push_back((at(i - 1) - 2.0 * at(i) + at(i + 1)).norm());
  }
  if (!has_unusual(lengths)) {
    return false;
  }
  lengths.clear();
  for (std::size_t i = 2; i + 2 < samples.size(); ++i) {
    lengths.push_back(
        (at(i - 2) - 4.0 * at(i - 1) + 6.0 * at(i) - 4.0 * at(i + 1) + at(i + 2)).norm());
  }
  return has_unusual(lengths);
}

/// Direction from the median place of the first half of a window to that of the second.
Vec2 direction_of(std::span<const StoredSample> window) {
  std::array<double, 2 * kReach + 1> values{};
  const auto median_place = [&](std::size_t begin, std::size_t end) {
    Vec2 place;
    for (int axis = 0; axis < 2; ++axis) {
      for (std::size_t i = begin; i < end; ++i) {
        values[i - begin] = window[i].position_m[axis];
      }
      place[axis] = median(std::span(values).first(end - begin));
    }
    return place;
  };
  const std::size_t half = window.size() / 2;
  return median_place(half, window.size()) - median_place(0, half);
}

/// Distance of sample `i` across travel from the parabola of least absolute deviations through its
/// neighbours in the window.
double deviation(std::span<const StoredSample> window, std::size_t i) {
  const Vec2 chord = direction_of(window);
  const double length = chord.norm();
  if (!(length > 0.0)) {
    return 0.0;  // dwelling: nothing to be off
  }
  const Vec2 axis = chord / length;
  const Vec2 origin = window[i].position_m;
  std::array<double, 2 * kReach + 1> x{};
  std::array<double, 2 * kReach + 1> y{};
  std::array<double, 2 * kReach + 1> w{};
  const std::size_t n = window.size();
  double scale = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const Vec2 from = window[k].position_m - origin;
    x[k] = from.dot(axis) / length;
    y[k] = cross(axis, from);
    w[k] = k == i ? 0.0 : 1.0;
    scale = std::max(scale, std::abs(y[k]));
  }
  if (scale == 0.0) {
    return 0.0;
  }
  // Iteratively reweighted least squares; the smallest deviation that still counts keeps it finite.
  constexpr int kIterations = 12;
  const double least = 1e-6 * scale;
  Eigen::Vector3d c = Eigen::Vector3d::Zero();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < n; ++k) {
      const Eigen::Vector3d row(1.0, x[k], x[k] * x[k]);
      a.noalias() += w[k] * row * row.transpose();
      b.noalias() += w[k] * y[k] * row;
    }
    c = a.ldlt().solve(b);
    for (std::size_t k = 0; k < n; ++k) {
      w[k] =
          k == i ? 0.0 : 1.0 / std::max(std::abs(y[k] - c[0] - x[k] * (c[1] + x[k] * c[2])), least);
    }
  }
  return std::isfinite(c[0]) ? -c[0] / std::sqrt(1.0 + (c[1] / length) * (c[1] / length)) : 0.0;
}

}  // namespace

std::vector<bool> find_spikes(std::span<const StoredSample> samples, double false_alarm) {
  const std::size_t n = samples.size();
  std::vector<bool> spikes(n, false);
  if (n < kFewestSamples || !anything_unusual(samples)) {
    return spikes;
  }
  std::vector<double> deviations(n);
  std::vector<double> magnitudes(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t begin = std::min(i >= kReach ? i - kReach : 0, n - kFewestSamples);
    const std::size_t end = std::max(std::min(i + kReach + 1, n), begin + kFewestSamples - 1);
    deviations[i] = deviation(samples.subspan(begin, end - begin), i - begin);
    magnitudes[i] = std::abs(deviations[i]);
  }
  const double scale = median(magnitudes) / kMedianOfMagnitude;
  const double limit = scale * two_sided_normal_quantile(false_alarm / static_cast<double>(n));
  for (std::size_t i = 0; i < n; ++i) {
    // A bend too sharp for a parabola throws whole runs off to one side; a spike stands alone among
    // its neighbours.
    const double before = i > 0 ? deviations[i - 1] : 0.0;
    const double after = i + 1 < n ? deviations[i + 1] : 0.0;
    const double alone =
        std::min(std::abs(deviations[i] - before), std::abs(deviations[i] - after));
    spikes[i] = std::abs(deviations[i]) > limit && alone > limit;
  }
  return spikes;
}

std::vector<bool> find_spikes_in_passes(std::span<const StoredSample> samples, double false_alarm) {
  constexpr int kMostPasses = 6;
  std::vector<bool> spikes = find_spikes(samples, false_alarm);
  bool found = std::find(spikes.begin(), spikes.end(), true) != spikes.end();
  for (int pass = 1; pass < kMostPasses && found; ++pass) {
    const std::vector<bool> more = find_spikes(without_spikes(samples, spikes), false_alarm);
    found = false;
    std::size_t next = 0;  // of those left
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (!spikes[i] && more[next++]) {
        spikes[i] = found = true;
      }
    }
  }
  // A run of so many is a bend: spikes take neighbours along, but where half of the samples go at
  // random, one patch of a hundred samples in a thousand loses such a run.
  constexpr std::ptrdiff_t kLongestRun = 16;
  for (auto run = spikes.begin(); run != spikes.end();) {
    const auto end = std::find(run, spikes.end(), !*run);
    if (*run && end - run >= kLongestRun) {
      std::fill(run, end, false);
    }
    run = end;
  }
  return spikes;
}

std::vector<StoredSample> without_spikes(std::span<const StoredSample> samples,
                                         const std::vector<bool>& is_spike) {
  std::vector<StoredSample> kept;
  kept.reserve(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!is_spike[i]) {
      kept.push_back(samples[i]);
    }
  }
  return kept;
}

}  // namespace palpate
