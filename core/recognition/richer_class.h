// A class that is the limit of a richer one: do the data exclude the richer one, or only not need it?
#pragma once

#include "core/curves/curve_class.h"
#include "core/recognition/weigh.h"

namespace palpate {

/// Whether `largest_departure` of `limit` asks for the fit of `richer`.
bool is_limit_of(CurveClass limit, CurveClass richer);

/// How far the richer class may depart from `limit` within two standard deviations of its own fit, as a
/// pure number (RecognizerOptions::excluded_departure tells which). 0 for classes that are no limit of
/// a richer one; infinite where the richer class has no determined fit of its own.
double largest_departure(const Weighing& weighing, CurveClass limit);

}  // namespace palpate
