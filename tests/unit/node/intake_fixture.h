// Messages given to an intake, for tests.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <numeric>
#include <string>

#include "contact_messages.h"
#include "node/groups/intake.h"

namespace palpate::testing {

inline constexpr v1::RejectReason kTaken = v1::REJECT_REASON_UNSPECIFIED;

class IntakeFixture : public ::testing::Test {
 protected:
  v1::RejectReason give(Intake& intake, const std::string& probe, const v1::ContactBatch& batch) {
    return intake.take(2, contact_topic(probe), batch.SerializeAsString(), now_, 0);
  }

  v1::RejectReason give(const std::string& probe, const v1::ContactBatch& batch) {
    return give(intake_, probe, batch);
  }

  static v1::ContactBatch in_group(const std::string& group, std::uint64_t object,
                                   v1::ContactBatch batch) {
    batch.set_group(group);
    batch.set_object(object);
    return batch;
  }

  static std::uint64_t rejected_sum(const Intake& intake) {
    const auto& rejected = intake.counters().rejected;
    return std::accumulate(rejected.begin(), rejected.end(), std::uint64_t{0});
  }

  // What a worker would do.
  std::shared_ptr<GroupRecognizer> recognize(const std::string& group) {
    std::shared_ptr<GroupRecognizer> recognizer =
        intake_.groups().begin_work(*intake_.groups().find(group));
    recognizer->run();
    intake_.groups().end_work(*intake_.groups().find(group));
    return recognizer;
  }

  std::uint64_t recognized_samples(const std::string& group) {
    return recognize(group)->answer.recognition.sample_count();
  }

  SteadyTime now_ = SteadyTime(std::chrono::seconds(1000));
  Intake intake_{IntakeOptions()};
};

}  // namespace palpate::testing
