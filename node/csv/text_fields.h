// A line's fields, by whatever people put between them.
#pragma once

#include <algorithm>
#include <iterator>
#include <string_view>
#include <vector>

#include "node/csv/text_lines.h"

namespace palpate::csv {

/// What parts the fields of a line, by rank: where there are tabs, commas are decimal points or
/// text. ' ' stands for any blanks.
inline char separator_of(std::string_view line) {
  for (const char separator : {'\t', ';', '|', ','}) {
    if (line.find(separator) != std::string_view::npos) return separator;
  }
  return ' ';
}

/// Where the field ends that begins at `from`: separators between quotes are text.
inline std::size_t field_end(std::string_view line, char separator, std::size_t from) {
  const std::size_t plain_end = std::min(line.find(separator, from), line.size());
  std::size_t at = from;
  while (at < line.size() && is_blank(line[at]) && line[at] != separator) ++at;
  if (at == line.size() || line[at] != '"') return plain_end;
  for (at = line.find('"', at + 1); at != std::string_view::npos; at = line.find('"', at + 1)) {
    const bool is_doubled = at + 1 < line.size() && line[at + 1] == '"';
    if (is_doubled) {
      ++at;
      continue;
    }
    ++at;
    while (at < line.size() && is_blank(line[at]) && line[at] != separator) ++at;
    // A quote in the midst of text, as of inches, closes nothing.
    return at == line.size() || line[at] == separator ? at : plain_end;
  }
  return plain_end;
}

inline void split_fields(std::string_view line, char separator,
                         std::vector<std::string_view>& fields) {
  fields.clear();
  if (separator == ' ') {
    for (std::size_t from = 0;;) {
      while (from < line.size() && is_blank(line[from])) ++from;
      if (from == line.size()) return;
      std::size_t end = from;
      while (end < line.size() && !is_blank(line[end])) ++end;
      fields.push_back(line.substr(from, end - from));
      from = end;
    }
  }
  for (std::size_t from = 0;;) {
    const std::size_t end = field_end(line, separator, from);
    std::string_view field = trimmed(line.substr(from, end - from));
    if (field.size() >= 2 && field.front() == '"' && field.back() == '"') {
      field = field.substr(1, field.size() - 2);
    }
    fields.push_back(field);
    if (end == line.size()) return;
    from = end + 1;
  }
}

/// Whether a spreadsheet's cell that failed begins here.
inline bool is_failed_cell(std::string_view text) {
  constexpr std::string_view kFailures[] = {"#N/A",   "#DIV/0!", "#REF!", "#VALUE!",
                                            "#NAME?", "#NUM!",   "#NULL!"};
  return std::any_of(std::begin(kFailures), std::end(kFailures),
                     [text](std::string_view failure) { return text.starts_with(failure); });
}

/// Where a comment begins: '#' or '%' at the line's beginning or after a blank. "#N/A" in a
/// spreadsheet's cell is none, nor is "[%]" in a name.
inline std::size_t comment_mark(std::string_view line) {
  for (std::size_t at = line.find_first_of("#%"); at != std::string_view::npos;
       at = line.find_first_of("#%", at + 1)) {
    if ((at == 0 || is_blank(line[at - 1])) && !is_failed_cell(line.substr(at))) return at;
  }
  return std::string_view::npos;
}

/// The separator of a spreadsheet's first line "sep=;"; 0 where the line is none.
inline char told_separator(std::string_view line) {
  constexpr std::string_view kMark = "sep=";
  const std::string_view told = trimmed(line);
  if (told.size() != kMark.size() + 1) return '\0';
  for (std::size_t i = 0; i < kMark.size(); ++i) {
    if (told[i] != kMark[i] && told[i] != kMark[i] - 'a' + 'A') return '\0';
  }
  return told.back();
}

}  // namespace palpate::csv
