// Text for a drawing, whatever it holds: escaped, and in lines that fit their place.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace palpate {

/// The text, escaped for use in markup. What is no UTF-8 or no character of XML becomes '?'.
std::string escaped(std::string_view text);

/// Width that the text takes at most in the sans-serif fonts that browsers have. [px]
double text_width_px(std::string_view text, double font_px);

/// The text in lines of at most this width: broken at blanks, or within a word that is longer than
/// a line. At least one line.
std::vector<std::string> lines_within(std::string_view text, double width_px, double font_px);

/// The text if it fits, else as much of its end as does after "...": of a path the end says most.
std::string end_within(std::string_view text, double width_px, double font_px);

}  // namespace palpate
