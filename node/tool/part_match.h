// Matches patches to a known closed part: reads the model, returns the answer as a message and as
// text.
#pragma once

#include <string>

#include "core/part/closed_spline.h"
#include "core/part/segment_match.h"
#include "node/files/result.h"
#include "node/tool/contact_groups.h"
#include "palpate/v1/part_match.pb.h"

namespace palpate {

/// Reads the closed spline of a scene file (palpate/v1/scene.proto); ignores its pose and probes.
/// An error reads "FILE[:LINE:COLUMN]: what is wrong".
Result<ClosedSpline> read_part(const std::string& path);
/// The same from text; `path` stands for the file in errors.
Result<ClosedSpline> parse_part(const std::string& text, const std::string& path);

/// In the answer, samples are numbered within their patch, in the order of the file.
v1::PartMatch match_part(const ContactGroup& group, const ClosedSpline& part,
                         const SegmentMatchOptions& options);

/// A text of several lines for a person to read; each line ends with a line feed.
/// `noise_is_stated`: by whoever touched, of every sample; else the text says what was assumed.
std::string part_match_text(const v1::PartMatch& match, bool noise_is_stated);

}  // namespace palpate
