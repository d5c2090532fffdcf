#include "core/qualification/probe_correction.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/numerics/matrices/symmetric_eigen.h"

namespace palpate {
namespace {

/// Derivative of a distance by shape and pose.
using Slope = Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, kLargestSymmetric>;

/// +1: the patch runs along increasing parameter, -1: against it, 0: neither.
int travel_of(const Curve& curve, const Pose2& pose, std::span<const ContactSample> samples) {
  const double period = domain(curve).period;
  double forth = 0.0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double from = foot_point(curve, pose.to_local(samples[i - 1].position_m)).t;
    const double step = foot_point(curve, pose.to_local(samples[i].position_m)).t - from;
    forth += period > 0.0 ? std::remainder(step, period) : step;
  }
  return forth > 0.0 ? 1 : (forth < 0.0 ? -1 : 0);
}

int majority(int votes) { return votes > 0 ? 1 : (votes < 0 ? -1 : 0); }

/// Derivatives of the orthogonal distance, positive out of the material, by shape, x, y and theta.
Slope distance_slope(const Curve& curve, const Pose2& pose, const Vec2& normal,
                     const FootPoint& foot) {
  const auto shape = static_cast<Eigen::Index>(parameter_letters(class_of(curve)).size());
  Slope slope(shape + 3);
  const Eigen::Matrix<double, 2, 3> by_shape = position_by_parameters(curve, foot.t);
  for (Eigen::Index i = 0; i < shape; ++i) slope[i] = -normal.dot(pose.rotate(by_shape.col(i)));
  slope[shape] = -normal.x();
  slope[shape + 1] = -normal.y();
  slope[shape + 2] = -normal.dot(left_of(pose.rotate(foot.position)));
  return slope;
}

/// Where a sample touches, and the normal out of the material there (to the right of increasing
/// parameter if the side is not known).
struct Touch {
  FootPoint foot;
  Vec2 normal;
  double offset_angle = 0.0;  ///< direction that the offset belongs to [rad]
};

bool has_lag(const ProbedPatch& patch) { return patch.probe != nullptr && patch.probe->lag_m; }

Touch touch_of(const ProbedPatch& patch, const Curve& curve, const Pose2& pose, int material,
               int travel, const ContactSample& sample) {
  Touch touch;
  touch.foot = foot_point(curve, pose.to_local(sample.position_m));
  const LocalGeometry local = geometry(curve, touch.foot.t);
  const double angle =
      local.tangent_angle + pose.theta - (material == 0 ? 1 : material) * 0.5 * kPi;
  touch.normal = {std::cos(angle), std::sin(angle)};
  const double lag = has_lag(patch) ? patch.probe->lag_m->value : 0.0;
  touch.offset_angle = angle + lag * travel * local.kappa /
                                   (1.0 + material * patch.context.tip_radius_m * local.kappa);
  return touch;
}

/// Adds to a contact what the offset that was taken off is uncertain by in another set-up: an error
/// d of it along the left normal moves the surface by d, turns it by d' and bends it by kappa^2 d +
/// d'', by arc length. Of the normal's direction phi, d' = kappa d_phi and d'' = kappa^2 d_phiphi +
/// kappa_s d_phi. The variance of kappa_s stays as it is: it would take a derivative more of the
/// curve than a contact tells.
void add_what_offset_leaves(const ProbedPatch& patch, const Curve& curve, const Pose2& pose,
                            int material, int travel, LocalEstimate* estimate) {
  const Touch touch = touch_of(patch, curve, pose, material, travel, {estimate->position, 0.0, 0});
  const int order = patch.probe->offset.order;
  const Eigen::RowVectorXd at = offset_basis(touch.offset_angle, order);
  const double kappa = estimate->kappa;
  const Vec2 forward(std::cos(estimate->tangent_angle), std::sin(estimate->tangent_angle));
  const double left = left_of(forward).dot(touch.normal) < 0.0 ? -1.0 : 1.0;
  Eigen::Matrix<double, 4, Eigen::Dynamic> by_offset(4, at.size());
  by_offset.row(0) = left * at;
  const Eigen::RowVectorXd slope = offset_basis_slope(touch.offset_angle, order);
  by_offset.row(1) = left * kappa * slope;
  by_offset.row(2) = left * (kappa * kappa * (at + offset_basis_bend(touch.offset_angle, order)) +
                             estimate->kappa_s * slope);
  by_offset.row(3).setZero();
  estimate->covariance += by_offset * covariance_elsewhere(*patch.probe) * by_offset.transpose();
}

}  // namespace

int material_sign(const Curve& curve, const Pose2& pose, const ProbedPatch& patch,
                  TouchedFrom touched_from) {
  int off = 0;
  int bend = 0;
  for (const ContactSample& sample : patch.samples) {
    const FootPoint foot = foot_point(curve, pose.to_local(sample.position_m));
    const double kappa = geometry(curve, foot.t).kappa;
    off += foot.distance < 0.0 ? 1 : -1;
    bend += kappa > 0.0 ? 1 : (kappa < 0.0 ? -1 : 0);
  }
  if (patch.context.tip_radius_m > 0.0) return majority(off);
  if (patch.context.material_side != MaterialSide::Unspecified) {
    const int side = patch.context.material_side == MaterialSide::Left ? 1 : -1;
    if (const int travel = travel_of(curve, pose, patch.samples); travel != 0) return side * travel;
  }
  return touched_from == TouchedFrom::Inside ? -majority(bend) : majority(bend);
}

std::vector<ContactSample> without_offset(const ProbedPatch& patch, const Curve& curve,
                                          const Pose2& pose, TouchedFrom touched_from) {
  std::vector<ContactSample> samples(patch.samples);
  const int material = patch.probe == nullptr ? 0 : material_sign(curve, pose, patch, touched_from);
  if (material == 0) return samples;
  const int travel = has_lag(patch) ? travel_of(curve, pose, patch.samples) : 0;
  for (ContactSample& sample : samples) {
    const Touch touch = touch_of(patch, curve, pose, material, travel, sample);
    sample.position_m -= offset_at(patch.probe->offset, touch.offset_angle) * touch.normal;
  }
  return samples;
}

ProbedPatch as_qualified(ProbedPatch patch) {
  if (patch.probe == nullptr) return patch;
  if (patch.probe->tip_radius_m > 0.0) patch.context.tip_radius_m = patch.probe->tip_radius_m;
  for (ContactSample& sample : patch.samples) {
    if (!(sample.sigma_m > 0.0)) sample.sigma_m = patch.probe->sigma_m.value;
  }
  return patch;
}

ShapePoseCovariance covariance_of_probes(const Curve& curve, const Pose2& pose,
                                         std::span<const ProbedPatch> patches,
                                         TouchedFrom touched_from) {
  const auto size = static_cast<Eigen::Index>(parameter_letters(class_of(curve)).size()) + 3;
  SmallSymmetric information = SmallSymmetric::Zero(size, size);
  std::map<const ProbeCharacter*, Eigen::MatrixXd> by_probe;   // J^T W B
  SmallSymmetric coherent = SmallSymmetric::Zero(size, size);  // J^T W D W J
  for (const ProbedPatch& patch : patches) {
    const int material = material_sign(curve, pose, patch, touched_from);
    const int travel = has_lag(patch) ? travel_of(curve, pose, patch.samples) : 0;
    // With D_ij = d^2 exp(-|s_i - s_j| / length), the sum over all pairs is a recursion along the
    // patch.
    SmallVector before = SmallVector::Zero(size);
    Vec2 last = Vec2::Zero();
    for (const ContactSample& sample : patch.samples) {
      const double weight = sample.sigma_m > 0.0 ? 1.0 / (sample.sigma_m * sample.sigma_m) : 1.0;
      const Touch touch = touch_of(patch, curve, pose, material, travel, sample);
      const Slope slope = distance_slope(curve, pose, touch.normal, touch.foot);
      information += weight * slope.transpose() * slope;
      if (patch.probe == nullptr) continue;
      const Vec2 at = pose * touch.foot.position;
      before *= std::exp(-(at - last).norm() / patch.probe->deviation_length_m.value);
      last = at;
      const SmallVector here = weight * slope.transpose();
      const double variance = mean_square(patch.probe->deviation_m);
      coherent += variance *
                  (here * here.transpose() + here * before.transpose() + before * here.transpose());
      before += here;
      if (material == 0) continue;
      const Eigen::RowVectorXd basis = offset_basis(touch.offset_angle, patch.probe->offset.order);
      Eigen::MatrixXd& sum =
          by_probe.try_emplace(patch.probe, Eigen::MatrixXd::Zero(size, basis.size()))
              .first->second;
      sum += weight * slope.transpose() * basis;
    }
  }
  // In units of the effect of each unknown on the samples. Directions that a symmetry leaves free
  // are omitted.
  const SmallVector moves =
      information.diagonal().cwiseSqrt().unaryExpr([](double v) { return v > 0.0 ? v : 1.0; });
  const SmallSymmetric scaled =
      moves.cwiseInverse().asDiagonal() * information * moves.cwiseInverse().asDiagonal();
  const SymmetricEigen eigen = symmetric_eigen(scaled);
  constexpr double kFree = 1e-12;  // rounding of a matrix with unit diagonal, with some margin
  const SmallVector inverse =
      eigen.values.unaryExpr([](double v) { return v > kFree ? 1.0 / v : 0.0; });
  const SmallSymmetric solve = moves.cwiseInverse().asDiagonal() * eigen.vectors *
                               inverse.asDiagonal() * eigen.vectors.transpose() *
                               moves.cwiseInverse().asDiagonal();
  SmallSymmetric covariance = solve * coherent * solve;
  for (const auto& [probe, sum] : by_probe) {
    const Eigen::MatrixXd influence = solve.lazyProduct(sum);
    covariance +=
        influence.lazyProduct(covariance_elsewhere(*probe)).lazyProduct(influence.transpose());
  }
  return covariance;
}

double inflation_of_probes(std::span<const ProbedPatch> patches) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const ProbedPatch& patch : patches) {
    count += patch.samples.size();
    if (patch.probe == nullptr) continue;
    double before = 0.0;  // sum of D_ij / deviation^2 over the samples before
    double pairs = 0.0;   // sum of (D_ij / deviation^2) / sigma_i^2 over all pairs, i = j included
    for (std::size_t i = 0; i < patch.samples.size(); ++i) {
      const ContactSample& sample = patch.samples[i];
      if (i > 0) {
        const double step = (sample.position_m - patch.samples[i - 1].position_m).norm();
        before = (before + 1.0) * std::exp(-step / patch.probe->deviation_length_m.value);
      }
      if (sample.sigma_m > 0.0) pairs += (1.0 + 2.0 * before) / (sample.sigma_m * sample.sigma_m);
    }
    sum += mean_square(patch.probe->deviation_m) * pairs;
  }
  return count > 0 ? 1.0 + sum / static_cast<double>(count) : 1.0;
}

void add_offset_uncertainty(std::span<const ProbedPatch> patches, const Curve& curve,
                            const Pose2& pose, TouchedFrom touched_from,
                            std::vector<LocalizedContact>* contacts) {
  for (const ProbedPatch& patch : patches) {
    const int material =
        patch.probe == nullptr ? 0 : material_sign(curve, pose, patch, touched_from);
    if (material == 0) continue;
    const int travel = has_lag(patch) ? travel_of(curve, pose, patch.samples) : 0;
    for (LocalizedContact& contact : *contacts) {
      if (contact.probe == patch.context.probe && contact.patch == patch.context.patch) {
        add_what_offset_leaves(patch, curve, pose, material, travel, &contact.estimate);
      }
    }
  }
}

}  // namespace palpate
