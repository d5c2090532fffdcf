#include "node/tool/commands/offline/placed_part.h"

#include <iostream>

#include "node/files/printable.h"
#include "node/files/written_file.h"
#include "node/tool/commands/command.h"
#include "node/tool/part_match.h"
#include "node/tool/text/message_json.h"

namespace palpate {

int place_part(const std::string& part_file, const std::vector<FitInput>& inputs,
               const RecognizerOptions& recognizer, bool json) {
  const Result<ClosedSpline> part = read_part(part_file);
  if (!part) {
    return complain(part.error, kUsage);
  }
  SegmentMatchOptions options;
  options.sigma_m = recognizer.sigma_m;
  options.determined_probability = recognizer.recognized_probability;
  options.false_outlier_probability = recognizer.false_outlier_probability;
  const char* separator = "";
  for (const FitInput& input : inputs) {
    const ContactGroup& group = input.group;
    for (const std::string& note : input.notes) complain(group.file + ": " + note, kDone);
    if (const std::string note = note_of_unused_detail(group); !note.empty()) {
      complain(group.file + ": " + note, kDone);
    }
    const v1::PartMatch match = match_part(group, *part.value, options);
    if (json) {
      std::cout << json_line(match);
    } else {
      std::cout << separator << printable_path(group.file) << ", " << group.name << ": "
                << part_match_text(match, options.sigma_m > 0.0 || input.noise_is_known);
      separator = "\n";
    }
  }
  const std::string why = flush_standard_output();
  return why.empty() ? kDone : complain(why, kFailed);
}

}  // namespace palpate
