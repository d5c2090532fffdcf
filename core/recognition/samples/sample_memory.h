// The samples of one object, patch by patch, in bounded memory.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/recognition/samples/contact_run.h"
#include "core/recognition/samples/contact_sample.h"
#include "core/recognition/samples/patch_queue.h"
#include "core/recognition/samples/sample_detail.h"
#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// Least bound of a patch's samples. Means of neighbours lie inside a bend; mean_on_path.h undoes
/// that but for 0.035 theta^4 of its radius, 0.37 theta^4 next to an end, theta the turn from
/// one mean to the next: 3e-6 and 3e-5 where so many go all the way round. Of eight it is 0.013.
inline constexpr std::size_t kFewestMeans = 64;

/// Bounds of the memory. Fewer samples than kFewestMeans, and no patch or touch at all, count as so
/// many, and as 1.
struct MemoryOptions {
  /// Most samples of a patch. When a patch is full, its dwells are merged (dwells.h). If that frees
  /// less than a quarter, neighbours are merged pairwise, and from then on the patch stores means
  /// of twice as many contacts. The weight of a mean keeps the noise level known, and
  /// mean_on_path.h undoes that it lies inside a bend.
  std::size_t most_samples_per_patch = 1024;
  /// Most patches of two samples or more; beyond it the oldest is forgotten.
  std::size_t most_patches = 64;
  /// The same for single touches (patches of one sample): together as many samples as one patch.
  std::size_t most_lone_touches = 1024;
  /// True: a sample at exactly the place of the one before is stored as a sample of its own. It
  /// says nothing new about the path, but counts where distances are summed. Dwells are then not
  /// merged. False: it is only counted (AddResult::repeated).
  bool takes_repeated = false;
};

/// Numbers of samples accepted and refused, by reason.
struct AddResult {
  std::size_t accepted = 0;
  std::size_t rejected_not_finite = 0;
  std::size_t rejected_negative_sigma = 0;
  std::size_t rejected_detail = 0;      ///< normal or covariance not sound (is_sound), or too few
  std::size_t rejected_tip_radius = 0;  ///< of a patch whose tip radius is negative or not finite
  std::size_t detailed = 0;             ///< accepted samples with a normal or a covariance
  std::size_t forgotten = 0;            ///< earlier contacts lost with patches that were forgotten
  std::size_t repeated = 0;  ///< at exactly the place of the sample before: refused, nothing new

  AddResult& operator+=(const AddResult& other) {
    accepted += other.accepted;
    rejected_not_finite += other.rejected_not_finite;
    rejected_negative_sigma += other.rejected_negative_sigma;
    rejected_detail += other.rejected_detail;
    rejected_tip_radius += other.rejected_tip_radius;
    detailed += other.detailed;
    forgotten += other.forgotten;
    repeated += other.repeated;
    return *this;
  }
};

class SampleMemory {
 public:
  explicit SampleMemory(const MemoryOptions& options = {});

  /// Appends to the patch of that probe and number, or begins it. A patch has one tip radius and at
  /// most one side, stated with any of its samples: others begin a patch of their own. `details`:
  /// one per sample, or empty; another number of them, or an invalid tip radius, rejects all
  /// samples. Amortised O(samples + log patches), and for each patch that is forgotten O(older ones
  /// of the other kind).
  AddResult add(const PatchContext& context, std::span<const ContactSample> samples,
                std::span<const SampleDetail> details = {});

  void clear() {
    patches_ = {};
    lone_touches_ = 0;
  }

  /// In the order in which they were begun; a view that holds until samples are added.
  std::span<const StoredPatch> patches() const { return patches_.patches(); }

  /// Contacts accepted since clear(), without those of forgotten patches.
  std::size_t sample_count() const;

 private:
  /// Makes the patch a single touch, or no longer one, as its samples are now. If that is one more
  /// of the kind than may be, forgets the oldest other one. Returns how many contacts that was.
  std::size_t make_room(StoredPatch** growing);

  MemoryOptions options_;
  PatchQueue patches_;
  std::size_t lone_touches_ = 0;  ///< of the patches
};

/// The stored samples of a patch as contacts. The mean of w contacts has noise smaller by sqrt(w).
ContactRun as_contacts(const StoredPatch& patch);

}  // namespace palpate
