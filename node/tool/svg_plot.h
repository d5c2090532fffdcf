// A recognition drawn: points, recognised curve, contacts and the curve's frame, to scale.
#pragma once

#include <string>

#include "core/recognition/recognition.h"
#include "node/tool/contact_groups.h"

namespace palpate {

/// An SVG document. `title` stands above the picture.
std::string svg_plot(const ContactGroup& group, const Recognition& answer,
                     const std::string& title);

}  // namespace palpate
