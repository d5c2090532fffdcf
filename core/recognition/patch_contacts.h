// Local estimates along the patches, computed again only for patches that changed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/recognition/contacts.h"
#include "core/recognition/samples/stored_patch.h"

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
  /// What the contacts of a patch are computed from. Samples are compared one by one: another one
  /// may be left out than last time, anywhere on the stroke.
  struct Given {
    StoredPatch used;
    std::size_t windows = 0;
    int side = 0;
    double form_deviation_m = 0.0;
    double noise_time = 1.0;

    bool operator==(const Given&) const = default;
  };
  struct Known {
    Given given;
    std::vector<LocalizedContact> contacts;
  };

  std::vector<Known> known_;
};

}  // namespace palpate
