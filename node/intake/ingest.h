// The border: one message from the wire becomes core types, or a reason why not. No sockets, no
// clock and no memory of earlier messages, so that it can be fuzzed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/recognition/recognizer.h"
#include "palpate/v1/contact.pb.h"
#include "palpate/v1/node_status.pb.h"

namespace palpate {

struct IngestLimits {
  std::size_t max_message_bytes = 65536;  ///< of the second frame
  /// About 40 kB on the wire; with normals and covariances 94 kB, which is too long a message.
  std::size_t max_samples_per_batch = 1024;
  /// Largest |x|, |y|. Beyond it a double no longer resolves a nanometre. [m]
  double max_coordinate_m = 1e7;
  double max_sigma_m = 1e3;       ///< [m]
  double max_tip_radius_m = 1e3;  ///< [m]
};

/// Sigmas between 0 ("not known") and this are no real noise, and their squares would underflow.
/// [m]
inline constexpr double kMinSigma = 1e-15;

/// The same of a normal's direction: a unit vector is rounded by a tenth of that. [rad]
inline constexpr double kMinNormalSigma = 1e-15;

/// A message that has passed; views point into the decoder's memory.
struct ContactMessage {
  std::string_view probe;
  std::string_view group;  ///< the probe's name where the message has none
  std::string_view frame;
  std::uint64_t epoch = 0;
  std::uint64_t seq = 0;
  std::int64_t published_ns = 0;
  std::uint64_t object = 0;
  std::uint32_t patch = 0;
  double tip_radius_m = 0.0;
  MaterialSide material_side = MaterialSide::Unspecified;
  std::vector<ContactSample> samples;  ///< at least one
  std::vector<SampleDetail> details;   ///< of the samples; empty where none says more
  std::int64_t newest_sample_stamp_ns = 0;
};

/// Decodes messages one after the other, without allocating once it has grown to the largest.
class ContactDecoder {
 public:
  explicit ContactDecoder(const IngestLimits& limits = {}) : limits_(limits) {}

  /// Checks and decodes one message of `frame_count` frames, of which the first two are given
  /// (empty where there are fewer). Returns REJECT_REASON_UNSPECIFIED where it has passed;
  /// message() then holds until the next call.
  v1::RejectReason decode(std::size_t frame_count, std::string_view topic,
                          std::string_view payload);

  const ContactMessage& message() const { return message_; }

  /// The probe of the topic last decoded, empty where the topic was invalid.
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

/// True for reasons that say the bytes are no contact message at all.
bool is_malformed(v1::RejectReason reason);

}  // namespace palpate
