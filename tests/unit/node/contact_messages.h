// Contact messages for tests.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "node/wire/topics.h"
#include "palpate/v1/contact.pb.h"

namespace palpate::testing {

/// A valid batch of `count` samples at `spacing_m` along the x axis, beginning at `first_m`.
inline v1::ContactBatch line_batch(const std::string& probe, std::uint64_t epoch, std::uint64_t seq,
                                   int count = 10, double first_m = 0.0, double spacing_m = 1e-3) {
  v1::ContactBatch batch;
  batch.mutable_header()->set_source(probe);
  batch.mutable_header()->set_epoch(epoch);
  batch.mutable_header()->set_seq(seq);
  for (int i = 0; i < count; ++i) {
    v1::ContactSample& sample = *batch.add_samples();
    sample.set_x_m(first_m + i * spacing_m);
    sample.set_y_m(0.0);
    sample.set_sigma_m(1e-5);
    sample.set_stamp_ns(1000 + i);
  }
  return batch;
}

/// A valid batch of `count` samples on an ellipse of 40 x 25 mm about (0.3, 0.1), from curve
/// parameter `first` on.
inline v1::ContactBatch ellipse_batch(const std::string& probe, std::uint64_t epoch,
                                      std::uint64_t seq, double first, int count = 20) {
  v1::ContactBatch batch = line_batch(probe, epoch, seq, count);
  for (int i = 0; i < count; ++i) {
    const double t = first + 0.012 * i;
    v1::ContactSample& sample = *batch.mutable_samples(i);
    sample.set_x_m(0.3 + 0.040 * std::cos(t));
    sample.set_y_m(0.1 + 0.025 * std::sin(t));
  }
  return batch;
}

inline std::string contact_topic(const std::string& probe) {
  return make_topic(TopicKind::Contact, probe);
}

}  // namespace palpate::testing
