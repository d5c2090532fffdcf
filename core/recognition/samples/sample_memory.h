// The samples of one object, patch by patch, in bounded memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/recognition/samples/contact_run.h"
#include "core/recognition/samples/contact_sample.h"
#include "core/recognition/samples/sample_detail.h"
#include "core/recognition/samples/stored_patch.h"

namespace palpate {

struct MemoryOptions {
  /// A patch that grows beyond this many samples has its dwells merged (dwells.h). Where these are
  /// less than a quarter of it, its neighbours are merged pairwise, and from then on it keeps means
  /// of twice as many contacts: no information on the noise's scale is lost, and the bias is stated
  /// (StoredPatch::merge_bias_m).
  std::size_t most_samples_per_patch = 1024;
  /// Beyond this many patches of two samples or more the oldest of them is forgotten.
  std::size_t most_patches = 64;
  /// Likewise of touches alone in their patch: together as much as one patch holds.
  std::size_t most_lone_touches = 1024;
  /// Whether a sample at exactly the place of the one before is taken, as one of its own. It says
  /// nothing new of the path, but counts where distances are summed. No dwell is merged then.
  bool takes_repeated = false;
};

/// Samples taken and samples refused, by reason.
struct AddResult {
  std::size_t accepted = 0;
  std::size_t rejected_not_finite = 0;
  std::size_t rejected_negative_sigma = 0;
  std::size_t rejected_detail = 0;  ///< no sound normal or covariance (is_sound)
  std::size_t detailed = 0;         ///< of those accepted: with a normal or a covariance
  std::size_t forgotten = 0;        ///< contacts taken before, of patches that had to make room
  std::size_t repeated = 0;  ///< at exactly the place of the sample before: they say nothing new

  AddResult& operator+=(const AddResult& other) {
    accepted += other.accepted;
    rejected_not_finite += other.rejected_not_finite;
    rejected_negative_sigma += other.rejected_negative_sigma;
    rejected_detail += other.rejected_detail;
    detailed += other.detailed;
    forgotten += other.forgotten;
    repeated += other.repeated;
    return *this;
  }
};

class SampleMemory {
 public:
  explicit SampleMemory(const MemoryOptions& options = {}) : options_(options) {}

  /// Appends to the patch of that probe and number, or begins it. `details`: of the samples, or
  /// none. Amortised O(samples + patches).
  AddResult add(const PatchContext& context, std::span<const ContactSample> samples,
                std::span<const SampleDetail> details = {});

  void clear() { patches_.clear(); }

  /// In the order in which they were begun.
  const std::vector<StoredPatch>& patches() const { return patches_; }

  /// Contacts taken since the memory was clear, less those of forgotten patches.
  std::size_t sample_count() const;

  /// Samples held, merged ones counted once.
  std::size_t stored_count() const;

 private:
  using Patch = std::vector<StoredPatch>::iterator;

  /// Forgets the oldest patch of the kind, touches alone or longer ones, but the `growing` one,
  /// where there are more than `most`, at least 1. Returns how many contacts it stood for.
  std::size_t make_room(bool lone, std::size_t most, Patch* growing);

  MemoryOptions options_;
  std::vector<StoredPatch> patches_;
};

/// The samples of a patch as if each were one contact: a mean of several as one of so much less
/// noise.
ContactRun as_contacts(const StoredPatch& patch);

}  // namespace palpate
