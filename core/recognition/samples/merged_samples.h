// One sample in place of several neighbours: their mean and its details.
#pragma once

#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// Weighted mean of two stored samples. sigma_m stays the noise of one contact: variances are
/// pooled; unknown if one is unknown.
StoredSample merged(const StoredSample& a, const StoredSample& b);

/// The details of the mean of two stored samples. A normal measured at only one of them is not
/// valid at the mean and is dropped.
SampleDetail merged(const StoredSample& a, const SampleDetail& of_a, const StoredSample& b,
                    const SampleDetail& of_b);

}  // namespace palpate
