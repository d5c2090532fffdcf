// The memory of samples holds what a plain one holds that looks through all patches at each sample.
#include "core/recognition/samples/sample_memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "tests/support/test_rng.h"

namespace palpate {
namespace {

/// What happens to the samples of one patch is a memory's own that holds no other.
struct PlainPatch {
  SampleMemory only;

  const StoredPatch& stored() const { return only.patches().front(); }
  bool is_lone() const { return stored().samples.size() == 1; }
};

class PlainMemory {
 public:
  explicit PlainMemory(const MemoryOptions& options) : options_(options) {}

  AddResult add(const PatchContext& context, const std::vector<ContactSample>& samples) {
    AddResult result;
    for (const ContactSample& sample : samples) {
      auto place = std::find_if(patches_.begin(), patches_.end(), [&](const PlainPatch& patch) {
        return is_of_one_stroke(patch.stored().context, context);
      });
      if (place == patches_.end()) {
        place = patches_.insert(place, PlainPatch{SampleMemory(options_)});
      }
      result += place->only.add(context, {&sample, 1});
      if (place->only.patches().empty()) {  // refused
        patches_.pop_back();
        continue;
      }
      const bool lone = place->is_lone();
      result.forgotten +=
          forget(lone, lone ? options_.most_lone_touches : options_.most_patches, &*place);
    }
    return result;
  }

  std::vector<StoredPatch> patches() const {
    std::vector<StoredPatch> all;
    for (const PlainPatch& patch : patches_) all.push_back(patch.stored());
    return all;
  }

 private:
  std::size_t forget(bool lone, std::size_t most, const PlainPatch* growing) {
    std::size_t count = 0;
    auto oldest = patches_.end();
    for (auto patch = patches_.begin(); patch != patches_.end(); ++patch) {
      count += patch->is_lone() == lone ? 1 : 0;
      if (oldest == patches_.end() && patch->is_lone() == lone && &*patch != growing) {
        oldest = patch;
      }
    }
    if (count <= most) return 0;
    const std::size_t contacts = oldest->only.sample_count();
    patches_.erase(oldest);
    return contacts;
  }

  MemoryOptions options_;
  std::vector<PlainPatch> patches_;
};

/// One of few strokes, so that samples continue old ones: numbers and tips recur, sides differ.
PatchContext random_stroke(std::mt19937_64& rng, std::uint32_t strokes) {
  const auto below = [&](std::uint32_t most) { return static_cast<std::uint32_t>(rng() % most); };
  PatchContext context{.probe = below(2), .patch = below(strokes)};
  if (below(4) == 0) context.tip_radius_m = 1e-3 * below(3);
  context.material_side = static_cast<MaterialSide>(below(3));
  return context;
}

/// Mostly single ones; some at the place of the one before, some of no use. Some stand still, but
/// for noise: of these a full patch keeps few.
std::vector<ContactSample> random_samples(std::mt19937_64& rng) {
  std::vector<ContactSample> samples(rng() % 4 == 0 ? 1 + rng() % 100 : 1);
  const double length_m = rng() % 2 == 0 ? 1.0 : 1e-6;
  for (ContactSample& sample : samples) {
    const bool repeats = rng() % 8 == 0;
    sample.position_m = Vec2(repeats ? 0.0 : test::uniform(rng, 0.0, length_m), 0.0);
    sample.sigma_m = rng() % 16 == 0 ? -1.0 : 1e-5;
  }
  return samples;
}

TEST(SampleMemoryProperty, HoldsWhatAPlainOneHolds) {
  std::mt19937_64 rng = test::test_rng();
  const int cases = test::stress_count(60);
  std::size_t forgotten = 0;
  for (int i = 0; i < cases; ++i) {
    MemoryOptions options;
    options.most_samples_per_patch = kFewestMeans;
    options.most_patches = 1 + rng() % 6;
    options.most_lone_touches = 1 + rng() % 12;
    options.takes_repeated = rng() % 2 == 0;
    const auto strokes = static_cast<std::uint32_t>(2 + rng() % 40);
    SampleMemory memory(options);
    PlainMemory plain(options);
    for (int k = 0; k < 200; ++k) {
      const PatchContext context = random_stroke(rng, strokes);
      const std::vector<ContactSample> samples = random_samples(rng);
      const AddResult result = memory.add(context, samples);
      const AddResult expected = plain.add(context, samples);
      ASSERT_EQ(result.accepted, expected.accepted);
      ASSERT_EQ(result.repeated, expected.repeated);
      ASSERT_EQ(result.forgotten, expected.forgotten);
      const std::vector<StoredPatch> patches(memory.patches().begin(), memory.patches().end());
      ASSERT_EQ(patches, plain.patches()) << "case " << i << ", after " << k;
      forgotten += result.forgotten;
    }
    SampleMemory copy = memory;  // each finds its own patches
    const PatchContext context = random_stroke(rng, strokes);
    const std::vector<ContactSample> samples = random_samples(rng);
    memory.add(context, samples);
    copy.add(context, samples);
    ASSERT_TRUE(std::equal(copy.patches().begin(), copy.patches().end(), memory.patches().begin(),
                           memory.patches().end()));
    memory.clear();
    EXPECT_TRUE(memory.patches().empty());
    EXPECT_EQ(memory.add(context, std::vector<ContactSample>(1)).accepted, 1U);
    EXPECT_EQ(memory.patches().size(), 1U);
  }
  EXPECT_GT(forgotten, 0U);
}

}  // namespace
}  // namespace palpate
