// The file of samples that a browser is offered: palpate fit reads from it what the node was told.
#include "node/tool/view/downloads.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "node/csv/contact_csv.h"
#include "node/tool/contact_groups.h"

namespace palpate {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

v1::ContactBatch batch_of(std::uint32_t patch, double x_m) {
  v1::ContactBatch batch;
  batch.mutable_header()->set_source("finger");
  batch.mutable_header()->set_epoch(5);
  batch.set_patch(patch);
  for (int i = 0; i < 3; ++i) {
    v1::ContactSample& sample = *batch.add_samples();
    sample.set_x_m(x_m + 1e-3 * i);
    sample.set_stamp_ns(7);
  }
  return batch;
}

class Downloads : public testing::Test {
 protected:
  void take(const v1::ContactBatch& batch) { state_.take(batch, SteadyTime()); }

  std::string csv() { return samples_csv(*state_.find("finger")); }

  /// What `palpate fit` reads, sorted into strokes.
  std::vector<ContactRun> read_again() {
    const auto table = parse_contact_csv(csv(), "samples.csv");
    EXPECT_TRUE(table) << table.error;
    if (!table) return {};
    return contact_groups("samples.csv", *table.value).front().runs;
  }

  LiveState state_;
};

TEST_F(Downloads, HaveAllThatAProbeStates) {
  v1::ContactBatch batch = batch_of(4, 0.1);
  batch.set_tip_radius_m(0.002);
  take(batch);
  batch.set_material_side(v1::MATERIAL_SIDE_LEFT);
  v1::ContactSample& sample = *batch.mutable_samples(1);
  sample.set_normal_x(0.6);
  sample.set_normal_y(-0.8);
  sample.set_normal_sigma_rad(0.02);
  sample.set_cov_xx_m2(4e-10);
  sample.set_cov_xy_m2(1e-10);
  sample.set_cov_yy_m2(2e-10);
  batch.mutable_samples(2)->set_sigma_m(3e-5);
  take(batch);
  const std::vector<ContactRun> runs = read_again();
  ASSERT_EQ(runs.size(), 1U);
  const PatchContext said = {0, 4, 0.002, MaterialSide::Left};
  EXPECT_EQ(runs[0].context, said);
  ASSERT_EQ(runs[0].samples.size(), 6U);
  EXPECT_EQ(runs[0].samples[0].stamp_ns, 7);
  EXPECT_EQ(runs[0].samples[5].sigma_m, 3e-5);
  ASSERT_EQ(runs[0].details.size(), 6U);
  const SampleDetail measured = {Vec2(0.6, -0.8), 0.02, Eigen::Vector3d(4e-10, 1e-10, 2e-10)};
  EXPECT_EQ(runs[0].details[4], measured);
  EXPECT_EQ(runs[0].details[0], SampleDetail());
  // Thinned, each sample keeps its own.
  while (state_.find("finger")->samples_kept + 6 <= kMostSamplesKept) take(batch);
  take(batch);
  take(batch);
  ASSERT_LT(state_.find("finger")->samples_kept, kMostSamplesKept);
  EXPECT_THAT(csv(), StartsWith("# "));
  for (const ContactRun& run : read_again()) {
    for (std::size_t i = 0; i < run.samples.size(); ++i) {
      if (says_more(run.details[i])) {
        EXPECT_EQ(run.samples[i].position_m.x(), 0.1 + 1e-3);
      }
    }
  }
}

TEST_F(Downloads, NumberAStrokeWhoseNumberComesAgainAnew) {
  take(batch_of(7, 0.1));
  take(batch_of(7, 0.2));
  take(batch_of(8, 0.3));
  EXPECT_THAT(csv(), Not(HasSubstr("numbered anew")));
  EXPECT_EQ(read_again()[0].context.patch, 7U);
  take(batch_of(7, 0.4));
  EXPECT_THAT(csv(), HasSubstr("numbered anew"));
  std::vector<ContactRun> runs = read_again();
  ASSERT_EQ(runs.size(), 3U);
  EXPECT_EQ(runs[0].samples.size(), 6U);
  EXPECT_NE(runs[2].context.patch, runs[0].context.patch);
  // A probe that has started again, or has another tip, makes another stroke too.
  v1::ContactBatch batch = batch_of(7, 0.5);
  batch.mutable_header()->set_epoch(6);
  take(batch);
  batch.set_tip_radius_m(0.001);
  take(batch);
  EXPECT_EQ(read_again().size(), 5U);
}

TEST_F(Downloads, OfWhatNoNodeAcceptsAreNone) {
  v1::ContactBatch batch = batch_of(0, 0.1);
  batch.mutable_samples(0)->set_cov_xx_m2(-1.0);
  take(batch);
  batch = batch_of(0, 0.1);
  batch.mutable_samples(0)->set_normal_x(3.0);
  take(batch);
  EXPECT_EQ(state_.find("finger"), nullptr);
}

}  // namespace
}  // namespace palpate
