// palpate fit --class: a given class fitted to one object of a file.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/recognition/recognizer.h"
#include "node/files/probe_files.h"
#include "node/tool/contact_groups.h"
#include "palpate/v1/given_class.pb.h"

namespace palpate {

struct GivenClass {
  CurveClass curve_class = CurveClass::Line;
  std::vector<std::size_t> left_out;  ///< samples that do not count, numbered from 1
};

/// By qualified probes where there are any. `notes` receives what is to be said beside the answer.
v1::GivenClassAnswer fit_given(const GivenClass& given, const ContactGroup& group,
                               const RecognizerOptions& options, const ProbeFiles& probes,
                               std::vector<std::string>& notes);

}  // namespace palpate
