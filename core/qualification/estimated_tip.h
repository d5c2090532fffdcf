// The radius of a round tip that nobody stated.
#pragma once

#include "core/qualification/probe_character.h"

namespace palpate {

/// The probe with the constant of its offset as its tip radius, if no tip radius is stated and the
/// constant can only be that of a round tip: then the samples are centres. As a tip radius it is on
/// the side where tips are known to lie (stated, measured, or asked for by TouchedFrom); as an
/// offset it would be on the outer side of every bend, which of a bore is wrong by two radii.
/// Otherwise the probe as it is.
ProbeCharacter with_estimated_tip(ProbeCharacter probe);

}  // namespace palpate
