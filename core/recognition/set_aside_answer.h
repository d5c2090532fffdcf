// What an answer says of the samples that were set aside.
#pragma once

#include <span>

#include "core/recognition/counted/weighed.h"
#include "core/recognition/recognition.h"

namespace palpate {

/// Tells which samples of `all` are not among those `used`.
Recognition with_set_aside(Recognition answer, std::span<const StoredPatch> all,
                           std::span<const StoredPatch> used);

/// Likewise, or are outliers of a weighing of those `used`. A misfit is a doubt where they are so
/// many next to one another that the part leaves the class there, and where they lead away from
/// the curve.
Recognition with_set_aside(Recognition answer, std::span<const StoredPatch> all,
                           std::span<const StoredPatch> used, const Weighed& weighed);

}  // namespace palpate
