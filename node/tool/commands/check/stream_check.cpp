#include "node/tool/commands/check/stream_check.h"

#include <algorithm>
#include <map>
#include <utility>

#include "node/check/approach_check.h"
#include "node/files/counted.h"
#include "node/security/decode_from.h"

namespace palpate {
namespace {

/// Samples of a patch that are kept for judgement: enough for every estimate below.
constexpr std::size_t kMostKept = 4096;
constexpr std::size_t kMostPatches = 256;
/// More than stand around one part.
constexpr std::size_t kMostProbes = 64;

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

/// As of a file: of each object's strokes.
void add_approaches(const std::string& probe, const std::vector<CheckedPatch>& patches,
                    std::vector<Finding>* findings) {
  std::map<std::uint64_t, ContactGroup> objects;
  for (const CheckedPatch& patch : patches) {
    ContactGroup& group = objects[patch.object];
    group.probes = {probe};
    ContactRun run;
    run.context.patch = patch.number;
    for (const Vec2& position : patch.positions) run.samples.push_back({position});
    group.runs.push_back(std::move(run));
  }
  for (const auto& [object, group] : objects) {
    auto found = judge_approaches(group, objects.size() == 1, {}, CheckedSource::Stream);
    if (!found) continue;
    found->probe = probe;
    findings->push_back(*std::move(found));
    return;  // said once
  }
}

}  // namespace

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
  if (probe.patches.empty() || probe.patches.back().object != message.object) {
    ++probe.objects;
    probe.samples_of_object = 0;
  }
  probe.samples_of_object += message.samples.size();
  probe.longest_object_samples = std::max(probe.longest_object_samples, probe.samples_of_object);
  const bool is_new_patch = probe.patches.empty() || probe.patches.back().number != message.patch ||
                            probe.patches.back().object != message.object;
  if (is_new_patch) {
    ++probe.patch_count;
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
    probe.stamps_differ |= probe.stamps++ > 0 && sample.stamp_ns != probe.last_stamp_ns;
    probe.stamps_backwards += sample.stamp_ns < probe.last_stamp_ns ? 1 : 0;
    probe.stamps_in_future += sample.stamp_ns > now_unix_ns + kClockTolerance ? 1 : 0;
    probe.last_stamp_ns = sample.stamp_ns;
    probe.largest_delay_ns = std::max(probe.largest_delay_ns, now_unix_ns - sample.stamp_ns);
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
            counted(probe.patch_count, "patch", "patches"),
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
          "dropped; split what is longer than " +
              std::to_string(IngestLimits{}.max_message_bytes) + " bytes: it does not arrive");
    }
    constexpr std::uint64_t kFewObjects = 2;  // two parts that were touched in turn
    if (probe.objects > kFewObjects && 2 * probe.objects > probe.messages) {
      findings.push_back(
          {Severity::Warning, name,
           "object changes with nearly every message: " + counted(probe.objects, "object") +
               " in " + counted(probe.messages, "message") + ", of at most " +
               counted(probe.longest_object_samples, "sample"),
           "object is the number of the part: another one makes the recognizer forget all samples; "
           "keep it until the next part",
           true});
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
    // The samples of one message may well have been taken at a time.
    if (probe.messages > 1 && probe.stamps > 1 && !probe.stamps_differ) {
      add(Severity::Warning, one_stamp_text(probe.stamps),
          "stamp each sample with Unix time in nanoseconds, when it was taken");
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
    add_approaches(name, probe.patches, &findings);
  }
  sort_findings(&findings);
  return findings;
}

}  // namespace palpate
