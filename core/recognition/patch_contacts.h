// Local estimates along the patches, made again only where a patch has changed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/recognition/contacts.h"

namespace palpate {

class PatchContacts {
 public:
  /// add_contacts() of each patch, with the tips on these `sides` (one per patch with samples, or
  /// none at all). Samples flagged in `outliers` (one flag per sample of the patches, or none at
  /// all) are left out.
  std::vector<LocalizedContact> of(std::span<const StoredPatch> patches,
                                   const std::vector<int>& sides, const std::vector<bool>& outliers,
                                   const ContactOptions& options);

  /// The side that a stroke's tips were taken to lie on by the last call of of(); 0 where it was
  /// not among the patches.
  int side_of(std::uint32_t probe, std::uint32_t patch) const;

  void clear() { known_.clear(); }

 private:
  /// What the contacts of a patch were made of, and they.
  struct Known {
    PatchVersion version;
    std::vector<Vec2> touches;  ///< of a run, which may change anywhere
    std::size_t windows = 0;
    int side = 0;
    double form_deviation_m = 0.0;
    std::vector<bool> outliers;
    std::vector<LocalizedContact> contacts;

    bool same_as(const Known& other) const;
  };

  std::vector<Known> known_;
};

}  // namespace palpate
