// Silence for protobuf's own log.
#pragma once

#include <google/protobuf/stubs/logging.h>

namespace palpate {

/// Every program calls this first: libprotobuf would print a line for each malformed message, as
/// many as a stranger likes to send. Who parses counts what fails, or says it.
inline void silence_protobuf() { google::protobuf::SetLogHandler(nullptr); }

}  // namespace palpate
