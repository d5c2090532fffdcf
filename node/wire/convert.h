// From the recognizer's types to the wire's.
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>

#include "core/recognition/recognition.h"
#include "core/recognition/samples/sample_detail.h"
#include "palpate/v1/contact.pb.h"
#include "palpate/v1/curve.pb.h"
#include "palpate/v1/local_estimate.pb.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate {

v1::CurveClass to_wire(CurveClass curve_class);
/// CurveClass::Unclassified for UNSPECIFIED and unknown values.
CurveClass from_wire(v1::CurveClass curve_class);

v1::RecognitionStatus to_wire(RecognitionStatus status);
v1::RecognitionDoubt to_wire(Doubt doubt);

void to_wire(const ShapeParameters& shape, v1::Parameters& out);
void to_wire(const Pose2& pose, v1::Pose2& out);

/// Name of the probe and its own patch number, for the recognizer's numbers of both.
struct ContactSource {
  std::string_view probe;
  std::uint32_t patch = 0;
};
using ContactSourceOf = std::function<ContactSource(std::uint32_t probe, std::uint32_t run)>;

/// Fills in all that the recognizer knows; header, group, object, newest_* and compute_ns are left
/// to the caller. Clears `out` first.
void to_wire(const Recognition& recognition, const ContactSourceOf& source_of,
             v1::Recognition& out);

/// Sets the fields of a normal or covariance that is there.
void to_wire(const SampleDetail& detail, v1::ContactSample& out);

/// All but the header.
void to_wire(const LocalEstimate& estimate, const ContactSource& source, v1::LocalEstimate& out);

}  // namespace palpate
