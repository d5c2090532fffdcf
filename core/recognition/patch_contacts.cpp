#include "core/recognition/patch_contacts.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "core/recognition/samples/cleaned/stored_spikes.h"

namespace palpate {

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
    Given now{patch, windows, 0, options.form_deviation_m, options.noise_time};
    if (!sides.empty() && !patch.samples.empty()) {
      assert(sided < sides.size());
      now.side = sides[sided++];
    }
    if (!outliers.empty()) {
      const auto begin = outliers.begin() + static_cast<std::ptrdiff_t>(first);
      const auto end = begin + static_cast<std::ptrdiff_t>(patch.samples.size());
      if (std::find(begin, end, true) != end) {
        now.used = without_spikes(patch, {begin, end});
      }
    }
    first += patch.samples.size();
    Known& known = known_[p];
    if (known.given != now) {
      known = {std::move(now), {}};
      add_contacts(known.given.used, windows, known.given.side, options, &known.contacts);
    }
    contacts.insert(contacts.end(), known.contacts.begin(), known.contacts.end());
  }
  return contacts;
}

int PatchContacts::side_of(std::uint32_t probe, std::uint32_t patch) const {
  const auto found = std::find_if(known_.begin(), known_.end(), [&](const Known& known) {
    const PatchContext& context = known.given.used.context;
    return context.probe == probe && context.patch == patch;
  });
  return found != known_.end() && !found->given.used.is_joined ? found->given.side : 0;
}

}  // namespace palpate
