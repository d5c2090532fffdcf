// Messages as protobuf's JSON, field names as in the wire contract.
#pragma once

#include <google/protobuf/message.h>

#include <string>

namespace palpate {

/// One line, ended; fields that are zero are printed too.
std::string json_line(const google::protobuf::Message& message);

}  // namespace palpate
