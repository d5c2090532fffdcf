#include "tests/bench/real/local_coverage.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <stdexcept>
#include <vector>

#include "core/curves/curve.h"

namespace palpate::bench {
namespace {

constexpr std::size_t kTurns = 36;

/// Twice the area to the left of a closed path.
double turned_area(const std::vector<Vec2>& points) {
  double area = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    area += cross(points[i], points[(i + 1) % points.size()]);
  }
  return area;
}

struct LaidPart {
  Pose2 world_T_part;
  double residual_rms_m = 0.0;
};

/// Least squares of the distances of the tip's centres less its radius, over the pose only.
/// Contacts beyond four robust deviations, which did not touch the part, are ignored.
LaidPart lay_part(const Curve& part, double tip_radius_m, const std::vector<Vec2>& centres,
                  double start_angle) {
  constexpr int kIterations = 100;
  constexpr double kConverged_m = 1e-12;
  constexpr double kOutlier = 4.0;
  constexpr double kSigmaOfMedian = 1.4826;
  Vec2 mean = Vec2::Zero();
  for (const Vec2& c : centres) {
    mean += c / static_cast<double>(centres.size());
  }
  LaidPart laid{{mean.x(), mean.y(), start_angle}};
  const auto count = static_cast<Eigen::Index>(centres.size());
  const double size = (centres.front() - mean).norm();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::MatrixX3d jacobian(count, 3);
    Eigen::VectorXd residuals(count);
    std::vector<double> sizes;
    for (Eigen::Index i = 0; i < count; ++i) {
      const Vec2& centre = centres[static_cast<std::size_t>(i)];
      const Vec2 local = laid.world_T_part.to_local(centre);
      const FootPoint foot = foot_point(part, local);
      const Vec2 outwards = laid.world_T_part.rotate((local - foot.position).normalized());
      const Vec2 arm = centre - laid.world_T_part.translation();
      residuals[i] = (local - foot.position).norm() - tip_radius_m;
      jacobian.row(i) << outwards.x(), outwards.y(), cross(arm, outwards) / size;
      sizes.push_back(std::abs(residuals[i]));
    }
    auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    const double most = kOutlier * kSigmaOfMedian * *middle;
    double used = 0.0;
    double squares = 0.0;
    for (Eigen::Index i = 0; i < count; ++i) {
      if (std::abs(residuals[i]) > most) {
        jacobian.row(i).setZero();
        residuals[i] = 0.0;
      } else {
        used += 1.0;
        squares += residuals[i] * residuals[i];
      }
    }
    laid.residual_rms_m = std::sqrt(squares / used);
    if (class_of(part) == CurveClass::Circle) {
      jacobian.col(2).setZero();  // its angle is free and stays unchanged
    }
    const Eigen::Vector3d step = jacobian.completeOrthogonalDecomposition().solve(residuals);
    if (!step.allFinite()) {
      break;
    }
    laid.world_T_part.x += step[0];
    laid.world_T_part.y += step[1];
    laid.world_T_part.theta += step[2] / size;
    if (step.norm() < kConverged_m) {
      return laid;
    }
  }
  throw std::runtime_error("the part cannot be laid on the recording");
}

LaidPart best_laid(const Curve& part, double tip_radius_m, const std::vector<Vec2>& centres) {
  constexpr int kStarts = 4;  // over half a turn, the part's symmetry
  LaidPart best;
  for (int i = 0; i < kStarts; ++i) {
    const LaidPart laid = lay_part(part, tip_radius_m, centres, i * kPi / kStarts);
    if (i == 0 || laid.residual_rms_m < best.residual_rms_m) {
      best = laid;
    }
  }
  return best;
}

struct Tally {
  int count = 0;
  std::array<int, 2> within{};
  std::array<double, 2> squares{};
};

/// One turn starting at contact `first`: compares every estimate with the truth.
void walk(const EllipsePart& part, const Curve& curve, const LaidPart& laid, std::size_t first,
          double form_deviation_m, bool leftwards, Tally* tally) {
  constexpr double kDeviations = 2.0;
  RecognizerOptions options;
  options.form_deviation_m = form_deviation_m;
  Recognizer recognizer(options);
  recognizer.stream_estimates(true);
  PatchContext context = part.recording.context;
  context.material_side = leftwards ? MaterialSide::Left : MaterialSide::Right;
  const std::vector<Vec2>& points = part.recording.points;
  std::vector<ContactSample> samples;
  for (std::size_t i = 0; i < points.size(); ++i) {
    samples.push_back({points[(first + i) % points.size()], 0.0, 0});
  }
  recognizer.add(context, samples);
  for (const LocalizedContact& contact : recognizer.take_estimates()) {
    const LocalEstimate& e = contact.estimate;
    const LocalGeometry along =
        geometry(curve, foot_point(curve, laid.world_T_part.to_local(e.position)).t);
    const LocalGeometry truth = leftwards ? along : reversed(along);
    const std::array errors = {e.kappa - truth.kappa, e.kappa_s - truth.kappa_s};
    ++tally->count;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto row = static_cast<Eigen::Index>(k) + 2;
      const double z = errors[k] / std::sqrt(e.covariance(row, row));
      tally->within[k] += std::abs(z) <= kDeviations ? 1 : 0;
      tally->squares[k] += z * z;
    }
  }
}

}  // namespace

void print_local_coverage(const EllipsePart& part, std::ostream& out) {
  const Curve curve = part.semi_major_m > part.semi_minor_m
                          ? Curve(Ellipse{part.semi_major_m, part.semi_minor_m})
                          : Curve(Circle{part.semi_major_m});
  const std::vector<Vec2>& points = part.recording.points;
  const LaidPart laid = best_laid(curve, part.recording.context.tip_radius_m, points);
  const bool leftwards = turned_area(points) > 0.0;
  out << "\nThe sliding window along " << kTurns
      << " turns from as many places: kappa and kappa_s beside the part's where each estimate "
         "lies; "
         "noise not told; the part laid on the contacts by its pose leaves "
      << std::setprecision(2) << laid.residual_rms_m
      << " m rms.\n\n| form deviation [m] | estimates | kappa within 2 deviations [%] | kappa_s "
         "[%] "
         "| rms error over deviation, kappa | kappa_s |\n|---|---|---|---|---|---|\n";
  std::vector<double> told = {0.0};
  if (part.form_deviation_m > 0.0) {
    told.push_back(part.form_deviation_m);
  }
  for (const double form_deviation_m : told) {
    Tally tally;
    for (std::size_t i = 0; i < kTurns; ++i) {
      walk(part, curve, laid, i * points.size() / kTurns, form_deviation_m, leftwards, &tally);
    }
    out << "| " << form_deviation_m << " | " << tally.count << std::setprecision(3);
    for (const int within : tally.within) {
      out << " | " << 100.0 * within / tally.count;
    }
    for (const double squares : tally.squares) {
      out << " | " << std::sqrt(squares / tally.count);
    }
    out << " |\n";
  }
}

}  // namespace palpate::bench
