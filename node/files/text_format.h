// Reads messages in protobuf's text format: scenes, parts, configurations.
#pragma once

#include <google/protobuf/text_format.h>

#include <string>
#include <string_view>

#include "node/files/result.h"

namespace palpate {

/// Parses `text` into `message`. Returns an empty string, or the first error as "NAME:LINE:COLUMN:
/// what is wrong". If given, `locations` receives the position of each field.
std::string parse_text(const std::string& text, const std::string& name,
                       google::protobuf::Message& message,
                       google::protobuf::TextFormat::ParseInfoTree* locations = nullptr);

/// An error of parse_text() for those who do not know the format: `words` first, and what the
/// parser said in brackets behind.
std::string in_words(std::string error, const std::string& name, std::string_view words);

/// Reads a whole file. An error reads "PATH: cannot be read: why".
Result<std::string> read_file(const std::string& path);

}  // namespace palpate
