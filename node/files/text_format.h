// Messages in protobuf's text format: scenes, parts, configurations.
#pragma once

#include <google/protobuf/text_format.h>

#include <string>

#include "node/files/result.h"

namespace palpate {

/// Reads `text` into `message`. Returns the first error, "NAME:LINE:COLUMN: what is wrong", or
/// nothing. `locations` receives where each field stands.
std::string parse_text(const std::string& text, const std::string& name,
                       google::protobuf::Message& message,
                       google::protobuf::TextFormat::ParseInfoTree* locations = nullptr);

/// A whole file; an error reads "PATH: cannot be read: why".
Result<std::string> read_file(const std::string& path);

}  // namespace palpate
