// Checks and decodes one message from the wire into core types, or returns the reason why not. Uses
// no sockets, no clock and no memory of earlier messages, so that it can be fuzzed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/recognition/recognizer.h"
#include "node/wire/ingest_limits.h"
#include "palpate/v1/contact.pb.h"
#include "palpate/v1/node_status.pb.h"

namespace palpate {

/// A message that has passed all checks. The views point into the decoder's memory.
struct ContactMessage {
  std::string_view probe;
  std::string_view group;  ///< the probe's name if the message has no group
  std::string_view frame;
  std::uint64_t epoch = 0;
  std::uint64_t seq = 0;
  std::int64_t published_ns = 0;
  std::uint64_t object = 0;
  std::uint32_t patch = 0;
  double tip_radius_m = 0.0;
  MaterialSide material_side = MaterialSide::Unspecified;
  std::vector<ContactSample> samples;  ///< at least one
  std::vector<SampleDetail> details;   ///< one per sample, or empty if no sample has any
  std::int64_t newest_sample_stamp_ns = 0;
};

/// Decodes messages one after the other. Does not allocate after it has seen the largest message.
class ContactDecoder {
 public:
  explicit ContactDecoder(const IngestLimits& limits = {}) : limits_(limits) {}

  /// Checks and decodes a message of `frame_count` frames; `topic` and `payload` are the first two
  /// (empty if there are fewer). Returns REJECT_REASON_UNSPECIFIED if it has passed; message() then
  /// holds until the next call.
  v1::RejectReason decode(std::size_t frame_count, std::string_view topic,
                          std::string_view payload);

  const ContactMessage& message() const { return message_; }

  /// The probe of the last topic; empty if the topic was invalid.
  std::string_view probe() const { return probe_; }

 private:
  v1::RejectReason check_header();
  v1::RejectReason check_context();
  v1::RejectReason take_samples();

  IngestLimits limits_;
  std::string_view probe_;
  v1::ContactBatch batch_;
  ContactMessage message_;
};

/// True for reasons which say that the bytes are no contact message at all.
bool is_malformed(v1::RejectReason reason);

}  // namespace palpate
