// The half of a group that computes: samples in, answer out, on a worker's thread.
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

/// Passes between the node's thread, which fills in `contacts` and reads `answer`, and a worker's,
/// which does run(); never in both hands.
class GroupRecognizer : public Work {
 public:
  struct Answer {
    v1::Recognition recognition;               ///< of the header, the frame only
    std::vector<v1::LocalEstimate> estimates;  ///< new ones, in order for each probe; the same
    std::size_t samples_refused = 0;           ///< by the recognizer
    std::int64_t compute_ns = 0;               ///< as a planner waits for it
    std::int64_t processor_ns = 0;  ///< of that on a core: on a busy machine it waits for one too
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
  /// Which probes are qualified; always or never nullptr. Another where the files are read again.
  std::shared_ptr<const ProbeFiles> probe_files;
  Answer answer;

  /// Takes `contacts` in, and answers for all samples of the object.
  void run() override;

  /// Name of a probe and its own patch number, for the recognizer's numbers of both. Views a name
  /// that lives until the next run().
  ContactSource source_of(std::uint32_t probe, std::uint32_t run) const;

 private:
  // A probe that has touched the present object. Its index is its number in the recognizer.
  struct Member {
    std::string probe;
    PatchNumbering patches;
  };

  // Where the samples taken last came from.
  struct Newest {
    std::string source;
    std::uint64_t epoch = 0;
    std::uint64_t seq = 0;
    std::int64_t sample_stamp_ns = 0;
  };

  static MemoryOptions memory_of(const RecognizerOptions& recognizer, bool is_class_given) {
    MemoryOptions memory = recognizer.memory;
    memory.takes_repeated = is_class_given;  // a distance measured twice counts twice
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
  /// Where there are probe files or a class is given: the samples as they came. Each answer takes
  /// the probes' offsets off anew, by the normals of the curve that it finds.
  SampleMemory touched_;
  std::size_t forgotten_ = 0;   ///< samples of touched_, since the object began
  std::size_t simplified_ = 0;  ///< likewise, those that said more than a search uses
  std::string frame_;
  std::uint64_t object_ = 0;
  std::vector<Member> members_;
  Newest newest_;
};

}  // namespace palpate
