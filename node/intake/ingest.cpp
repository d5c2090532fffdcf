#include "node/intake/ingest.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "node/wire/convert.h"
#include "node/wire/parse.h"
#include "node/wire/topics.h"

namespace palpate {
namespace {

using v1::RejectReason;

constexpr RejectReason kPassed = v1::REJECT_REASON_UNSPECIFIED;

bool all_finite(double x, double y, double sigma) {
  return std::isfinite(x) && std::isfinite(y) && std::isfinite(sigma);
}

/// True if any field is set, even to 0.
bool has_normal(const v1::ContactSample& sample) {
  return sample.has_normal_x() || sample.has_normal_y() || sample.has_normal_sigma_rad();
}
bool has_covariance(const v1::ContactSample& sample) {
  return sample.has_cov_xx_m2() || sample.has_cov_xy_m2() || sample.has_cov_yy_m2();
}

RejectReason take_normal(const v1::ContactSample& sample, SampleDetail* detail) {
  const Vec2 normal(sample.normal_x(), sample.normal_y());
  const double sigma = sample.normal_sigma_rad();
  if (!normal.allFinite() || !std::isfinite(sigma)) return v1::REJECT_REASON_NOT_FINITE;
  const bool whole =
      sample.has_normal_x() && sample.has_normal_y() && sample.has_normal_sigma_rad();
  if (!whole || !is_unit(normal) || sigma < kMinNormalSigma || sigma > kPi) {
    return v1::REJECT_REASON_NORMAL;
  }
  detail->normal = as_unit(normal);
  detail->normal_sigma_rad = sigma;
  return kPassed;
}

RejectReason take_covariance(const v1::ContactSample& sample, double max_sigma_m,
                             SampleDetail* detail) {
  const Eigen::Vector3d covariance(sample.cov_xx_m2(), sample.cov_xy_m2(), sample.cov_yy_m2());
  if (!covariance.allFinite()) return v1::REJECT_REASON_NOT_FINITE;
  const bool whole = sample.has_cov_xx_m2() && sample.has_cov_xy_m2() && sample.has_cov_yy_m2();
  const double largest = std::max(covariance.x(), covariance.z());
  const double least = std::min(covariance.x(), covariance.z());
  if (!whole || !is_covariance(covariance) || largest > max_sigma_m * max_sigma_m ||
      least < kMinSigma * kMinSigma) {
    return v1::REJECT_REASON_COVARIANCE;
  }
  detail->covariance_m2 = covariance;
  return kPassed;
}

RejectReason take_detail(const v1::ContactSample& sample, double max_sigma_m,
                         SampleDetail* detail) {
  RejectReason reason = kPassed;
  if (has_normal(sample)) reason = take_normal(sample, detail);
  if (reason == kPassed && has_covariance(sample)) {
    reason = take_covariance(sample, max_sigma_m, detail);
  }
  return reason;
}

}  // namespace

RejectReason ContactDecoder::decode(std::size_t frame_count, std::string_view topic,
                                    std::string_view payload) {
  probe_ = {};
  if (frame_count != 2) return v1::REJECT_REASON_FRAMES;
  const std::optional<Topic> parsed = parse_topic(topic);
  if (!parsed || parsed->kind != TopicKind::Contact) return v1::REJECT_REASON_TOPIC;
  probe_ = parsed->name;
  if (payload.size() > limits_.max_message_bytes) return v1::REJECT_REASON_TOO_LARGE;
  if (!parse(batch_, payload)) return v1::REJECT_REASON_PARSE;
  RejectReason reason = check_header();
  if (reason == kPassed) reason = check_context();
  if (reason == kPassed) reason = take_samples();
  return reason;
}

RejectReason ContactDecoder::check_header() {
  if (!batch_.has_header()) return v1::REJECT_REASON_HEADER;
  const v1::Header& header = batch_.header();
  if (!header.source().empty() && header.source() != probe_) return v1::REJECT_REASON_SOURCE;
  if (!header.frame().empty() && !is_valid_name(header.frame())) {
    return v1::REJECT_REASON_FRAME_NAME;
  }
  if (!batch_.group().empty() && !is_valid_name(batch_.group())) {
    return v1::REJECT_REASON_GROUP_NAME;
  }
  message_.probe = probe_;
  message_.group = batch_.group().empty() ? probe_ : std::string_view(batch_.group());
  message_.frame = header.frame().empty() ? kDefaultFrame : std::string_view(header.frame());
  message_.epoch = header.epoch();
  message_.seq = header.seq();
  message_.published_ns = header.stamp_ns();
  return kPassed;
}

RejectReason ContactDecoder::check_context() {
  const double radius = batch_.tip_radius_m();
  if (!std::isfinite(radius)) return v1::REJECT_REASON_NOT_FINITE;
  if (radius < 0.0 || radius > limits_.max_tip_radius_m) return v1::REJECT_REASON_TIP_RADIUS;
  const std::optional<MaterialSide> side = from_wire(batch_.material_side());
  if (!side) return v1::REJECT_REASON_MATERIAL_SIDE;
  message_.material_side = *side;
  message_.object = batch_.object();
  message_.patch = batch_.patch();
  message_.tip_radius_m = radius;
  return kPassed;
}

RejectReason ContactDecoder::take_samples() {
  const auto count = static_cast<std::size_t>(batch_.samples_size());
  if (count == 0) return v1::REJECT_REASON_EMPTY;
  if (count > limits_.max_samples_per_batch) return v1::REJECT_REASON_TOO_MANY_SAMPLES;
  message_.samples.clear();
  message_.details.clear();
  message_.newest_sample_stamp_ns = batch_.samples(0).stamp_ns();
  for (const v1::ContactSample& sample : batch_.samples()) {
    const double x = sample.x_m();
    const double y = sample.y_m();
    const double sigma = sample.sigma_m();
    if (!all_finite(x, y, sigma)) return v1::REJECT_REASON_NOT_FINITE;
    if (std::abs(x) > limits_.max_coordinate_m || std::abs(y) > limits_.max_coordinate_m) {
      return v1::REJECT_REASON_COORDINATE;
    }
    if (sigma != 0.0 && (sigma < kMinSigma || sigma > limits_.max_sigma_m)) {
      return v1::REJECT_REASON_SIGMA;
    }
    message_.samples.push_back({Vec2(x, y), sigma, sample.stamp_ns()});
    if (has_normal(sample) || has_covariance(sample)) {
      message_.details.resize(count);
      SampleDetail& detail = message_.details[message_.samples.size() - 1];
      const RejectReason reason = take_detail(sample, limits_.max_sigma_m, &detail);
      if (reason != kPassed) return reason;
      if (detail.covariance_m2.x() > 0.0) {
        message_.samples.back().sigma_m = mean_sigma_m(detail.covariance_m2);
      }
    }
    message_.newest_sample_stamp_ns = std::max(message_.newest_sample_stamp_ns, sample.stamp_ns());
  }
  return kPassed;
}

bool is_malformed(RejectReason reason) {
  return reason == v1::REJECT_REASON_FRAMES || reason == v1::REJECT_REASON_TOPIC ||
         reason == v1::REJECT_REASON_TOO_LARGE || reason == v1::REJECT_REASON_PARSE ||
         reason == v1::REJECT_REASON_HEADER;
}

}  // namespace palpate
