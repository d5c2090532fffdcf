// Local estimates along the patches, computed again only for patches that changed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/recognition/contacts.h"
#include "core/recognition/samples/cleaned/clean_patches.h"

namespace palpate {

class PatchContacts {
 public:
  /// add_contacts() of each patch. `sides`: the tips' side for each patch with samples, or empty.
  /// `outliers`: one flag per sample of all patches, or empty; flagged samples are left out.
  std::vector<LocalizedContact> of(std::span<const StoredPatch> patches,
                                   const std::vector<int>& sides, const std::vector<bool>& outliers,
                                   const ContactOptions& options);

  /// The tips' side of a stroke in the last call of of(); 0 if it was not among the patches.
  int side_of(std::uint32_t probe, std::uint32_t patch) const;

  void clear() { known_.clear(); }

 private:
  /// The contacts of a patch, and the inputs they were computed from.
  struct Known {
    PatchVersion version;
    std::vector<Vec2> touches;  ///< positions of a run of touches, which may change anywhere
    std::size_t windows = 0;
    int side = 0;
    double form_deviation_m = 0.0;
    double noise_time = 1.0;
    std::vector<bool> outliers;
    std::vector<LocalizedContact> contacts;

    bool same_as(const Known& other) const;
  };

  std::vector<Known> known_;
};

}  // namespace palpate
