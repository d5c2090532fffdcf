// Of strokes: the evidence of parts that are of the best class but for a smooth deviation.
#pragma once

#include "core/recognition/weigh/contenders.h"

namespace palpate {

/// log of the evidence of smooth parts near the best class, times what they are as probable
/// beforehand as a class (core/README.md, "The posterior"). A curve near another class is near the
/// best as well, and counts once. `least_size`: smaller deviations do not count [half extents];
/// `least`: less need not be computed. -infinity if there is none, or if the best has no evidence
/// about a fit: what the prior alone has led to is placed nowhere.
double log_evidence_near_best(CurveClass best, double least_size, double least,
                              const Contenders& contenders, const EvidenceContext& context);

}  // namespace palpate
