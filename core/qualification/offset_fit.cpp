#include "core/qualification/offset_fit.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate {
namespace {

/// The unknowns in the form in which Ceres changes them.
struct Blocks {
  std::vector<Eigen::Vector2d> translation;
  std::vector<double> angle;
  Eigen::VectorXd coefficients;
  double lag = 0.0;
};

Blocks blocks_of(const OffsetUnknowns& unknowns) {
  Blocks blocks;
  for (const Pose2& pose : unknowns.poses) {
    blocks.translation.push_back(pose.translation());
    blocks.angle.push_back(pose.theta);
  }
  blocks.coefficients = unknowns.offset.coefficients_m;
  blocks.lag = unknowns.lag_m.value_or(0.0);
  return blocks;
}

void take(const Blocks& blocks, OffsetUnknowns& unknowns) {
  for (std::size_t i = 0; i < unknowns.poses.size(); ++i) {
    unknowns.poses[i] = {blocks.translation[i].x(), blocks.translation[i].y(), blocks.angle[i]};
  }
  unknowns.offset.coefficients_m = blocks.coefficients;
  if (unknowns.lag_m) unknowns.lag_m = blocks.lag;
}

/// Residual of a sample and its derivatives. One effect is omitted from the derivatives: a motion
/// of the pose turns the normal and so changes the offset. It is the slope of the offset over the
/// radius of curvature, some thousandths, and only slows the last steps.
struct Row {
  double residual = 0.0;
  Eigen::RowVectorXd by_translation;
  double by_angle = 0.0;
  Eigen::RowVectorXd by_coefficients;
  double by_lag = 0.0;
  double normal_angle = 0.0;
  double offset_angle = 0.0;  ///< direction that the offset belongs to, lag included
};

Row row_of(const Curve& artefact, MaterialSign material, const ArtefactSample& sample,
           const Pose2& pose, const Eigen::VectorXd& coefficients, int order, double lag) {
  const SampleOnArtefact at = beside(artefact, material, pose, sample);
  const double phi = at.normal_angle + at.turn_per_m * lag;
  Row row;
  row.by_coefficients = -offset_basis(phi, order);
  row.residual = at.distance_m + row.by_coefficients.dot(coefficients);
  row.by_translation = -at.normal.transpose();
  row.by_angle = at.by_angle;
  row.by_lag = -at.turn_per_m * offset_basis_slope(phi, order).dot(coefficients);
  row.normal_angle = at.normal_angle;
  row.offset_angle = phi;
  return row;
}

/// Order of an offset with so many coefficients.
int order_of(Eigen::Index coefficients) {
  return coefficients == 1 ? 0 : static_cast<int>(coefficients + 1) / 2;
}

/// One sample, divided by its noise.
class SampleCost : public ceres::CostFunction {
 public:
  SampleCost(const Curve& artefact, MaterialSign material, const ArtefactSample& sample,
             double setup_m, double scale_m, int coefficients)
      : artefact_(artefact),
        material_(material),
        sample_(sample),
        setup_m_(setup_m),
        scale_m_(scale_m) {
    set_num_residuals(1);
    *mutable_parameter_block_sizes() = {2, 1, coefficients};
  }

  bool Evaluate(const double* const* blocks, double* residual, double** jacobians) const override {
    const Eigen::Index count = parameter_block_sizes()[2];
    const Row row =
        row_of(artefact_, material_, sample_, {blocks[0][0], blocks[0][1], blocks[1][0]},
               Eigen::Map<const Eigen::VectorXd>(blocks[2], count), order_of(count), 0.0);
    residual[0] = (row.residual - setup_m_) / scale_m_;
    if (jacobians != nullptr) {
      if (jacobians[0] != nullptr) {
        std::copy_n(row.by_translation.data(), 2, jacobians[0]);
        for (int i = 0; i < 2; ++i) jacobians[0][i] /= scale_m_;
      }
      if (jacobians[1] != nullptr) jacobians[1][0] = row.by_angle / scale_m_;
      if (jacobians[2] != nullptr) {
        for (Eigen::Index i = 0; i < count; ++i) {
          jacobians[2][i] = row.by_coefficients[i] / scale_m_;
        }
      }
    }
    return std::isfinite(residual[0]);
  }

 private:
  const Curve& artefact_;
  MaterialSign material_;
  const ArtefactSample& sample_;
  double setup_m_;
  double scale_m_;
};

/// All samples, whitened. Blocks: translation and angle of each recording, coefficients, lag.
class WhiteCost : public ceres::CostFunction {
 public:
  WhiteCost(const Curve& artefact, MaterialSign material, std::span<const ArtefactSample> samples,
            const KnownNoise& noise, const OffsetUnknowns& unknowns, int coefficients)
      : artefact_(artefact), material_(material), samples_(samples), noise_(noise) {
    set_num_residuals(static_cast<int>(samples.size()));
    for (const ArtefactSample& sample : samples) setup_m_.push_back(setup_of(unknowns, sample));
    for (std::size_t i = 0; i < unknowns.poses.size(); ++i) {
      mutable_parameter_block_sizes()->push_back(2);
      mutable_parameter_block_sizes()->push_back(1);
    }
    mutable_parameter_block_sizes()->push_back(coefficients);
    mutable_parameter_block_sizes()->push_back(1);
  }

  bool Evaluate(const double* const* blocks, double* residuals, double** jacobians) const override {
    const std::size_t recordings = parameter_block_sizes().size() / 2 - 1;
    const Eigen::Index count = parameter_block_sizes()[2 * recordings];
    const auto rows = static_cast<Eigen::Index>(samples_.size());
    const auto poses = static_cast<Eigen::Index>(3 * recordings);
    const Eigen::Map<const Eigen::VectorXd> coefficients(blocks[2 * recordings], count);
    const double lag = blocks[2 * recordings + 1][0];
    // Columns: residual, poses, coefficients, lag.
    Eigen::MatrixXd white =
        Eigen::MatrixXd::Zero(rows, jacobians == nullptr ? 1 : poses + count + 2);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const ArtefactSample& sample = samples_[static_cast<std::size_t>(i)];
      const std::size_t r = sample.recording;
      const Row row = row_of(artefact_, material_, sample,
                             {blocks[2 * r][0], blocks[2 * r][1], blocks[2 * r + 1][0]},
                             coefficients, order_of(count), lag);
      white(i, 0) = row.residual - setup_m_[static_cast<std::size_t>(i)];
      if (jacobians != nullptr) {
        const auto first = static_cast<Eigen::Index>(1 + 3 * r);
        white.block(i, first, 1, 2) = row.by_translation;
        white(i, first + 2) = row.by_angle;
        white.block(i, 1 + poses, 1, count) = row.by_coefficients;
        white(i, 1 + poses + count) = row.by_lag;
      }
    }
    whiten(noise_.coherence, noise_.strokes, noise_.arc_m, noise_.used, white);
    white /= noise_.sigma_m;
    if (!white.allFinite()) return false;
    Eigen::Map<Eigen::VectorXd>(residuals, rows) = white.col(0);
    Eigen::Index column = 1;
    for (std::size_t b = 0; jacobians != nullptr && b < parameter_block_sizes().size(); ++b) {
      const Eigen::Index width = parameter_block_sizes()[b];
      if (jacobians[b] != nullptr) {
        using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
        if (width == 1) {
          Eigen::Map<Eigen::VectorXd>(jacobians[b], rows) = white.col(column);
        } else {
          Eigen::Map<RowMajor>(jacobians[b], rows, width) = white.middleCols(column, width);
        }
      }
      column += width;
    }
    return true;
  }

 private:
  const Curve& artefact_;
  MaterialSign material_;
  std::span<const ArtefactSample> samples_;
  KnownNoise noise_;
  std::vector<double> setup_m_;  ///< by sample
};

/// The harmonics, divided by their prior standard deviation.
class PriorCost : public ceres::CostFunction {
 public:
  PriorCost(int coefficients, double deviation_m) : deviation_m_(deviation_m) {
    set_num_residuals(coefficients - 1);
    *mutable_parameter_block_sizes() = {coefficients};
  }

  bool Evaluate(const double* const* blocks, double* residuals, double** jacobians) const override {
    const int count = parameter_block_sizes()[0];
    for (int i = 1; i < count; ++i) residuals[i - 1] = blocks[0][i] / deviation_m_;
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      std::fill_n(jacobians[0], (count - 1) * count, 0.0);
      for (int i = 1; i < count; ++i) jacobians[0][(i - 1) * count + i] = 1.0 / deviation_m_;
    }
    return true;
  }

 private:
  double deviation_m_;
};

ceres::Solver::Options solver_options() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = 100;
  // Costs are about the number of samples: a gain below 1e-10 of that changes nothing.
  options.function_tolerance = 1e-10;
  options.parameter_tolerance = 1e-12;
  options.gradient_tolerance = 1e-10;
  return options;
}

bool is_circle(const Curve& artefact) { return class_of(artefact) == CurveClass::Circle; }

/// Adds the pose blocks. The angle of a circle is held constant.
void add_poses(const Curve& artefact, Blocks& blocks, ceres::Problem& problem) {
  for (std::size_t i = 0; i < blocks.translation.size(); ++i) {
    problem.AddParameterBlock(blocks.translation[i].data(), 2);
    problem.AddParameterBlock(&blocks.angle[i], 1);
    if (is_circle(artefact)) problem.SetParameterBlockConstant(&blocks.angle[i]);
  }
}

void add_prior(const HarmonicPrior& prior, Blocks& blocks, ceres::Problem& problem) {
  const int count = static_cast<int>(blocks.coefficients.size());
  if (count > 1) {
    problem.AddResidualBlock(new PriorCost(count, prior.deviation_m), nullptr,
                             blocks.coefficients.data());
  }
}

}  // namespace

double setup_of(const OffsetUnknowns& unknowns, const ArtefactSample& sample) {
  return unknowns.setup_m.empty() ? 0.0 : unknowns.setup_m[sample.recording];
}

OffsetResiduals residuals_about(const Curve& artefact, MaterialSign material,
                                std::span<const ArtefactSample> samples,
                                const OffsetUnknowns& unknowns, int order) {
  const auto rows = static_cast<Eigen::Index>(samples.size());
  const Eigen::Index pose_columns = is_circle(artefact) ? 2 : 3;
  const auto recordings = static_cast<Eigen::Index>(unknowns.poses.size());
  const Eigen::Index setups = unknowns.setup_m.empty() ? 0 : recordings - 1;
  OffsetResiduals about;
  about.residual_m.resize(rows);
  about.flat =
      Eigen::MatrixXd::Zero(rows, setups + pose_columns * recordings + (unknowns.lag_m ? 1 : 0));
  about.basis.resize(rows, offset_coefficients(order));
  for (Eigen::Index i = 0; i < rows; ++i) {
    const ArtefactSample& sample = samples[static_cast<std::size_t>(i)];
    const double lag = unknowns.lag_m.value_or(0.0);
    const Pose2& pose = unknowns.poses[sample.recording];
    const Row row = row_of(artefact, material, sample, pose, unknowns.offset.coefficients_m,
                           unknowns.offset.order, lag);
    const auto recording = static_cast<Eigen::Index>(sample.recording);
    const Eigen::Index first = setups + pose_columns * recording;
    about.residual_m[i] = row.residual - setup_of(unknowns, sample);
    if (setups > 0 && recording > 0) about.flat(i, recording - 1) = 1.0;
    about.flat.block(i, first, 1, 2) = -row.by_translation;
    if (pose_columns == 3) about.flat(i, first + 2) = -row.by_angle;
    if (unknowns.lag_m) about.flat(i, about.flat.cols() - 1) = -row.by_lag;
    about.basis.row(i) = offset_basis(row.offset_angle, order);
    about.normal_angle.push_back(row.normal_angle);
  }
  return about;
}

bool fit_robustly(const Curve& artefact, MaterialSign material,
                  std::span<const ArtefactSample> samples, double scale_m,
                  const HarmonicPrior& prior, OffsetUnknowns& unknowns) {
  Blocks blocks = blocks_of(unknowns);
  constexpr double kWidth = 2.0;  // Cauchy's loss has half the slope of the square there
  ceres::Problem problem;
  add_poses(artefact, blocks, problem);
  const int count = static_cast<int>(blocks.coefficients.size());
  for (const ArtefactSample& sample : samples) {
    problem.AddResidualBlock(
        new SampleCost(artefact, material, sample, setup_of(unknowns, sample), scale_m, count),
        new ceres::CauchyLoss(kWidth), blocks.translation[sample.recording].data(),
        &blocks.angle[sample.recording], blocks.coefficients.data());
  }
  add_prior(prior, blocks, problem);
  ceres::Solver::Options options = solver_options();
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) return false;
  take(blocks, unknowns);
  return true;
}

std::optional<double> fit_under_noise(const Curve& artefact, MaterialSign material,
                                      std::span<const ArtefactSample> samples,
                                      const KnownNoise& noise, const HarmonicPrior& prior,
                                      OffsetUnknowns& unknowns) {
  Blocks blocks = blocks_of(unknowns);
  ceres::Problem problem;
  add_poses(artefact, blocks, problem);
  std::vector<double*> all;
  for (std::size_t i = 0; i < blocks.translation.size(); ++i) {
    all.push_back(blocks.translation[i].data());
    all.push_back(&blocks.angle[i]);
  }
  const int count = static_cast<int>(blocks.coefficients.size());
  all.push_back(blocks.coefficients.data());
  all.push_back(&blocks.lag);
  problem.AddResidualBlock(new WhiteCost(artefact, material, samples, noise, unknowns, count),
                           nullptr, all);
  if (!unknowns.lag_m) problem.SetParameterBlockConstant(&blocks.lag);
  add_prior(prior, blocks, problem);
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(), &problem, &summary);
  if (!summary.IsSolutionUsable()) return std::nullopt;
  take(blocks, unknowns);

  ceres::Covariance::Options covariance_options;
  covariance_options.algorithm_type = ceres::DENSE_SVD;  // does not assume full rank
  ceres::Covariance covariance(covariance_options);
  std::vector<std::pair<const double*, const double*>> wanted = {
      {blocks.coefficients.data(), blocks.coefficients.data()}};
  if (unknowns.lag_m) wanted.emplace_back(&blocks.lag, &blocks.lag);
  if (!covariance.Compute(wanted, &problem)) return std::nullopt;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> of_offset(count, count);
  covariance.GetCovarianceBlock(blocks.coefficients.data(), blocks.coefficients.data(),
                                of_offset.data());
  unknowns.offset.covariance_m2 = of_offset;
  double of_lag = 0.0;
  if (unknowns.lag_m) covariance.GetCovarianceBlock(&blocks.lag, &blocks.lag, &of_lag);
  return of_lag;
}

}  // namespace palpate
