#include "core/part/segment_match.h"

#include <algorithm>
#include <cmath>

#include "core/numerics/probability/chi_square.h"
#include "core/part/part_placement.h"
#include "core/part/part_slides.h"
#include "core/part/touch_posterior.h"
#include "core/recognition/samples/cleaned/stored_spikes.h"
#include "core/recognition/smooth/residual_correlation.h"
#include "core/recognition/smooth/smooth_model.h"

namespace palpate {
namespace {

/// Fewest degrees of freedom for an estimate of the noise: its relative standard deviation is then
/// about 1/3.
constexpr int kFewestNoiseDegrees = 4;

/// The patches without spikes, and a flag per given sample that says whether it was a spike.
struct Despiked {
  std::vector<StoredPatch> patches;
  std::vector<std::vector<bool>> is_spike;
};

Despiked despiked(std::span<const StoredPatch> patches, double sigma_m, double false_alarm) {
  Despiked clean;
  for (const StoredPatch& patch : patches) {
    WorkBudget unbounded;
    clean.is_spike.push_back(spikes_of(patch, sigma_m, false_alarm, unbounded));
    clean.patches.push_back(without_spikes(patch, clean.is_spike.back()));
  }
  return clean;
}

/// The patch with the longest chord, among those that have samples.
std::size_t longest_patch(const FitData& data) {
  std::size_t longest = 0;
  double length = -1.0;
  for (std::size_t p = 0; p < data.patches.size(); ++p) {
    const auto patch = data.patch(p);
    const double chord = (patch.back().position - patch.front().position).norm();
    if (chord > length) {
      longest = p;
      length = chord;
    }
  }
  return longest;
}

/// Index of the middle of a patch among the points.
std::size_t middle_of(const FitData& data, std::size_t patch) {
  return data.patches[patch].begin + data.patches[patch].size() / 2;
}

/// Whether a polynomial follows the samples around a point, so that its tangent is known. Of single
/// touches, and of touches too few for the bends between them, none does.
bool is_followed(const SmoothModel& smooth, std::size_t point) {
  return !section_of(smooth, point).kept;
}

bool lie_at_one_place(std::span<const FitPoint> points) {
  return std::all_of(points.begin(), points.end(), [&](const FitPoint& point) {
    return point.position == points.front().position;
  });
}

/// Material lies left of increasing t if the outside lies right.
TravelDirections directions_of(MaterialSide side, const ScaledPart& part) {
  if (side == MaterialSide::Unspecified) {
    return {};
  }
  const bool along = (side == MaterialSide::Left) == (part.outside() < 0.0);
  return {along, !along};
}

class Match {
 public:
  Match(const ClosedSpline& part, std::span<const StoredPatch> patches,
        const SegmentMatchOptions& options)
      : part_(part),
        given_(patches),
        options_(options),
        clean_(despiked(patches, options.sigma_m, spike_probability(patches, options))) {
    smooth();
    if (take_back_spikes()) {
      smooth();
    }
  }

  /// The answer, by noise of which so many neighbours err together as residuals about the best
  /// placement show, where the sections show that they do. Polynomials take the slowest of it.
  SegmentMatch answer() {
    constexpr double kSame = 1.25;  // times that count alike
    SegmentMatch match = answer_by_noise();
    const bool is_shown = smooth_.noise_time * smooth_.chi2 >
                          kLeastNoiseShown * static_cast<double>(data_.points.size());
    if (smooth_.noise_time > 1.0 && is_shown && !match.placements.empty()) {
      const double time = time_about(match.placements.front());
      if (time > kSame * smooth_.noise_time) {
        scale_noise(std::sqrt(time / smooth_.noise_time), &data_, &smooth_);
        smooth_.noise_time = time;
        match = answer_by_noise();
      }
    }
    return match;
  }

 private:
  static double time_about(const PartPlacement& placement) {
    std::vector<RunOfResiduals> runs;
    for (const PatchOnPart& patch : placement.patches) {
      RunOfResiduals& run = runs.emplace_back();
      for (const SamplePlace& sample : patch.samples) {
        if (!sample.is_outlier) {
          run.residuals.push_back(sample.residual);
        }
      }
    }
    return correlation_time(runs);
  }

  SegmentMatch answer_by_noise() const {
    SegmentMatch match;
    const int n = static_cast<int>(data_.points.size());
    if (n <= kPoseDegrees || !noise_known_) {
      return match;
    }
    match.sigma_m = rms_sigma(data_) * data_.scale;
    const ScaledPart part(part_, data_.scale);
    const std::size_t longest = longest_patch(data_);
    match.longest_patch = given_number(longest);
    if (lie_at_one_place(data_.points)) {
      return match;
    }
    const std::size_t middle = middle_of(data_, longest);
    FitPoint reference = data_.points[middle];
    if (!is_followed(smooth_, middle)) {
      reference.tangent.setZero();
    }
    const MaterialSide side = given_[match.longest_patch].context.material_side;
    const std::span<const FitPoint> points = smooth_.reduced.points;
    const SlidePosterior posterior =
        reference.tangent.isZero()
            ? touch_posterior(part, points, reference)
            : slide_posterior(part, points, reference, directions_of(side, part));
    match.segment_probability = posterior.segment_probability;
    for (const PartCandidate& candidate : posterior.candidates) {
      if (candidate.probability < options_.least_probability) {
        break;
      }
      PartPlacement placement =
          placement_of({given_, clean_.is_spike, data_, smooth_}, part, candidate, reference);
      if (agrees_with_material(placement, part)) {
        match.placements.push_back(std::move(placement));
      }
    }
    normalise(&match.placements);
    judge(&match);
    return match;
  }

  static double spike_probability(std::span<const StoredPatch> patches,
                                  const SegmentMatchOptions& options) {
    return options.false_outlier_probability /
           static_cast<double>(std::max<std::size_t>(patches.size(), 1));
  }

  /// The data without spikes, their smooth model and their noise.
  void smooth() {
    data_ = make_fit_data(clean_.patches, options_.sigma_m);
    if (data_.points.empty()) {
      return;
    }
    // A stated noise is what the verdict tests against. Were it thought too low where samples are
    // few, polynomials would be taken for their path that miss it by far.
    smooth_ = fit_smooth_model(&data_, data_.noise_is_stated, StatedNoise::Holds);
    noise_known_ = data_.noise_is_stated || smooth_.dof() >= kFewestNoiseDegrees;
    if (!data_.noise_is_stated) {
      const double sigma = std::max(smooth_.noise_ratio(), rounding_level(data_));
      scale_noise(sigma, &data_, &smooth_);
    }
    // Of samples that err together each counts as one in so many, of a noise as much larger.
    scale_noise(std::sqrt(smooth_.noise_time), &data_, &smooth_);
  }

  /// A spike is told by the smooth path of its neighbours. Where no polynomial follows most samples
  /// of a patch, as of few touches round a part, none is: up to half of the touches would be set
  /// aside, and the rest fit another part. Returns whether any was.
  bool take_back_spikes() {
    std::vector<std::size_t> taken_back;
    for (std::size_t p = 0; p < data_.patches.size(); ++p) {
      const PatchSpan& patch = data_.patches[p];
      std::size_t followed = 0;
      for (std::size_t i = patch.begin; i < patch.end; ++i) {
        followed += is_followed(smooth_, i);
      }
      const std::size_t number = given_number(p);
      if (2 * followed < patch.size() &&
          clean_.patches[number].samples.size() < given_[number].samples.size()) {
        taken_back.push_back(number);
      }
    }
    for (const std::size_t number : taken_back) {
      clean_.patches[number] = given_[number];
      clean_.is_spike[number].assign(given_[number].samples.size(), false);
    }
    return !taken_back.empty();
  }

  /// Index of a patch of data_ among the given patches; data_ has no empty patches.
  std::size_t given_number(std::size_t patch) const {
    std::size_t number = 0;
    for (std::size_t left = patch;; ++number) {
      if (!clean_.patches[number].samples.empty() && left-- == 0) {
        return number;
      }
    }
  }

  bool agrees_with_material(const PartPlacement& placement, const ScaledPart& part) const {
    for (std::size_t p = 0; p < given_.size(); ++p) {
      const TravelDirections allowed = directions_of(given_[p].context.material_side, part);
      const PatchOnPart& place = placement.patches[p];
      if (place.samples.size() > 1 &&
          !(place.along_increasing_t ? allowed.along : allowed.against)) {
        return false;
      }
    }
    return true;
  }

  static void normalise(std::vector<PartPlacement>* placements) {
    double sum = 0.0;
    for (const PartPlacement& placement : *placements) {
      sum += placement.probability;
    }
    for (PartPlacement& placement : *placements) {
      placement.probability /= sum;
    }
  }

  /// Two tests of one hypothesis, each at half the significance.
  bool fits(const PartPlacement& placement) const {
    const double half = 0.5 * options_.significance;
    return chi_square_survival(placement.chi2, placement.dof) >= half &&
           chi_square_survival(placement.misfit_chi2, placement.misfit_dof) >= half;
  }

  void judge(SegmentMatch* match) const {
    const std::vector<PartPlacement>& placements = match->placements;
    if (std::none_of(placements.begin(), placements.end(),
                     [&](const PartPlacement& placement) { return fits(placement); })) {
      match->status = SegmentMatchStatus::NoMatch;
      return;
    }
    const PartPlacement& best = placements.front();
    const auto begin = static_cast<double>(best.patches[match->longest_patch].segment);
    const double length = part_.arc_length(begin, begin + 1.0);
    if (best.probability < options_.determined_probability || !fits(best)) {
      match->doubt = SegmentMatchDoubt::SeveralPlacements;
    } else if (!(best.slide_sd_m <= options_.determined_slide * length &&
                 best.nonlinearity <= options_.determined_nonlinearity)) {
      match->doubt = SegmentMatchDoubt::SlidesAlong;
    }
    match->status = match->doubt == SegmentMatchDoubt::None ? SegmentMatchStatus::Determined
                                                            : SegmentMatchStatus::Ambiguous;
  }

  const ClosedSpline& part_;
  std::span<const StoredPatch> given_;
  SegmentMatchOptions options_;
  Despiked clean_;
  FitData data_;
  SmoothModel smooth_;
  bool noise_known_ = true;
};

}  // namespace

std::string_view name_of(SegmentMatchStatus status) {
  switch (status) {
    case SegmentMatchStatus::TooFewSamples:
      return "too_few_samples";
    case SegmentMatchStatus::NoMatch:
      return "no_match";
    case SegmentMatchStatus::Ambiguous:
      return "ambiguous";
    case SegmentMatchStatus::Determined:
      return "determined";
  }
  return "";
}

std::string_view name_of(SegmentMatchDoubt doubt) {
  switch (doubt) {
    case SegmentMatchDoubt::None:
      return "none";
    case SegmentMatchDoubt::SeveralPlacements:
      return "several_placements";
    case SegmentMatchDoubt::SlidesAlong:
      return "slides_along";
  }
  return "";
}

SegmentMatch match_segment(const ClosedSpline& part, std::span<const StoredPatch> patches,
                           const SegmentMatchOptions& options) {
  return Match(part, patches, options).answer();
}

}  // namespace palpate
