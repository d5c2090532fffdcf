// A contact as the plant gives it: what it is, and which of the stream and of the consumer.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "node/gateway/group_feed.h"

namespace palpate::gateway {

struct GroupContact {
  std::string group;
  FedContact contact;
};

/// A contact of the plant; nullopt where subject and payload do not agree, or are none of ours.
std::optional<GroupContact> read_contact(std::string_view subject, std::string_view payload,
                                         std::uint64_t stream_seq);

/// Of "$JS.ACK.STREAM.CONSUMER.TIMES.STREAM_SEQ.CONSUMER_SEQ.TIME.PENDING", before which newer
/// servers have two more tokens.
struct DeliveryNumbers {
  std::uint64_t stream_seq = 0;
  std::uint64_t consumer_seq = 0;
};

DeliveryNumbers numbers_of(std::string_view reply);

}  // namespace palpate::gateway
