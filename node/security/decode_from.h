// Decodes a message and checks that its sender may publish it.
#pragma once

#include <cstddef>
#include <string_view>

#include "node/intake/ingest.h"
#include "node/security/sender.h"

namespace palpate {

/// Decodes a message of that sender (ContactDecoder::decode). Returns NOT_ALLOWED if the sender may
/// not publish as this probe, whatever else is wrong.
inline v1::RejectReason decode_from(const Sender& sender, ContactDecoder& decoder,
                                    std::size_t frame_count, std::string_view topic,
                                    std::string_view payload) {
  const v1::RejectReason reason = decoder.decode(frame_count, topic, payload);
  return decoder.probe().empty() || sender.may_publish_as(decoder.probe())
             ? reason
             : v1::REJECT_REASON_NOT_ALLOWED;
}

}  // namespace palpate
