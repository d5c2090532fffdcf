// What is to be said of an answer to a file, beside the answer.
#pragma once

#include <string>

#include "core/recognition/recognizer.h"
#include "node/tool/contact_groups.h"
#include "node/tool/text/advice.h"
#include "palpate/v1/given_class.pb.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate {

/// What was stated of the samples, by options or by themselves.
Stated stated_of(const ContactGroup& group, const RecognizerOptions& options, bool noise_is_known);

/// That nothing tells on which side of a circle its round tips were, and its radius if they were
/// on the other; empty where that is told or the answer is no circle. The centres are a circle's
/// from outside and another one's from within, which fit alike.
std::string note_of_tip_side(const ContactGroup& group, const v1::Recognition& answer,
                             TouchedFrom touched_from);

/// That --touched-from tells nothing, for no sample is the centre of a round tip; empty where one
/// is or nothing was said.
std::string note_of_unused_side(const ContactGroup& group, TouchedFrom touched_from);

/// That a given class leaves residuals which the stated noise cannot be, and the sample that lies
/// furthest off; empty where it can.
std::string note_of_misfit(const v1::GivenClassAnswer& answer);

}  // namespace palpate
