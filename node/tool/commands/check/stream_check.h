// What is wrong with a probe's stream, told to its author.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "node/intake/ingest.h"
#include "node/intake/sequence_tracker.h"
#include "node/security/sender.h"

namespace palpate {

enum class Severity { Note, Warning, Error };

struct Finding {
  Severity severity = Severity::Note;
  std::string probe;  ///< empty = no probe's in particular
  std::string what;   ///< what was seen, with its numbers
  std::string cure;   ///< what to do about it
  /// An answer from these samples would be wrong or worth less, whatever the recogniser makes of
  /// it.
  bool spoils_answer = false;
  bool has_no_order = false;  ///< rows of a stroke lead to and fro instead of along the part
};

/// What is kept of a patch for judgement.
struct CheckedPatch {
  std::uint32_t number = 0;
  std::uint64_t object = 0;
  double tip_radius_m = 0.0;
  MaterialSide material_side = MaterialSide::Unspecified;
  std::vector<Vec2> positions = {};
  std::vector<Vec2> normals = {};  ///< by position, zero where none; empty where there are none
  double sigma_squares = 0.0;
  std::size_t with_sigma = 0;

  /// `detail`: nullptr where the sample says no more.
  void take(const Vec2& position_m, double sigma_m, const SampleDetail* detail);
};

/// Where patches came from: the cures differ.
enum class CheckedSource { Stream, File };

/// Units, spacing, noise, jumps and repeats of a probe's patches.
void judge_patches(const std::string& probe, const std::vector<CheckedPatch>& patches,
                   CheckedSource source, std::vector<Finding>* findings);

/// Worst first, else in their order.
void sort_findings(std::vector<Finding>* findings);

/// "ERROR  ", "WARNING" or "note   ".
const char* name_of(Severity severity);

/// Takes messages as they come off the wire, judges them at the end.
class StreamCheck {
 public:
  /// One message that arrived at `now_unix_ns`.
  void take(std::size_t frame_count, std::string_view topic, std::string_view payload,
            std::int64_t now_unix_ns, const Sender& sender = {});

  /// Worst first.
  std::vector<Finding> findings() const;

  std::uint64_t messages() const { return messages_; }

 private:
  struct Probe {
    SequenceTracker sequence;
    std::uint64_t samples = 0;
    std::uint64_t messages = 0;
    std::uint64_t without_epoch = 0;
    std::uint64_t stamps_backwards = 0;
    std::uint64_t stamps_missing = 0;
    std::uint64_t stamps_in_future = 0;
    std::int64_t last_stamp_ns = 0;
    std::int64_t largest_delay_ns = 0;
    std::vector<CheckedPatch> patches;
  };

  ContactDecoder decoder_;
  std::uint64_t messages_ = 0;
  std::map<std::pair<std::string, v1::RejectReason>, std::uint64_t> rejected_;
  std::map<std::string, Probe, std::less<>> probes_;
};

}  // namespace palpate
