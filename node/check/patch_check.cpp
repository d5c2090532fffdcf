#include "node/check/patch_check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/local/noise.h"
#include "core/numerics/quantile.h"
#include "core/recognition/samples/dwell_means.h"
#include "core/recognition/samples/stroke_order.h"
#include "node/check/normal_check.h"
#include "node/check/tip_check.h"
#include "node/files/counted.h"
#include "node/files/quantity.h"

namespace palpate {
namespace {

std::vector<double> spacings(const std::vector<Vec2>& positions) {
  std::vector<double> result;
  for (std::size_t i = 1; i < positions.size(); ++i) {
    result.push_back((positions[i] - positions[i - 1]).norm());
  }
  return result;
}

/// How often something was seen, and where first.
struct Seen {
  std::size_t count = 0;
  std::uint32_t first_patch = 0;

  void add(std::size_t times, const CheckedPatch& patch) {
    if (count == 0) first_patch = patch.number;
    count += times;
  }
};

/// What the patches of a probe show together.
struct SeenInPatches {
  double extent = 0.0;  ///< of a patch
  std::size_t longest = 0;
  std::size_t patches = 0;
  Seen jumps;
  Seen unordered;
  Seen unordered_within;  ///< to and fro over the patch alone
  std::size_t repeated = 0;
  Seen holes;
  double widest = 0.0;  ///< hole, in typical spacings
  std::size_t samples = 0;
  double noise_ratio = 0.0;  ///< largest of estimated over stated, or of stated over estimated
  double estimated_noise = 0.0;
  double stated_noise = 0.0;
  double largest_stated = 0.0;
  double coarsest = 0.0;
};

/// A lift-off is many spacings and of the size of the part.
constexpr double kJumpSpacings = 20.0;

/// A spike comes back at once, and the way back is no lift-off either.
std::size_t jumps_of(const std::vector<Vec2>& moved, double typical) {
  std::size_t jumps = 0;
  for (std::size_t i = 0; i + 1 < moved.size(); ++i) {
    const double step = (moved[i + 1] - moved[i]).norm();
    const auto is_away = [&](std::size_t from, std::size_t to) {
      return (moved[to] - moved[from]).norm() > 0.5 * step;
    };
    const bool stays =
        (i + 2 >= moved.size() || is_away(i, i + 2)) && (i == 0 || is_away(i - 1, i + 1));
    jumps += step > kJumpSpacings * typical && stays ? 1 : 0;
  }
  return jumps;
}

void see_holes(const CheckedPatch& patch, const std::vector<double>& steps, double typical,
               const NoiseEstimate& noise, SeenInPatches* seen) {
  // Noise alone widens a spacing too: by three standard deviations of a difference at most.
  constexpr double kHoleSpacings = 3.0;
  constexpr double kNoiseWidths = 3.0;
  const double by_noise =
      noise.status == LocalStatus::Ok ? kNoiseWidths * std::sqrt(2.0) * noise.sigma_m : 0.0;
  for (const double step : steps) {
    if (step > kHoleSpacings * typical + by_noise && step <= kJumpSpacings * typical) {
      seen->holes.add(1, patch);
      seen->widest = std::max(seen->widest, step / typical);
    }
  }
}

void see_noise(const CheckedPatch& patch, const NoiseEstimate& noise, SeenInPatches* seen) {
  if (noise.status != LocalStatus::Ok || noise.dof <= 20 || patch.with_sigma == 0) {
    return;
  }
  const double stated = patch.stated_sigma_m();
  const double ratio = std::max(noise.sigma_m / stated, stated / noise.sigma_m);
  if (ratio > seen->noise_ratio) {
    seen->noise_ratio = ratio;
    seen->estimated_noise = noise.sigma_m;
    seen->stated_noise = stated;
  }
}

void see_patch(const CheckedPatch& patch, double extent_of_all, SeenInPatches* seen) {
  seen->longest = std::max(seen->longest, patch.positions.size());
  seen->samples += patch.positions.size();
  seen->largest_stated = std::max(seen->largest_stated, patch.stated_sigma_m());
  if (patch.positions.size() < 2) {
    return;
  }
  Vec2 low = patch.positions.front();
  Vec2 high = low;
  for (const Vec2& p : patch.positions) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double extent = (high - low).norm();
  seen->extent = std::max(seen->extent, extent);
  const std::vector<double> all_steps = spacings(patch.positions);
  seen->repeated += static_cast<std::size_t>(std::count(all_steps.begin(), all_steps.end(), 0.0));
  // Of a probe that stands still spacings tell nothing.
  const std::vector<Vec2> moved = without_dwells(patch.positions);
  std::vector<double> steps = spacings(moved);
  std::erase(steps, 0.0);
  if (steps.empty()) {
    return;
  }
  std::vector<double> sorted = steps;
  const double typical = median_of(sorted);
  // A stroke no longer than its noise leads to and fro as well.
  constexpr double kLongStroke = 20.0;  // of the stated noise
  if (leads_to_and_fro(moved, extent_of_all)) {
    seen->unordered.add(1, patch);
  } else if (extent > kLongStroke * patch.stated_sigma_m() && leads_to_and_fro(moved, extent)) {
    seen->unordered_within.add(1, patch);
  }
  seen->jumps.add(jumps_of(moved, typical), patch);
  const NoiseEstimate noise = estimate_noise(patch.positions);
  see_holes(patch, steps, typical, noise, seen);
  seen->coarsest = std::max(seen->coarsest, typical / std::max(extent, typical));
  see_noise(patch, noise, seen);
}

SeenInPatches see_patches(const std::vector<CheckedPatch>& patches) {
  Eigen::AlignedBox2d box;
  for (const CheckedPatch& patch : patches) {
    for (const Vec2& position : patch.positions) box.extend(position);
  }
  const double extent_of_all = box.isEmpty() ? 0.0 : box.diagonal().norm();
  SeenInPatches seen;
  seen.patches = patches.size();
  for (const CheckedPatch& patch : patches) {
    see_patch(patch, extent_of_all, &seen);
  }
  return seen;
}

/// Tells what was seen.
class PatchFindings {
 public:
  PatchFindings(const std::string& probe, CheckedSource source, const SeenInPatches& seen,
                std::vector<Finding>* findings)
      : probe_(probe), source_(source), seen_(seen), findings_(findings) {}

  /// Whether lengths are those of a part that a touch probe strokes, in metres.
  void judge_units() const {
    constexpr double kLargestPart = 2.0;  // that a touch probe strokes [m]
    constexpr double kSmallestPart = 1e-5;
    if (seen_.extent > kLargestPart) {
      add_spoiling(Severity::Warning, "a patch extends over " + text_of_length(seen_.extent),
                   cure_of(source_, "coordinates are metres: were these millimetres?",
                           "were these millimetres? Then say --unit mm",
                           "were these millimetres? Then say unit=\"mm\""));
    }
    constexpr double kLargestProbeNoiseM = 1e-3;  // of a touch probe [m]
    if (seen_.estimated_noise > kLargestProbeNoiseM || seen_.largest_stated > kLargestProbeNoiseM) {
      add_spoiling(
          Severity::Error,
          "noise of " + text_of_length(std::max(seen_.estimated_noise, seen_.largest_stated)) +
              " is no touch probe's",
          cure_of(source_, "coordinates and sigma_m are metres: were these millimetres?",
                  "were these millimetres? Then say --unit mm; --sigma is metres whatever the unit",
                  "were these millimetres? Then say unit=\"mm\"; sigma is in that unit too"));
    }
    if (seen_.extent > 0.0 && seen_.extent < kSmallestPart) {
      add(Severity::Warning, "the longest patch extends over " + text_of_length(seen_.extent),
          "coordinates are metres: were these kilometres, or does the probe dwell?");
    }
  }

  /// Strokes that jump, or lead to and fro.
  void judge_order() const {
    if (seen_.jumps.count > 0) {
      add_spoiling(
          Severity::Error,
          counted(seen_.jumps.count, "jump") + " of more than 20 spacings within a patch" +
              first(seen_.jumps),
          cure_of(
              source_, "count patch up by one at each lift-off",
              "give each stroke a patch number of its own (column patch, or an empty line "
              "between strokes); rows in no order along the part are --touches",
              "give each stroke an array of its own (in the list of points) or a patch number of "
              "its own (Recognizer.add); points in no order "
              "along the part are touches=True"));
    }
    if (seen_.unordered.count > 0) {
      add_spoiling(
          Severity::Error,
          counted(seen_.unordered.count, "patch goes", "patches go") +
              " to and fro over the whole extent" + first(seen_.unordered),
          cure_of(source_,
                  "send the samples of a patch in their order along the part; single touches are "
                  "patches of their own",
                  "sort the rows of a stroke along the part; rows in no order are --touches",
                  "sort the points of a stroke along the part; points in no order are "
                  "touches=True"));
      findings_->back().has_no_order = true;
    }
    if (seen_.unordered_within.count > 0) {
      add_spoiling(Severity::Warning,
                   counted(seen_.unordered_within.count, "patch goes", "patches go") +
                       " to and fro over its own extent" + first(seen_.unordered_within),
                   cure_of(source_,
                           "send the samples of a patch in their order along the part, unless it "
                           "is no longer than their noise",
                           "were the rows sorted by a coordinate? Leave them in the order of the "
                           "stroke; a stroke that is no longer than its noise looks so, too",
                           "were the points sorted by a coordinate? Leave them in the order of "
                           "the stroke; one that is no longer than its noise looks so, too"));
    }
  }

  /// Whether there are samples enough along the arcs. `patches`: how many.
  void judge_density(std::size_t patches) const {
    constexpr std::size_t kShort = 20;
    const bool are_touches = source_ != CheckedSource::Stream && seen_.longest <= 1;
    if (are_touches) {
      add(Severity::Note, counted(patches, "single touch", "single touches"), "");
    } else if (seen_.longest < kShort) {
      add(Severity::Warning, "the longest patch has " + counted(seen_.longest, "sample"),
          "20 samples or more along an arc are needed for its curvature; 100 are good");
    }
    constexpr double kCoarse = 1.0 / 15.0;
    if (seen_.longest >= kShort && seen_.coarsest > kCoarse) {
      add(Severity::Note,
          "samples lie 1/" + number(std::round(1.0 / seen_.coarsest)) + " of their patch apart",
          "sample more densely: noise averages out over the samples");
    }
  }

  /// Holes and repeats.
  void judge_gaps() const {
    constexpr double kFewHoles = 0.01;  // of the samples: dropouts that do no harm
    if (seen_.holes.count > 0) {
      add(static_cast<double>(seen_.holes.count) > kFewHoles * static_cast<double>(seen_.samples)
              ? Severity::Warning
              : Severity::Note,
          counted(seen_.holes.count, "hole") + " of 3 to " + with_digits(seen_.widest, 2) +
              " typical spacings within a patch" + first(seen_.holes),
          cure_of(
              source_,
              "publish every contact at an even pace along the arc; a real lift-off needs a new "
              "patch",
              "a lift-off begins another patch; else give every sample along the arc",
              "a lift-off begins another patch; else give every sample along the arc"));
    }
    if (seen_.repeated > 0) {
      add(Severity::Note,
          counted(seen_.repeated, "sample") + " at exactly the place of the one before",
          cure_of(source_,
                  "they say nothing new and are dropped; publish contacts while the probe moves",
                  "they say nothing new and are dropped", "they say nothing new and are dropped"));
    }
  }

  /// Whether the stated noise is that of the samples.
  void judge_noise() const {
    constexpr double kNoiseOff = 2.0;
    const std::string what =
        cure_of(source_, "sigma_m says ", "the stated noise is ", "sigma is ") +
        text_of_length(seen_.stated_noise) + ", the samples scatter by " +
        text_of_length(seen_.estimated_noise);
    if (seen_.noise_ratio > kNoiseOff) {
      add(Severity::Warning, what,
          "state the noise as it is, or 0 to have it estimated: covariances and classes depend on "
          "it");
      // Of a noise that is stated too large the answer is doubtful more often, not wrong.
      findings_->back().spoils_answer = seen_.stated_noise < seen_.estimated_noise;
    } else if (seen_.noise_ratio > 0.0) {
      add(Severity::Note, what, "as it should be");
    }
  }

  /// That no noise is stated.
  void judge_silence() const {
    if (seen_.samples > 0 && seen_.largest_stated == 0.0) {
      add(Severity::Note,
          source_ == CheckedSource::Stream ? "sigma_m is 0: the noise is estimated"
                                           : "no noise is stated: it is estimated",
          cure_of(
              source_, "state it where it is known: fewer samples then suffice",
              "state it where it is known (--sigma of fit and replay, or a column sigma): fewer "
              "samples then suffice",
              "state it where it is known (sigma): fewer samples then suffice"));
    }
  }

 private:
  /// Which patch of several shows it, or shows it first.
  std::string first(const Seen& seen) const {
    if (seen_.patches < 2) return "";
    return (seen.count > 1 ? " (first in patch " : " (patch ") + std::to_string(seen.first_patch) +
           ")";
  }
  void add(Severity severity, std::string what, std::string cure) const {
    findings_->push_back({severity, probe_, std::move(what), std::move(cure)});
  }
  void add_spoiling(Severity severity, std::string what, std::string cure) const {
    findings_->push_back({severity, probe_, std::move(what), std::move(cure), true});
  }

  const std::string& probe_;
  CheckedSource source_;
  const SeenInPatches& seen_;
  std::vector<Finding>* findings_;
};

}  // namespace

void CheckedPatch::take(const Vec2& position_m, double sigma_m, const SampleDetail* detail) {
  if (detail != nullptr) {
    normals.resize(positions.size());
    normals.push_back({detail->normal, detail->normal_sigma_rad});
  }
  positions.push_back(position_m);
  sigma_squares += sigma_m * sigma_m;
  with_sigma += sigma_m > 0.0 ? 1 : 0;
}

double CheckedPatch::stated_sigma_m() const {
  return with_sigma > 0 ? std::sqrt(sigma_squares / static_cast<double>(with_sigma)) : 0.0;
}

void judge_patches(const std::string& probe, const std::vector<CheckedPatch>& patches,
                   CheckedSource source, std::vector<Finding>* findings) {
  const SeenInPatches seen = see_patches(patches);
  const PatchFindings told(probe, source, seen, findings);
  told.judge_units();
  told.judge_order();
  told.judge_density(patches.size());
  told.judge_gaps();
  told.judge_noise();
  judge_tips(probe, patches, source, findings);
  judge_normals(probe, patches, findings);
  told.judge_silence();
}

std::string one_stamp_text(std::size_t samples) {
  return "all " + std::to_string(samples) + " stamps are equal: they tell no time";
}

void sort_findings(std::vector<Finding>* findings) {
  std::stable_sort(findings->begin(), findings->end(), [](const Finding& a, const Finding& b) {
    return static_cast<int>(a.severity) > static_cast<int>(b.severity);
  });
}

const char* name_of(Severity severity) {
  switch (severity) {
    case Severity::Error:
      return "ERROR  ";
    case Severity::Warning:
      return "WARNING";
    case Severity::Note:
      break;
  }
  return "note   ";
}

}  // namespace palpate
