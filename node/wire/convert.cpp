#include "node/wire/convert.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace palpate {
namespace {

// Sets the fields that LocalizedContact and LocalEstimate share.
template <typename Message>
void fill_geometry(const LocalEstimate& estimate, const ContactSource& source, Message& out) {
  out.set_probe(source.probe.data(), source.probe.size());
  out.set_patch(source.patch);
  out.set_x_m(estimate.position.x());
  out.set_y_m(estimate.position.y());
  out.set_tangent_rad(estimate.tangent_angle);
  out.set_kappa_per_m(estimate.kappa);
  out.set_kappa_s_per_m2(estimate.kappa_s);
  out.set_normal_sigma_m(std::sqrt(estimate.covariance(0, 0)));
  out.set_tangent_sigma_rad(std::sqrt(estimate.covariance(1, 1)));
  out.set_kappa_sigma_per_m(std::sqrt(estimate.covariance(2, 2)));
  out.set_kappa_s_sigma_per_m2(std::sqrt(estimate.covariance(3, 3)));
}

void fill_hypothesis(const Hypothesis& hypothesis, v1::Hypothesis& out) {
  out.set_curve_class(to_wire(hypothesis.shape.curve_class));
  out.set_probability(hypothesis.probability);
  out.set_chi2(hypothesis.chi2);
  out.set_dof(static_cast<std::uint32_t>(std::max(hypothesis.dof, 0)));
  out.set_at_limit(hypothesis.at_limit);
  // Classes with no chance have no canonical form.
  if (hypothesis.at_limit || hypothesis.covariance.size() == 0) return;
  to_wire(hypothesis.shape, *out.mutable_parameters());
  to_wire(hypothesis.world_T_curve, *out.mutable_pose());
}

}  // namespace

v1::CurveClass to_wire(CurveClass curve_class) {
  switch (curve_class) {
    case CurveClass::Unclassified:
      return v1::CURVE_CLASS_UNCLASSIFIED;
    case CurveClass::Line:
      return v1::CURVE_CLASS_LINE;
    case CurveClass::Circle:
      return v1::CURVE_CLASS_CIRCLE;
    case CurveClass::Ellipse:
      return v1::CURVE_CLASS_ELLIPSE;
    case CurveClass::Parabola:
      return v1::CURVE_CLASS_PARABOLA;
    case CurveClass::Hyperbola:
      return v1::CURVE_CLASS_HYPERBOLA;
    case CurveClass::CubicalParabola:
      return v1::CURVE_CLASS_CUBICAL_PARABOLA;
    case CurveClass::SemiCubicalParabola:
      return v1::CURVE_CLASS_SEMI_CUBICAL_PARABOLA;
    case CurveClass::CubicSpline:
      return v1::CURVE_CLASS_CUBIC_SPLINE;
  }
  return v1::CURVE_CLASS_UNSPECIFIED;
}

CurveClass from_wire(v1::CurveClass curve_class) {
  for (const CurveClass candidate : kCurveClasses) {
    if (to_wire(candidate) == curve_class) return candidate;
  }
  return CurveClass::Unclassified;
}

v1::MaterialSide to_wire(MaterialSide side) {
  switch (side) {
    case MaterialSide::Left:
      return v1::MATERIAL_SIDE_LEFT;
    case MaterialSide::Right:
      return v1::MATERIAL_SIDE_RIGHT;
    case MaterialSide::Unspecified:
      break;
  }
  return v1::MATERIAL_SIDE_UNSPECIFIED;
}

std::optional<MaterialSide> from_wire(v1::MaterialSide side) {
  switch (side) {
    case v1::MATERIAL_SIDE_UNSPECIFIED:
      return MaterialSide::Unspecified;
    case v1::MATERIAL_SIDE_LEFT:
      return MaterialSide::Left;
    case v1::MATERIAL_SIDE_RIGHT:
      return MaterialSide::Right;
    default:
      return std::nullopt;
  }
}

v1::RecognitionStatus to_wire(RecognitionStatus status) {
  switch (status) {
    case RecognitionStatus::Collecting:
      return v1::RECOGNITION_STATUS_COLLECTING;
    case RecognitionStatus::Ambiguous:
      return v1::RECOGNITION_STATUS_AMBIGUOUS;
    case RecognitionStatus::Recognized:
      return v1::RECOGNITION_STATUS_RECOGNIZED;
  }
  return v1::RECOGNITION_STATUS_UNSPECIFIED;
}

v1::RecognitionDoubt to_wire(Doubt doubt) {
  switch (doubt) {
    case Doubt::None:
      break;
    case Doubt::SeveralClasses:
      return v1::RECOGNITION_DOUBT_SEVERAL_CLASSES;
    case Doubt::AtLimit:
      return v1::RECOGNITION_DOUBT_AT_LIMIT;
    case Doubt::FormError:
      return v1::RECOGNITION_DOUBT_FORM_ERROR;
    case Doubt::Misfit:
      return v1::RECOGNITION_DOUBT_MISFIT;
    case Doubt::TwoShapes:
      return v1::RECOGNITION_DOUBT_TWO_SHAPES;
    case Doubt::Undetermined:
      return v1::RECOGNITION_DOUBT_UNDETERMINED;
    case Doubt::TreeRejects:
      return v1::RECOGNITION_DOUBT_TREE_REJECTS;
    case Doubt::FewPlaces:
      return v1::RECOGNITION_DOUBT_FEW_PLACES;
    case Doubt::WorkLimit:
      return v1::RECOGNITION_DOUBT_WORK_LIMIT;
  }
  return v1::RECOGNITION_DOUBT_UNSPECIFIED;
}

void to_wire(const Eigen::Ref<const Eigen::MatrixXd>& matrix,
             google::protobuf::RepeatedField<double>& out) {
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) out.Add(matrix(row, column));
  }
}

void to_wire(const ShapeParameters& shape, v1::Parameters& out) {
  Eigen::Index index = 0;
  for (const char letter : parameter_letters(shape.curve_class)) {
    const double value = shape.values[index++];
    if (letter == 'a') out.set_a(value);
    if (letter == 'b') out.set_b(value);
    if (letter == 'c') out.set_c(value);
  }
}

void to_wire(const Pose2& pose, v1::Pose2& out) {
  out.set_x_m(pose.x);
  out.set_y_m(pose.y);
  out.set_theta_rad(pose.theta);
}

void to_wire(const Recognition& recognition, const ContactSourceOf& source_of,
             v1::Recognition& out) {
  out.Clear();
  const CurveClass curve_class = recognition.shape.curve_class;
  out.set_status(to_wire(recognition.status));
  out.set_doubt(to_wire(recognition.doubt));
  // While COLLECTING no class is named: "unclassified" would be an answer.
  const bool has_answer = recognition.status != RecognitionStatus::Collecting;
  out.set_curve_class(has_answer ? to_wire(curve_class) : v1::CURVE_CLASS_UNSPECIFIED);
  // A best fit at the limit of its class has no shape of that class.
  const bool has_shape = recognition.hypotheses.empty() || !recognition.hypotheses.front().at_limit;
  if (has_answer && has_shape && curve_class != CurveClass::Unclassified) {
    to_wire(recognition.shape, *out.mutable_parameters());
    to_wire(recognition.world_T_curve, *out.mutable_pose());
    out.set_pose_symmetry(static_cast<std::uint32_t>(pose_symmetry(curve_class)));
    to_wire(recognition.covariance, *out.mutable_covariance());
    if (recognition.unqualified_probe) {
      to_wire(noise_covariance(recognition), *out.mutable_noise_covariance());
    }
  }
  for (const Hypothesis& hypothesis : recognition.hypotheses) {
    fill_hypothesis(hypothesis, *out.add_hypotheses());
  }
  for (const LocalizedContact& contact : recognition.contacts) {
    v1::LocalizedContact& localized = *out.add_contacts();
    fill_geometry(contact.estimate, source_of(contact.probe, contact.patch), localized);
    localized.set_t(contact.t);
  }
  for (const Decision& decision : recognition.decisions) {
    v1::Decision& step = *out.add_decisions();
    step.set_test(decision.test.data(), decision.test.size());
    step.set_value(decision.value);
    step.set_threshold(decision.threshold);
    step.set_passed(decision.passed);
    if (!std::isnan(decision.p_value)) step.set_p_value(decision.p_value);
  }
  for (const NamedInvariant& named : recognition.invariants) {
    v1::Invariant& invariant = *out.add_invariants();
    invariant.set_curve_class(to_wire(named.curve_class));
    invariant.set_name(named.name.data(), named.name.size());
    invariant.set_value(named.value);
    invariant.set_sigma(named.sigma);
    for (const std::size_t contact : recognition.pooled_contacts) {
      invariant.add_contacts(static_cast<std::uint32_t>(contact));
    }
  }
  out.set_sample_count(recognition.sample_count);
  out.set_outlier_count(recognition.outlier_count);
  out.set_dwelling_count(recognition.dwelling_count);
  out.set_forgotten_count(recognition.forgotten_count);
  out.set_simplified_count(recognition.simplified_count);
  out.set_unqualified_probe(recognition.unqualified_probe);
  out.set_sigma_m(recognition.sigma_m);
  out.set_noise_correlation_m(recognition.noise_correlation_m);
}

void to_wire(const LocalEstimate& estimate, const ContactSource& source, v1::LocalEstimate& out) {
  out.Clear();
  fill_geometry(estimate, source, out);
  out.set_window_samples(static_cast<std::uint32_t>(std::max(estimate.window_samples, 0)));
  out.set_window_arc_m(estimate.window_arc_m);
}

void to_wire(const SampleDetail& detail, v1::ContactSample& out) {
  if (detail.normal_sigma_rad > 0.0) {
    out.set_normal_x(detail.normal.x());
    out.set_normal_y(detail.normal.y());
    out.set_normal_sigma_rad(detail.normal_sigma_rad);
  }
  if (detail.covariance_m2.x() > 0.0) {
    out.set_cov_xx_m2(detail.covariance_m2.x());
    out.set_cov_xy_m2(detail.covariance_m2.y());
    out.set_cov_yy_m2(detail.covariance_m2.z());
  }
}

}  // namespace palpate
