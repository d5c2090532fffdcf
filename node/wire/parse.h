// Parses a message's payload where it lies.
#pragma once

#include <google/protobuf/message_lite.h>

#include <string_view>

namespace palpate {

/// False if the payload is no such message.
inline bool parse(google::protobuf::MessageLite& message, std::string_view payload) {
  return message.ParseFromArray(payload.data(), static_cast<int>(payload.size()));
}

}  // namespace palpate
