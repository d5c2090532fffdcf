#include "core/qualification/offset_evidence.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "core/numerics/probability/log_gamma.h"
#include "core/numerics/quantile.h"
#include "core/qualification/normal_offset.h"

namespace palpate {
namespace {

/// One point of the grid.
struct Cell {
  int order = 0;
  double log_ratio = 0.0;
  double log_length = 0.0;
  double log_evidence = -std::numeric_limits<double>::infinity();
  double variance = 0.0;  ///< mean variance of the white noise, given the cell [m^2]
  double harmonic = 0.0;  ///< standard deviation of the harmonics over that of the noise
  double degrees = 0.0;
  Eigen::VectorXd coefficients;
};

/// Ends of the range of a prior; values are evenly spaced in it.
struct Range {
  double low = 0.0;
  double high = 0.0;
};

/// Sums for one coherence that the evidences of all orders share.
struct NormalEquations {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right;
  double squares = 0.0;
  double log_determinant = 0.0;
};

NormalEquations normal_equations(const OffsetModel& model, const Coherence& coherence) {
  const Eigen::Index rows = model.residual_m.size();
  const Eigen::Index columns = model.flat.cols() + model.basis.cols();
  Eigen::MatrixXd white(rows, columns + 1);
  white << model.flat, model.basis, model.residual_m;
  NormalEquations sums;
  sums.log_determinant = whiten(coherence, model.strokes, model.arc_m, model.used, white);
  sums.matrix = white.leftCols(columns).transpose() * white.leftCols(columns);
  sums.right = white.leftCols(columns).transpose() * white.col(columns);
  sums.squares = white.col(columns).squaredNorm();
  return sums;
}

/// Ratios of the standard deviation of the harmonics to that of the noise, uniform in the
/// logarithm: from a size that no number of samples shows to one that a single sample shows.
std::vector<double> harmonic_sizes() {
  std::vector<double> sizes;
  for (double size = 0.01; size < 200.0; size *= 2.0) sizes.push_back(size);
  return sizes;
}

/// The matrix of so many columns, of which the first `flat` have no prior and the harmonics after
/// them one of `size` times the noise. `log_sizes`: the sum of their logarithms.
Eigen::MatrixXd with_prior(const NormalEquations& sums, Eigen::Index flat, Eigen::Index columns,
                           double size, double* log_sizes) {
  Eigen::MatrixXd matrix = sums.matrix.topLeftCorner(columns, columns);
  for (Eigen::Index i = flat; i < columns; ++i) {
    const double expected = size * overtone(static_cast<int>(i - flat) / 2 + 2);
    matrix(i, i) += 1.0 / (expected * expected);
    *log_sizes += std::log(expected);
  }
  return matrix;
}

/// Adds the cells of all orders for one coherence.
void add_cells(const OffsetModel& model, int highest, double log_ratio, double log_length,
               std::vector<Cell>& cells) {
  const double ratio = std::exp(log_ratio);
  const NormalEquations sums = normal_equations(model, {ratio, std::exp(log_length)});
  const Eigen::Index flat = model.flat.cols() + 1;
  const auto used = static_cast<double>(std::count(model.used.begin(), model.used.end(), 1));
  const double degrees = used - static_cast<double>(flat);
  static const std::vector<double> sizes = harmonic_sizes();
  for (int order = 0; order <= highest; order = order == 0 ? 2 : order + 1) {
    const Eigen::Index columns = model.flat.cols() + offset_coefficients(order);
    for (const double size : sizes) {
      double log_sizes = 0.0;
      const Eigen::LDLT<Eigen::MatrixXd> factor(with_prior(sums, flat, columns, size, &log_sizes));
      const Eigen::VectorXd solution = factor.solve(sums.right.head(columns));
      const double squares = std::max(sums.squares - sums.right.head(columns).dot(solution),
                                      degrees * model.least_noise_m * model.least_noise_m);
      Cell cell{order, log_ratio, log_length, 0.0, squares / (degrees - 2.0), size, degrees, {}};
      cell.log_evidence = -0.5 * sums.log_determinant -
                          0.5 * factor.vectorD().array().abs().log().sum() - log_sizes -
                          0.5 * degrees * std::log(0.5 * squares) + log_gamma(0.5 * degrees) -
                          // Without harmonics their size has no effect: one cell stands for all
                          // sizes.
                          (order == 0 ? 0.0 : std::log(static_cast<double>(sizes.size())));
      cell.coefficients = solution.tail(offset_coefficients(order));
      if (std::isfinite(cell.log_evidence)) cells.push_back(std::move(cell));
      if (order == 0) break;
    }
  }
}

std::vector<Cell> grid(const OffsetModel& model, int highest, Range ratios, Range lengths,
                       int steps) {
  std::vector<Cell> cells;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; j <= steps; ++j) {
      add_cells(model, highest, ratios.low + (ratios.high - ratios.low) * i / steps,
                lengths.low + (lengths.high - lengths.low) * j / steps, cells);
    }
  }
  return cells;
}

double highest_evidence(const std::vector<Cell>& cells) {
  double highest = -std::numeric_limits<double>::infinity();
  for (const Cell& cell : cells) highest = std::max(highest, cell.log_evidence);
  return highest;
}

/// The part of a range where the evidence is not negligible, plus one step on either side.
Range where_told(const std::vector<Cell>& cells, Range range, int steps, double Cell::*field) {
  constexpr double kNothing = 12.0;  // e^-12
  const double highest = highest_evidence(cells);
  Range told{range.high, range.low};
  for (const Cell& cell : cells) {
    if (cell.log_evidence > highest - kNothing) {
      told.low = std::min(told.low, cell.*field);
      told.high = std::max(told.high, cell.*field);
    }
  }
  const double step = (range.high - range.low) / steps;
  return {std::max(told.low - step, range.low), std::min(told.high + step, range.high)};
}

/// The order of a place in OffsetEvidence::probabilities.
int order_of(std::size_t index) { return index == 0 ? 0 : static_cast<int>(index) + 1; }

/// Covariance of the coefficients of a cell, given the cell.
Eigen::MatrixXd covariance_of(const OffsetModel& model, const Cell& cell) {
  const NormalEquations sums =
      normal_equations(model, {std::exp(cell.log_ratio), std::exp(cell.log_length)});
  const Eigen::Index flat = model.flat.cols();
  const Eigen::Index coefficients = offset_coefficients(cell.order);
  const Eigen::Index columns = flat + coefficients;
  double log_sizes = 0.0;
  const Eigen::MatrixXd inverse = with_prior(sums, flat + 1, columns, cell.harmonic, &log_sizes)
                                      .ldlt()
                                      .solve(Eigen::MatrixXd::Identity(columns, columns));
  return cell.variance * inverse.bottomRightCorner(coefficients, coefficients);
}

/// The lowest order that no higher one beats by substantial evidence (H. Jeffreys).
int fewest_asked_for(const std::vector<double>& by_order) {
  constexpr double kSubstantial = 3.0;
  for (auto order = by_order.begin(); order != by_order.end(); ++order) {
    if (kSubstantial * *order >= *std::max_element(order, by_order.end())) {
      return order_of(static_cast<std::size_t>(order - by_order.begin()));
    }
  }
  return 0;
}

/// OffsetEvidence::other_orders_m2, from their cells, about the coefficients of the chosen order. A
/// harmonic that an order does not have is 0 for certain. Each order's covariance is that of its
/// most probable cell.
Eigen::MatrixXd moments_of_other_orders(const OffsetModel& model, const std::vector<Cell>& cells,
                                        const OffsetEvidence& chosen,
                                        const Eigen::VectorXd& about) {
  Eigen::MatrixXd moments = Eigen::MatrixXd::Zero(about.size(), about.size());
  for (std::size_t index = 0; index < chosen.probabilities.size(); ++index) {
    const int order = order_of(index);
    const Cell* best = nullptr;
    for (const Cell& cell : cells) {
      const bool is_better = best == nullptr || cell.log_evidence > best->log_evidence;
      if (cell.order == order && is_better) best = &cell;
    }
    if (best == nullptr) continue;
    const Eigen::Index shared = std::min(about.size(), best->coefficients.size());
    double total = 0.0;
    Eigen::MatrixXd off_m2 = Eigen::MatrixXd::Zero(about.size(), about.size());
    for (const Cell& cell : cells) {
      if (cell.order != order) continue;
      const double weight = std::exp(cell.log_evidence - best->log_evidence);
      Eigen::VectorXd off = -about;
      off.head(shared) += cell.coefficients.head(shared);
      off_m2 += weight * off * off.transpose();
      total += weight;
    }
    off_m2 /= total;
    off_m2.topLeftCorner(shared, shared) +=
        covariance_of(model, *best).topLeftCorner(shared, shared);
    moments += chosen.probabilities[index] * off_m2;
  }
  return moments;
}

/// Mean and standard deviation over cells; the weights sum to 1.
template <typename Value>
Estimate estimate_over(const std::vector<Cell>& cells, const std::vector<double>& weights,
                       const Value& value) {
  double mean = 0.0;
  double square = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Estimate e = value(cells[i]);
    mean += weights[i] * e.value;
    square += weights[i] * (e.value * e.value + e.deviation * e.deviation);
  }
  return {mean, std::sqrt(std::max(0.0, square - mean * mean))};
}

Estimate sigma_of(const Cell& cell) {
  const double sigma = std::sqrt(cell.variance);
  return {sigma, sigma / std::sqrt(2.0 * cell.degrees)};
}

/// From a few sample spacings to a part of the longest stroke. A shorter deviation counts as noise;
/// a longer one cannot be distinguished from a constant.
Range lengths_of(const OffsetModel& model) {
  std::vector<double> steps;
  double longest = 0.0;
  for (const StrokePlaces& stroke : model.strokes) {
    for (Eigen::Index i = stroke.begin + 1; i < stroke.end; ++i) {
      const auto k = static_cast<std::size_t>(i);
      steps.push_back(model.arc_m[k] - model.arc_m[k - 1]);
    }
    if (stroke.end > stroke.begin) {
      longest = std::max(longest, model.arc_m[static_cast<std::size_t>(stroke.end - 1)] -
                                      model.arc_m[static_cast<std::size_t>(stroke.begin)]);
    }
  }
  constexpr double kFewestSteps = 4.0;  // drift over fewer steps looks like noise
  constexpr double kShare = 0.5;  // of a stroke; a longer deviation is absorbed by the constant
  if (steps.empty() || !(longest > 0.0)) return {0.0, 0.0};
  const double shortest = std::max(kFewestSteps * median_of(steps), 1e-6 * longest);
  return {std::log(std::min(shortest, kShare * longest)), std::log(kShare * longest)};
}

}  // namespace

std::optional<OffsetEvidence> weigh_offsets(const OffsetModel& model) {
  // Steps of nearly an e-fold. They show where the evidence lies; where_told keeps a step beyond,
  // so a peak between two steps is not lost.
  constexpr int kCoarse = 9;
  // Over what remains, which is at least two coarse steps: an eighth of an e-fold each. The
  // trapezoid rule errs by a hundredth for a normal peak whose deviation is half a step, and by far
  // less for a wider one.
  constexpr int kFine = 15;
  const int columns = static_cast<int>(model.basis.cols());
  const int highest = columns == 1 ? 0 : (columns + 1) / 2;
  // Uniform in the logarithm, as for the noise: no size is preferred. Below a hundredth no number
  // of samples shows the deviation.
  const Range ratios{std::log(0.01), std::log(30.0)};
  const Range lengths = lengths_of(model);
  const std::vector<Cell> coarse = grid(model, highest, ratios, lengths, kCoarse);
  if (coarse.empty()) return std::nullopt;
  std::vector<Cell> cells =
      grid(model, highest, where_told(coarse, ratios, kCoarse, &Cell::log_ratio),
           where_told(coarse, lengths, kCoarse, &Cell::log_length), kFine);
  if (cells.empty()) return std::nullopt;

  OffsetEvidence result;
  const double top = highest_evidence(cells);
  std::vector<double> by_order(static_cast<std::size_t>(std::max(highest, 1)), 0.0);
  double total = 0.0;
  for (const Cell& cell : cells) {
    const double weight = std::exp(cell.log_evidence - top);
    by_order[static_cast<std::size_t>(std::max(cell.order - 1, 0))] += weight;
    total += weight;
  }
  for (double& p : by_order) p /= total;
  result.order = fewest_asked_for(by_order);
  result.probabilities = std::move(by_order);

  const auto rest = std::stable_partition(
      cells.begin(), cells.end(), [&](const Cell& cell) { return cell.order == result.order; });
  const std::vector<Cell> others(std::make_move_iterator(rest),
                                 std::make_move_iterator(cells.end()));
  cells.erase(rest, cells.end());
  const Cell& best_cell = *std::max_element(
      cells.begin(), cells.end(),
      [](const Cell& a, const Cell& b) { return a.log_evidence < b.log_evidence; });
  result.coherence = {std::exp(best_cell.log_ratio), std::exp(best_cell.log_length)};
  std::vector<double> weights;
  total = 0.0;
  for (const Cell& cell : cells) {
    weights.push_back(std::exp(cell.log_evidence - top));
    total += weights.back();
  }
  for (double& weight : weights) weight /= total;
  result.sigma_m = estimate_over(cells, weights, sigma_of);
  result.deviation_m = estimate_over(cells, weights, [](const Cell& cell) {
    const Estimate sigma = sigma_of(cell);
    const double ratio = std::exp(cell.log_ratio);
    return Estimate{ratio * sigma.value, ratio * sigma.deviation};
  });
  result.deviation_length_m = estimate_over(cells, weights, [](const Cell& cell) {
    return Estimate{std::exp(cell.log_length), 0.0};
  });
  result.harmonic_m = estimate_over(cells, weights, [](const Cell& cell) {
                        return Estimate{cell.harmonic * std::sqrt(cell.variance), 0.0};
                      }).value;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(offset_coefficients(result.order));
  for (std::size_t i = 0; i < cells.size(); ++i) mean += weights[i] * cells[i].coefficients;
  result.spread_m2 = Eigen::MatrixXd::Zero(mean.size(), mean.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Eigen::VectorXd off = cells[i].coefficients - mean;
    result.spread_m2 += weights[i] * off * off.transpose();
  }
  result.other_orders_m2 = moments_of_other_orders(model, others, result, mean);
  return result;
}

Eigen::MatrixXd over_all_orders(const Eigen::MatrixXd& of_order_m2,
                                const OffsetEvidence& evidence) {
  const double of_order =
      evidence.probabilities[static_cast<std::size_t>(std::max(evidence.order - 1, 0))];
  return of_order * (of_order_m2 + evidence.spread_m2) + evidence.other_orders_m2;
}

}  // namespace palpate
