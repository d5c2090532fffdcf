// An object as its answer sees it: what probe files say of its samples is applied to them.
#pragma once

#include <vector>

#include "node/files/probe_files.h"
#include "node/tool/contact_groups.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate {

/// The samples with the tip radius and noise of their probe files, less the offsets along the
/// normals of the answer's curve. As they came, if the answer uses no probe file or has no curve.
/// A sample's noise includes its probe's drift: both part it from the curve.
ContactGroup as_measured(const ContactGroup& group, const ProbeFiles& probes,
                         const v1::Recognition& answer, TouchedFrom touched_from);

}  // namespace palpate
