#include "core/recognition/recognizer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/numerics/probability/negligible.h"
#include "core/recognition/counted/counted_samples.h"
#include "core/recognition/counted/fewest_places.h"
#include "core/recognition/counted/outliers.h"
#include "core/recognition/counted/way_set_aside.h"
#include "core/recognition/estimate_stream.h"
#include "core/recognition/likelihood_answer.h"
#include "core/recognition/patch_contacts.h"
#include "core/recognition/posterior/likelihood_of.h"
#include "core/recognition/reported_tree_path.h"
#include "core/recognition/samples/cleaned/clean_patches.h"
#include "core/recognition/samples/stroke_order.h"
#include "core/recognition/samples/tips/tip_sides.h"
#include "core/recognition/samples/work_limit.h"
#include "core/recognition/touches/joined_touches.h"
#include "core/recognition/tree_answer.h"
#include "core/recognition/weigh/contenders.h"

namespace palpate {
namespace {

/// Whether the points spread over an extent that double precision resolves.
bool have_extent(const FitData& data) {
  // A shape of five parameters needs digits: a thousand roundings across.
  constexpr double kMostRounding = 1e-3;
  // Squares of coordinates and of their inverses must be numbers.
  constexpr double kSmallest = 1e-100;
  constexpr double kLargest = 1e100;
  return rounding_level(data) < kMostRounding && data.scale > kSmallest && data.scale < kLargest;
}

/// Half of all work is kept from the search for spikes for the classes.
constexpr double kShareOfClasses = 0.5;

/// Of all work, kept for the covariance of what is told: an answer that was cut is AMBIGUOUS, but
/// its uncertainty holds. A deviation that neighbours share takes at most 16 passes over the points
/// that stand for the samples (coherent_moment.h): half a clean ellipse or less.
constexpr double kShareOfMoments = 0.5 / kMostWork;

/// What speaks against an answer that nothing has spoken against yet.
void doubt(Recognition* answer, Doubt doubt) {
  if (answer->status == RecognitionStatus::Recognized) {
    answer->status = RecognitionStatus::Ambiguous;
    answer->doubt = doubt;
  }
}

/// At how many places an answer's class can be RECOGNIZED, by evidence and of stated noise. A
/// sample that is set aside is an unknown more.
std::size_t fewest_places_for(const Recognition& answer) {
  const CurveClass curve_class = answer.shape.curve_class;
  if (curve_class == CurveClass::Unclassified) {
    return kFewestPlaces;
  }
  return fewest_places(curve_class) + answer.outlier_count;
}

std::vector<Vec2> places_of(std::span<const SetAside> samples) {
  std::vector<Vec2> places_m;
  for (const SetAside& aside : samples) {
    places_m.push_back(aside.sample.position_m);
  }
  return places_m;
}

/// Whether a class that had more than `most` has less than a fiftieth of it left: a few samples
/// seldom speak so strongly.
bool has_lost_one(const ClassProbabilities& now, const ClassProbabilities& before, double most) {
  constexpr double kLeft = 0.02;
  for (std::size_t i = 1; i < now.size(); ++i) {
    if (before[i] > most && now[i] < kLeft * before[i]) {
      return true;
    }
  }
  return false;
}

}  // namespace

class Recognizer::Impl {
 public:
  explicit Impl(const RecognizerOptions& options) : options_(options), memory_(options.memory) {}

  AddResult add(const PatchContext& context, std::span<const ContactSample> samples,
                std::span<const SampleDetail> details) {
    if (stream_) {
      stream_->add(context, samples);
    }
    const AddResult result = memory_.add(context, samples, details);
    forgotten_ += result.forgotten;
    simplified_ += result.detailed;
    return result;
  }

  void stream_estimates(bool on) {
    if (!on) {
      stream_.reset();
    } else if (!stream_) {
      SlidingOptions options;
      options.sigma_m = options_.sigma_m;
      options.form_deviation_m = options_.form_deviation_m;
      stream_.emplace(options);
    }
  }

  std::vector<LocalizedContact> take_estimates() {
    if (!stream_) {
      return {};
    }
    return stream_->take(
        [&](std::uint32_t probe, std::uint32_t patch) { return contacts_.side_of(probe, patch); });
  }

  void reset() {
    memory_.clear();
    forgotten_ = 0;
    simplified_ = 0;
    clean_.clear();
    contacts_.clear();
    last_.reset();
    kept_ = {};
    if (stream_) {
      stream_->clear();
    }
  }

  Recognition recognize() {
    unused_.reset();
    WorkBudget work = work_limit(memory_.patches());
    Recognition answer = look(work);
    if (work.was_cut() && answer.status != RecognitionStatus::Collecting) {
      answer.status = RecognitionStatus::Ambiguous;
      answer.doubt = Doubt::WorkLimit;
    }
    answer.work = work;
    answer.sample_count = memory_.sample_count();
    answer.dwelling_count = clean_.dwelling_count();
    answer.forgotten_count = forgotten_;
    answer.simplified_count = unused_.value_or(simplified_);
    return answer;
  }

 private:
  /// All but what the memory counts.
  Recognition look(WorkBudget& work) {
    Recognition answer;
    {
      const WorkBudget::Reserve for_classes(work, kShareOfClasses);
      clean_.update(memory_.patches(), options_.sigma_m, options_.false_outlier_probability, work);
    }
    const std::vector<StoredPatch>& clean = clean_.clean();
    bool sigma_known = false;
    FitData data = make_fit_data(clean, options_.sigma_m, &sigma_known);
    const std::size_t fewest =
        memory_.patches().size() < kFewestPatches ? kFewestPlaces : kFewestPatches;
    if (!have_places(data, fewest) || !have_extent(data)) {
      // What is stated is known, and may be why: noise larger than the part leaves one place.
      if (sigma_known && !data.points.empty()) {
        answer.sigma_m = rms_sigma(data) * data.scale * noise_over_means(clean, options_.sigma_m);
      }
      return answer;
    }
    auto joined = joined_touches(clean, options_.sigma_m, options_.classes, work);
    if (joined) {
      data = make_fit_data(joined->patches, options_.sigma_m, &sigma_known);
    }
    const std::span<const StoredPatch> patches = joined ? joined->patches : clean;
    std::vector<SidedStart> sought;
    if (joined && joined->start) {  // of the tips' centres
      sought.push_back({std::vector<int>(joined->patches.size(), 0), *std::move(joined->start)});
    }
    answer = options_.method == RecognitionMethod::Tree
                 ? by_tree(data, sigma_known, patches, work)
                 : by_likelihood(data, sigma_known, patches, sought, work);
    // Touches in no order whose noise nobody states lie about any curve, if the noise is large
    // enough.
    if (!sigma_known && are_mostly_touches(clean) && answer.sigma_m > kLargestNoise * data.scale) {
      doubt(&answer, Doubt::Misfit);
    }
    // No path leads through what is sent as a stroke and is none: "unclassified" is its doing, and
    // where nobody states the noise, so is that.
    const bool by_path = !sigma_known || answer.shape.curve_class == CurveClass::Unclassified;
    if (by_path && lead_mostly_to_and_fro(clean)) {
      doubt(&answer, Doubt::Misfit);
    }
    const bool by_evidence = options_.method == RecognitionMethod::MaximumLikelihood && sigma_known;
    const double touch_sigma = sigma_known ? 0.0 : answer.sigma_m / data.scale;
    if (!have_places(data, by_evidence ? fewest_places_for(answer) : kFewestPlaces, touch_sigma)) {
      doubt(&answer, Doubt::FewPlaces);
    }
    if (!sigma_known) {  // rounding is the least that it can be
      answer.sigma_m = std::max(answer.sigma_m, data.reading_noise * data.scale);
    }
    // Told of the samples as they came, not of the means that stand for them.
    answer.sigma_m *= noise_over_means(clean, options_.sigma_m);
    return answer;
  }

  /// `patches`: those that the data are of; `sought`: what joining them has found.
  Recognition by_likelihood(const FitData& data, bool sigma_known,
                            std::span<const StoredPatch> patches,
                            std::span<const SidedStart> sought, WorkBudget& work) {
    std::optional<WorkBudget::Reserve> for_moments(std::in_place, work, kShareOfMoments);
    Weighed weighed = weigh_from_last_or_search(data, sigma_known, patches, sought, work);
    const std::size_t stored = clean_.moved_count();
    const CountedSamples samples(counting_options(), clean_);
    const bool is_class = weighed.w.best != CurveClass::Unclassified;
    if (is_class && stored > data.points.size() && !work.was_cut()) {
      weighed = samples.with_ends(std::move(weighed), sigma_known, work);
      if (!weighed.patches) {
        weighed = samples.with_explained(std::move(weighed), work);
      }
    }
    if (!work.was_cut()) {
      weighed = samples.without_spikes_in_bends(std::move(weighed), patches, work);
    }
    last_->explains = weighed.explains;
    const std::span<const StoredPatch> used = weighed.patches ? *weighed.patches : patches;
    last_->off_m = places_of(flagged_samples(used, weighed.outliers));
    if (work.was_cut()) {
      last_.reset();  // what was found by then may be far from what there is
    }
    const Weighing& w = weighed.w;
    for_moments.reset();
    BestMoments moments = moments_of_best(w, work);
    if (!work.allows()) {
      moments = {};  // a part of a valley is no moment: what the noise leaves is told
    }
    Recognition answer = answer_by_likelihood(
        w, moments, {options_.recognized_probability, options_.determined_fraction}, stored);
    // Of all samples the chi-square says so where the noise is stated.
    const bool is_told = sigma_known && weighed.outliers.empty();
    if (!is_told && weighed.leaves_class && w.best != CurveClass::Unclassified) {
      doubt(&answer, Doubt::Misfit);
    }
    answer.outlier_count = stored - w.data.points.size();
    if (answer.outlier_count > 0) {
      const std::vector<bool> aside = samples_set_aside(clean_.moved(), used, weighed.outliers);
      answer.outliers_m = places_of(flagged_samples(clean_.moved(), aside));
      const auto curve = curve_of(w);
      if (curve && has_way_set_aside(clean_.moved(), aside, *curve)) {
        doubt(&answer, Doubt::Misfit);
      }
    }
    if (sigma_known) {
      unused_ = contacts_with_details(w.data);
    }
    answer.contacts = contacts_.of(
        used, w.sides, weighed.outliers,
        contact_options(told_deviation_m(moments, w.data.scale), in_steps(w.smooth.noise_time)));
    add_path(reported_tree_path(w, answer.contacts, options_.tree), &answer);
    const double p_value = answer.tree_p_values[answer.shape.curve_class];
    if (p_value < options_.tree.significance) {
      doubt(&answer, Doubt::TreeRejects);
    }
    localise_contacts(answer.shape, answer.world_T_curve, &answer.contacts);
    return answer;
  }

  Recognition by_tree(FitData data, bool sigma_known, std::span<const StoredPatch> patches,
                      WorkBudget& work) {
    const std::size_t outliers = clean_.moved_count() - data.points.size();
    const FitData reduced = fit_smooth_model(&data, sigma_known).reduced;
    const auto contacts_of = [&](const std::vector<int>& sides) {
      return contacts_.of(patches, sides, {}, contact_options());
    };
    Recognition answer =
        answer_by_tree(possible_sides(patches, reduced, turns_of(reduced), {}, work).ways,
                       contacts_of, options_.tree, data.scale, options_.determined_fraction);
    answer.outlier_count = outliers;
    if (outliers > 0) {
      answer.outliers_m = places_of(
          flagged_samples(clean_.moved(), samples_set_aside(clean_.moved(), patches, {})));
    }
    return answer;
  }

  /// What the last weighing left.
  struct Last {
    std::vector<SidedStart> starts;
    ClassProbabilities probabilities{};
    std::size_t samples = 0;  ///< at the last search
    std::size_t patches = 0;
    std::optional<ExplainingCurve> explains = {};  ///< spikes, of the best class then
    std::vector<Vec2> off_m = {};                  ///< places of the samples that it misses
  };

  /// From the last weighing while the object is touched on in the same patches; from a new search
  /// where they have grown by this, where there is another patch, and where a class comes out best
  /// that was out, or one is gone that might have kept it from being RECOGNIZED: following may have
  /// lost its fit.
  /// `sought`: by_likelihood's.
  Weighed weigh_from_last_or_search(const FitData& data, bool sigma_known,
                                    std::span<const StoredPatch> patches,
                                    std::span<const SidedStart> sought, WorkBudget& work) {
    constexpr double kGrowth = 1.25;  // ten searches while a patch grows tenfold
    // Probability: of what had less, a search leaves the fit rough (weigh/contenders.cpp).
    const double out = std::exp(-log_odds(options_.recognized_probability) - 0.5 * kLeastError);
    const CountedSamples counted(counting_options(), clean_);
    const std::size_t samples = memory_.sample_count();
    const bool warm = last_ && last_->patches == data.patches.size() &&
                      static_cast<double>(samples) <= kGrowth * static_cast<double>(last_->samples);
    if (warm) {
      Weighed weighed = counted.followed(data, sigma_known, patches, last_->starts, last_->explains,
                                         last_->off_m, work);
      const Weighing& w = weighed.w;
      const bool holds = last_->probabilities[w.best] > out &&
                         !has_lost_one(w.probabilities, last_->probabilities,
                                       1.0 - options_.recognized_probability);
      if (holds || !work.allows()) {
        last_->starts = w.starts;
        last_->probabilities = w.probabilities;
        return weighed;
      }
    }
    Weighed weighed =
        counted.without_outliers(data, sigma_known, patches, sought, StartsOf::Search, {}, work);
    last_ = Last{weighed.w.starts, weighed.w.probabilities, samples, data.patches.size()};
    return weighed;
  }

  /// `deviation_m`: what residuals tell of a smooth deviation, if it is more than is stated;
  /// `noise_time`: of how many neighbours each sample counts as one.
  ContactOptions contact_options(double deviation_m = 0.0, double noise_time = 1.0) const {
    ContactOptions options = options_.contacts;
    options.noise_time = noise_time;
    options.sigma_m = options_.sigma_m;
    options.form_deviation_m = std::max(options_.form_deviation_m, deviation_m);
    return options;
  }

  CountingOptions counting_options() {
    CountingOptions options;
    options.weigh.classes = options_.classes;
    options.weigh.recognized_probability = options_.recognized_probability;
    options.weigh.form_deviation_m = options_.form_deviation_m;
    options.weigh.touched_from = options_.touched_from;
    options.weigh.kept_sections = &kept_;
    options.sigma_m = options_.sigma_m;
    options.unqualified_probe = options_.unqualified_probe;
    options.has_probe_file = options_.has_probe_file;
    options.false_outlier_probability = options_.false_outlier_probability;
    return options;
  }

  RecognizerOptions options_;
  SampleMemory memory_;
  std::size_t forgotten_ = 0;          ///< samples, since the object began
  std::size_t simplified_ = 0;         ///< likewise, those with details
  std::optional<std::size_t> unused_;  ///< of these, those that the answer leaves some of out
  CleanPatches clean_;
  PatchContacts contacts_;
  std::optional<Last> last_;
  KeptSections kept_;
  std::optional<EstimateStream> stream_;
};

Recognizer::Recognizer(const RecognizerOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Recognizer::~Recognizer() = default;
Recognizer::Recognizer(Recognizer&&) noexcept = default;
Recognizer& Recognizer::operator=(Recognizer&&) noexcept = default;

AddResult Recognizer::add(const PatchContext& context, std::span<const ContactSample> samples,
                          std::span<const SampleDetail> details) {
  return impl_->add(context, samples, details);
}

Recognition Recognizer::recognize() { return impl_->recognize(); }

void Recognizer::stream_estimates(bool on) { impl_->stream_estimates(on); }

std::vector<LocalizedContact> Recognizer::take_estimates() { return impl_->take_estimates(); }

void Recognizer::reset() { impl_->reset(); }

}  // namespace palpate
