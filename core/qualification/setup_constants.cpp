#include "core/qualification/setup_constants.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace palpate {

SetupConstants constants_of(const OffsetModel& model, const Coherence& coherence, double sigma_m,
                            const Eigen::VectorXd& coefficients_m,
                            const std::vector<double>& setup_m, double harmonic_m) {
  const Eigen::Index flat = model.flat.cols();
  const Eigen::Index offset = coefficients_m.size();
  const Eigen::Index columns = flat + offset;
  Eigen::MatrixXd white(model.residual_m.size(), columns + 1);
  white << model.flat, model.basis.leftCols(offset), model.residual_m;
  whiten(coherence, model.strokes, model.arc_m, model.used, white);
  white /= sigma_m;
  Eigen::MatrixXd matrix = white.leftCols(columns).transpose() * white.leftCols(columns);
  Eigen::VectorXd right = white.leftCols(columns).transpose() * white.col(columns);
  const double weight = 1.0 / (harmonic_m * harmonic_m);
  for (Eigen::Index i = 1; i < offset; ++i) {
    matrix(flat + i, flat + i) += weight;
    right[flat + i] -= weight * coefficients_m[i];
  }
  const auto count = static_cast<Eigen::Index>(setup_m.size());
  Eigen::MatrixXd of_recording = Eigen::MatrixXd::Zero(count, columns);
  SetupConstants constants;
  constants.value_m.resize(count);
  for (Eigen::Index r = 0; r < count; ++r) {
    of_recording(r, flat) = 1.0;
    if (r > 0) of_recording(r, r - 1) = 1.0;
    constants.value_m[r] = coefficients_m[0] + setup_m[static_cast<std::size_t>(r)];
  }
  const Eigen::LDLT<Eigen::MatrixXd> factor(matrix);
  constants.value_m += of_recording * factor.solve(right);
  constants.covariance_m2 = of_recording * factor.solve(of_recording.transpose());
  return constants;
}

SetupSpread spread_of(const SetupConstants& constants, double expected_m) {
  // Student's law, cut at 0. It is flat below its scale, so that set-ups may agree, and has a
  // power-law tail, so that they may differ by far more than expected. Three degrees of freedom are
  // the fewest for which the mean square exists; it is three times that of the scale.
  constexpr double kDegrees = 3.0;
  const double scale = expected_m / std::sqrt(kDegrees);
  const Eigen::Index count = constants.value_m.size();
  const double middle = constants.value_m.mean();
  const Eigen::VectorXd values = (constants.value_m.array() - middle).matrix();
  // Below this range the law has a hundredth of its mass, above it a few thousandths of its mean
  // square.
  const double low = std::log(0.01 * scale);
  const double high = std::log(std::max(1000.0 * scale, 10.0 * values.cwiseAbs().maxCoeff()));
  // Steps of less than 0.1 in the logarithm. n set-ups determine the logarithm to 1 / sqrt(2 n),
  // and a trapezoid rule with steps no wider than the deviation of a normal law errs by 1e-8.
  constexpr int kSteps = 160;
  struct Cell {
    double log_weight = 0.0;
    double between = 0.0;
    double constant = 0.0;
    double variance = 0.0;  ///< of the constant
  };
  std::vector<Cell> cells;
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(count);
  double top = -std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kSteps; ++i) {
    Cell& cell = cells.emplace_back();
    const double log_between = low + (high - low) * i / kSteps;
    cell.between = std::exp(log_between);
    Eigen::MatrixXd covariance = constants.covariance_m2;
    covariance.diagonal().array() += cell.between * cell.between;
    const Eigen::LDLT<Eigen::MatrixXd> factor(covariance);
    const Eigen::VectorXd weights = factor.solve(ones);
    cell.variance = 1.0 / weights.sum();
    cell.constant = cell.variance * weights.dot(values);
    const Eigen::VectorXd off = (values.array() - cell.constant).matrix();
    const double over = cell.between / scale;
    // The constant itself has a flat prior.
    cell.log_weight = -0.5 * factor.vectorD().array().log().sum() + 0.5 * std::log(cell.variance) -
                      0.5 * off.dot(factor.solve(off)) -
                      0.5 * (kDegrees + 1.0) * std::log1p(over * over / kDegrees) + log_between;
    top = std::max(top, cell.log_weight);
  }
  double total = 0.0;
  double between = 0.0;
  double square = 0.0;
  double constant = 0.0;
  double elsewhere = 0.0;  // mean square of another set-up's constant
  for (const Cell& cell : cells) {
    const double weight = std::exp(cell.log_weight - top);
    const double variance = cell.between * cell.between;
    total += weight;
    between += weight * cell.between;
    square += weight * variance;
    constant += weight * cell.constant;
    elsewhere += weight * (cell.constant * cell.constant + cell.variance + variance);
  }
  constant /= total;
  square /= total;
  // The offset's covariance already contains the uncertainty of the mean due to noise.
  const double noise = 1.0 / constants.covariance_m2.ldlt().solve(ones).sum();
  const double more = elsewhere / total - constant * constant - noise;
  const double root = std::sqrt(std::max(0.0, more));
  const double relative =
      std::sqrt(std::max(0.0, 1.0 - between / total * (between / total) / square));
  return {middle + constant, {root, relative * root}};
}

}  // namespace palpate
