#include "core/recognition/coherent/coherent_rows.h"

#include <algorithm>
#include <cmath>

#include "core/recognition/modes/moments.h"

namespace palpate {
namespace {

/// Adds the products of four rows to columns First ... Last - 1 of the upper triangle.
template <int First, int Last, int Columns>
void add_products(const Eigen::Matrix<double, Columns, 4>& rows,
                  Eigen::Matrix<double, Columns, Columns>* sums) {
  for (int k = First; k < Last; ++k) {
    sums->col(k).template head<Last>() += rows(k, 0) * rows.col(0).template head<Last>() +
                                          rows(k, 1) * rows.col(1).template head<Last>() +
                                          rows(k, 2) * rows.col(2).template head<Last>() +
                                          rows(k, 3) * rows.col(3).template head<Last>();
  }
}

}  // namespace

std::vector<CoherentStep> coherent_steps(const CanonicalFit& placed, const FitData& reduced,
                                         const Curve& curve, double sigma) {
  const auto letters =
      static_cast<Eigen::Index>(parameter_letters(placed.shape.curve_class).size());
  std::vector<CoherentStep> steps;
  steps.reserve(reduced.points.size());
  for (const DriftStep& at : drift_steps(placed, reduced, sigma)) {
    const FittedPoint& fitted = placed.points[at.point];
    const Vec2 normal = placed.world_T_curve.rotate_back(fitted.normal);
    CoherentStep step{at};
    step.row.head(letters) =
        position_by_parameters(curve, fitted.t).leftCols(letters).transpose() * normal;
    step.row.segment<2>(letters) = fitted.normal;
    step.row[letters + 2] = placed.shape.curve_class == CurveClass::Circle
                                ? 0.0  // turning a circle does not change it
                                : normal.dot(left_of(position(curve, fitted.t)));
    step.row.head<kUnknowns>() /= sigma * reduced.scale;
    step.row[kResidualColumn] = at.residual;
    auto harmonics = step.row.tail<offset_coefficients(kHighestOrder)>();
    set_harmonics(fitted.normal, kHighestOrder, &harmonics);
    steps.push_back(step);
  }
  return steps;
}

std::optional<std::vector<CoherentStep>> steps_by_coordinates(const CanonicalFit& placed,
                                                              const ClassEvidence& evidence,
                                                              const FitData& reduced,
                                                              const Likelihood& likelihood,
                                                              double sigma) {
  const auto curve = make_curve(placed.shape.curve_class, placed.shape.values);
  if (!curve) {
    return std::nullopt;
  }
  std::vector<CoherentStep> steps = coherent_steps(placed, reduced, *curve, sigma);
  const Eigen::Matrix<double, kUnknowns, kUnknowns> by_coordinates =
      shape_pose_by_coordinates(evidence, reduced);
  for (CoherentStep& step : steps) {
    const Eigen::Matrix<double, kUnknowns, 1> by_shape_pose = step.row.head<kUnknowns>();
    step.row.head<kUnknowns>() = by_coordinates.transpose() * by_shape_pose;
    step.at.variance *= likelihood.inflation();
  }
  return steps;
}

double longest_run(const std::vector<CoherentStep>& steps) {
  double longest = 0.0;
  double run = 0.0;
  for (const CoherentStep& step : steps) {
    run = std::isfinite(step.at.from_last) ? run + step.at.from_last : 0.0;
    longest = std::max(longest, run);
  }
  return longest;
}

template <int Highest>
WhiteRows<Highest> white_rows(const std::vector<CoherentStep>& steps, const Drift& drift) {
  constexpr int kColumns = columns_to(Highest);
  constexpr int kMiddle = (kUnknowns + kColumns) / 2;
  constexpr std::size_t kBlock = 4;
  using Row = Eigen::Matrix<double, kColumns, 1>;
  using Block = Eigen::Matrix<double, kColumns, kBlock>;
  Block block = Block::Zero();
  WhiteRows<Highest> result;
  Row mean = Row::Zero();
  DriftFilter filter(drift);
  double variances = 1.0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const DriftFilter::Gain gain = filter.next(steps[i].at);
    mean *= gain.kept;
    const Row surprise = steps[i].row.head<kColumns>() - mean;
    mean += gain.share * surprise;
    const std::size_t in_block = i % kBlock;
    block.col(static_cast<Eigen::Index>(in_block)) = surprise / std::sqrt(gain.variance);
    variances *= gain.variance / steps[i].at.variance;
    if (in_block + 1 == kBlock || i + 1 == steps.size()) {
      add_products<0, kUnknowns>(block, &result.sums);
      add_products<kUnknowns, kMiddle>(block, &result.sums);
      add_products<kMiddle, kColumns>(block, &result.sums);
      block.setZero();
      result.log_determinant += std::log(variances);
      variances = 1.0;
    }
  }
  result.sums.template triangularView<Eigen::StrictlyLower>() = result.sums.transpose();
  return result;
}

template WhiteRows<kHighestOrder> white_rows(const std::vector<CoherentStep>&, const Drift&);
template WhiteRows<kHighestOfClasses> white_rows(const std::vector<CoherentStep>&, const Drift&);

}  // namespace palpate
