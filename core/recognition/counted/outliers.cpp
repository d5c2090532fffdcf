#include "core/recognition/counted/outliers.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "core/local/spikes/jumps.h"
#include "core/numerics/probability/normal_law.h"
#include "core/numerics/probability/student_quantile.h"
#include "core/numerics/quantile.h"
#include "core/recognition/samples/cleaned/stored_spikes.h"

namespace palpate {
namespace {

/// The best class placed on all points; nullptr if there is none.
const CanonicalFit* best_class_of(const Weighing& weighing) {
  const CanonicalFit* fit = nullptr;
  double best = -1.0;
  for (std::size_t i = 1; i < weighing.canonical.size(); ++i) {
    if (weighing.canonical[i] && weighing.fits[i]->on_all && weighing.probabilities[i] > best) {
      best = weighing.probabilities[i];
      fit = &*weighing.canonical[i];
    }
  }
  return fit;
}

/// By how many deviations of the noise each point misses the class, its normal likewise, and how
/// far noise lets it.
struct Misses {
  std::vector<double> magnitude;
  double limit = 0.0;
};

Misses misses_of(const CanonicalFit& fit, const Weighing& weighing,
                 double false_outlier_probability) {
  const std::size_t n = fit.points.size();
  Misses misses{std::vector<double>(n), 0.0};
  for (std::size_t i = 0; i < n; ++i) {
    misses.magnitude[i] = std::abs(fit.points[i].residual);
  }
  // Robust scale of the residuals: their noise may be unknown, and spikes must not widen it. What
  // is stated is the least, else rounding and the readings' step: the smooth model may have taken a
  // feature of the part, which few samples show, for noise.
  std::vector<double> sizes = misses.magnitude;
  // The fit absorbs part of the noise. And a median knows a scale only as well as a root mean
  // square of 0.37 times the degrees of freedom (its efficiency).
  constexpr double kEfficiencyOfMedian = 0.37;
  const double dof = static_cast<double>(n) - degrees_of_freedom(fit.shape.curve_class);
  const double taken = std::sqrt(static_cast<double>(n) / std::max(dof, 1.0));
  const FitData& data = weighing.data;
  const double least = data.noise_is_stated
                           ? 1.0
                           : std::max(rounding_level(data), data.reading_noise) / weighing.sigma;
  const double scale = std::max(least, taken * median_of(sizes) / kMedianOfNormal);
  const std::size_t residuals = residual_count(data);
  const double z =
      two_sided_normal_quantile(false_outlier_probability / static_cast<double>(residuals));
  misses.limit =
      scale *
      (data.noise_is_stated ? z : student_quantile(z, kEfficiencyOfMedian * std::max(dof, 1.0)));
  if (residuals > n) {
    for (std::size_t i = 0; i < n; ++i) {
      misses.magnitude[i] = std::max(misses.magnitude[i], std::abs(fit.points[i].normal_residual));
    }
  }
  return misses;
}

}  // namespace

FarSamples far_samples(const Weighing& weighing, const FitData& data, std::vector<bool> aside,
                       double false_outlier_probability) {
  const CanonicalFit* fit = best_class_of(weighing);
  if (fit == nullptr) {
    return {};
  }
  const auto [magnitude, limit] = misses_of(*fit, weighing, false_outlier_probability);
  if (std::none_of(magnitude.begin(), magnitude.end(),
                   [limit = limit](double m) { return m > limit; })) {
    return {};
  }
  const bool is_first = std::none_of(aside.begin(), aside.end(), [](bool flag) { return flag; });
  std::vector<FitPoint> kept;  // with the noise that the misses are told in
  std::size_t weighed = 0;     // of the points before
  double squares_of_kept = 0.0;
  double squares_of_dropped = 0.0;
  for (const PatchSpan& patch : data.patches) {
    std::size_t run = 0;
    for (std::size_t i = patch.begin; i < patch.end; ++i) {
      if (!aside[i]) {
        const double miss = magnitude[weighed];
        aside[i] = miss > limit;
        (aside[i] ? squares_of_dropped : squares_of_kept) += miss * miss;
        if (!aside[i]) {
          kept.push_back(weighing.data.points[weighed]);
        }
        ++weighed;
      }
      run = aside[i] ? run + 1 : 0;
      if (run > kLongestRunOfSpikes) {
        return {{}, true};
      }
    }
  }
  // An outlier that brings a chi-square into a fit leaves itself 1 - h of it, h its leverage: more
  // than half, unless it alone determines the curve. So a larger misfit of the other points is not
  // its doing. (Those beside one that was taken out before did no such thing.)
  const bool misfits = is_first && squares_of_kept > most_chi2_of_noise(kept) &&
                       squares_of_kept > squares_of_dropped;
  if (misfits || data.points.size() - kept.size() > most_set_aside(data.points.size())) {
    return {};
  }
  return {std::move(aside), false};
}

std::vector<SetAside> flagged_samples(std::span<const StoredPatch> patches,
                                      const std::vector<bool>& flagged) {
  std::vector<SetAside> samples;
  std::size_t number = 0;
  for (const StoredPatch& patch : patches) {
    for (const StoredSample& sample : patch.samples) {
      if (number < flagged.size() && flagged[number++]) {
        samples.push_back({sample, patch.context.tip_radius_m});
      }
    }
  }
  return samples;
}

std::vector<Vec2> places_of(std::span<const SetAside> samples) {
  std::vector<Vec2> places_m;
  for (const SetAside& aside : samples) {
    places_m.push_back(aside.sample.position_m);
  }
  return places_m;
}

std::vector<bool> samples_set_aside(std::span<const StoredPatch> all,
                                    std::span<const StoredPatch> used,
                                    const std::vector<bool>& flagged) {
  // Joined touches are the same samples in another order: they are known by their places.
  using Place = std::pair<double, double>;
  std::multiset<Place> kept;
  std::size_t number = 0;
  for (const StoredPatch& patch : used) {
    for (const StoredSample& sample : patch.samples) {
      const bool is_out = number < flagged.size() && flagged[number];
      ++number;
      if (!is_out) kept.insert({sample.position_m.x(), sample.position_m.y()});
    }
  }
  std::vector<bool> aside;
  for (const StoredPatch& patch : all) {
    for (const StoredSample& sample : patch.samples) {
      const auto found = kept.find({sample.position_m.x(), sample.position_m.y()});
      aside.push_back(found == kept.end());
      if (found != kept.end()) kept.erase(found);
    }
  }
  return aside;
}

bool may_have_missed_spikes(std::size_t stored, std::size_t used) {
  // The spike search needs half of a block of 16 samples to be good. With a tenth of spikes, a
  // block has nine or more once in 10^5 (binomial law, 5e-6), and a patch of 111 samples once in
  // ten thousand.
  constexpr double kManySpikes = 0.1;
  return static_cast<double>(stored - used) > kManySpikes * static_cast<double>(stored);
}

std::vector<bool> left_out(const FitData& all, const FitData& kept) {
  std::vector<bool> flags(all.points.size(), true);
  std::size_t next = 0;
  for (std::size_t i = 0; i < flags.size() && next < kept.points.size(); ++i) {
    if (all.points[i].position == kept.points[next].position) {
      flags[i] = false;
      ++next;
    }
  }
  return flags;
}

}  // namespace palpate
