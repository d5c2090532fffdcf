// One sample in place of several neighbours: their mean, and what is known of it.
#pragma once

#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// Mean of two stored samples. sigma_m is the noise of one contact: variances are pooled, unknown
/// stays unknown.
StoredSample merged(const StoredSample& a, const StoredSample& b);

/// What is known of the mean of two stored samples. A normal that was measured at one of them alone
/// is not one at their mean, and is lost.
SampleDetail merged(const StoredSample& a, const SampleDetail& of_a, const StoredSample& b,
                    const SampleDetail& of_b);

}  // namespace palpate
