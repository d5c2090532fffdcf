// What palpate fit recognises: one object of a file, and what is to be said about it.
#pragma once

#include <string>
#include <vector>

#include "node/csv/contact_file.h"
#include "node/tool/contact_groups.h"

namespace palpate {

struct FitInput {
  ContactGroup group;
  std::vector<std::string> notes;     ///< what was assumed, merged, dropped or ignored
  std::vector<std::string> warnings;  ///< what makes the answer wrong or worth less
  bool noise_is_known = false;        ///< every sample brings its sigma
  bool is_alone = false;              ///< the file's only group and object
};

/// The objects of a file, in its order, judged with this noise of samples that bring none [m].
Result<std::vector<FitInput>> read_fit_input(const std::string& file,
                                             const ContactFileOptions& options, double sigma_m);

/// Memory that holds the whole object. A file is there at once: nothing of it is forgotten, unless
/// the bound on patches was asked for.
MemoryOptions memory_for(const ContactGroup& group, MemoryOptions memory, bool patches_are_bounded);

/// All that is to be said of a file's object: warnings, what reading assumed, and what such a
/// memory did to the samples.
std::vector<std::string> notes_for(const FitInput& input, const MemoryOptions& memory,
                                   const AddResult& added);

/// A message's JSON line with a field "notes" at its end; as it is where there are none.
std::string with_notes(std::string json_line, const std::vector<std::string>& notes);

}  // namespace palpate
