// Draws a recognition to scale: samples, the most probable curve with its 95 % band, rivals,
// enlarged residuals, contacts and frame, and a table of the results.
#pragma once

#include <span>
#include <string>

#include "node/tool/contact_groups.h"
#include "node/tool/text/advice.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate {

/// An SVG document of at most a few megabytes. Samples whose dots would coincide are drawn once;
/// the picture says how many are left out.
/// `set_aside`: where the samples lie that the answer calls spikes. `stated`: what no advice in it
/// asks for.
std::string svg_plot(const ContactGroup& group, const v1::Recognition& answer,
                     std::span<const Vec2> set_aside = {}, const Stated& stated = {});

}  // namespace palpate
