// Converts the recognizer's types to messages.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

#include "core/recognition/recognition.h"
#include "core/recognition/samples/contact_sample.h"
#include "core/recognition/samples/sample_detail.h"
#include "palpate/v1/contact.pb.h"
#include "palpate/v1/curve.pb.h"
#include "palpate/v1/local_estimate.pb.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate {

v1::CurveClass to_wire(CurveClass curve_class);
/// CurveClass::Unclassified for UNSPECIFIED and for unknown values.
CurveClass from_wire(v1::CurveClass curve_class);

v1::MaterialSide to_wire(MaterialSide side);
/// nullopt for a value that the contract does not have.
std::optional<MaterialSide> from_wire(v1::MaterialSide side);

v1::RecognitionStatus to_wire(RecognitionStatus status);
v1::RecognitionDoubt to_wire(Doubt doubt);

/// Adds the entries row by row.
void to_wire(const Eigen::Ref<const Eigen::MatrixXd>& matrix,
             google::protobuf::RepeatedField<double>& out);
void to_wire(const ShapeParameters& shape, v1::Parameters& out);
void to_wire(const Pose2& pose, v1::Pose2& out);

/// Name of a probe and its own patch number, from the recognizer's numbers of both.
struct ContactSource {
  std::string_view probe;
  std::uint32_t patch = 0;
};
using ContactSourceOf = std::function<ContactSource(std::uint32_t probe, std::uint32_t run)>;

/// Sets all fields that the recognizer knows; the caller sets header, group, object, newest_* and
/// compute_ns. Clears `out` first.
void to_wire(const Recognition& recognition, const ContactSourceOf& source_of,
             v1::Recognition& out);

/// Sets the fields of the normal and of the covariance, if present.
void to_wire(const SampleDetail& detail, v1::ContactSample& out);

/// Sets all fields but the header. Clears `out` first.
void to_wire(const LocalEstimate& estimate, const ContactSource& source, v1::LocalEstimate& out);

}  // namespace palpate
