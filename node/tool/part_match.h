// Patches on a known closed part: model file in, message and text out.
#pragma once

#include <string>

#include "core/part/closed_spline.h"
#include "core/part/segment_match.h"
#include "node/files/result.h"
#include "node/tool/contact_groups.h"
#include "palpate/v1/part_match.pb.h"

namespace palpate {

/// The closed spline of a file in the scenes' schema (palpate/v1/scene.proto); its pose and probes
/// are not looked at. An error reads "FILE[:LINE:COLUMN]: what is wrong".
Result<ClosedSpline> read_part(const std::string& path);
/// The same of a text; `path` is what errors name.
Result<ClosedSpline> parse_part(const std::string& text, const std::string& path);

/// Sample numbers count the samples of a patch in the order of the file.
v1::PartMatch match_part(const ContactGroup& group, const ClosedSpline& part,
                         const SegmentMatchOptions& options);

/// For a person to read, several lines, each ended.
std::string part_match_text(const v1::PartMatch& match);

}  // namespace palpate
