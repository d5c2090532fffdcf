#include "core/recognition/recognizer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/numerics/chi_square.h"
#include "core/numerics/normal_law.h"
#include "core/recognition/estimate_stream.h"
#include "core/recognition/outliers.h"
#include "core/recognition/samples/explained_spikes.h"
#include "core/recognition/samples/stored_spikes.h"
#include "core/recognition/samples/tip_sides.h"
#include "core/recognition/verdict/determined.h"
#include "core/recognition/weigh/weigh.h"

namespace palpate {
namespace {

/// Fewer points than this fit almost anything.
constexpr std::size_t kFewestSamples = 8;

/// Whether the points lie at enough different places, over an extent that double precision
/// resolves, to have a shape at all.
bool have_extent(const FitData& data) {
  std::array<Vec2, kFewestSamples> places;
  std::size_t distinct = 0;
  for (const FitPoint& point : data.points) {
    const auto end = places.begin() + static_cast<std::ptrdiff_t>(distinct);
    if (std::find(places.begin(), end, point.position) == end) {
      places[distinct++] = point.position;
      if (distinct == kFewestSamples) {
        break;
      }
    }
  }
  // A shape of five parameters needs digits: a thousand roundings across.
  constexpr double kMostRounding = 1e-3;
  // Squares of coordinates and of their inverses must be numbers.
  constexpr double kSmallest = 1e-100;
  constexpr double kLargest = 1e100;
  return distinct == kFewestSamples && rounding_level(data) < kMostRounding &&
         data.scale > kSmallest && data.scale < kLargest;
}

/// Whether noise of the stated size can have left this chi-square (five standard deviations).
bool is_noise(double chi2, double dof) { return chi2 <= dof + 5.0 * std::sqrt(2.0 * dof); }

/// Noise of the typical sample; where it was estimated, by the best class's residuals. [m]
double residual_noise_m(const Weighing& w) {
  return w.sigma * w.data.scale * (w.correlation_length > 0.0 ? 1.0 : std::sqrt(w.noise_inflation));
}

Hypothesis to_hypothesis(const Weighing& w, CurveClass curve_class) {
  const auto i = static_cast<std::size_t>(curve_class);
  Hypothesis hypothesis;
  hypothesis.shape.curve_class = curve_class;
  hypothesis.probability = w.probabilities[i];
  if (curve_class == CurveClass::Unclassified) {
    hypothesis.chi2 = w.smooth.chi2;
    hypothesis.dof = w.smooth.dof();
    return hypothesis;
  }
  hypothesis.chi2 = w.fits[i]->chi2;
  hypothesis.dof = static_cast<int>(w.data.points.size()) - degrees_of_freedom(curve_class);
  hypothesis.at_limit = w.fits[i]->at_limit;
  if (const auto& canonical = w.canonical[i]) {
    hypothesis.shape = canonical->shape;
    hypothesis.world_T_curve = canonical->world_T_curve;
    hypothesis.covariance = w.inflation * canonical->covariance;
  }
  return hypothesis;
}

void add_path(TreeResult tree, Recognition* answer) {
  answer->decisions = std::move(tree.decisions);
  answer->tree_class = tree.shape.curve_class;
  answer->tree_p_values = tree.p_values;
  answer->invariants = std::move(tree.invariants);
  answer->pooled_contacts = std::move(tree.pooled);
}

/// One flag per point of `all`: not in `kept`, which has the others in their order.
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

/// Where the classes' fits on the samples lie.
KnownCurves curves_of(const Weighing& w) {
  KnownCurves curves;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    if (const auto& canonical = w.canonical[i]) {
      curves[i] = CurveStart{canonical->shape.values, canonical->world_T_curve.theta};
    }
  }
  return curves;
}

/// That chance alone makes the leaf's test as bad.
double tail_probability(const TreeResult& tree) { return chi_square_survival(tree.chi2, tree.dof); }

}  // namespace

class Recognizer::Impl {
 public:
  explicit Impl(const RecognizerOptions& options) : options_(options), memory_(options.memory) {}

  AddResult add(const PatchContext& context, std::span<const ContactSample> samples) {
    if (stream_) {
      stream_->add(context, samples);
    }
    return memory_.add(context, samples);
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
    return stream_->take([&](std::uint32_t probe, std::uint32_t patch) {
      const auto found = std::find_if(clean_.begin(), clean_.end(), [&](const StoredPatch& known) {
        return known.context.probe == probe && known.context.patch == patch;
      });
      const auto p = static_cast<std::size_t>(found - clean_.begin());
      return p < clean_states_.size() ? clean_states_[p].side : 0;
    });
  }

  void reset() {
    memory_.clear();
    clean_.clear();
    clean_states_.clear();
    last_.reset();
    if (stream_) {
      stream_->clear();
    }
  }

  Recognition recognize() {
    Recognition answer;
    answer.sample_count = memory_.sample_count();
    const std::vector<StoredPatch>& patches = clean_patches();
    bool sigma_known = false;
    const FitData data = make_fit_data(patches, options_.sigma_m, &sigma_known);
    if (data.points.size() < kFewestSamples || !have_extent(data)) {
      return answer;
    }
    if (options_.method == RecognitionMethod::Tree) {
      answer.outlier_count = memory_.stored_count() - data.points.size();
      walk_tree(data, sigma_known, patches, &answer);
      return answer;
    }
    std::vector<bool> outliers;
    Weighing w = weigh_once_more(data, sigma_known, patches, &outliers);
    if (memory_.stored_count() > data.points.size()) {
      take_back_explained(patches, &w);
    }
    answer.outlier_count = memory_.stored_count() - w.data.points.size();
    fill(w, &answer);
    answer.contacts = contacts_of(patches, w.sides, outliers);
    add_path(tree_of(answer.contacts, curves_of(w)), &answer);
    const double p_value = answer.tree_p_values[static_cast<std::size_t>(answer.shape.curve_class)];
    if (answer.status == RecognitionStatus::Recognized && p_value < options_.tree.significance) {
      answer.status = RecognitionStatus::Ambiguous;
      answer.doubt = Doubt::TreeRejects;
    }
    localise_contacts(answer.shape, answer.world_T_curve, &answer.contacts);
    return answer;
  }

 private:
  /// What the last weighing left.
  struct Last {
    std::vector<SidedStart> starts;
    ClassProbabilities probabilities{};
    std::size_t samples = 0;  ///< at the last search
    std::size_t patches = 0;
  };

  /// From the last weighing while the object is touched on in the same patches; from a new search
  /// where they have grown by this, where there is another patch, and where a class comes out best
  /// that was out.
  Weighing weigh_once_more(const FitData& data, bool sigma_known,
                           std::span<const StoredPatch> patches, std::vector<bool>* outliers) {
    constexpr double kGrowth = 1.25;
    constexpr double kOut = 0.01;  // probability
    const std::size_t samples = memory_.sample_count();
    const bool warm = last_ && last_->patches == data.patches.size() &&
                      static_cast<double>(samples) <= kGrowth * static_cast<double>(last_->samples);
    if (warm) {
      Weighing w = weigh_without_outliers(data, sigma_known, patches, last_->starts, outliers);
      if (last_->probabilities[static_cast<std::size_t>(w.best)] > kOut) {
        last_->starts = w.starts;
        last_->probabilities = w.probabilities;
        return w;
      }
    }
    Weighing w = weigh_without_outliers(data, sigma_known, patches, {}, outliers);
    last_ = Last{w.starts, w.probabilities, samples, data.patches.size()};
    return w;
  }

  /// `outliers`: one flag per sample of the patches; empty where there are none.
  Weighing weigh_without_outliers(const FitData& data, bool sigma_known,
                                  std::span<const StoredPatch> patches,
                                  std::span<const SidedStart> starts,
                                  std::vector<bool>* outliers) const {
    outliers->clear();
    Weighing w = weigh(data, sigma_known, patches, weigh_options(), starts);
    if (const auto kept = without_outliers(w, data, options_.false_outlier_probability)) {
      // A search is not followed: the outliers may have led it astray.
      const std::vector<SidedStart> nearer =
          starts.empty() ? std::vector<SidedStart>{} : std::move(w.starts);
      w = weigh(*kept, sigma_known, patches, weigh_options(), nearer);
      *outliers = left_out(data, *kept);
    }
    return w;
  }

  WeighOptions weigh_options() const {
    return {options_.classes, options_.recognized_probability, options_.form_deviation_m};
  }

  /// Weighs again with the spikes that the best class explains; that stands where the class does.
  void take_back_explained(std::span<const StoredPatch> patches, Weighing* w) const {
    const auto& best = w->canonical[static_cast<std::size_t>(w->best)];
    const auto curve = best ? make_curve(w->best, best->shape.values) : std::nullopt;
    if (!curve) {
      return;
    }
    const double noise_m = residual_noise_m(*w);
    const double limit = two_sided_normal_quantile(options_.false_outlier_probability /
                                                   static_cast<double>(memory_.stored_count()));
    const auto more = with_explained_spikes(memory_.patches(), patches, *curve, best->world_T_curve,
                                            noise_m, limit);
    if (!more) {
      return;
    }
    bool sigma_known = false;
    const FitData data = make_fit_data(*more, options_.sigma_m, &sigma_known);
    std::vector<bool> outliers;
    Weighing again = weigh_without_outliers(data, sigma_known, *more, last_->starts, &outliers);
    if (again.best == w->best && again.canonical[static_cast<std::size_t>(again.best)]) {
      *w = std::move(again);
    }
  }

  /// What is known of a patch without its spikes, as long as the patch stays as it is.
  struct CleanPatch {
    std::size_t stored = 0;
    double contacts_per_sample = 0.0;
    Vec2 newest_m = Vec2::Zero();
    std::vector<LocalizedContact> contacts = {};
    std::size_t windows = 0;  ///< that the contacts are of; 0 = there are none yet
    int side = 0;
    std::vector<bool> outliers = {};  ///< that the contacts are without
  };

  const std::vector<StoredPatch>& clean_patches() {
    const std::vector<StoredPatch>& patches = memory_.patches();
    clean_.resize(patches.size());
    clean_states_.resize(patches.size());
    for (std::size_t p = 0; p < patches.size(); ++p) {
      const StoredPatch& patch = patches[p];
      CleanPatch& state = clean_states_[p];
      const bool same = state.stored == patch.samples.size() &&
                        state.contacts_per_sample == patch.contacts_per_sample &&
                        state.newest_m == patch.newest_m &&
                        clean_[p].context.probe == patch.context.probe &&
                        clean_[p].context.patch == patch.context.patch;
      if (!same) {
        clean_[p] = patch;
        clean_[p].samples = without_spikes(
            patch.samples, spikes_of(patch.samples, options_.false_outlier_probability));
        state = {patch.samples.size(), patch.contacts_per_sample, patch.newest_m};
      }
    }
    return clean_;
  }

  /// Of the clean patches without `outliers` (one flag per sample, or none): what was estimated of
  /// a patch stays while the patch does.
  std::vector<LocalizedContact> contacts_of(const std::vector<StoredPatch>& patches,
                                            const std::vector<int>& sides,
                                            const std::vector<bool>& outliers = {}) {
    const ContactOptions options = contact_options();
    const std::size_t windows = windows_of_a_patch(patches.size(), options);
    std::vector<LocalizedContact> contacts;
    std::size_t first = 0;  // sample of the patch among all
    for (std::size_t p = 0; p < patches.size(); ++p) {
      CleanPatch& state = clean_states_[p];
      const int side = p < sides.size() ? sides[p] : 0;
      std::vector<bool> own;
      if (!outliers.empty()) {
        const auto begin = outliers.begin() + static_cast<std::ptrdiff_t>(first);
        own.assign(begin, begin + static_cast<std::ptrdiff_t>(patches[p].samples.size()));
      }
      first += patches[p].samples.size();
      const bool some = std::find(own.begin(), own.end(), true) != own.end();
      if (!some) {
        own.clear();
      }
      if (state.windows != windows || state.side != side || state.outliers != own) {
        state.contacts.clear();
        if (some) {
          StoredPatch rest = patches[p];
          rest.samples = without_spikes(patches[p].samples, own);
          add_contacts(rest, windows, side, options, &state.contacts);
        } else {
          add_contacts(patches[p], windows, side, options, &state.contacts);
        }
        state.windows = windows;
        state.side = side;
        state.outliers = std::move(own);
      }
      contacts.insert(contacts.end(), state.contacts.begin(), state.contacts.end());
    }
    return contacts;
  }

  ContactOptions contact_options() const {
    ContactOptions options = options_.contacts;
    options.sigma_m = options_.sigma_m;
    options.form_deviation_m = options_.form_deviation_m;
    return options;
  }

  /// The tree over the contacts, whose windows share no sample.
  TreeResult tree_of(const std::vector<LocalizedContact>& contacts,
                     const KnownCurves& known = {}) const {
    std::vector<TreePoint> points;
    int patch = 0;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      if (i > 0 && (contacts[i].probe != contacts[i - 1].probe ||
                    contacts[i].patch != contacts[i - 1].patch)) {
        ++patch;
      }
      points.push_back({contacts[i].estimate, patch});
    }
    SplineOptions spline;
    if (options_.method == RecognitionMethod::MaximumLikelihood) {
      spline.fallback_starts = 0;  // the path is reported only: not worth the time
    }
    return recognise_by_tree(points, options_.tree, known, spline);
  }

  /// The paper's way: nothing but the tree's answer. Where a round tip's side is not told, every
  /// way that it may lie is walked; a second one that ends in a class leaves a doubt.
  void walk_tree(FitData data, bool sigma_known, const std::vector<StoredPatch>& patches,
                 Recognition* answer) {
    const double extent_m = data.scale;
    const FitData reduced = fit_smooth_model(&data, sigma_known).reduced;
    TreeResult tree;
    std::size_t classes = 0;
    for (const std::vector<int>& sides : possible_sides(patches, reduced)) {
      std::vector<LocalizedContact> contacts = contacts_of(patches, sides);
      TreeResult walked = tree_of(contacts);
      const bool ends = walked.status == InvariantStatus::Ok &&
                        walked.shape.curve_class != CurveClass::Unclassified;
      const bool better =
          ends && (classes == 0 || tail_probability(walked) > tail_probability(tree));
      classes += ends ? 1 : 0;
      if (better || answer->contacts.empty()) {
        tree = std::move(walked);
        answer->contacts = std::move(contacts);
      }
    }
    answer->shape = tree.shape;
    double squares = 0.0;
    for (const LocalizedContact& contact : answer->contacts) {
      squares += contact.estimate.sigma_m * contact.estimate.sigma_m;
    }
    if (!answer->contacts.empty()) {
      answer->sigma_m = std::sqrt(squares / static_cast<double>(answer->contacts.size()));
    }
    const auto letters =
        static_cast<Eigen::Index>(parameter_letters(tree.shape.curve_class).size());
    // The tree does not propagate the pose's: what is not known has an infinite variance.
    answer->covariance = ShapePoseCovariance::Zero(letters + 3, letters + 3);
    answer->covariance.topLeftCorner(letters, letters) =
        tree.covariance.topLeftCorner(letters, letters);
    answer->covariance.diagonal().tail<3>().setConstant(std::numeric_limits<double>::infinity());
    const bool told =
        tree.status == InvariantStatus::Ok && tree.world_T_curve &&
        is_determined(tree.shape, answer->covariance, extent_m, options_.determined_fraction);
    answer->doubt = classes > 1 ? Doubt::TwoShapes : told ? Doubt::None : Doubt::Undetermined;
    answer->status =
        answer->doubt == Doubt::None ? RecognitionStatus::Recognized : RecognitionStatus::Ambiguous;
    Hypothesis only;
    only.shape = tree.shape;
    only.covariance = answer->covariance;
    only.probability = 1.0;
    only.chi2 = tree.chi2;
    only.dof = tree.dof;
    if (tree.world_T_curve) {
      answer->world_T_curve = only.world_T_curve = *tree.world_T_curve;
      localise_contacts(answer->shape, answer->world_T_curve, &answer->contacts);
    }
    answer->hypotheses.push_back(only);
    add_path(std::move(tree), answer);
  }

  void fill(const Weighing& w, Recognition* answer) const {
    for (std::size_t i = 0; i < w.probabilities.size(); ++i) {
      if (i == 0 || w.fits[i]) {
        answer->hypotheses.push_back(to_hypothesis(w, static_cast<CurveClass>(i)));
      }
    }
    std::stable_sort(
        answer->hypotheses.begin(), answer->hypotheses.end(),
        [](const Hypothesis& a, const Hypothesis& b) { return a.probability > b.probability; });
    Hypothesis& best = answer->hypotheses.front();
    const auto& canonical = w.canonical[static_cast<std::size_t>(best.shape.curve_class)];
    if (canonical && w.moment) {
      best.covariance = *w.moment;
    }
    answer->shape = best.shape;
    answer->world_T_curve = best.world_T_curve;
    answer->covariance = best.covariance;
    answer->sigma_m = residual_noise_m(w);
    answer->noise_correlation_m = w.correlation_length * w.data.scale;
    answer->doubt = doubt_about(w, best);
    answer->status =
        answer->doubt == Doubt::None ? RecognitionStatus::Recognized : RecognitionStatus::Ambiguous;
  }

  /// What speaks against a class that is more probable than all others.
  Doubt doubt_about(const Weighing& w, const Hypothesis& best) const {
    // A misfit that is no noise may be form error, or another class: the data cannot tell.
    if (w.correlation_length > 0.0) {
      return Doubt::FormError;
    }
    if (!(best.probability >= options_.recognized_probability)) {
      return Doubt::SeveralClasses;
    }
    const CurveClass curve_class = best.shape.curve_class;
    // Where so many samples had to be set aside, what fits badly may be spikes that were not.
    constexpr double kManySpikes = 0.1;  // of the samples
    const auto stored = static_cast<double>(memory_.stored_count());
    const bool many_spikes =
        stored - static_cast<double>(w.data.points.size()) > kManySpikes * stored;
    if (many_spikes && !is_noise(w.counted_chi2, best.dof)) {
      return Doubt::Misfit;
    }
    if (curve_class == CurveClass::Unclassified) {
      if (!(w.margin_of_unclassified >= log_odds(options_.recognized_probability))) {
        return Doubt::SeveralClasses;
      }
      // What not even the smooth model follows says nothing about classes.
      return many_spikes || !is_noise(best.chi2, best.dof) ? Doubt::Misfit : Doubt::None;
    }
    if (best.at_limit || best.covariance.size() == 0) {
      return Doubt::AtLimit;
    }
    if (!is_noise(w.counted_chi2 / w.noise_inflation, best.dof)) {
      return Doubt::Misfit;
    }
    // A second mode that has more than what RECOGNIZED leaves to doubt.
    const double odds = log_odds(options_.recognized_probability);
    const bool has_rival = curve_class == CurveClass::CubicSpline &&
                           w.rival_share > 1.0 - options_.recognized_probability;
    if (has_rival || w.sides_margin / w.noise_inflation <= odds) {
      return Doubt::TwoShapes;
    }
    const bool means_something =
        is_determined(best.shape, best.covariance, w.data.scale, options_.determined_fraction);
    return means_something ? Doubt::None : Doubt::Undetermined;
  }

  RecognizerOptions options_;
  SampleMemory memory_;
  std::vector<StoredPatch> clean_;  ///< the memory's patches without spikes
  std::vector<CleanPatch> clean_states_;
  std::optional<Last> last_;
  std::optional<EstimateStream> stream_;
};

Recognizer::Recognizer(const RecognizerOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Recognizer::~Recognizer() = default;
Recognizer::Recognizer(Recognizer&&) noexcept = default;
Recognizer& Recognizer::operator=(Recognizer&&) noexcept = default;

AddResult Recognizer::add(const PatchContext& context, std::span<const ContactSample> samples) {
  return impl_->add(context, samples);
}

Recognition Recognizer::recognize() { return impl_->recognize(); }

void Recognizer::stream_estimates(bool on) { impl_->stream_estimates(on); }

std::vector<LocalizedContact> Recognizer::take_estimates() { return impl_->take_estimates(); }

void Recognizer::reset() { impl_->reset(); }

}  // namespace palpate
