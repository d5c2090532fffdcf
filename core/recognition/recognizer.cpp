#include "core/recognition/recognizer.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "core/recognition/counted/counted_samples.h"
#include "core/recognition/counted/last_weighing.h"
#include "core/recognition/estimate_stream.h"
#include "core/recognition/likelihood_answer.h"
#include "core/recognition/patch_contacts.h"
#include "core/recognition/reported_tree_path.h"
#include "core/recognition/sample_doubts.h"
#include "core/recognition/samples/cleaned/clean_patches.h"
#include "core/recognition/samples/tips/tip_sides.h"
#include "core/recognition/samples/work_limit.h"
#include "core/recognition/set_aside_answer.h"
#include "core/recognition/touches/joined_touches.h"
#include "core/recognition/tree_answer.h"
#include "core/recognition/weigh/best_moments.h"

namespace palpate {
namespace {

/// Of all work, kept for the classes: the search for spikes ends where the rest is spent, and what
/// it has not judged counts as on the path. Half, so that neither can take the other's time: which
/// one needs more is not known beforehand.
constexpr double kShareOfClasses = 0.5;

/// Of all work, kept for the covariance of what is told: an answer that was cut is AMBIGUOUS, but
/// its uncertainty holds. A deviation that neighbours share takes at most 16 passes over the points
/// that stand for the samples (coherent_moment.h): half a clean ellipse or less.
constexpr double kShareOfMoments = 0.5 / kMostWork;

}  // namespace

class Recognizer::Impl {
 public:
  explicit Impl(const RecognizerOptions& options) : options_(options), memory_(options.memory) {}

  AddResult add(const PatchContext& context, std::span<const ContactSample> samples,
                std::span<const SampleDetail> details) {
    if (stream_) {
      stream_->add(context, samples, details);
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
    last_.forget();
    kept_ = {};
    if (stream_) {
      stream_->clear();
    }
  }

  Recognition recognize() {
    WorkBudget work = work_limit(memory_.patches(), options_.patience);
    Recognition answer = look(work);
    if (work.was_cut() && answer.status != RecognitionStatus::Collecting) {
      answer.status = RecognitionStatus::Ambiguous;
      answer.doubt = Doubt::WorkLimit;
    }
    answer.work = work;
    answer.sample_count = memory_.sample_count();
    answer.dwelling_count = clean_.dwelling_count();
    answer.forgotten_count = forgotten_;
    return answer;
  }

 private:
  /// The method, from stored samples to the answer: core/README.md, "The method on one page".
  Recognition look(WorkBudget& work) {
    const std::vector<StoredPatch>& clean = cleaned(work);
    Touched touched{make_fit_data(clean, options_.sigma_m), clean};
    if (!can_answer(touched.data, memory_.patches().size())) {
      return collecting(touched.data);
    }
    JoinedTouches joined = joined_touches(clean, options_.sigma_m, options_.classes, work);
    if (joined.patches) {
      touched = {make_fit_data(*joined.patches, options_.sigma_m), *joined.patches};
    }
    if (joined.start) {  // of the tips' centres
      touched.sought = {{std::vector<int>(touched.patches.size(), 0), *std::move(joined.start)}};
    }
    const bool by_evidence = options_.method == RecognitionMethod::MaximumLikelihood;
    Recognition answer = by_evidence ? by_likelihood(touched, work) : by_tree(touched, work);
    answer = with_sample_doubts(std::move(answer), touched.data, clean, by_evidence);
    // Told of the samples as they came, not of the means that stand for them, and no smaller than
    // their rounding.
    answer.sigma_m = told_noise_m(answer.sigma_m, touched.data);
    return answer;
  }

  Recognition by_likelihood(const Touched& touched, WorkBudget& work) {
    const Weighed weighed = counted(touched, work);
    const std::span<const StoredPatch> used = patches_of(weighed, touched.patches);
    const Weighing& w = weighed.w;
    const BestMoments moments = moments_within(w, work);
    Recognition answer = answer_by_likelihood(
        w, moments, {options_.recognized_probability, options_.determined_fraction},
        clean_.moved_count());
    answer = with_set_aside(std::move(answer), clean_.moved(), used, weighed);
    answer.simplified_count =
        touched.data.noise_is_stated ? contacts_with_details(w.data) : simplified_;
    answer.contacts = contacts_.of(
        used, w.sides, weighed.outliers,
        contact_options(told_deviation_m(moments, w.data.scale), in_steps(w.smooth.noise_time)));
    answer = with_tree_path(std::move(answer), w, options_.tree);
    localise_contacts(answer.shape, answer.world_T_curve, &answer.contacts);
    return answer;
  }

  Recognition by_tree(const Touched& touched, WorkBudget& work) {
    FitData data = touched.data;
    const FitData reduced = fit_smooth_model(&data, data.noise_is_stated).reduced;
    const auto contacts_of = [&](const std::vector<int>& sides) {
      return contacts_.of(touched.patches, sides, {}, contact_options());
    };
    Recognition answer =
        answer_by_tree(possible_sides(touched.patches, reduced, turns_of(reduced), {}, work).ways,
                       contacts_of, options_.tree, data.scale, options_.determined_fraction);
    answer.simplified_count = simplified_;
    return with_set_aside(std::move(answer), clean_.moved(), touched.patches);
  }

  /// What there is to say while too little is touched.
  Recognition collecting(const FitData& data) const {
    Recognition answer;
    answer.simplified_count = simplified_;
    // What is stated is known, and may be why: noise larger than the part leaves one place.
    if (data.noise_is_stated && !data.points.empty()) {
      answer.sigma_m = told_noise_m(rms_sigma(data) * data.scale, data);
    }
    return answer;
  }

  const std::vector<StoredPatch>& cleaned(WorkBudget& work) {
    const WorkBudget::Reserve for_classes(work, kShareOfClasses);
    clean_.update(memory_.patches(),
                  {options_.sigma_m, options_.form_deviation_m, options_.false_outlier_probability},
                  work);
    return clean_.clean();
  }

  Weighed counted(const Touched& touched, WorkBudget& work) {
    const WorkBudget::Reserve for_moments(work, kShareOfMoments);
    const CountedSamples samples(counting_options(), clean_);
    return last_.followed_or_searched(samples, touched, {memory_.sample_count(), forgotten_},
                                      options_.recognized_probability, work);
  }

  static BestMoments moments_within(const Weighing& w, WorkBudget& work) {
    BestMoments moments = moments_of_best(w, work);
    // A part of a valley is no moment: what the noise leaves is told.
    return work.allows() ? moments : BestMoments{};
  }

  /// Noise of a sample as it came, where `sigma_m` is that of the means that stand for several; no
  /// less than the rounding of readings whose noise nobody states. [m]
  double told_noise_m(double sigma_m, const FitData& data) const {
    const double least_m = data.noise_is_stated ? 0.0 : data.reading_noise * data.scale;
    return std::max(sigma_m, least_m) * noise_over_means(clean_.clean(), options_.sigma_m);
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
  std::size_t forgotten_ = 0;   ///< samples, since the object began
  std::size_t simplified_ = 0;  ///< likewise, those with details
  CleanPatches clean_;
  PatchContacts contacts_;
  LastWeighing last_;
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
