// Residuals across a trial axis and their derivatives, for refine_axis().
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "core/recognition/fit/starts/axis_fit.h"

namespace palpate {

template <PolynomialModel kModel>
constexpr bool has_arms() {
  return kModel == PolynomialModel::SemiCubicalParabola || kModel == PolynomialModel::CubicSpline;
}

/// Powers of x (graph models) or t (arm models) in y. A cubical parabola's inflection may lie
/// anywhere along the axis, so that its graph has all powers.
template <PolynomialModel kModel>
constexpr auto powers() {
  return exponents_of_model < kModel == PolynomialModel::CubicalParabola
             ? PolynomialModel::CubicSpline
             : kModel > ();
}

/// Residuals across the axis at the best coefficients of y, for minimise_residuals. The few linear
/// unknowns are eliminated by modified Gram-Schmidt with the right side as one more column, which
/// is as stable as Householder's QR (A. Bjorck, 1967). Each point is a row, so that its columns are
/// adjacent in memory.
template <PolynomialModel kModel>
class AxisResiduals {
 public:
  static constexpr auto kPowers = powers<kModel>();
  static constexpr bool kArms = has_arms<kModel>();
  static constexpr int kLinear = static_cast<int>(kPowers.size());
  enum { NUM_PARAMETERS = kArms ? 2 : 1 };
  using Coefficients = Eigen::Matrix<double, kLinear, 1>;

  AxisResiduals(std::span<const FitPoint> points, std::span<const double> arms)
      : points_(points), arms_(arms), rows_(points.size()) {}

  int NumResiduals() const { return static_cast<int>(points_.size()); }

  /// Coefficients of y at the last evaluation.
  const Coefficients& coefficients() const { return coefficients_; }

  bool operator()(const double* x, double* residuals, double* jacobian) const {
    const std::size_t n = points_.size();
    // The Jacobian is requested at an accepted trial: all else is already computed for it.
    const bool same = jacobian != nullptr && std::equal(x, x + NUM_PARAMETERS, at_.begin());
    if (!same) {
      std::copy(x, x + NUM_PARAMETERS, at_.begin());
      solved_ = solve();
    }
    if (!solved_) {
      return false;  // all points alike, e.g. the vertex lies beyond them: no curve
    }
    for (std::size_t i = 0; i < n; ++i) {
      residuals[i] = rows_[i].columns[kLinear];
    }
    for (std::size_t i = 0; any_before_vertex_ && i < n; ++i) {
      residuals[i] = residual_of(i);
    }
    if (jacobian != nullptr) {
      differentiate(jacobian);
    }
    return true;
  }

 private:
  /// Columns and right side, padded to an even number: two doubles are processed at once.
  static constexpr int kWidth = kLinear + 1 + (kLinear + 1) % 2;
  using Columns = Eigen::Matrix<double, kWidth, 1>;

  struct Row {
    Columns columns;  ///< w u^k, orthogonalised by `solve`; the last is y's residual
    /// Derivative of the residual; `differentiate` projects it off the columns.
    Vec2 by_parameters;
    double along = 0.0;   ///< coordinate along the axis
    double across = 0.0;  ///< coordinate across the axis
    double weight = 0.0;
    double u = 0.0;
  };

  /// A point before the vertex is as far from the curve as from the vertex. Without that, a vertex
  /// in the midst of the points would free the points before it, and the fit would beat the true
  /// curve.
  double residual_of(std::size_t i) const {
    const Row& row = rows_[i];
    return row.u == 0.0 ? std::sqrt(row.columns[kLinear] * row.columns[kLinear] +
                                    before_vertex(i) * before_vertex(i))
                        : row.columns[kLinear];
  }

  /// Distance over noise by which a point without u lies before the vertex.
  double before_vertex(std::size_t i) const {
    return (at_[1] - rows_[i].along) * points_[i].inverse_sigma;
  }

  /// Adds the distance to the vertex to the Jacobian's rows of points before it.
  void add_distances_to_vertex() const {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      Row& row = rows_[i];
      const double residual = residual_of(i);
      if (row.u == 0.0 && residual > 0.0) {
        const Vec2 by = points_[i].inverse_sigma * Vec2(-row.across, 1.0);
        row.by_parameters =
            (row.columns[kLinear] * row.by_parameters + before_vertex(i) * by) / residual;
      }
    }
  }

  /// Fills and orthogonalises the columns. False if they are dependent.
  bool solve() const {
    const Vec2 axis(std::cos(at_[0]), std::sin(at_[0]));
    const double x0 = at_[1];
    Columns products = Columns::Zero();  // of the first column with all
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const FitPoint& point = points_[i];
      Row& row = rows_[i];
      row.weight = point.inverse_sigma * verticality(point, axis);
      row.along = point.position.dot(axis);
      row.across = cross(axis, point.position);
      row.u = row.along;
      if constexpr (kArms) {
        least = std::min(least, row.along);
        row.u = arms_[i] * std::sqrt(std::max(row.along - x0, 0.0));
      }
      const double power[4] = {1.0, row.u, row.u * row.u, row.u * row.u * row.u};
      for (int k = 0; k < kLinear; ++k) {
        row.columns[k] = row.weight * power[kPowers[static_cast<std::size_t>(k)]];
      }
      row.columns[kLinear] = row.weight * row.across;
      if constexpr (kWidth > kLinear + 1) {
        row.columns[kWidth - 1] = 0.0;
      }
      products += row.columns[0] * row.columns;
    }
    any_before_vertex_ = kArms && least <= x0;
    // Column k: its coefficients in the later columns.
    Eigen::Matrix<double, kWidth, kLinear> factors;
    for (int k = 0; k < kLinear; ++k) {
      squares_[k] = products[k];
      if (!(products[k] > 0.0)) {
        return false;
      }
      Columns off = products / products[k];
      off.head(k + 1).setZero();
      factors.col(k) = off;
      products.setZero();
      for (Row& row : rows_) {
        row.columns -= row.columns[k] * off;
        products += row.columns[k + 1] * row.columns;
      }
    }
    for (int k = kLinear - 1; k >= 0; --k) {
      coefficients_[k] = factors(kLinear, k);
      for (int j = k + 1; j < kLinear; ++j) {
        coefficients_[k] -= factors(j, k) * coefficients_[j];
      }
    }
    return true;
  }

  /// Kaufman's form: the derivative at fixed coefficients, projected off the columns.
  void differentiate(double* jacobian) const {
    Vec2 products = Vec2::Zero();  // of the first column with the derivatives
    for (Row& row : rows_) {
      double slope = 0.0;  // dy/dx of the curve
      const double u_by_x = !kArms ? 1.0 : row.u != 0.0 ? 0.5 / row.u : 0.0;
      double power = 1.0;
      int degree = 0;
      for (int k = 0; k < kLinear; ++k) {
        const int wanted = kPowers[static_cast<std::size_t>(k)];
        for (; degree + 1 < wanted; ++degree) {
          power *= row.u;
        }
        slope += wanted > 0 ? wanted * coefficients_[k] * power * u_by_x : 0.0;
      }
      // Turning the axis by d changes across by -along d, and along by across d.
      row.by_parameters = row.weight * Vec2(-row.along - slope * row.across, slope);
      products += row.columns[0] * row.by_parameters;
    }
    for (int k = 0; k < kLinear; ++k) {
      const Vec2 off = products / squares_[k];
      products.setZero();
      for (Row& row : rows_) {
        row.by_parameters -= row.columns[k] * off;
        products += row.columns[k + 1] * row.by_parameters;
      }
    }
    const std::size_t n = points_.size();
    if (any_before_vertex_) {
      add_distances_to_vertex();
    }
    for (std::size_t j = 0; j < NUM_PARAMETERS; ++j) {
      for (std::size_t i = 0; i < n; ++i) {
        jacobian[j * n + i] = rows_[i].by_parameters[static_cast<Eigen::Index>(j)];
      }
    }
  }

  std::span<const FitPoint> points_;
  std::span<const double> arms_;
  // State of the last evaluation:
  mutable std::array<double, 2> at_ = {std::numeric_limits<double>::quiet_NaN(), 0.0};
  mutable bool solved_ = false;
  mutable bool any_before_vertex_ = false;
  mutable std::vector<Row> rows_;
  mutable Coefficients squares_ = Coefficients::Zero();  ///< of the orthogonal columns
  mutable Coefficients coefficients_ = Coefficients::Zero();
};

}  // namespace palpate
