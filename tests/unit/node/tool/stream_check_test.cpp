// What palpate check finds in streams that are wrong in one way each.
#include "node/tool/commands/check/stream_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "palpate/v1/contact.pb.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kNow = 1'700'000'000'000'000'000;

/// Feeds batches of ten samples along a circle of 20 mm, each changed by `spoil`.
std::vector<Finding> findings_of(
    const std::function<void(std::size_t number, v1::ContactBatch& batch)>& spoil) {
  StreamCheck check;
  std::mt19937_64 rng = test::test_rng();
  std::normal_distribution<double> noise(0.0, 1e-5);
  for (std::size_t number = 0; number < 20; ++number) {
    v1::ContactBatch batch;
    batch.mutable_header()->set_source("p");
    batch.mutable_header()->set_epoch(5);
    batch.mutable_header()->set_seq(number);
    for (std::size_t i = 0; i < 10; ++i) {
      const double t = 0.01 * static_cast<double>(10 * number + i);
      v1::ContactSample& sample = *batch.add_samples();
      sample.set_x_m(0.02 * std::cos(t) + noise(rng));
      sample.set_y_m(0.02 * std::sin(t) + noise(rng));
      sample.set_sigma_m(1e-5);
      sample.set_stamp_ns(kNow + static_cast<std::int64_t>(10 * number + i) * 1'000'000);
    }
    spoil(number, batch);
    check.take(2, "contact/p/", batch.SerializeAsString(),
               kNow + static_cast<std::int64_t>(10 * number + 10) * 1'000'000);
  }
  return check.findings();
}

bool has(const std::vector<Finding>& findings, Severity severity, const std::string& what) {
  for (const Finding& finding : findings) {
    if (finding.severity == severity && finding.what.find(what) != std::string::npos) {
      return true;
    }
  }
  return false;
}

TEST(StreamCheck, AStreamWithoutEpochIsNotFit) {
  const auto findings = findings_of(
      [](std::size_t, v1::ContactBatch& batch) { batch.mutable_header()->clear_epoch(); });
  EXPECT_TRUE(has(findings, Severity::Error, "without header.epoch"));
}

TEST(StreamCheck, InventedNamesAreCountedNotKept) {
  StreamCheck check;
  v1::ContactBatch batch;
  batch.mutable_header()->set_epoch(1);
  batch.add_samples();
  for (int i = 0; i < 10'000; ++i) {
    const std::string topic = "contact/p" + std::to_string(i) + "/";
    check.take(2, topic, batch.SerializeAsString(), kNow);
    check.take(2, topic, "no message", kNow);
  }
  const std::vector<Finding> findings = check.findings();
  EXPECT_TRUE(has(findings, Severity::Error, "TOO_MANY_PROBES"));
  EXPECT_LT(findings.size(), 1000U);
}

TEST(StreamCheck, APatchInNoOrderIsNotFit) {
  const auto findings = findings_of([](std::size_t number, v1::ContactBatch& batch) {
    for (int i = 0; i < batch.samples_size(); ++i) {
      const double t = 2.4 * static_cast<double>(10 * number + static_cast<std::size_t>(i));
      batch.mutable_samples(i)->set_x_m(0.02 * std::cos(t));
      batch.mutable_samples(i)->set_y_m(0.02 * std::sin(t));
    }
  });
  EXPECT_TRUE(has(findings, Severity::Error, "to and fro"));
}

TEST(StreamCheck, AllPatchesOfALongStreamAreCounted) {
  StreamCheck check;
  constexpr std::uint32_t kPatches = 300;  // more than are kept for judgement
  for (std::uint32_t number = 0; number < kPatches; ++number) {
    v1::ContactBatch batch;
    batch.mutable_header()->set_epoch(5);
    batch.mutable_header()->set_seq(number);
    batch.set_patch(number);
    batch.add_samples()->set_x_m(1e-3 * number);
    check.take(2, "contact/p/", batch.SerializeAsString(), kNow);
  }
  EXPECT_TRUE(has(check.findings(), Severity::Note, "300 messages, 300 samples, 300 patches"));
}

TEST(StreamCheck, AGoodStreamHasNotesOnly) {
  for (const Finding& finding : findings_of([](std::size_t, v1::ContactBatch&) {})) {
    EXPECT_EQ(finding.severity, Severity::Note) << finding.what;
  }
}

/// Normals of the circle, turned by so much.
std::function<void(std::size_t, v1::ContactBatch&)> with_normals(double turned) {
  return [turned](std::size_t number, v1::ContactBatch& batch) {
    for (int i = 0; i < batch.samples_size(); ++i) {
      const double t = 0.01 * (10.0 * static_cast<double>(number) + i) + turned;
      batch.mutable_samples(i)->set_normal_x(std::cos(t));
      batch.mutable_samples(i)->set_normal_y(std::sin(t));
      batch.mutable_samples(i)->set_normal_sigma_rad(0.01);
    }
    batch.set_material_side(v1::MATERIAL_SIDE_LEFT);
  };
}

TEST(StreamCheck, NormalsAreSeenBesideTheTravel) {
  EXPECT_TRUE(has(findings_of(with_normals(0.0)), Severity::Note, "200 measured normals"));
  EXPECT_TRUE(has(findings_of(with_normals(0.5 * kPi)), Severity::Error, "along the travel"));
  EXPECT_TRUE(has(findings_of(with_normals(kPi)), Severity::Error, "material_side"));
  EXPECT_TRUE(has(findings_of([](std::size_t, v1::ContactBatch& batch) {
                    batch.mutable_samples(0)->set_normal_x(2.0);
                  }),
                  Severity::Error, "REJECT_REASON_NORMAL"));
  EXPECT_TRUE(has(findings_of([](std::size_t, v1::ContactBatch& batch) {
                    batch.mutable_samples(0)->set_cov_xx_m2(-1.0);
                  }),
                  Severity::Error, "REJECT_REASON_COVARIANCE"));
}

TEST(StreamCheck, NormalsThatAreFurtherOffThanTheyStateAreNotAsTheyShouldBe) {
  const auto findings = findings_of(with_normals(0.3));  // of a stated 0.01 rad
  EXPECT_TRUE(has(findings, Severity::Warning, "half of 200 measured normals are more than 17"));
  EXPECT_TRUE(has(findings, Severity::Warning, "they state a deviation of 0.57 degrees"));
  EXPECT_FALSE(has(findings, Severity::Note, "measured normals"));
}

TEST(StreamCheck, NormalsOfNeighboursThatAreOpposedAreSeen) {
  const auto with_every_turned_over = [](std::size_t one_of) {
    return [one_of](std::size_t number, v1::ContactBatch& batch) {
      with_normals(0.0)(number, batch);
      batch.set_material_side(v1::MATERIAL_SIDE_UNSPECIFIED);
      for (int i = 0; i < batch.samples_size(); ++i) {
        v1::ContactSample& sample = *batch.mutable_samples(i);
        if ((10 * number + static_cast<std::size_t>(i)) % one_of != one_of - 1) continue;
        sample.set_normal_x(-sample.normal_x());
        sample.set_normal_y(-sample.normal_y());
      }
    };
  };
  EXPECT_TRUE(has(findings_of(with_every_turned_over(2)), Severity::Error,
                  "of 200 measured normals, 199 pairs of neighbours point to opposite sides"));
  EXPECT_TRUE(has(findings_of(with_every_turned_over(150)), Severity::Warning,
                  "2 pairs of neighbours point to opposite sides"));
}

TEST(StreamCheck, AnObjectForEachMessageIsTold) {
  const auto counted_up = [](std::size_t messages) {
    return findings_of(
        [=](std::size_t number, v1::ContactBatch& batch) { batch.set_object(number / messages); });
  };
  EXPECT_TRUE(has(counted_up(1), Severity::Warning,
                  "nearly every message: 20 objects in 20 messages, of at most 10 samples"));
  EXPECT_FALSE(has(counted_up(5), Severity::Warning, "object changes"));
}

TEST(StreamCheck, AnApproachThroughTheAirIsToldAsOfAFile) {
  // From beside the circle straight to it, at a right angle.
  const auto findings = findings_of([](std::size_t number, v1::ContactBatch& batch) {
    for (int i = 0; i < batch.samples_size(); ++i) {
      const double step = 10.0 * static_cast<double>(number) + i - 20.0;
      v1::ContactSample& sample = *batch.mutable_samples(i);
      const double noise = i % 2 == 0 ? 1e-6 : -1e-6;
      sample.set_x_m((step < 0.0 ? 0.02 - 2e-4 * step : 0.02 * std::cos(0.01 * step)) + noise);
      sample.set_y_m((step < 0.0 ? 0.0 : 0.02 * std::sin(0.01 * step)) - noise);
    }
  });
  EXPECT_TRUE(has(findings, Severity::Warning, "1 stroke runs straight at an end"));
  EXPECT_FALSE(has(findings_of([](std::size_t, v1::ContactBatch&) {}), Severity::Warning,
                   "straight at an end"));
}

TEST(StreamCheck, MillimetresAreSuspected) {
  const auto findings = findings_of([](std::size_t, v1::ContactBatch& batch) {
    for (v1::ContactSample& sample : *batch.mutable_samples()) {
      sample.set_x_m(1e3 * sample.x_m());
      sample.set_y_m(1e3 * sample.y_m());
    }
  });
  EXPECT_TRUE(has(findings, Severity::Warning, "a patch extends over"));
}

TEST(StreamCheck, ATipOfMillimetresAsMetresIsSaid) {
  const auto with_tip = [](double radius_m) {
    return findings_of(
        [&](std::size_t, v1::ContactBatch& batch) { batch.set_tip_radius_m(radius_m); });
  };
  EXPECT_TRUE(has(with_tip(4.75), Severity::Warning, "centres of a tip of radius 4.75 m"));
  EXPECT_FALSE(has(with_tip(4.75e-3), Severity::Warning, "centres of a tip"));
}

TEST(StreamCheck, AnUnevenPaceIsHoles) {
  // Every other batch starts seven spacings late.
  double late = 0.0;
  const auto findings = findings_of([&](std::size_t number, v1::ContactBatch& batch) {
    late += number % 2 == 1 ? 0.07 : 0.0;
    for (v1::ContactSample& sample : *batch.mutable_samples()) {
      const double x = sample.x_m();
      sample.set_x_m(x * std::cos(late) - sample.y_m() * std::sin(late));
      sample.set_y_m(x * std::sin(late) + sample.y_m() * std::cos(late));
    }
  });
  EXPECT_TRUE(has(findings, Severity::Warning, "10 holes of 3 to"));
  EXPECT_FALSE(has(findings, Severity::Error, "jump"));
}

TEST(StreamCheck, AMissingLiftOffIsAJump) {
  const auto findings = findings_of([](std::size_t number, v1::ContactBatch& batch) {
    for (v1::ContactSample& sample : *batch.mutable_samples()) {
      sample.set_x_m(sample.x_m() + (number >= 10 ? 0.05 : 0.0));
    }
  });
  EXPECT_TRUE(has(findings, Severity::Error, "1 jump"));
}

TEST(StreamCheck, ASpikeIsNoJump) {
  const auto findings = findings_of([](std::size_t number, v1::ContactBatch& batch) {
    if (number != 10) return;
    v1::ContactSample& sample = *batch.mutable_samples(4);
    sample.set_x_m(sample.x_m() + 0.05);
  });
  EXPECT_FALSE(has(findings, Severity::Error, "jump"));
}

TEST(StreamCheck, AProbeThatStandsStillDoesNotJumpAfterwards) {
  // Sixteen batches of twenty at one place; the stroke goes on from there.
  std::mt19937_64 rng = test::test_rng();
  std::normal_distribution<double> jitter(0.0, 1e-6);
  const auto findings = findings_of([&](std::size_t number, v1::ContactBatch& batch) {
    if (number < 2) return;
    for (int i = 0; i < batch.samples_size(); ++i) {
      const double t = number < 18 ? 0.2 : 0.01 * (10.0 * (static_cast<double>(number) - 16.0) + i);
      v1::ContactSample& sample = *batch.mutable_samples(i);
      sample.set_x_m(0.02 * std::cos(t) + jitter(rng));
      sample.set_y_m(0.02 * std::sin(t) + jitter(rng));
    }
  });
  EXPECT_FALSE(has(findings, Severity::Error, "jump"));
}

TEST(StreamCheck, NoiseThatIsNotAsStatedIsTold) {
  const auto stated = [](double sigma_m) {
    const auto findings = findings_of([=](std::size_t, v1::ContactBatch& batch) {
      for (v1::ContactSample& sample : *batch.mutable_samples()) sample.set_sigma_m(sigma_m);
    });
    const auto told = std::find_if(findings.begin(), findings.end(), [](const Finding& finding) {
      return finding.what.find("the samples scatter by") != std::string::npos;
    });
    EXPECT_NE(told, findings.end());
    return told == findings.end() ? Finding() : *told;
  };
  EXPECT_EQ(stated(1e-7).severity, Severity::Warning);
  EXPECT_TRUE(stated(1e-7).spoils_answer);
  // Too large a noise makes answers doubtful, not wrong.
  EXPECT_EQ(stated(1e-4).severity, Severity::Warning);
  EXPECT_FALSE(stated(1e-4).spoils_answer);
}

TEST(StreamCheck, GapsInSeqAreCounted) {
  const auto findings = findings_of([](std::size_t number, v1::ContactBatch& batch) {
    batch.mutable_header()->set_seq(number + (number >= 7 ? 3 : 0));
  });
  EXPECT_TRUE(has(findings, Severity::Warning, "1 gap in seq, 3 messages lost"));
}

TEST(StreamCheck, BadStampsAreErrors) {
  EXPECT_TRUE(has(findings_of([](std::size_t, v1::ContactBatch& batch) {
                    for (v1::ContactSample& sample : *batch.mutable_samples()) {
                      sample.set_stamp_ns(sample.stamp_ns() - kNow + 1);
                    }
                  }),
                  Severity::Error, "more than an hour old"));
  EXPECT_TRUE(has(findings_of([](std::size_t, v1::ContactBatch& batch) {
                    for (v1::ContactSample& sample : *batch.mutable_samples()) {
                      sample.set_stamp_ns(2 * kNow - sample.stamp_ns());
                    }
                  }),
                  Severity::Error, "stamps earlier than the one before"));
  EXPECT_TRUE(has(findings_of([](std::size_t, v1::ContactBatch& batch) {
                    for (v1::ContactSample& sample : *batch.mutable_samples()) {
                      sample.set_stamp_ns(sample.stamp_ns() + 1'000'000'000);
                    }
                  }),
                  Severity::Error, "stamps in the future"));
  const auto stamped = [](std::size_t number_of_another) {
    return findings_of([=](std::size_t number, v1::ContactBatch& batch) {
      for (v1::ContactSample& sample : *batch.mutable_samples()) {
        sample.set_stamp_ns(number == number_of_another ? kNow + 1 : kNow);
      }
    });
  };
  EXPECT_TRUE(has(stamped(20), Severity::Warning, "all 200 stamps are equal: they tell no time"));
  EXPECT_FALSE(has(stamped(19), Severity::Warning, "stamps are equal"));
}

TEST(StreamCheck, WhatTheRecognizerWouldRejectIsNamedWithItsCure) {
  StreamCheck check;
  check.take(2, "contact/p/", "no message", kNow);
  check.take(1, "contact/p/", "", kNow);
  check.take(2, "contact/p", "", kNow);
  const auto findings = check.findings();
  ASSERT_EQ(findings.size(), 3U);
  for (const Finding& finding : findings) {
    EXPECT_EQ(finding.severity, Severity::Error);
    EXPECT_THAT(finding.what, HasSubstr("1 message rejected"));
    EXPECT_FALSE(finding.cure.empty());
  }
}

}  // namespace
}  // namespace palpate
