// Decimal points and decimal commas of one file.
#pragma once

#include <string>
#include <string_view>

namespace palpate::csv {

/// Which marks its numbers have had. A file that has both means thousands by one of them.
class DecimalMarks {
 public:
  /// Takes a number's text; what is wrong with it beside those before, or nothing.
  std::string take(std::string_view text) {
    const bool has_comma = text.find(',') != std::string_view::npos;
    comma_ |= has_comma;
    point_ |= text.find('.') != std::string_view::npos;
    if (!comma_ || !point_) return {};
    return has_comma ? "numbers before have a decimal point: does this comma part thousands?"
                     : "numbers before have a decimal comma, this one has a point";
  }

  bool comma() const { return comma_; }

 private:
  bool comma_ = false;
  bool point_ = false;
};

/// What is to be said beside of a line of more fields than there are columns: commas that part
/// fields and decimal commas are not told apart.
inline std::string_view hint_of_commas(std::string_view line, char separator) {
  return separator == ',' && line.find('.') == std::string_view::npos
             ? "; are these decimal commas? Then part the columns by semicolons or tabs"
             : "";
}

}  // namespace palpate::csv
