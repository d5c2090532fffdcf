#include "node/intake/ingest.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "contact_messages.h"
#include "node/wire/convert.h"

namespace palpate {
namespace {

using testing::contact_topic;
using testing::line_batch;

v1::RejectReason decode(const v1::ContactBatch& batch) {
  ContactDecoder decoder;
  return decoder.decode(2, contact_topic("p"), batch.SerializeAsString());
}

TEST(Ingest, AValidMessageArrivesWhole) {
  v1::ContactBatch batch = line_batch("p", 3, 4);
  batch.mutable_header()->set_stamp_ns(99);
  batch.set_group("cup");
  batch.set_object(5);
  batch.set_patch(6);
  batch.set_tip_radius_m(2e-3);
  batch.set_material_side(v1::MATERIAL_SIDE_RIGHT);
  batch.mutable_samples(3)->set_stamp_ns(5000);
  const std::string payload = batch.SerializeAsString();
  const std::string topic = contact_topic("p");  // the message views it
  ContactDecoder decoder;
  ASSERT_EQ(decoder.decode(2, topic, payload), v1::REJECT_REASON_UNSPECIFIED);
  const ContactMessage& message = decoder.message();
  EXPECT_EQ(message.probe, "p");
  EXPECT_EQ(message.group, "cup");
  EXPECT_EQ(message.frame, "world");
  EXPECT_EQ(message.epoch, 3U);
  EXPECT_EQ(message.seq, 4U);
  EXPECT_EQ(message.published_ns, 99);
  EXPECT_EQ(message.object, 5U);
  EXPECT_EQ(message.patch, 6U);
  EXPECT_EQ(message.tip_radius_m, 2e-3);
  EXPECT_EQ(message.material_side, MaterialSide::Right);
  ASSERT_EQ(message.samples.size(), 10U);
  EXPECT_EQ(message.samples[2].position_m, Vec2(2e-3, 0.0));
  EXPECT_EQ(message.samples[2].sigma_m, 1e-5);
  EXPECT_EQ(message.samples[2].stamp_ns, 1002);
  EXPECT_EQ(message.newest_sample_stamp_ns, 5000);
}

TEST(Ingest, AGroupLeftOutIsTheProbe) {
  ContactDecoder decoder;
  const std::string payload = line_batch("p", 0, 0).SerializeAsString();
  const std::string topic = contact_topic("p");
  ASSERT_EQ(decoder.decode(2, topic, payload), v1::REJECT_REASON_UNSPECIFIED);
  EXPECT_EQ(decoder.message().group, "p");
}

TEST(Ingest, NothingOfAnEarlierMessageRemains) {
  ContactDecoder decoder;
  v1::ContactBatch first = line_batch("p", 0, 0);
  first.set_group("g");
  first.set_tip_radius_m(1e-3);
  first.mutable_header()->set_frame("table");
  ASSERT_EQ(decoder.decode(2, contact_topic("p"), first.SerializeAsString()),
            v1::REJECT_REASON_UNSPECIFIED);
  const std::string topic = contact_topic("q");
  ASSERT_EQ(decoder.decode(2, topic, line_batch("q", 0, 0, 2).SerializeAsString()),
            v1::REJECT_REASON_UNSPECIFIED);
  EXPECT_EQ(decoder.message().group, "q");
  EXPECT_EQ(decoder.message().frame, "world");
  EXPECT_EQ(decoder.message().tip_radius_m, 0.0);
  EXPECT_EQ(decoder.message().samples.size(), 2U);
}

TEST(Ingest, FramesTopicAndBytes) {
  ContactDecoder decoder;
  const std::string good = line_batch("p", 0, 0).SerializeAsString();
  for (const std::size_t frames : {0, 1, 3, 1000}) {
    EXPECT_EQ(decoder.decode(frames, contact_topic("p"), good), v1::REJECT_REASON_FRAMES);
  }
  for (const char* topic : {"", "contact/", "contact/p", "recognition/p/", "contact/p p/"}) {
    EXPECT_EQ(decoder.decode(2, topic, good), v1::REJECT_REASON_TOPIC) << topic;
    EXPECT_TRUE(decoder.probe().empty());
  }
  EXPECT_EQ(decoder.decode(2, contact_topic("p"), "\xff\xff\xff"), v1::REJECT_REASON_PARSE);
  EXPECT_EQ(decoder.decode(2, contact_topic("p"), good.substr(0, good.size() - 1)),
            v1::REJECT_REASON_PARSE);
  EXPECT_EQ(decoder.decode(2, contact_topic("p"), ""), v1::REJECT_REASON_HEADER);
  IngestLimits limits;
  limits.max_message_bytes = good.size() - 1;
  EXPECT_EQ(ContactDecoder(limits).decode(2, contact_topic("p"), good),
            v1::REJECT_REASON_TOO_LARGE);
}

void set_normal(v1::ContactBatch& batch, double x, double y, double sigma) {
  v1::ContactSample& sample = *batch.mutable_samples(3);
  sample.set_normal_x(x);
  sample.set_normal_y(y);
  sample.set_normal_sigma_rad(sigma);
}

void set_covariance(v1::ContactBatch& batch, double xx, double xy, double yy) {
  v1::ContactSample& sample = *batch.mutable_samples(3);
  sample.set_cov_xx_m2(xx);
  sample.set_cov_xy_m2(xy);
  sample.set_cov_yy_m2(yy);
}

TEST(Ingest, NormalsAndCovariancesPass) {
  v1::ContactBatch batch = line_batch("p", 0, 0);
  set_normal(batch, -0.6, 0.8, 0.02);
  set_covariance(batch, 3e-8, -1e-8, 1e-8);
  ContactDecoder decoder;
  ASSERT_EQ(decoder.decode(2, contact_topic("p"), batch.SerializeAsString()),
            v1::REJECT_REASON_UNSPECIFIED);
  ASSERT_EQ(decoder.message().details.size(), 10U);
  const SampleDetail& detail = decoder.message().details[3];
  EXPECT_EQ(detail.normal, Vec2(-0.6, 0.8));
  EXPECT_EQ(detail.normal_sigma_rad, 0.02);
  EXPECT_EQ(detail.covariance_m2, Eigen::Vector3d(3e-8, -1e-8, 1e-8));
  EXPECT_DOUBLE_EQ(decoder.message().samples[3].sigma_m, std::sqrt(2e-8));
  EXPECT_FALSE(says_more(decoder.message().details[2]));
  EXPECT_EQ(decoder.message().samples[2].sigma_m, 1e-5);
  // What it says goes out as it came in.
  v1::ContactSample again;
  to_wire(detail, again);
  EXPECT_EQ(again.normal_y(), 0.8);
  EXPECT_EQ(again.cov_xy_m2(), -1e-8);
  again.Clear();
  to_wire(SampleDetail{}, again);
  EXPECT_EQ(again.ByteSizeLong(), 0U);
  // The next message has none, and none is kept.
  ASSERT_EQ(decoder.decode(2, contact_topic("p"), line_batch("p", 0, 1).SerializeAsString()),
            v1::REJECT_REASON_UNSPECIFIED);
  EXPECT_TRUE(decoder.message().details.empty());
}

TEST(Ingest, SixHundredAndFiftySamplesFitWithAllTheirFields) {
  const std::string longest_name(64, 'p');
  v1::ContactBatch batch = line_batch(longest_name, std::numeric_limits<std::uint64_t>::max(), 0);
  batch.set_group(longest_name);
  batch.mutable_samples(3)->set_stamp_ns(std::numeric_limits<std::int64_t>::min());  // ten bytes
  set_normal(batch, -0.6, 0.8, 0.02);
  set_covariance(batch, 3e-8, -1e-8, 1e-8);
  const v1::ContactSample full = batch.samples(3);
  batch.clear_samples();
  for (int i = 0; i < 650; ++i) {
    *batch.add_samples() = full;
  }
  EXPECT_EQ(ContactDecoder().decode(2, contact_topic(longest_name), batch.SerializeAsString()),
            v1::REJECT_REASON_UNSPECIFIED);
}

TEST(Ingest, EachReasonOfContent) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  using Change = std::function<void(v1::ContactBatch&)>;
  const std::vector<std::pair<v1::RejectReason, Change>> changes = {
      {v1::REJECT_REASON_HEADER, [](auto& b) { b.clear_header(); }},
      {v1::REJECT_REASON_SOURCE, [](auto& b) { b.mutable_header()->set_source("q"); }},
      {v1::REJECT_REASON_FRAME_NAME, [](auto& b) { b.mutable_header()->set_frame("a/b"); }},
      {v1::REJECT_REASON_GROUP_NAME, [](auto& b) { b.set_group("a/b"); }},
      {v1::REJECT_REASON_GROUP_NAME, [](auto& b) { b.set_group(std::string(65, 'x')); }},
      {v1::REJECT_REASON_EMPTY, [](auto& b) { b.clear_samples(); }},
      {v1::REJECT_REASON_TOO_MANY_SAMPLES, [](auto& b) { b = line_batch("p", 0, 0, 1025); }},
      {v1::REJECT_REASON_NOT_FINITE, [](auto& b) { b.mutable_samples(4)->set_x_m(kNan); }},
      {v1::REJECT_REASON_NOT_FINITE, [](auto& b) { b.mutable_samples(4)->set_y_m(-kInfinity); }},
      {v1::REJECT_REASON_NOT_FINITE, [](auto& b) { b.mutable_samples(4)->set_sigma_m(kNan); }},
      {v1::REJECT_REASON_NOT_FINITE, [](auto& b) { b.set_tip_radius_m(kInfinity); }},
      {v1::REJECT_REASON_COORDINATE, [](auto& b) { b.mutable_samples(9)->set_x_m(1e308); }},
      {v1::REJECT_REASON_COORDINATE, [](auto& b) { b.mutable_samples(0)->set_y_m(-1.1e7); }},
      {v1::REJECT_REASON_SIGMA, [](auto& b) { b.mutable_samples(0)->set_sigma_m(-1e-6); }},
      {v1::REJECT_REASON_SIGMA, [](auto& b) { b.mutable_samples(0)->set_sigma_m(1e4); }},
      {v1::REJECT_REASON_SIGMA, [](auto& b) { b.mutable_samples(0)->set_sigma_m(5e-324); }},
      {v1::REJECT_REASON_NOT_FINITE, [](auto& b) { set_normal(b, kNan, 0.0, 0.1); }},
      {v1::REJECT_REASON_NOT_FINITE, [](auto& b) { set_normal(b, 1.0, 0.0, kInfinity); }},
      {v1::REJECT_REASON_NOT_FINITE, [](auto& b) { set_covariance(b, 1e-8, kNan, 1e-8); }},
      {v1::REJECT_REASON_NORMAL, [](auto& b) { set_normal(b, 1.0, 0.0, 0.0); }},
      {v1::REJECT_REASON_NORMAL, [](auto& b) { set_normal(b, 1.0, 0.0, -0.1); }},
      {v1::REJECT_REASON_NORMAL, [](auto& b) { set_normal(b, 1.0, 0.0, 3.2); }},
      {v1::REJECT_REASON_NORMAL, [](auto& b) { set_normal(b, 0.7, 0.7, 0.1); }},
      {v1::REJECT_REASON_NORMAL, [](auto& b) { set_normal(b, 0.0, 0.0, 0.1); }},
      {v1::REJECT_REASON_NORMAL, [](auto& b) { set_normal(b, 0.0, 0.0, 0.0); }},
      {v1::REJECT_REASON_NORMAL, [](auto& b) { b.mutable_samples(3)->set_normal_x(1.0); }},
      {v1::REJECT_REASON_NORMAL, [](auto& b) { b.mutable_samples(3)->set_normal_sigma_rad(0.1); }},
      {v1::REJECT_REASON_COVARIANCE, [](auto& b) { set_covariance(b, 1e-8, 2e-8, 1e-8); }},
      {v1::REJECT_REASON_COVARIANCE, [](auto& b) { set_covariance(b, 1e-8, 1e-8, 1e-8); }},
      {v1::REJECT_REASON_COVARIANCE, [](auto& b) { set_covariance(b, 0.0, 0.0, 0.0); }},
      {v1::REJECT_REASON_COVARIANCE, [](auto& b) { set_covariance(b, 0.0, 0.0, 1e-8); }},
      {v1::REJECT_REASON_COVARIANCE, [](auto& b) { set_covariance(b, -1e-8, 0.0, 1e-8); }},
      {v1::REJECT_REASON_COVARIANCE, [](auto& b) { set_covariance(b, 1e8, 0.0, 1e-8); }},
      {v1::REJECT_REASON_COVARIANCE, [](auto& b) { set_covariance(b, 1e-8, 0.0, 1e-40); }},
      {v1::REJECT_REASON_COVARIANCE, [](auto& b) { b.mutable_samples(3)->set_cov_xx_m2(1e-8); }},
      {v1::REJECT_REASON_TIP_RADIUS, [](auto& b) { b.set_tip_radius_m(-1e-3); }},
      {v1::REJECT_REASON_TIP_RADIUS, [](auto& b) { b.set_tip_radius_m(1e4); }},
      {v1::REJECT_REASON_MATERIAL_SIDE,
       [](auto& b) { b.set_material_side(static_cast<v1::MaterialSide>(77)); }},
  };
  for (const auto& [reason, change] : changes) {
    v1::ContactBatch batch = line_batch("p", 0, 0);
    ASSERT_EQ(decode(batch), v1::REJECT_REASON_UNSPECIFIED);
    change(batch);
    EXPECT_EQ(decode(batch), reason) << v1::RejectReason_Name(reason);
  }
}

TEST(Ingest, TheBoundsThemselvesPass) {
  v1::ContactBatch batch = line_batch("p", 0, 0, 1024);
  batch.mutable_samples(0)->set_x_m(-1e7);
  batch.mutable_samples(1)->set_sigma_m(0.0);
  batch.mutable_samples(2)->set_sigma_m(kMinSigma);
  batch.mutable_samples(3)->set_sigma_m(1e3);
  batch.set_tip_radius_m(1e3);
  EXPECT_EQ(decode(batch), v1::REJECT_REASON_UNSPECIFIED);
}

}  // namespace
}  // namespace palpate
