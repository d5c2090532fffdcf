// A small drawing of a recognition in the characters of a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "node/tool/contact_groups.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate {

/// `rows` lines of at most `columns` characters: samples, most probable curve and rivals to scale,
/// with a legend and the size of the picture below them. Empty if there is nothing to show or too
/// little room.
std::vector<std::string> terminal_plot(const ContactGroup& group, const v1::Recognition& answer,
                                       std::size_t columns, std::size_t rows);

}  // namespace palpate
