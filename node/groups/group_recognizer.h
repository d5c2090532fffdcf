// The computing half of a group: samples in, answer out, on a worker's thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/recognition/recognizer.h"
#include "core/recognition/samples/sample_memory.h"
#include "node/files/probe_files.h"
#include "node/groups/work.h"
#include "node/intake/contact_queue.h"
#include "node/intake/patch_numbering.h"
#include "node/wire/convert.h"
#include "palpate/v1/local_estimate.pb.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate {

/// The node's thread fills in `contacts` and reads `answer`; a worker's thread calls run(). Only
/// one of them uses the object at a time.
class GroupRecognizer : public Work {
 public:
  struct Answer {
    v1::Recognition recognition;               ///< its header has only the frame
    std::vector<v1::LocalEstimate> estimates;  ///< new ones, in order per probe; header as above
    std::size_t samples_refused = 0;           ///< by the recognizer
    std::int64_t compute_ns = 0;               ///< elapsed time of the computation
    std::int64_t processor_ns = 0;  ///< the part of it spent on a core; the rest is waiting for one
  };

  /// `gap_break_spacings`, `given_class`: see GroupOptions.
  GroupRecognizer(std::string_view name, const RecognizerOptions& recognizer,
                  double gap_break_spacings, std::optional<CurveClass> given_class = {})
      : name_(name),
        gap_break_spacings_(gap_break_spacings),
        given_class_(given_class),
        options_(recognizer),
        recognizer_(recognizer),
        touched_(memory_of(recognizer, given_class.has_value())) {}

  ContactQueue contacts;
  bool wants_estimates = false;
  /// The node's probe files; nullptr if it has none. Replaced when the files are read again.
  std::shared_ptr<const ProbeFiles> probe_files;
  Answer answer;

  /// Processes `contacts` and computes the answer for all samples of the object.
  void run() override;

  /// Name and patch number of a probe, from the recognizer's numbers. The name is valid until the
  /// next run().
  ContactSource source_of(std::uint32_t probe, std::uint32_t run) const;

 private:
  // A probe that has touched the present object. Its index is its number in the recognizer.
  struct Member {
    std::string probe;
    PatchNumbering patches;
  };

  // Where the last samples came from.
  struct Newest {
    std::string source;
    std::uint64_t epoch = 0;
    std::uint64_t seq = 0;
    std::int64_t sample_stamp_ns = 0;
  };

  static MemoryOptions memory_of(const RecognizerOptions& recognizer, bool is_class_given) {
    MemoryOptions memory = recognizer.memory;
    memory.takes_repeated = is_class_given;  // two equal distances count twice in least squares
    return memory;
  }

  std::size_t take(const QueuedContacts& message, std::span<const ContactSample> samples,
                   std::span<const SampleDetail> details);
  std::vector<const ProbeCharacter*> qualified_probes(std::vector<std::string>& files) const;
  void answer_by_search();
  void answer_of_given_class();
  ContactSourceOf sources() const;
  void take_estimates();

  std::string name_;
  double gap_break_spacings_;
  std::optional<CurveClass> given_class_;
  RecognizerOptions options_;
  Recognizer recognizer_;
  /// The samples as they came; used with probe files or a given class. Each answer subtracts the
  /// probes' offsets anew, along the normals of the curve that it finds.
  SampleMemory touched_;
  std::size_t forgotten_ = 0;  ///< samples of this object that touched_ has forgotten
  /// Of this object, samples with more information than a search uses.
  std::size_t simplified_ = 0;
  std::string frame_;
  std::uint64_t object_ = 0;
  std::vector<Member> members_;
  Newest newest_;
};

}  // namespace palpate
