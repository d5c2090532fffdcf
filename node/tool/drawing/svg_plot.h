// A recognition drawn to scale: samples, most probable curve with its 95 % band, rivals, enlarged
// residuals, contacts and frame, with a table of what is known.
#pragma once

#include <string>

#include "node/tool/contact_groups.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate {

/// An SVG document of at most a few megabytes: of samples that lie on one another's dots one is
/// drawn, and the picture says how many are left out.
std::string svg_plot(const ContactGroup& group, const v1::Recognition& answer);

}  // namespace palpate
