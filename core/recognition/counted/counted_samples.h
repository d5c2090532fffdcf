// Which samples count: weighs the classes, sets aside what none explains, and takes back what the
// best one does.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/curves/pose2.h"
#include "core/recognition/counted/outliers.h"
#include "core/recognition/counted/weighed.h"
#include "core/recognition/samples/cleaned/clean_patches.h"
#include "core/recognition/weigh/sided_start.h"
#include "core/recognition/weigh/weigh.h"

namespace palpate {

/// What is to be weighed.
struct Touched {
  FitData data;
  std::span<const StoredPatch> patches;  ///< that the data are of
  std::vector<SidedStart> sought = {};   ///< by joining touches; empty = a search finds them
};

/// What the starts of a weighing are from. Those of a search are not followed where samples are set
/// aside: these may have led it astray.
enum class StartsOf { LastWeighing, Search };

/// As RecognizerOptions.
struct CountingOptions {
  WeighOptions weigh;  ///< but for what the samples decide: unqualified_probe and near_parts
  double sigma_m = 0.0;
  std::optional<bool> unqualified_probe;
  bool has_probe_file = false;
  double false_outlier_probability = 0.01;
};

/// Of the samples that one recognition is about. Refers to what it is made of.
class CountedSamples {
 public:
  CountedSamples(const CountingOptions& options, const CleanPatches& samples)
      : options_(options), samples_(samples) {}

  /// Weighed by a search, again without the samples that the best class misses by far more than
  /// noise, until there are none.
  Weighed searched(const Touched& touched, WorkBudget& work) const;

  /// The same from the last weighing, at once with the spikes that its curve `explains`, if the
  /// class stands so and explains no others, and without the samples at the places `off_m` that it
  /// had off, if the curve found then still misses them: so a sample is not weighed twice with each
  /// of the next ones.
  Weighed followed(const Touched& touched, std::span<const SidedStart> starts,
                   const std::optional<ExplainingCurve>& explains, std::span<const Vec2> off_m,
                   WorkBudget& work) const;

  /// Weighed again with what the class that was found makes of the samples that were set aside, and
  /// of those that may be spikes: the three steps below. `patches`: those that `weighed` is of,
  /// unless it has its own.
  Weighed settled(Weighed weighed, std::span<const StoredPatch> patches, WorkBudget& work) const;

 private:
  /// `off_m`: places of samples that are likely outliers.
  Weighed without_outliers(const Touched& touched, std::span<const SidedStart> starts, StartsOf of,
                           std::span<const Vec2> off_m, WorkBudget& work) const;

  /// Where no class fits, or a spline of which a spike may make the bend: weighed again without the
  /// samples in sharp bends that no polynomial follows, for a spike among them bends every class
  /// towards itself. If a class is found so, those that it explains are taken back. What is left
  /// out may be spikes then: that is the answer where no class fits, and another reading of the
  /// samples where the spline does (two_readings.h).
  Weighed without_spikes_in_bends(Weighed weighed, std::span<const StoredPatch> patches,
                                  WorkBudget& work) const;

  /// Weighed again with what was told for spikes at the ends of strokes, where the noise is stated
  /// and the class that the rest is of leaves no more than noise of all.
  Weighed with_ends(Weighed weighed, WorkBudget& work) const;

  /// Weighed again with the spikes that the best class explains, where the class stands then.
  Weighed with_explained(Weighed weighed, WorkBudget& work) const;

  void weigh_again(std::vector<bool> aside, const Touched& touched, StartsOf of, Weighed* weighed,
                   WorkBudget& work) const;
  std::optional<std::vector<StoredPatch>> with_spikes_on(const ExplainingCurve& curve,
                                                         std::span<const StoredPatch> counted,
                                                         WorkBudget& work) const;
  std::optional<Weighed> again_with(std::vector<StoredPatch> more,
                                    std::span<const SidedStart> starts, CurveClass best,
                                    std::span<const Vec2> off_m, WorkBudget& work) const;
  bool misses_all(const ExplainingCurve& curve, std::span<const SetAside> samples) const;
  double farthest_by_noise() const;
  WeighOptions weigh_options(const FitData& data) const;

  CountingOptions options_;
  const CleanPatches& samples_;
};

}  // namespace palpate
