#include "core/recognition/posterior/free_form.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "core/numerics/negligible.h"

namespace palpate {
namespace {

constexpr int kMostNodes = 12;  // of a section at a time; a smoothed one has at most ten
constexpr int kTerms = 12;      // of a path's power series: one more than the nodes tell
using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostNodes, kMostNodes>;
using Nodes = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostNodes, 1>;
using Terms = Eigen::Matrix<double, Eigen::Dynamic, kTerms, 0, kMostNodes, kTerms>;

/// Sizes of features that a free-form part may have, in touched half extents, alike probable: a
/// factor of two apart, from an eighth (finer ones would not be one arc) to where paths are
/// straight lines to most probes.
constexpr std::array kSizes = {0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0};

constexpr std::size_t kMiddleSize = 3;  ///< a half extent

/// Ordinate and its first two derivatives by the abscissa of a frame, and their covariance.
struct Junction {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  /// A square root of their covariance, R R^T: rounding cannot make it less than nothing.
  Eigen::Matrix3d root = Eigen::Matrix3d::Zero();
};

/// Nodes of one section in its chord frame, lengths in half extents.
struct SectionNodes {
  Nodes x;
  Nodes y;
  Nodes weight;  ///< inverse standard deviation of y
};

SectionNodes nodes_of(const SmoothModel& smooth, const ReducedSection& section, std::size_t begin,
                      double weight) {
  const auto n = static_cast<Eigen::Index>(std::min<std::size_t>(kMostNodes, section.end - begin));
  SectionNodes nodes{Nodes(n), Nodes(n), Nodes(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const FitPoint& point = smooth.reduced.points[begin + static_cast<std::size_t>(i)];
    const Vec2 away = point.position - section.middle;
    const double cosine = point.tangent.isZero() ? 1.0 : std::abs(point.tangent.dot(section.axis));
    nodes.x[i] = away.dot(section.axis);
    nodes.y[i] = cross(section.axis, away);
    nodes.weight[i] = weight * point.inverse_sigma * cosine;
  }
  return nodes;
}

/// The junction as the next section's frame sees it: the geometry exactly, its covariance to first
/// order in the normal offset, the angle and the curvature.
Junction in_frame(const Junction& junction, double x, const ReducedSection& from,
                  const ReducedSection& to, double* x_there) {
  const Vec2 point = from.middle + x * from.axis + junction.mean[0] * left_of(from.axis);
  const double slope = junction.mean[1];
  const Vec2 tangent = (from.axis + slope * left_of(from.axis)).normalized();
  const double cosine = tangent.dot(from.axis);
  const double cosine_there = std::max(tangent.dot(to.axis), 0.1);  // sections turn by a radian
  const double kappa = junction.mean[2] * cosine * cosine * cosine;
  const double ratio = cosine / cosine_there;
  const Eigen::Vector3d scale(ratio, ratio * ratio, ratio * ratio * ratio);
  Junction there;
  *x_there = (point - to.middle).dot(to.axis);
  there.mean = {cross(to.axis, point - to.middle), cross(to.axis, tangent) / cosine_there,
                kappa / (cosine_there * cosine_there * cosine_there)};
  there.root = scale.asDiagonal() * junction.root;
  return there;
}

/// The evidence of one section, and what it says of the path at its end.
struct SectionEvidence {
  double chi2 = 0.0;
  double log_determinant = 0.0;
  Junction end;
};

/// y = sum c_k (x - origin)^k. At a patch's start c_0 and c_1 are the free place and direction;
/// later, c_0 to c_2 continue what came before. The rest has the prior of features of `size`:
/// c_k = size^(1-k) / (k (k - 1)), the series of a logarithm, which converges within `size`.
SectionEvidence evidence_of(const SectionNodes& nodes, double origin, double end, double size,
                            const std::optional<Junction>& before, bool goes_on) {
  const Eigen::Index n = nodes.x.size();
  const double width = std::sqrt(0.5 * std::numbers::pi);  // as offset and turn of a class
  Terms terms(n, kTerms);                                  // whitened powers
  Nodes column = nodes.weight;
  for (int k = 0; k < kTerms; ++k) {
    terms.col(k) = column;
    column = column.cwiseProduct(nodes.x - Nodes::Constant(n, origin));
  }
  // The prior's covariance: a block of the first three terms, the rest independent.
  Eigen::Matrix3d first = Eigen::Matrix3d::Zero();  // its square root
  Eigen::Matrix<double, kTerms, 1> variances;
  double power = 1.0 / size;
  for (int k = 2; k < kTerms; ++k) {
    const double deviation = power / (k * (k - 1));
    variances[k] = deviation * deviation;
    power /= size;
  }
  Nodes residual = nodes.weight.cwiseProduct(nodes.y);
  if (before) {
    const Eigen::Vector3d half(1.0, 1.0, 0.5);  // c_2 is half the second derivative
    first = half.asDiagonal() * before->root;
    residual.noalias() -= terms.leftCols<3>() * half.cwiseProduct(before->mean);
  } else {
    first.diagonal() << width, width, std::sqrt(variances[2]);
  }
  Terms spread(n, kTerms);  // by the square root of the prior's covariance
  spread.leftCols<3>().noalias() = terms.leftCols<3>().lazyProduct(first);
  for (int k = 3; k < kTerms; ++k) {
    spread.col(k) = std::sqrt(variances[k]) * terms.col(k);
  }
  Block covariance = spread.lazyProduct(spread.transpose());
  covariance.diagonal().array() += 1.0;
  const Eigen::LLT<Block> llt(covariance);
  const Nodes whitened = llt.matrixL().solve(residual);
  SectionEvidence evidence;
  evidence.chi2 = whitened.squaredNorm();
  for (Eigen::Index i = 0; i < n; ++i) {
    evidence.log_determinant += 2.0 * std::log(llt.matrixLLT()(i, i));
  }
  if (!goes_on) {
    return evidence;
  }
  // The path at the end, given the section's points.
  Eigen::Matrix<double, 3, kTerms> at = Eigen::Matrix<double, 3, kTerms>::Zero();
  const double x = end - origin;
  double x_power = 1.0;
  for (int k = 0; k < kTerms; ++k) {
    at(0, k) = x_power;
    if (k + 1 < kTerms) at(1, k + 1) = (k + 1) * x_power;
    if (k + 2 < kTerms) at(2, k + 2) = (k + 2) * (k + 1) * x_power;
    x_power *= x;
  }
  const Eigen::Matrix3d free_at = at.leftCols<3>();
  at.leftCols<3>() = free_at * first;  // (of the terms in units of the prior's)
  for (int k = 3; k < kTerms; ++k) {
    at.col(k) *= std::sqrt(variances[k]);
  }
  const Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kMostNodes, 3> half_gain =
      llt.matrixL().solve(spread.lazyProduct(at.transpose()));
  evidence.end.mean = half_gain.transpose() * whitened;
  if (before) {
    evidence.end.mean +=
        free_at * Eigen::Vector3d(before->mean[0], before->mean[1], 0.5 * before->mean[2]);
  }
  // at (I + spread^T spread)^-1 at^T by its square root.
  Eigen::Matrix<double, kTerms, kTerms> information;
  information.triangularView<Eigen::Lower>() = spread.transpose().lazyProduct(spread);
  information.diagonal().array() += 1.0;
  const Eigen::LLT<Eigen::Matrix<double, kTerms, kTerms>> of_terms(information);
  const Eigen::Matrix<double, kTerms, 3> half_of_end = of_terms.matrixL().solve(at.transpose());
  const Eigen::HouseholderQR<Eigen::Matrix<double, kTerms, 3>> qr(half_of_end);
  evidence.end.root =
      qr.matrixQR().topRows<3>().triangularView<Eigen::Upper>().toDenseMatrix().transpose();
  return evidence;
}

/// A touch by itself is a path by itself, whose direction may be any: uniform over half a turn, as
/// measured normals are compared either way round.
void add_normal(const FitPoint& touch, double weight, FreeForm* paths) {
  if (touch.inverse_normal_sigma > 0.0) {
    const double sigma = 1.0 / (weight * touch.inverse_normal_sigma);
    paths->log_occam += std::min(0.0, std::log(std::sqrt(2.0 / std::numbers::pi) * sigma));
    paths->determined += 1.0;
  }
}

FreeForm paths_of(const SmoothModel& smooth, double size, double weight) {
  FreeForm paths;
  std::optional<Junction> junction;
  double junction_x = 0.0;
  const ReducedSection* last = nullptr;
  for (const ReducedSection& section : smooth.sections) {
    for (std::size_t begin = section.begin; begin < section.end; begin += kMostNodes) {
      const SectionNodes nodes = nodes_of(smooth, section, begin, weight);
      const bool joined = section.joined || begin > section.begin;
      std::optional<Junction> before;
      double origin = -section.half_length;
      if (joined && last != nullptr) {
        before = in_frame(*junction, junction_x, *last, section, &origin);
      }
      // The section's chord ends with its last point; a section taken in parts, with the part's.
      const double end =
          begin + kMostNodes >= section.end ? section.half_length : nodes.x[nodes.x.size() - 1];
      const bool goes_on = begin + kMostNodes < section.end ||
                           (&section != &smooth.sections.back() && (&section + 1)->joined);
      const SectionEvidence evidence =
          evidence_of(nodes, before ? origin : 0.0, end, size, before, goes_on);
      paths.chi2 += evidence.chi2;
      paths.log_occam -= 0.5 * evidence.log_determinant;
      paths.determined += static_cast<double>(nodes.x.size());
      if (section.end - section.begin == 1) {
        add_normal(smooth.reduced.points[begin], weight, &paths);
      }
      junction = evidence.end;
      junction_x = end;
      last = &section;
    }
  }
  return paths;
}

}  // namespace

FreeForm free_form(const SmoothModel& smooth, double inflation) {
  const double weight = 1.0 / std::sqrt(inflation);
  FreeForm best;
  double top = -std::numeric_limits<double>::infinity();
  double sum = 0.0;  // of the evidences, over that of `best`
  const auto take = [&](std::size_t s) {
    const FreeForm paths = paths_of(smooth, kSizes[s], weight);
    const double value = paths.log_occam - 0.5 * paths.chi2;
    if (!std::isfinite(value)) {
      return false;  // sections much longer than the features: their power series overflows
    }
    if (value > top) {
      sum = sum * std::exp(top - value) + 1.0;
      top = value;
      best = paths;
    } else {
      sum += std::exp(value - top);
    }
    return value > top - kTailOfDensity;
  };
  // The evidence has one maximum: outwards from the middle until it has fallen off.
  const auto from = [&](std::size_t s, int step) {
    for (auto i = static_cast<int>(s); i >= 0 && i < static_cast<int>(kSizes.size()); i += step) {
      const double before = top;
      if (!take(static_cast<std::size_t>(i)) && top == before && std::isfinite(top)) {
        break;
      }
    }
  };
  from(kMiddleSize, 1);
  from(kMiddleSize - 1, -1);
  best.log_occam += std::log(sum / static_cast<double>(kSizes.size()));
  return best;
}

}  // namespace palpate
