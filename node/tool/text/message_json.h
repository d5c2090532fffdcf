// Messages as protobuf's JSON, with the field names of the wire contract.
#pragma once

#include <google/protobuf/message.h>

#include <string>

namespace palpate {

/// One line, ending with a line feed. Fields that are zero are included.
std::string json_line(const google::protobuf::Message& message);

}  // namespace palpate
