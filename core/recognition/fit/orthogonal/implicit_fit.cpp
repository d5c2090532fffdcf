#include "core/recognition/fit/orthogonal/implicit_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/numerics/least_squares.h"
#include "core/recognition/fit/orthogonal/measured_normal.h"
#include "core/recognition/fit/orthogonal/touchable.h"

namespace palpate {
namespace {

double value(const ConicCoefficients& q, const Vec2& p) {
  return (q[0] * p.x() + q[1] * p.y() + q[3]) * p.x() + (q[2] * p.y() + q[4]) * p.y() + q[5];
}

/// Columns: the model's directions in the space of the six coefficients.
template <int K>
using ModelBasis = Eigen::Matrix<double, 6, K>;

ModelBasis<6> conic_basis() { return ModelBasis<6>::Identity(); }

ModelBasis<4> circle_basis() {
  ModelBasis<4> basis = ModelBasis<4>::Zero();
  basis(0, 0) = basis(2, 0) = std::sqrt(0.5);
  basis(3, 1) = basis(4, 2) = basis(5, 3) = 1.0;
  return basis;
}

ModelBasis<3> line_basis() {
  ModelBasis<3> basis = ModelBasis<3>::Zero();
  basis(3, 0) = basis(4, 1) = basis(5, 2) = 1.0;
  return basis;
}

/// Orthonormal columns across `unit`: all but the first column of the Householder reflection that
/// turns it into the first axis.
template <int K>
Eigen::Matrix<double, K, K - 1> tangent_space(const Eigen::Matrix<double, K, 1>& unit) {
  Eigen::Matrix<double, K, K - 1> tangent;
  const double sign = unit[0] >= 0.0 ? 1.0 : -1.0;
  for (int j = 1; j < K; ++j) {
    const double share = unit[j] / (1.0 + std::abs(unit[0]));
    tangent(0, j - 1) = -sign * unit[j];
    for (int i = 1; i < K; ++i) {
      tangent(i, j - 1) = (i == j ? 1.0 : 0.0) - unit[i] * share;
    }
  }
  return tangent;
}

struct Foot {
  Vec2 position = Vec2::Zero();
  double distance = 0.0;  ///< positive where the polynomial is
};

/// The conic at a foot.
struct ConicAtFoot {
  NormalAtFoot at;     ///< by arc length with the gradient on the left
  double slope = 0.0;  ///< of the polynomial: the length of its gradient
  double slope_by_arc = 0.0;
};

ConicAtFoot conic_at(const ConicCoefficients& q, const Foot& foot) {
  const Vec2 g = conic_gradient(q, foot.position);
  const double slope = g.norm();
  const Vec2 normal = g / slope;
  const Vec2 tangent = -left_of(normal);
  const Vec2 by_arc(2.0 * q[0] * tangent.x() + q[1] * tangent.y(),
                    q[1] * tangent.x() + 2.0 * q[2] * tangent.y());
  return {{normal, tangent, -tangent.dot(by_arc) / slope * normal, foot.distance},
          slope,
          normal.dot(by_arc)};
}

/// By what angle the normal at the foot turns, per coefficient: the curve moves along its normal
/// alone, by -(monomial) / |gradient|.
Monomials turn_by_coefficients(const ConicCoefficients& q, const Foot& foot) {
  const auto [at, slope, slope_by_arc] = conic_at(q, foot);
  if (!(slope > 0.0) || !at.is_followed()) {
    return Monomials::Zero();
  }
  const Vec2& t = at.first;
  const Vec2& p = foot.position;
  const Monomials by_arc(2.0 * p.x() * t.x(), p.y() * t.x() + p.x() * t.y(), 2.0 * p.y() * t.y(),
                         t.x(), t.y(), 0.0);
  return -(by_arc - slope_by_arc / slope * monomials(p)) / (slope * at.slope());
}

/// Residuals over the tangent space of the unit sphere at `start`, for minimise_residuals.
template <int K>
class SphereResiduals {
 public:
  enum { NUM_PARAMETERS = K - 1 };
  using Start = Eigen::Matrix<double, K, 1>;
  using Step = Eigen::Matrix<double, K - 1, 1>;

  SphereResiduals(std::span<const FitPoint> points, const ModelBasis<K>& basis, const Start& start,
                  int side, std::span<const Vec2> near, WorkBudget& work)
      : points_(points),
        basis_(basis),
        start_(start.normalized()),
        side_(side),
        near_(near.begin(), near.end()),
        feet_(points.size()),
        work_(work) {
    trial_.setConstant(std::numeric_limits<double>::quiet_NaN());
    tangent_ = tangent_space<K>(start_);
    if (count_normals(points) > 0) {
      weigh_normals();
    }
  }

  int NumResiduals() const { return static_cast<int>(points_.size() + normals_.size()); }

  /// Columns: the directions of a step's elements.
  const Eigen::Matrix<double, K, K - 1>& tangent() const { return tangent_; }

  ConicCoefficients coefficients(const Step& step) const {
    return basis_ * (start_ + tangent_ * step).normalized();
  }

  // The solver asks for residuals alone at a trial step, and for the Jacobian at the same one when
  // it is accepted: the foot points are there already.
  bool operator()(const double* step_data, double* residuals, double* jacobian) const {
    const Step step = Eigen::Map<const Step>(step_data);
    const Start moved = start_ + tangent_ * step;
    const double norm = moved.norm();
    const Start u = moved / norm;
    const ConicCoefficients q = basis_ * u;
    const std::size_t n = points_.size();
    const std::size_t rows = n + normals_.size();
    if (jacobian == nullptr || step != trial_) {
      place(q, step);
    }
    for (std::size_t i = 0; i < n; ++i) {
      const FitPoint& point = points_[i];
      residuals[i] = (feet_[i].distance - side_ * point.offset) * point.inverse_sigma;
    }
    for (std::size_t k = 0; k < normals_.size(); ++k) {
      const FitPoint& point = points_[normals_[k].point];
      const Vec2 normal = conic_gradient(q, feet_[normals_[k].point].position).normalized();
      residuals[n + k] = normals_[k].weight * normal_miss(point.normal, normal);
    }
    if (jacobian == nullptr) {
      return true;
    }
    for (std::size_t i = 0; i < near_.size(); ++i) {
      near_[i] = feet_[i].position;
    }
    const Eigen::Matrix<double, 6, K - 1> q_by_step =
        basis_ * ((tangent_ - u * (u.transpose() * tangent_)) / norm);
    for (std::size_t i = 0; i < n; ++i) {
      // Envelope theorem: only the curve's motion along its normal at the foot point counts.
      const Vec2& foot = feet_[i].position;
      const double gradient_norm = conic_gradient(q, foot).norm();
      const double factor = gradient_norm > 0.0 ? points_[i].inverse_sigma / gradient_norm : 0.0;
      const Eigen::Matrix<double, 1, K - 1> row =
          factor * (monomials(foot).transpose() * q_by_step);
      for (std::size_t k = 0; k < K - 1; ++k) {
        jacobian[k * rows + i] = row[static_cast<Eigen::Index>(k)];
      }
    }
    for (std::size_t j = 0; j < normals_.size(); ++j) {
      const Eigen::Matrix<double, 1, K - 1> row =
          normals_[j].weight *
          (turn_by_coefficients(q, feet_[normals_[j].point]).transpose() * q_by_step);
      for (std::size_t k = 0; k < K - 1; ++k) {
        jacobian[k * rows + n + j] = row[static_cast<Eigen::Index>(k)];
      }
    }
    return true;
  }

  /// Foot points on the curve `step`, where the solver has ended: found at its last trial, unless
  /// that was rejected.
  std::vector<Vec2> feet(const Step& step) const {
    if (step != trial_) {
      place(coefficients(step), step);
    }
    std::vector<Vec2> positions;
    positions.reserve(feet_.size());
    for (const Foot& foot : feet_) {
      positions.push_back(foot.position);
    }
    return positions;
  }

 private:
  void place(const ConicCoefficients& q, const Step& step) const {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      Foot& foot = feet_[i];
      const Vec2& point = points_[i].position;
      foot.distance = !near_.empty() && points_[i].offset > 0.0
                          ? signed_distance_of_tip(near_[i], q, point, &foot.position, work_)
                          : signed_distance(q, point, &foot.position);
    }
    trial_ = step;
  }

  /// Weights of the normals by the curve at the start: as found, not as sought.
  void weigh_normals() {
    const ConicCoefficients q = basis_ * start_;
    place(q, Step::Zero());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (has_normal(points_[i])) {
        normals_.push_back({i, weight_of_normal(q, feet_[i].position, points_[i])});
      }
    }
  }

  std::span<const FitPoint> points_;
  ModelBasis<K> basis_;
  Start start_;
  Eigen::Matrix<double, K, K - 1> tangent_;
  int side_;
  std::vector<WeighedNormal> normals_;
  mutable std::vector<Vec2> near_;  ///< feet of tips at the last accepted step; empty: not known
  mutable std::vector<Foot> feet_;  ///< at trial_
  mutable Step trial_;
  WorkBudget& work_;
};

template <int K>
ImplicitFit refine(std::span<const FitPoint> points, const ModelBasis<K>& basis,
                   const ConicCoefficients& start, int side, const RefineEffort& effort,
                   WorkBudget& work, std::span<const Vec2> near) {
  const Eigen::Matrix<double, K, 1> start_in_model = basis.transpose() * start;
  const SphereResiduals<K> residuals(points, basis, start_in_model, side, near, work);
  Eigen::Matrix<double, K - 1, 1> step = Eigen::Matrix<double, K - 1, 1>::Zero();
  const auto summary =
      minimise_residuals(residuals,
                         {.iterations = effort.iterations,
                          .chi2_tolerance = effort.chi2_tolerance,
                          .relative_tolerance = effort.relative_tolerance(residuals.NumResiduals()),
                          .coarse_above = most_chi2_of_noise(points),
                          .out_of_reach = effort.out_of_reach,
                          .work = &work,
                          .row = WorkKind::ConicRow,
                          .rows = points.size()},
                         &step);
  return {residuals.coefficients(step), summary.chi2, side, residuals.feet(step)};
}

/// How a foot is sought.
struct FootSteps {
  int most = 0;
  double least_slope = kLeastFootSlope;  ///< for a step by Newton's method
  /// Where there is less, Gauss-Newton's step along the curve; otherwise none, for it may lead
  /// anywhere.
  bool goes_on = false;
};

/// From the first-order foot, of a point that is near the curve.
constexpr FootSteps kFromNear{5};

/// From the foot of a neighbour, of a tip's centre. A ball that leaves a twentieth of its bore's
/// radius free has a twentieth of the slope: Gauss-Newton's steps take as much of the way each,
/// Newton's all. Where it leaves less than a hundredth, a foot may stay where it is: the distance
/// is as flat.
constexpr FootSteps kOfTip{20, 0.01, true};

struct Followed {
  bool found = false;
  int steps = 0;
};

/// Seeks the foot of a point from `foot`.
Followed follow_foot(const ConicCoefficients& q, const Vec2& point, const FootSteps& steps,
                     Vec2* foot) {
  // Newton's method on {Q(f) = 0, (point - f) x grad Q(f) = 0}.
  // After a last step s the foot point is off by about s^2 in normalised extents: by so much at
  // most, absolute and of the distance.
  constexpr double kAbsoluteError = 1e-12;
  constexpr double kRelativeError = 1e-8;
  Vec2& f = *foot;
  for (int taken = 0; taken < steps.most; ++taken) {
    const double v = value(q, f);
    const Vec2 g = conic_gradient(q, f);
    const double g2 = g.squaredNorm();
    if (g2 <= 0.0) {
      return {false, taken};
    }
    const Vec2 away = point - f;
    const double c = away.x() * g.y() - away.y() * g.x();
    // d(away x g)/df = H rotated: rows for f.x and f.y.
    const double cx = -g.y() + away.x() * q[1] - away.y() * 2.0 * q[0];
    const double cy = g.x() + away.x() * 2.0 * q[2] - away.y() * q[1];
    const double determinant = g.x() * cy - g.y() * cx;
    Vec2 step;
    if (determinant > steps.least_slope * g2) {
      step = {(-v * cy + c * g.y()) / determinant, (-g.x() * c + v * cx) / determinant};
    } else {
      step = -v / g2 * g;  // beyond the centre of curvature
      if (steps.goes_on) {
        step -= c / g2 * left_of(g);
      }
    }
    f += step;
    if (step.squaredNorm() < std::min(kAbsoluteError, kRelativeError * away.norm())) {
      return {true, taken + 1};
    }
  }
  return {false, steps.most};
}

/// Newton's first step from the point itself: its first-order (Sampson) foot.
Vec2 first_order_foot(const ConicCoefficients& q, const Vec2& point) {
  const Vec2 g = conic_gradient(q, point);
  const double g2 = g.squaredNorm();
  // At the centre of a conic there is no direction to go.
  return g2 > 0.0 ? Vec2(point - value(q, point) / g2 * g) : point;
}

/// Whether two points of a conic lie on two branches of a hyperbola: halfway between them is then
/// where the centre is, between the branches, and else within one.
bool are_on_two_branches(const ConicCoefficients& q, const Vec2& a, const Vec2& b) {
  return discriminant(q) < 0.0 && value(q, 0.5 * (a + b)) * value(q, centre_of(q)) > 0.0;
}

}  // namespace

double weight_of_normal(const ConicCoefficients& q, const Vec2& foot, const FitPoint& point) {
  const NormalAtFoot at = conic_at(q, {foot, signed_distance_from(foot, q, point.position)}).at;
  return at.normal.allFinite() && at.is_followed() ? normal_weight(point, at.turn_along()) : 0.0;
}

double normal_residual(const ConicCoefficients& q, const Vec2& foot, const FitPoint& point) {
  return weight_of_normal(q, foot, point) *
         normal_miss(point.normal, conic_gradient(q, foot).normalized());
}

double signed_distance(const ConicCoefficients& q, const Vec2& point, Vec2* foot) {
  *foot = first_order_foot(q, point);
  follow_foot(q, point, kFromNear, foot);
  return signed_distance_from(*foot, q, point);
}

double signed_distance_of_tip(const Vec2& near, const ConicCoefficients& q, const Vec2& point,
                              Vec2* foot, WorkBudget& work) {
  // A row's price is that of a point near the curve: so many steps cost as much.
  constexpr int kStepsOfRow = 8;
  // About the centre of a conic, where a tip may be that is as large as a bore's b or a hyperbola's
  // a, the polynomial is flat, the first-order foot anywhere, and the foot that it leads to any of
  // four.
  *foot = near;
  const Followed from_near = follow_foot(q, point, kOfTip, foot);
  int steps = from_near.steps;
  if (!from_near.found || are_on_two_branches(q, *foot, near)) {
    Vec2 other = first_order_foot(q, point);
    const Followed leads = follow_foot(q, point, kFromNear, &other);
    steps += leads.steps;
    if (leads.found && (other - near).squaredNorm() < (*foot - near).squaredNorm()) {
      *foot = other;
    }
  }
  work.spend(WorkKind::ConicRow, static_cast<std::size_t>(steps / kStepsOfRow));
  return signed_distance_from(*foot, q, point);
}

double signed_distance_from(const Vec2& foot, const ConicCoefficients& q, const Vec2& point) {
  const double distance = (point - foot).norm();
  return (point - foot).dot(conic_gradient(q, foot)) >= 0.0 ? distance : -distance;
}

ImplicitFit placed_on(std::span<const FitPoint> points, ImplicitFit fit) {
  fit.chi2 = 0.0;
  fit.feet.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double residual = signed_distance(fit.coefficients, points[i].position, &fit.feet[i]) *
                            points[i].inverse_sigma;
    fit.chi2 += residual * residual;
    if (has_normal(points[i])) {
      const double turned = normal_residual(fit.coefficients, fit.feet[i], points[i]);
      fit.chi2 += turned * turned;
    }
  }
  return fit;
}

ImplicitFit refine_conic(std::span<const FitPoint> points, const ConicCoefficients& start, int side,
                         const RefineEffort& effort, WorkBudget& work, std::span<const Vec2> near) {
  return refine<6>(points, conic_basis(), start, side, effort, work, near);
}

ImplicitFit refine_circle(std::span<const FitPoint> points, const ConicCoefficients& start,
                          int side, const RefineEffort& effort, WorkBudget& work,
                          std::span<const Vec2> near) {
  return refine<4>(points, circle_basis(), start, side, effort, work, near);
}

ImplicitFit refine_line(std::span<const FitPoint> points, const ConicCoefficients& start, int side,
                        const RefineEffort& effort, WorkBudget& work, std::span<const Vec2> near) {
  return refine<3>(points, line_basis(), start, side, effort, work, near);
}

}  // namespace palpate
