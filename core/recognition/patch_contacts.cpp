#include "core/recognition/patch_contacts.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "core/recognition/samples/cleaned/stored_spikes.h"

namespace palpate {

bool PatchContacts::Known::same_as(const Known& other) const {
  return version == other.version && touches == other.touches && windows == other.windows &&
         side == other.side && form_deviation_m == other.form_deviation_m &&
         noise_time == other.noise_time && outliers == other.outliers;
}

std::vector<LocalizedContact> PatchContacts::of(std::span<const StoredPatch> patches,
                                                const std::vector<int>& sides,
                                                const std::vector<bool>& outliers,
                                                const ContactOptions& options) {
  const std::size_t windows = windows_of_a_patch(patches.size(), options);
  known_.resize(patches.size());
  std::vector<LocalizedContact> contacts;
  std::size_t first = 0;  // sample of the patch among all
  std::size_t sided = 0;  // patch among those with samples
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const StoredPatch& patch = patches[p];
    Known now;
    now.version = version_of(patch);
    now.windows = windows;
    now.form_deviation_m = options.form_deviation_m;
    now.noise_time = options.noise_time;
    if (!sides.empty() && !patch.samples.empty()) {
      assert(sided < sides.size());
      now.side = sides[sided++];
    }
    for (std::size_t i = 0; patch.is_joined && i < patch.samples.size(); ++i) {
      now.touches.push_back(patch.samples[i].position_m);
    }
    if (!outliers.empty()) {
      const auto begin = outliers.begin() + static_cast<std::ptrdiff_t>(first);
      const auto end = begin + static_cast<std::ptrdiff_t>(patch.samples.size());
      if (std::find(begin, end, true) != end) {
        now.outliers.assign(begin, end);
      }
    }
    first += patch.samples.size();
    if (!known_[p].same_as(now)) {
      if (now.outliers.empty()) {
        add_contacts(patch, windows, now.side, options, &now.contacts);
      } else {
        const StoredPatch rest = without_spikes(patch, now.outliers);
        add_contacts(rest, windows, now.side, options, &now.contacts);
      }
      known_[p] = std::move(now);
    }
    contacts.insert(contacts.end(), known_[p].contacts.begin(), known_[p].contacts.end());
  }
  return contacts;
}

int PatchContacts::side_of(std::uint32_t probe, std::uint32_t patch) const {
  const auto found = std::find_if(known_.begin(), known_.end(), [&](const Known& known) {
    return known.version.probe == probe && known.version.patch == patch;
  });
  return found != known_.end() && found->touches.empty() ? found->side : 0;
}

}  // namespace palpate
