// What an answer says, in words beside its picture.
#pragma once

#include "node/tool/contact_groups.h"
#include "node/tool/drawing/svg/svg_table.h"
#include "node/tool/text/advice.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate {

void add_answer(const ContactGroup& group, const v1::Recognition& answer, const Stated& stated,
                SvgTable& table);

}  // namespace palpate
