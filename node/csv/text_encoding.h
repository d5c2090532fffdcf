// Text as spreadsheets save it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace palpate::csv {

/// UTF-16 with a byte order mark, which Excel calls Unicode text, as UTF-8; nullopt for other text.
std::optional<std::string> utf8_of_utf16(std::string_view text);

/// Why these bytes are no text, as of a packed file or a spreadsheet's own format, and what to do;
/// nullopt for text.
std::optional<std::string> no_text_because(std::string_view bytes);

}  // namespace palpate::csv
