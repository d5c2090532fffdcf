// What a recognizer accepts in a contact message, checked before the message is sent.
#pragma once

#include "node/python/point_details.h"

namespace palpate {

/// Throws std::invalid_argument for a standard deviation or a tip radius that a recognizer with its
/// default limits rejects.
void check_sendable_lengths(double sigma_m, double tip_radius_m);

/// The same for points (n, 2) and their details (PointDetails); all lengths in metres.
void check_sendable_points(const Array& points_m, const Array& normals, const Array& normal_sigmas,
                           const Array& covariances_m2);

}  // namespace palpate
