#include "node/tool/commands/check/stream_check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/local/noise.h"
#include "core/numerics/median.h"
#include "core/recognition/samples/dwells.h"
#include "core/recognition/samples/stroke_order.h"
#include "node/files/counted.h"
#include "node/security/decode_from.h"
#include "node/tool/commands/check/normal_check.h"
#include "node/tool/commands/check/tip_check.h"
#include "node/tool/text/quantity.h"

namespace palpate {
namespace {

/// Samples of a patch that are kept for judgement: enough for every estimate below.
constexpr std::size_t kMostKept = 4096;
constexpr std::size_t kMostPatches = 256;
/// More than stand around one part.
constexpr std::size_t kMostProbes = 64;

/// Mean square root of the standard deviations that its samples state, 0 where none does. [m]
double stated_sigma(const CheckedPatch& patch) {
  return patch.with_sigma > 0
             ? std::sqrt(patch.sigma_squares / static_cast<double>(patch.with_sigma))
             : 0.0;
}

std::vector<double> spacings(const std::vector<Vec2>& positions) {
  std::vector<double> result;
  for (std::size_t i = 1; i < positions.size(); ++i) {
    result.push_back((positions[i] - positions[i - 1]).norm());
  }
  return result;
}

std::string cure_of(v1::RejectReason reason) {
  switch (reason) {
    case v1::REJECT_REASON_FRAMES:
      return "send two frames: the topic, then one ContactBatch";
    case v1::REJECT_REASON_TOPIC:
      return "publish on contact/<probe>/ with a name of 1 to 64 of A-Z a-z 0-9 _ . -, slash at "
             "the end";
    case v1::REJECT_REASON_TOO_LARGE:
    case v1::REJECT_REASON_TOO_MANY_SAMPLES:
      return "send fewer samples a message";
    case v1::REJECT_REASON_PARSE:
      return "serialise palpate.v1.ContactBatch of proto/palpate/v1/contact.proto";
    case v1::REJECT_REASON_HEADER:
      return "fill in header";
    case v1::REJECT_REASON_SOURCE:
      return "set header.source to the probe's name in the topic";
    case v1::REJECT_REASON_GROUP_NAME:
    case v1::REJECT_REASON_FRAME_NAME:
      return "names are 1 to 64 of A-Z a-z 0-9 _ . -";
    case v1::REJECT_REASON_EMPTY:
      return "send no batch without samples";
    case v1::REJECT_REASON_NOT_FINITE:
      return "leave out samples that are NaN or infinite";
    case v1::REJECT_REASON_COORDINATE:
      return "coordinates are metres";
    case v1::REJECT_REASON_SIGMA:
      return "sigma_m is a standard deviation in metres, 0 where it is not known";
    case v1::REJECT_REASON_NORMAL:
      return "normal_x and normal_y are a unit vector, normal_sigma_rad a standard deviation in "
             "radians above 0; leave all three out where nothing is measured";
    case v1::REJECT_REASON_COVARIANCE:
      return "cov_xx_m2, cov_xy_m2, cov_yy_m2 are a positive definite covariance in square metres; "
             "leave all three out where the noise is alike in all directions";
    case v1::REJECT_REASON_TIP_RADIUS:
      return "tip_radius_m is in metres, 0 for surface points";
    case v1::REJECT_REASON_MATERIAL_SIDE:
      return "use a value of MaterialSide";
    case v1::REJECT_REASON_NOT_ALLOWED:
      return "add the probe's name to probes= behind its key in the recognizer's list of clients";
    default:
      return "see RejectReason in node_status.proto";
  }
}

}  // namespace

void CheckedPatch::take(const Vec2& position_m, double sigma_m, const SampleDetail* detail) {
  if (detail != nullptr) {
    normals.resize(positions.size(), Vec2::Zero());
    normals.push_back(detail->normal);
  }
  positions.push_back(position_m);
  sigma_squares += sigma_m * sigma_m;
  with_sigma += sigma_m > 0.0 ? 1 : 0;
}

void StreamCheck::take(std::size_t frame_count, std::string_view topic, std::string_view payload,
                       std::int64_t now_unix_ns, const Sender& sender) {
  ++messages_;
  v1::RejectReason reason = decode_from(sender, decoder_, frame_count, topic, payload);
  if (reason != v1::REJECT_REASON_UNSPECIFIED) {
    const bool is_known = probes_.contains(decoder_.probe()) || rejected_.size() < kMostProbes;
    ++rejected_[{std::string(is_known ? decoder_.probe() : std::string_view()), reason}];
    return;
  }
  const ContactMessage& message = decoder_.message();
  if (probes_.size() >= kMostProbes && !probes_.contains(message.probe)) {
    ++rejected_[{std::string(), v1::REJECT_REASON_TOO_MANY_PROBES}];
    return;
  }
  Probe& probe = probes_[std::string(message.probe)];
  probe.without_epoch += message.epoch == 0 ? 1 : 0;
  if (!is_news(probe.sequence.take(message.epoch, message.seq))) {
    ++rejected_[{std::string(message.probe), v1::REJECT_REASON_SEQUENCE}];
    return;
  }
  ++probe.messages;
  probe.samples += message.samples.size();
  const bool is_new_patch = probe.patches.empty() || probe.patches.back().number != message.patch ||
                            probe.patches.back().object != message.object;
  if (is_new_patch) {
    if (probe.patches.size() == kMostPatches) {
      probe.patches.erase(probe.patches.begin());
    }
    probe.patches.push_back(
        {message.patch, message.object, message.tip_radius_m, message.material_side});
  }
  CheckedPatch& patch = probe.patches.back();
  for (std::size_t i = 0; i < message.samples.size(); ++i) {
    const ContactSample& sample = message.samples[i];
    if (patch.positions.size() < kMostKept) {
      patch.take(sample.position_m, sample.sigma_m,
                 message.details.empty() ? nullptr : &message.details[i]);
    }
    if (sample.stamp_ns <= 0) {
      ++probe.stamps_missing;
      continue;
    }
    constexpr std::int64_t kClockTolerance = 50'000'000;  // between two clocks [ns]
    probe.stamps_backwards += sample.stamp_ns < probe.last_stamp_ns ? 1 : 0;
    probe.stamps_in_future += sample.stamp_ns > now_unix_ns + kClockTolerance ? 1 : 0;
    probe.last_stamp_ns = sample.stamp_ns;
    probe.largest_delay_ns = std::max(probe.largest_delay_ns, now_unix_ns - sample.stamp_ns);
  }
}

void judge_patches(const std::string& probe, const std::vector<CheckedPatch>& patches,
                   CheckedSource source, std::vector<Finding>* findings) {
  const auto add = [&](Severity severity, std::string what, std::string cure) {
    findings->push_back({severity, probe, std::move(what), std::move(cure)});
  };
  const auto add_spoiling = [&](Severity severity, std::string what, std::string cure) {
    findings->push_back({severity, probe, std::move(what), std::move(cure), true});
  };
  const bool is_file = source == CheckedSource::File;
  Eigen::AlignedBox2d box;
  for (const CheckedPatch& patch : patches) {
    for (const Vec2& position : patch.positions) box.extend(position);
  }
  const double extent_of_all = box.isEmpty() ? 0.0 : box.diagonal().norm();
  double extent = 0.0;  // of a patch
  std::size_t longest = 0;
  std::size_t jumps = 0;
  std::size_t unordered = 0;
  std::size_t repeated = 0;
  std::size_t holes = 0;
  double widest = 0.0;  // hole, in typical spacings
  std::size_t samples = 0;
  double noise_ratio = 0.0;  // largest of estimated over stated, or of stated over estimated
  double estimated_noise = 0.0;
  double stated_noise = 0.0;
  double largest_stated = 0.0;
  double coarsest = 0.0;
  for (const CheckedPatch& patch : patches) {
    longest = std::max(longest, patch.positions.size());
    samples += patch.positions.size();
    largest_stated = std::max(largest_stated, stated_sigma(patch));
    if (patch.positions.size() < 2) {
      continue;
    }
    Vec2 low = patch.positions.front();
    Vec2 high = low;
    for (const Vec2& p : patch.positions) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    extent = std::max(extent, (high - low).norm());
    const std::vector<double> all_steps = spacings(patch.positions);
    repeated += static_cast<std::size_t>(std::count(all_steps.begin(), all_steps.end(), 0.0));
    // Of a probe that stands still spacings tell nothing.
    const std::vector<Vec2> moved = without_dwells(patch.positions);
    std::vector<double> steps = spacings(moved);
    std::erase(steps, 0.0);
    if (steps.empty()) {
      continue;
    }
    std::vector<double> sorted = steps;
    const double typical = median_of(sorted);
    unordered += leads_to_and_fro(moved, extent_of_all) ? 1 : 0;
    // A lift-off is many spacings and of the size of the part; a spike comes back at once, and the
    // way back is no lift-off either.
    constexpr double kJumpSpacings = 20.0;
    for (std::size_t i = 0; i + 1 < moved.size(); ++i) {
      const double step = (moved[i + 1] - moved[i]).norm();
      const auto is_away = [&](std::size_t from, std::size_t to) {
        return (moved[to] - moved[from]).norm() > 0.5 * step;
      };
      const bool stays =
          (i + 2 >= moved.size() || is_away(i, i + 2)) && (i == 0 || is_away(i - 1, i + 1));
      jumps += step > kJumpSpacings * typical && stays ? 1 : 0;
    }
    // Noise alone widens a spacing too: by three standard deviations of a difference at most.
    constexpr double kHoleSpacings = 3.0;
    constexpr double kNoiseWidths = 3.0;
    const NoiseEstimate noise = estimate_noise(patch.positions);
    const double by_noise =
        noise.status == LocalStatus::Ok ? kNoiseWidths * std::sqrt(2.0) * noise.sigma_m : 0.0;
    for (const double step : steps) {
      if (step > kHoleSpacings * typical + by_noise && step <= kJumpSpacings * typical) {
        ++holes;
        widest = std::max(widest, step / typical);
      }
    }
    coarsest = std::max(coarsest, typical / std::max((high - low).norm(), typical));
    if (noise.status == LocalStatus::Ok && noise.dof > 20 && patch.with_sigma > 0) {
      const double stated = stated_sigma(patch);
      const double ratio = std::max(noise.sigma_m / stated, stated / noise.sigma_m);
      if (ratio > noise_ratio) {
        noise_ratio = ratio;
        estimated_noise = noise.sigma_m;
        stated_noise = stated;
      }
    }
  }
  constexpr double kLargestPart = 2.0;  // that a touch probe strokes [m]
  constexpr double kSmallestPart = 1e-5;
  if (extent > kLargestPart) {
    add_spoiling(Severity::Warning, "a patch extends over " + text_of_length(extent),
                 is_file ? "were these millimetres? Then say --unit mm"
                         : "coordinates are metres: were these millimetres?");
  }
  constexpr double kLargestProbeNoiseM = 1e-3;  // of a touch probe [m]
  if (estimated_noise > kLargestProbeNoiseM || largest_stated > kLargestProbeNoiseM) {
    add_spoiling(
        Severity::Error,
        "noise of " + text_of_length(std::max(estimated_noise, largest_stated)) +
            " is no touch probe's",
        is_file ? "were these millimetres? Then say --unit mm; --sigma is metres whatever the unit"
                : "coordinates and sigma_m are metres: were these millimetres?");
  }
  if (extent > 0.0 && extent < kSmallestPart) {
    add(Severity::Warning, "the longest patch extends over " + text_of_length(extent),
        "coordinates are metres: were these kilometres, or does the probe dwell?");
  }
  if (jumps > 0) {
    add_spoiling(
        Severity::Error, counted(jumps, "jump") + " of more than 20 spacings within a patch",
        is_file ? "give each stroke a patch number of its own (column patch, or an empty line "
                  "between strokes); rows in no order along the part are --touches"
                : "count patch up by one at each lift-off");
  }
  if (unordered > 0) {
    add_spoiling(
        Severity::Error,
        counted(unordered, "patch goes", "patches go") + " to and fro over the whole extent",
        is_file ? "sort the rows of a stroke along the part; rows in no order are --touches"
                : "send the samples of a patch in their order along the part; single "
                  "touches are patches of their own");
    findings->back().has_no_order = true;
  }
  constexpr std::size_t kShort = 20;
  const bool are_touches = is_file && longest <= 1;
  if (are_touches) {
    add(Severity::Note, counted(patches.size(), "single touch", "single touches"), "");
  } else if (longest < kShort) {
    add(Severity::Warning, "the longest patch has " + counted(longest, "sample"),
        "20 samples or more along an arc are needed for its curvature; 100 are good");
  }
  constexpr double kCoarse = 1.0 / 15.0;
  if (longest >= kShort && coarsest > kCoarse) {
    add(Severity::Note,
        "samples lie 1/" + number(std::round(1.0 / coarsest)) + " of their patch apart",
        "sample more densely: noise averages out over the samples");
  }
  constexpr double kFewHoles = 0.01;  // of the samples: dropouts that do no harm
  if (holes > 0) {
    add(static_cast<double>(holes) > kFewHoles * static_cast<double>(samples) ? Severity::Warning
                                                                              : Severity::Note,
        counted(holes, "hole") + " of 3 to " + with_digits(widest, 2) +
            " typical spacings within a patch",
        is_file ? "a lift-off begins another patch; else give every sample along the arc"
                : "publish every contact at an even pace along the arc; a real lift-off needs a "
                  "new patch");
  }
  if (repeated > 0) {
    add(Severity::Note, counted(repeated, "sample") + " at exactly the place of the one before",
        is_file ? "they say nothing new and are dropped"
                : "they say nothing new and are dropped; publish contacts while the probe moves");
  }
  constexpr double kNoiseOff = 2.0;
  if (noise_ratio > kNoiseOff) {
    add(Severity::Warning,
        "sigma_m says " + text_of_length(stated_noise) + ", the samples scatter by " +
            text_of_length(estimated_noise),
        "state the noise as it is, or 0 to have it estimated: covariances and classes depend on "
        "it");
  } else if (noise_ratio > 0.0) {
    add(Severity::Note,
        "sigma_m says " + text_of_length(stated_noise) + ", the samples scatter by " +
            text_of_length(estimated_noise),
        "as it should be");
  }
  judge_tips(probe, patches, source, findings);
  judge_normals(probe, patches, findings);
  if (samples > 0 && largest_stated == 0.0) {
    add(Severity::Note,
        is_file ? "no noise is stated: it is estimated" : "sigma_m is 0: the noise is estimated",
        is_file
            ? "state it where it is known (--sigma of fit and replay, or a column sigma): fewer "
              "samples then suffice"
            : "state it where it is known: fewer samples then suffice");
  }
}

std::vector<Finding> StreamCheck::findings() const {
  std::vector<Finding> findings;
  for (const auto& [key, count] : rejected_) {
    findings.push_back(
        {Severity::Error, key.first,
         counted(count, "message") + " rejected: " + v1::RejectReason_Name(key.second),
         cure_of(key.second)});
  }
  for (const auto& entry : probes_) {
    const std::string& name = entry.first;
    const Probe& probe = entry.second;
    const auto add = [&](Severity severity, std::string what, std::string cure) {
      findings.push_back({severity, name, std::move(what), std::move(cure)});
    };
    add(Severity::Note,
        counted(probe.messages, "message") + ", " + counted(probe.samples, "sample") + ", " +
            counted(probe.patches.size(), "patch", "patches"),
        "");
    if (probe.without_epoch > 0) {
      add(Severity::Error, counted(probe.without_epoch, "message") + " without header.epoch",
          "set it to a random number at each start: else a restart looks like old messages");
    }
    if (probe.sequence.gaps() > 0) {
      add(Severity::Warning,
          counted(probe.sequence.gaps(), "gap") + " in seq, " +
              counted(probe.sequence.missing(), "message") + " lost",
          "count seq up by one a message from 0; raise the high-water mark where messages are "
          "dropped");
    }
    if (probe.stamps_missing > 0) {
      add(Severity::Warning, counted(probe.stamps_missing, "sample") + " without stamp_ns",
          "stamp each sample with Unix time in nanoseconds, when it was taken");
    }
    if (probe.stamps_backwards > 0) {
      add(Severity::Error,
          counted(probe.stamps_backwards, "stamp") + " earlier than the one before",
          "send samples in the order in which they were taken");
    }
    if (probe.stamps_in_future > 0) {
      add(Severity::Error, counted(probe.stamps_in_future, "stamp") + " in the future",
          "stamp_ns is Unix time in nanoseconds; synchronise the clocks");
    }
    constexpr std::int64_t kLongAgo = 3'600'000'000'000;
    if (probe.largest_delay_ns > kLongAgo) {
      add(Severity::Error, "stamps more than an hour old",
          "stamp_ns is Unix time in nanoseconds, not time since the start");
    }
    judge_patches(name, probe.patches, CheckedSource::Stream, &findings);
  }
  sort_findings(&findings);
  return findings;
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
