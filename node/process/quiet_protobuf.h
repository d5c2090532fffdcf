// Switches protobuf's own log off.
#pragma once

#include <google/protobuf/stubs/logging.h>

namespace palpate {

/// Every program calls this first. Otherwise libprotobuf would print a line for each malformed
/// message, as many as a stranger sends. The code that parses counts or reports failures itself.
inline void silence_protobuf() { google::protobuf::SetLogHandler(nullptr); }

}  // namespace palpate
