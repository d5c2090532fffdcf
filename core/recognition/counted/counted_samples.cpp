#include "core/recognition/counted/counted_samples.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/numerics/probability/negligible.h"
#include "core/numerics/probability/normal_law.h"
#include "core/recognition/counted/fewest_places.h"
#include "core/recognition/counted/gross_touches.h"
#include "core/recognition/counted/two_readings.h"
#include "core/recognition/counted/unfollowed_samples.h"
#include "core/recognition/samples/cleaned/explained_spikes.h"
#include "core/recognition/touches/joined_touches.h"
#include "core/recognition/weigh/weigh_in_full.h"

namespace palpate {
namespace {

/// One flag per sample: it lies at one of these places. Empty if none does.
std::vector<bool> samples_at(std::span<const Vec2> places_m, std::span<const StoredPatch> patches) {
  std::vector<bool> flags;
  if (places_m.empty()) {
    return flags;
  }
  for (const StoredPatch& patch : patches) {
    for (const StoredSample& sample : patch.samples) {
      flags.push_back(std::find(places_m.begin(), places_m.end(), sample.position_m) !=
                      places_m.end());
    }
  }
  return std::find(flags.begin(), flags.end(), true) == flags.end() ? std::vector<bool>{} : flags;
}

}  // namespace

Weighed CountedSamples::searched(const Touched& touched, WorkBudget& work) const {
  return without_outliers(touched, touched.sought, StartsOf::Search, {}, work);
}

Weighed CountedSamples::without_outliers(const Touched& touched, std::span<const SidedStart> starts,
                                         StartsOf of, std::span<const Vec2> off_m,
                                         WorkBudget& work) const {
  const FitData& data = touched.data;
  const std::span<const StoredPatch> patches = touched.patches;
  Weighed weighed;
  weighed.w.starts.assign(starts.begin(), starts.end());
  // (Of touches that lie apart, what parts near a class have on all of them must be known.)
  const auto likely_off = all_lie_apart(data) ? std::span<const Vec2>{} : off_m;
  if (std::vector<bool> off = samples_at(likely_off, patches); !off.empty()) {
    weigh_again(std::move(off), touched, StartsOf::LastWeighing, &weighed, work);
  }
  const auto curve = weighed.outliers.empty() ? std::nullopt : curve_of(weighed.w);
  if (!curve || !misses_all(*curve, flagged_samples(patches, weighed.outliers))) {
    weighed = {};
    weighed.w = weigh_in_full(data, patches, work, weigh_options(data), starts);
  }
  const Weighing& w = weighed.w;
  const auto look_again = [&] {
    std::vector<bool> aside =
        weighed.outliers.empty() ? std::vector<bool>(data.points.size()) : weighed.outliers;
    FarSamples far = far_samples(w, data, std::move(aside), options_.false_outlier_probability);
    weighed.leaves_class = far.are_form;
    return std::move(far.aside);
  };
  std::vector<bool> aside = look_again();
  if (aside.empty() && data.noise_is_stated && w.best == CurveClass::Unclassified &&
      work.allows()) {
    if (const auto kept = without_gross_touches(w, data, work)) {
      weigh_again(left_out(data, *kept), touched, of, &weighed, work);
    }
    return weighed;
  }
  // Those that are farthest keep the curve off the others beside them, which are seen next.
  while (!aside.empty() && work.allows()) {
    weigh_again(std::move(aside), touched, weighed.outliers.empty() ? of : StartsOf::LastWeighing,
                &weighed, work);
    const bool done = work.was_cut() || w.best == CurveClass::Unclassified;
    aside = done ? std::vector<bool>{} : look_again();
  }
  return weighed;
}

Weighed CountedSamples::settled(Weighed weighed, std::span<const StoredPatch> patches,
                                WorkBudget& work) const {
  const bool is_class = weighed.w.best != CurveClass::Unclassified;
  if (is_class && samples_.moved_count() > count_samples(patches) && !work.was_cut()) {
    weighed = with_ends(std::move(weighed), work);
    if (!weighed.patches) {
      weighed = with_explained(std::move(weighed), work);
    }
  }
  if (!work.was_cut()) {
    weighed = without_spikes_in_bends(std::move(weighed), patches, work);
  }
  return weighed;
}

Weighed CountedSamples::without_spikes_in_bends(Weighed weighed,
                                                std::span<const StoredPatch> patches,
                                                WorkBudget& work) const {
  // Of all classes a spline alone bends as sharply as it takes to run through a spike.
  const bool is_none = weighed.w.best == CurveClass::Unclassified;
  const bool may_run_through =
      weighed.w.best == CurveClass::CubicSpline && weighed.w.stated.sigma_known;
  const bool are_strokes = patches.data() == samples_.clean().data();  // no joined touches
  if (!are_strokes || !(is_none || may_run_through) || !work.allows()) {
    return weighed;
  }
  const std::size_t counted = weighed.w.data.points.size();
  // Where a class fits all samples without spikes, only a curve that misses some tells any.
  const auto tells_spikes = [&](const ExplainingCurve& curve, std::span<const StoredPatch> others) {
    const auto explained = is_none ? std::nullopt : with_spikes_on(curve, others, work);
    return !explained || count_samples(*explained) != counted;
  };
  const std::span<const StoredPatch> weighed_patches = patches_of(weighed, patches);
  auto fewer = without_unfollowed(weighed.w, weighed.outliers, weighed_patches, tells_spikes, work);
  if (!fewer) {
    return weighed;
  }
  const Touched fewer_touched{make_fit_data(*fewer, options_.sigma_m), *fewer};
  if (!have_places(fewer_touched.data, kFewestPlaces)) {
    return weighed;
  }
  const Weighed without = searched(fewer_touched, work);
  const auto curve = curve_of(without.w);
  if (!curve || !work.allows()) {
    return weighed;
  }
  if (auto more = with_spikes_on(*curve, *fewer, work)) {
    fewer = std::move(more);
  }
  auto again = may_lack_spikes(weighed_patches, *fewer)
                   ? again_with(*std::move(fewer), without.w.starts, without.w.best, {}, work)
                   : std::nullopt;
  if (!again) {
    return weighed;
  }
  return is_none ? *std::move(again)
                 : more_probable(std::move(weighed), *std::move(again), patches, samples_.moved());
}

Weighed CountedSamples::with_ends(Weighed weighed, WorkBudget& work) const {
  auto more =
      weighed.w.data.noise_is_stated && weighed.w.best != CurveClass::Unclassified && work.allows()
          ? with_runs_at_ends(samples_.moved(), samples_.clean())
          : std::nullopt;
  if (!more) {
    return weighed;
  }
  auto again = again_with(*std::move(more), weighed.w.starts, weighed.w.best, {}, work);
  const bool fits =
      again && again->outliers.empty() &&
      can_be_noise(again->w.counted_chi2, static_cast<double>(again->w.residuals[again->w.best]));
  return fits ? *std::move(again) : std::move(weighed);
}

Weighed CountedSamples::with_explained(Weighed weighed, WorkBudget& work) const {
  const auto curve = work.allows() ? curve_of(weighed.w) : std::nullopt;
  auto more = curve ? with_spikes_on(*curve, samples_.clean(), work) : std::nullopt;
  auto again = more ? again_with(*std::move(more), weighed.w.starts, weighed.w.best, {}, work)
                    : std::nullopt;
  if (!again) {
    return weighed;
  }
  again->explains = curve_of(again->w);
  return *std::move(again);
}

Weighed CountedSamples::followed(const Touched& touched, std::span<const SidedStart> starts,
                                 const std::optional<ExplainingCurve>& explains,
                                 std::span<const Vec2> off_m, WorkBudget& work) const {
  auto more = explains ? with_spikes_on(*explains, samples_.clean(), work) : std::nullopt;
  if (more) {
    const std::size_t count = count_samples(*more);
    auto again = again_with(*std::move(more), starts, explains->shape.curve_class, off_m, work);
    const auto now = again ? curve_of(again->w) : std::nullopt;
    const auto same = now ? with_spikes_on(*now, samples_.clean(), work) : std::nullopt;
    if (same && count_samples(*same) == count) {
      again->explains = now;
      return *std::move(again);
    }
  }
  return without_outliers(touched, starts, StartsOf::LastWeighing, off_m, work);
}

/// Whether the curve misses each by more than noise lets it.
bool CountedSamples::misses_all(const ExplainingCurve& curve,
                                std::span<const SetAside> samples) const {
  return std::all_of(samples.begin(), samples.end(), [&](const SetAside& off) {
    return distance_m(curve, off.sample, off.tip_radius_m) >
           farthest_by_noise() * noise_m(curve, off.sample);
  });
}

/// Noise puts a sample so many deviations off anywhere in the scene with the probability of a false
/// outlier.
double CountedSamples::farthest_by_noise() const {
  return two_sided_normal_quantile(options_.false_outlier_probability /
                                   static_cast<double>(samples_.moved_count()));
}

/// These patches with the samples that they lack and that lie on the curve; nullopt where none do.
std::optional<std::vector<StoredPatch>> CountedSamples::with_spikes_on(
    const ExplainingCurve& on, std::span<const StoredPatch> counted, WorkBudget& work) const {
  work.spend(kind_of_foot(on.shape.curve_class), samples_.moved_count() - count_samples(counted));
  return with_explained_spikes(samples_.moved(), counted,
                               *make_curve(on.shape.curve_class, on.shape.values), on.world_T_curve,
                               on.noise_m, farthest_by_noise());
}

/// Weighs without the samples that have a flag.
void CountedSamples::weigh_again(std::vector<bool> aside, const Touched& touched, StartsOf of,
                                 Weighed* weighed, WorkBudget& work) const {
  const FitData kept = without_points(touched.data, aside);
  const std::vector<SidedStart> starts =
      of == StartsOf::Search ? std::vector<SidedStart>{} : weighed->w.starts;
  WeighOptions options = weigh_options(kept);
  options.log_odds_against_gross = log_odds_against_gross(touched.data, kept);
  options.log_near_with_gross = weighed->w.log_near_over_paths;
  Weighing again = weigh_in_full(kept, touched.patches, work, options, starts);
  if (!work.was_cut()) {  // else the one before says more
    weighed->w = std::move(again);
    weighed->outliers = std::move(aside);
  }
}

/// Weighed again with these patches; nullopt where the class does not stand then.
std::optional<Weighed> CountedSamples::again_with(std::vector<StoredPatch> more,
                                                  std::span<const SidedStart> starts,
                                                  CurveClass best, std::span<const Vec2> off_m,
                                                  WorkBudget& work) const {
  if (JoinedTouches joined = joined_touches(more, options_.sigma_m, options_.weigh.classes, work);
      joined.patches) {
    more = *std::move(joined.patches);
  }
  Weighed again = without_outliers({make_fit_data(more, options_.sigma_m), more}, starts,
                                   StartsOf::LastWeighing, off_m, work);
  if (work.was_cut() || again.w.best != best || !again.w.canonical[best]) {
    return std::nullopt;
  }
  again.patches = std::move(more);
  return again;
}

WeighOptions CountedSamples::weigh_options(const FitData& data) const {
  WeighOptions options = options_.weigh;
  options.unqualified_probe = options_.unqualified_probe.value_or(!data.noise_is_stated);
  options.near_parts = !options.unqualified_probe && !options_.has_probe_file &&
                       !may_have_missed_spikes(samples_.moved_count(), data.points.size());
  return options;
}

}  // namespace palpate
